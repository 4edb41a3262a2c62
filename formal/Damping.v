(** Gains that break a bound on K_v and have dV/dt < 0 nevertheless. *)
From Coq Require Import QArith Qreals List Lra Lia Reals FunctionalExtensionality.
Require Import Definitions.
Require Import Arm Certified.
Import ListNotations.
Open Scope R_scope.

Lemma entries_scaled k l : entries (map (Qmult k) l) = fun i => Q2R k * entries l i.
Proof.
  apply functional_extensionality. intros i. unfold entries. revert i. induction l as [|x l IH]; intros [|i]; cbn [map nth]; auto; rewrite ?Q2R_mult, ?Q2R_0; ring.
Qed.
Theorem damping_above A m kp kv largest bound k eps0 : Qle_bool k 0 = false -> Qle_bool eps0 0 = false ->
  certified A m kp (map (Qmult k) kv) eps0 -> bound <= Q2R k * Q2R largest -> ~ damping_below A m kp kv largest bound.
Proof.
  intros Hk He [P D] Hb B. assert (K : Q2R k * Q2R largest < bound).
  { apply (B (Q2R k) (Q2R eps0)); try (now apply positive_Q); auto. intros qd. destruct (D qd) as [D1 _]. now rewrite entries_scaled in D1. }
  lra.
Qed.
