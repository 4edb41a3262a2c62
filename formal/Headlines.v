(** The headline theorems: what each says in the words of Definitions.v, and the axioms it rests on. *)
Require Import Lyapcheck.Certificates.
Import Lyapcheck.Definitions.
Set Printing Width 118.
Check proposition_of_the_paper.
Check V_of_the_paper.
Check tracking_of_the_paper.
Check V_is_positive_definite.
Check V_is_radially_unbounded.
Check origin_is_only_equilibrium.
Check pendulums.
Check h_derive.
Check U_derive.
Check Gate.accepts.
Check Gate.saturated.
Check Gate.saturated_rejects.
Definition headlines := (proposition_of_the_paper, V_of_the_paper, tracking_of_the_paper, V_is_positive_definite, V_is_radially_unbounded,
  origin_is_only_equilibrium, pendulums, h_derive, U_derive, Gate.accepts, Gate.saturated, Gate.saturated_rejects).
Print Assumptions headlines.
