(** What the gate says of gains on an arm with motors: to be read after Definitions.v, as the rest of what a statement means. *)
From Coq Require Import Reals QArith Qreals List.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Import ListNotations.
Open Scope R_scope.

(** A polynomial in sines and cosines of n angles and in parameters p, whose powers follow those of the cosines. *)
Definition poly_with (n : nat) (ts : list monomial) (p q : vec) : R := fold_right (fun t s =>
  product (length (fst t) - 2 * n) (fun k => p k ^ nth (2 * n + k) (fst t) 0%nat) * monomial_at n q t + s) 0 ts.
(** Gains for an arm: g(q) and its potential, the ranges of the parameters in them, the bounds k_gi, the range of each b_i, the
    limits of the motors, m, K_p and K_v. *)
Record gated := Gated { axes : nat; torques : list (list monomial); pull : list monomial; ranges : list (Q * Q); k_g : list Q;
  friction : list (Q * Q); limit : list Q; family : nat; k_p : list Q; k_v : list Q }.
Definition gravity_at (D : gated) (p q : vec) : vec := fun i => poly_with (axes D) (nth i (torques D) []) p q.
(** K_p h_m(e) - K_v h_m(w) + g(q), entry i: the command of (6). *)
Definition command (D : gated) (p e w q : vec) : vec := fun i =>
  entries (k_p D) i * h (family D) (e i) - entries (k_v D) i * h (family D) (w i) + gravity_at D p q i.
(** g is the gradient of the potential; |g_i(q)| <= k_gi; and what a motor does: the whole command. *)
Definition gravity_known (D : gated) (p : vec) : Prop := forall q i, (i < axes D)%nat -> gravity_at D p q i = partial (poly_with (axes D) (pull D) p) i q.
Definition gravity_kept (D : gated) (p : vec) : Prop := forall q i, (i < axes D)%nat -> Rabs (gravity_at D p q i) <= entries (k_g D) i.
Definition clip (top u : R) : R := Rmax (- top) (Rmin top u).
Definition within_limits (D : gated) (p : vec) : Prop := forall e w q i, (i < axes D)%nat ->
  Rabs (command D p e w q i) <= entries (limit D) i /\ clip (entries (limit D) i) (command D p e w q i) = command D p e w q i.
(** (10p), (10i) and (19), for every b in its range. *)
Definition root_n (D : gated) : R := sqrt (INR (axes D)).
Definition holds_10p (D : gated) : Prop := forall i, (i < axes D)%nat ->
  entries (k_p D) i + entries (k_v D) i < (entries (limit D) i - entries (k_g D) i) / (root_n D * gamma (family D)).
Definition holds_10i (D : gated) : Prop := forall i, (i < axes D)%nat ->
  entries (k_p D) i + entries (k_v D) i <= (entries (limit D) i - entries (k_g D) i) / gamma (family D).
Definition holds_19 (D : gated) : Prop := forall b, in_ranges (friction D) b -> forall i j, (i < axes D)%nat -> (j < axes D)%nat ->
  entries (k_v D) i < b j / (root_n D * gamma (family D)).
(** Which of them the gains have to meet. *)
Record asked := Asked { by_10p : bool; by_10i : bool; by_19 : bool }.
(** All that the gate says of gains that it accepts, for every arm in the ranges; k_g is the same everywhere. *)
Definition gate_accepts (D : gated) (c : asked) : Prop :=
  positive (axes D) (entries (k_p D)) /\ positive (axes D) (entries (k_v D)) /\
  (forall p, in_ranges (ranges D) p -> gravity_known D p /\ gravity_kept D p /\ ((by_10p c = true \/ by_10i c = true) -> within_limits D p)) /\
  (by_10p c = true -> holds_10p D) /\ (by_10i c = true -> holds_10i D) /\ (by_19 c = true -> holds_19 D).
(** Some arm in the ranges has a state at which the command of motor i is beyond its limit. *)
Definition saturates (D : gated) (i : nat) : Prop := exists p e w q, in_ranges (ranges D) p /\ entries (limit D) i < Rabs (command D p e w q i).
