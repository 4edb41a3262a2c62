(** The headline theorems: what each says in the words of Definitions.v, and the axioms it rests on. *)
Require Import Lyapcheck.Certificates.
Import Lyapcheck.SampledDefinitions.
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
Check Period.bounds_goal.
Check Period.bounds_rest.
Check Period.potential_goal.
Check Period.potential_rest.
Check Period.gravity_in.
Check Goal.S_suffices.
Check Rests.comes_to_rest.
Check Rests.settles.
Check Witness.rest_runs.
Definition headlines := (proposition_of_the_paper, V_of_the_paper, tracking_of_the_paper, V_is_positive_definite, V_is_radially_unbounded,
  origin_is_only_equilibrium, pendulums, h_derive, U_derive, Gate.accepts, Gate.saturated, Gate.saturated_rejects,
  Period.bounds_goal, Period.bounds_rest, Period.potential_goal, Period.potential_rest, Period.gravity_in, Goal.S_suffices, @Rests.comes_to_rest,
  @Rests.settles, Witness.rest_runs).
Print Assumptions headlines.
