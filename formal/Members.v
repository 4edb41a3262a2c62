(** h_m with given bounds, and over intervals. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia Reals Psatz.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Real.Xreal.
Require Import Definitions.
Require Loop Family.
Require Import Boxes.
Open Scope R_scope.

Definition member_of (m : nat) (Hm : (1 <= m)%nat) (ga ro Lp : Q) (Hg : forall x, Rabs (h m x) <= Q2R ga) (Hr : forall x, Rabs (dh m x) <= Q2R ro)
  (Hl : forall x, Rabs (h m x) <= Q2R Lp * Rabs x) : Loop.member.
Proof.
  refine (Loop.Member (h m) (dh m) (U m) (Q2R ga) (Q2R ro) (Q2R Lp) _ _ _ (Family.h_derive m Hm) (Family.U_derive m Hm) _ _ _ (Family.U_zero m Hm) Hg Hr Hl).
  - eapply Rle_trans; [apply Rabs_pos|apply (Hg 0)].
  - eapply Rle_trans; [apply Rabs_pos|apply (Hr 0)].
  - specialize (Hl 1). rewrite Rabs_R1, Rmult_1_r in Hl. eapply Rlt_le_trans; [|exact Hl]. apply Rabs_pos_lt.
    pose proof (Family.h_pos m 1 ltac:(lra)). lra.
  - intros x. apply Family.h_sign; auto.
  - apply Family.h_zero; auto.
  - intros x. apply Family.U_pos; auto.
Defined.

(** *** m = 1: h = tanh = 1 - 2 / (exp(2 x) + 1), h' = 1 - h^2 *)
Definition one_minus (i : I.type) : I.type := I.sub prec (I.fromZ prec 1) i.
Definition h1_I (i : I.type) : I.type :=
  one_minus (I.div prec (I.fromZ prec 2) (I.add prec (I.exp prec (I.mul prec (I.fromZ prec 2) i)) (I.fromZ prec 1))).
Definition dh1_I (i : I.type) : I.type := one_minus (I.sqr prec (h1_I i)).
Lemma h1_exp x : h 1 x = 1 - 2 / (exp (2 * x) + 1).
Proof.
  unfold h, bottom. replace (2 * 1 - 1)%nat with 1%nat by lia. replace (2 * 1)%nat with 2%nat by lia.
  rewrite pow_1, <- Family.cosh2. pose proof (Family.cosh_pos x). pose proof (exp_pos x).
  replace (2 * x) with (x + x) by ring. rewrite exp_plus. unfold sinh, cosh in *. rewrite exp_Ropp in *.
  assert (0 < / exp x) by (apply Rinv_0_lt_compat; auto). field. repeat split; nra.
Qed.
Lemma dh1_h x : dh 1 x = 1 - h 1 x * h 1 x.
Proof.
  unfold dh, h, bottom. replace (2 * 1 - 1)%nat with 1%nat by lia. replace (2 * 1 - 2)%nat with 0%nat by lia.
  replace (4 * 1 - 2)%nat with 2%nat by lia. replace (2 * 1)%nat with 2%nat by lia.
  pose proof (Family.cosh2 x) as E. pose proof (pow2_ge_0 (sinh x)). simpl INR. set (s := sinh x) in *. set (c := cosh x) in *. clearbody s c.
  replace (1 + s ^ 2) with (c ^ 2) by lra. assert (Hc : c ^ 2 <> 0) by lra. assert (Hc1 : c <> 0) by (intros ->; apply Hc; ring).
  simpl pow at 1 3. field_simplify_eq; [|auto]. nra.
Qed.
Lemma h1_correct i x : rel i x -> rel (h1_I i) (h 1 x).
Proof.
  intros K. rewrite h1_exp. apply rel_sub; [apply rel_cst|]. apply rel_div; [apply rel_cst|]. apply rel_add; [|apply rel_cst].
  apply rel_expo. apply rel_mul; [apply rel_cst|exact K].
Qed.
Lemma dh1_correct i x : rel i x -> rel (dh1_I i) (dh 1 x).
Proof. intros K. rewrite dh1_h. apply rel_sub; [apply rel_cst|]. now apply rel_sqr, h1_correct. Qed.
