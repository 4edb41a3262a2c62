(** h_m with given bounds, and over intervals. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia Reals Psatz.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Interval.Interval Interval.Float_full Float.Basic Float.Primitive_ops Real.Xreal.
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

(** *** Any m: with a = 1 - exp(-2 |x|) and y = 4 (1 - a) both are rational functions of a in [0, 1), without overflow:
    h = a^(2m-1) (2 - a) / (a^(2m) + y^m),  h' = y P ((2m-1) y^m + 2m a^2 y^(m-1) - P a^2) / (P a^2 + y^m)^2,  P = a^(2m-2) *)
Section Rational.
Variable m : nat.
Hypothesis Hm : (1 <= m)%nat.
Section In.
Variable A : arith.
Fixpoint pw (x : num A) (k : nat) : num A := match k with O => cst A 1 | S O => x | S k' => mul A x (pw x k') end.
Definition h_A (a : num A) : num A :=
  let a2 := sqr A a in let P := pw a2 (m - 1) in let y := mul A (cst A 4) (sub A (cst A 1) a) in
  div A (mul A (mul A a P) (sub A (cst A 2) a)) (add A (mul A P a2) (pw y m)).
Definition dh_A (a : num A) : num A :=
  let a2 := sqr A a in let P := pw a2 (m - 1) in let y := mul A (cst A 4) (sub A (cst A 1) a) in
  let z := pw y (m - 1) in let ym := pw y m in
  div A (mul A (mul A y P) (sub A (add A (mul A (cst A (Z.of_nat (2 * m - 1))) ym) (mul A (mul A (cst A (Z.of_nat (2 * m))) a2) z)) (mul A P a2)))
        (sqr A (add A ym (mul A P a2))).
End In.
Lemma pw_R x k : pw RA x k = x ^ k.
Proof.
  induction k as [|k IH]; [reflexivity|]. destruct k; [change (num RA) with R in *; simpl; ring|].
  change (pw RA x (S (S k))) with (x * pw RA x (S k)). rewrite IH. reflexivity.
Qed.
Lemma rel_pw i x k : rel i x -> rel (pw IA i k) (pw RA x k).
Proof.
  intros K. induction k as [|k IH]; [apply rel_cst|]. destruct k; [exact K|].
  change (rel (I.mul prec i (pw IA i (S k))) (x * pw RA x (S k))). now apply rel_mul.
Qed.
Lemma rel_h_A i x : rel i x -> rel (h_A IA i) (h_A RA x).
Proof.
  intros K. unfold h_A. cbv zeta. apply rel_div; [apply rel_mul; [apply rel_mul; [exact K|apply rel_pw; now apply rel_sqr]|apply rel_sub; [apply rel_cst|exact K]]|].
  apply rel_add; [apply rel_mul; [apply rel_pw|]; now apply rel_sqr|apply rel_pw]. apply rel_mul; [apply rel_cst|]. apply rel_sub; [apply rel_cst|exact K].
Qed.
Lemma rel_dh_A i x : rel i x -> rel (dh_A IA i) (dh_A RA x).
Proof.
  intros K. unfold dh_A. cbv zeta.
  assert (Y : rel (mul IA (cst IA 4) (sub IA (cst IA 1) i)) (mul RA (cst RA 4) (sub RA (cst RA 1) x))) by (apply rel_mul; [apply rel_cst|apply rel_sub; [apply rel_cst|exact K]]).
  assert (A2 : rel (sqr IA i) (sqr RA x)) by now apply rel_sqr.
  pose proof (rel_pw _ _ (m - 1) A2) as P. pose proof (rel_pw _ _ (m - 1) Y) as Z. pose proof (rel_pw _ _ m Y) as Ym.
  apply rel_div; [apply rel_mul; [now apply rel_mul|]|].
  - apply rel_sub; [|now apply rel_mul]. apply rel_add; [apply rel_mul; [apply rel_cst|exact Ym]|]. apply rel_mul; [|exact Z]. apply rel_mul; [apply rel_cst|exact A2].
  - apply rel_sqr. apply rel_add; [exact Ym|now apply rel_mul].
Qed.

(** The functions themselves, for x >= 0. *)
Section At.
Variable x : R.
Notation z := (2 * exp (- x)).
Notation a := (1 - exp (- 2 * x)).
Lemma a_sinh : a = z * sinh x.
Proof. unfold sinh. replace (-2 * x) with (- x + - x) by ring. rewrite exp_plus. assert (exp x * exp (- x) = 1) by (rewrite <- exp_plus, Rplus_opp_r; apply exp_0). nra. Qed.
Lemma a_cosh : 2 - a = z * cosh x.
Proof. unfold cosh. replace (-2 * x) with (- x + - x) by ring. rewrite exp_plus. assert (exp x * exp (- x) = 1) by (rewrite <- exp_plus, Rplus_opp_r; apply exp_0). nra. Qed.
Lemma z_pos : 0 < z. Proof. pose proof (exp_pos (- x)). lra. Qed.
Lemma y_z : 4 * (1 - a) = z ^ 2.
Proof. replace (-2 * x) with (- x + - x) by ring. rewrite exp_plus. ring. Qed.
Lemma h_by_a : h_A RA a = h m x.
Proof.
  unfold h_A. cbv zeta. rewrite !pw_R. cbv [div mul add sub sqr cst RA]. rewrite y_z, a_cosh, a_sinh. unfold h, bottom.
  pose proof z_pos as Z. set (Zz := z) in *. set (s := sinh x). set (c := cosh x). clearbody Zz s c.
  replace (Zz * s * (Zz * s)) with (Zz ^ 2 * s ^ 2) by ring.
  assert (B : 1 + s ^ (2 * m) <> 0) by (pose proof (Family.even_pow_pos s m); lra).
  assert (Zm : Zz ^ (2 * m) <> 0) by (apply pow_nonzero; lra).
  assert (E1 : (Zz ^ 2 * s ^ 2) ^ (m - 1) * (Zz ^ 2 * s ^ 2) = Zz ^ (2 * m) * s ^ (2 * m)).
  { rewrite Rmult_comm, tech_pow_Rmult. replace (S (m - 1)) with m by lia. rewrite Rpow_mult_distr, <- !pow_mult. reflexivity. }
  assert (E2 : Zz * s * (Zz ^ 2 * s ^ 2) ^ (m - 1) * (Zz * c) = Zz ^ (2 * m) * (s ^ (2 * m - 1) * c)).
  { rewrite Rpow_mult_distr, <- !pow_mult. assert (M1 : (2 * m - 1 = 1 + 2 * (m - 1))%nat) by lia. assert (M2 : (2 * m = 2 + 2 * (m - 1))%nat) by lia.
    rewrite M1, M2, !pow_add. ring. }
  rewrite E1, E2, <- pow_mult. replace (Zz ^ (2 * m) * s ^ (2 * m) + Zz ^ (2 * m)) with (Zz ^ (2 * m) * (1 + s ^ (2 * m))) by ring.
  match goal with |- @eq _ ?u ?v => change (@eq R u v) end. field. split; auto.
Qed.
Lemma dh_by_a : dh_A RA a = dh m x.
Proof.
  unfold dh_A. cbv zeta. rewrite !pw_R. cbv [div mul add sub sqr cst RA]. rewrite y_z, a_sinh. unfold dh, bottom.
  pose proof z_pos as Z. set (Zz := z) in *. set (s := sinh x). clearbody Zz s. rewrite <- !INR_IZR_INZ.
  set (k1 := INR (2 * m - 1)). set (k2 := INR (2 * m)).
  replace (Zz * s * (Zz * s)) with (Zz ^ 2 * s ^ 2) by ring.
  assert (B : 1 + s ^ (2 * m) <> 0) by (pose proof (Family.even_pow_pos s m); lra).
  assert (Zm : Zz ^ (2 * m) <> 0) by (apply pow_nonzero; lra).
  assert (E1 : (Zz ^ 2 * s ^ 2) ^ (m - 1) * (Zz ^ 2 * s ^ 2) = Zz ^ (2 * m) * s ^ (2 * m)).
  { rewrite Rmult_comm, tech_pow_Rmult. replace (S (m - 1)) with m by lia. rewrite Rpow_mult_distr, <- !pow_mult. reflexivity. }
  rewrite E1, <- !pow_mult.
  assert (E2 : Zz ^ 2 * (Zz ^ 2 * s ^ 2) ^ (m - 1) = Zz ^ (2 * m) * s ^ (2 * m - 2)).
  { rewrite Rpow_mult_distr, <- !pow_mult. assert (M1 : (2 * m - 2 = 2 * (m - 1))%nat) by lia. assert (M2 : (2 * m = 2 + 2 * (m - 1))%nat) by lia.
    rewrite M1, M2, !pow_add. ring. }
  assert (E3 : k2 * (Zz ^ 2 * s ^ 2) * Zz ^ (2 * (m - 1)) = Zz ^ (2 * m) * (k2 * s ^ 2)).
  { assert (M2 : (2 * m = 2 + 2 * (m - 1))%nat) by lia. rewrite M2, pow_add. ring. }
  assert (E4 : s ^ (2 * m) = s ^ (2 * m - 2) * s ^ 2) by (rewrite <- pow_add; f_equal; lia).
  assert (E5 : s ^ (4 * m - 2) = s ^ (2 * m - 2) * s ^ (2 * m)) by (rewrite <- pow_add; f_equal; lia).
  rewrite E2, E3. replace (Zz ^ (2 * m) * s ^ (2 * m - 2) * (k1 * Zz ^ (2 * m) + Zz ^ (2 * m) * (k2 * s ^ 2) - Zz ^ (2 * m) * s ^ (2 * m)))
    with (Zz ^ (2 * m) * Zz ^ (2 * m) * (k1 * s ^ (2 * m - 2) + k2 * (s ^ (2 * m - 2) * s ^ 2) - s ^ (2 * m - 2) * s ^ (2 * m))) by ring.
  rewrite <- E4, <- E5.
  replace (Zz ^ (2 * m) + Zz ^ (2 * m) * s ^ (2 * m)) with (Zz ^ (2 * m) * (1 + s ^ (2 * m))) by ring.
  match goal with |- @eq _ ?u ?v => change (@eq R u v) end. field. split; auto.
Qed.
End At.

(** In 2^k parts of the interval of a, which are joined: each entry occurs several times. *)
Fixpoint parted (k : nat) (f : I.type -> I.type) (s : side) : I.type :=
  match k with
  | O => f (span s)
  | S k' => let c := PrimFloat.mul 0.5 (PrimFloat.add (fst s) (snd s)) in
      if is_real c then I.join (parted k' f (fst s, c)) (parted k' f (c, snd s)) else f (span s)
  end.
Lemma parted_correct F f : (forall i x, rel i x -> rel (f i) (F x)) -> forall k s x, is_real (fst s) = true -> is_real (snd s) = true -> inside s x -> rel (parted k f s) (F x).
Proof.
  intros Hf. induction k as [|k IH]; intros [l u] x Rl Ru Hx; cbn [parted fst snd] in *.
  - apply Hf. apply span_correct; cbn [fst snd]; [rewrite Rl, Ru; reflexivity|exact Hx].
  - destruct (is_real (PrimFloat.mul 0.5 (PrimFloat.add l u))) eqn:Rc.
    + destruct Hx as [X1 X2]. cbn [fst snd] in *. apply I.join_correct.
      destruct (Rle_dec x (value (PrimFloat.mul 0.5 (PrimFloat.add l u)))); [left|right]; apply IH; auto; split; cbn [fst snd]; lra.
    + apply Hf. apply span_correct; cbn [fst snd]; [rewrite Rl, Ru; reflexivity|exact Hx].
Qed.
Definition over (k : nat) (f : I.type -> I.type) (i : I.type) : I.type :=
  let s := (I.lower i, I.upper i) in if is_real (fst s) && is_real (snd s) then parted k f s else f i.
Lemma over_correct k F f i x : (forall i x, rel i x -> rel (f i) (F x)) -> rel i x -> rel (over k f i) (F x).
Proof.
  intros Hf K. unfold over. destruct (is_real _ && is_real _)%bool eqn:E; [|now apply Hf]. apply andb_prop in E. destruct E as [El Eu]. cbn [fst snd] in *.
  apply parted_correct; auto. unfold inside. cbn [fst snd]. pose proof (real_val _ El) as Vl. pose proof (real_val _ Eu) as Vu.
  destruct i as [|l u]; cbn [I.lower I.upper] in *.
  - discriminate El.
  - unfold rel in K. cbn [I.convert] in K. destruct (I.F.valid_lb l && I.F.valid_ub u)%bool; cbn [I.convert contains] in K; [|lra].
    change I.F.toX with F.toX in K. rewrite Vl, Vu in K. exact K.
Qed.
Definition a_I (i : I.type) : I.type := I.sub prec (I.fromZ prec 1) (I.exp prec (I.mul prec (I.fromZ prec (-2)) i)).
Lemma a_correct i x : rel i x -> rel (a_I i) (1 - exp (-2 * x)).
Proof. intros K. apply rel_sub; [apply rel_cst|]. apply rel_expo. apply rel_mul; [apply rel_cst|exact K]. Qed.
Lemma rel_abs i x : rel i x -> rel (I.abs i) (Rabs x).
Proof. intros K. exact (I.abs_correct i (Xreal x) K). Qed.
Variable k : nat.
Definition h_I (i : I.type) : I.type :=
  let j := over k (h_A IA) (a_I (I.abs i)) in
  match I.sign_large i with Xgt | Xeq => j | Xlt => I.neg j | Xund => I.join j (I.neg j) end.
Definition dh_I (i : I.type) : I.type := over k (dh_A IA) (a_I (I.abs i)).
Theorem h_correct i x : rel i x -> rel (h_I i) (h m x).
Proof.
  intros K. unfold h_I. cbv zeta.
  assert (J : rel (over k (h_A IA) (a_I (I.abs i))) (h m (Rabs x))).
  { rewrite <- h_by_a. apply (over_correct k (h_A RA)); [apply rel_h_A|]. apply a_correct. now apply rel_abs. }
  set (j := over _ _ _) in *. clearbody j. pose proof (I.sign_large_correct i) as Sg.
  assert (P : 0 <= x -> rel j (h m x)) by (intros Hx; rewrite Rabs_pos_eq in J; auto).
  assert (N : x <= 0 -> rel (I.neg j) (h m x)).
  { intros Hx. rewrite <- (Ropp_involutive (h m x)), <- (Family.h_odd m Hm). apply rel_neg. rewrite Rabs_left1 in J; auto. }
  destruct (I.sign_large i).
  - specialize (Sg _ K). apply P. apply (f_equal proj_val) in Sg. cbn [proj_val] in Sg. lra.
  - specialize (Sg _ K). apply N. destruct Sg as [_ Sg]. cbn [proj_val] in Sg. lra.
  - specialize (Sg _ K). apply P. destruct Sg as [_ Sg]. cbn [proj_val] in Sg. lra.
  - apply I.join_correct. destruct (Rle_dec 0 x); [left; apply P; auto|right; apply N; lra].
Qed.
Theorem dh_correct i x : rel i x -> rel (dh_I i) (dh m x).
Proof.
  intros K. unfold dh_I. assert (E : dh m x = dh m (Rabs x)).
  { unfold Rabs. destruct (Rcase_abs x); auto. now rewrite (Family.dh_even m Hm). }
  rewrite E, <- dh_by_a. apply (over_correct k (dh_A RA)); [apply rel_dh_A|]. apply a_correct. now apply rel_abs.
Qed.
End Rational.
