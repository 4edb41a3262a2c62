(** Bounds of h_m, h_m' and h_m(x)/x for one m by inequalities between polynomials on [0, 1], and what follows
    for gamma_m, rho_m and L_m.  With u = sinh^2 x everything is rational in u; t is u, or 1/u. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Tactic.
Require Import Definitions Family.
Open Scope R_scope.
Local Arguments Nat.mul : simpl never.
Local Arguments Nat.sub : simpl never.
Local Arguments INR : simpl never.
Local Arguments pow : simpl never.

Lemma inverse_power u k j : 0 < u -> (j <= k)%nat -> u ^ j = u ^ k * (/ u) ^ (k - j).
Proof.
  intros P H. replace k with (j + (k - j))%nat at 1 by lia. rewrite pow_add, Rmult_assoc, <- Rpow_mult_distr.
  rewrite Rinv_r by lra. now rewrite pow1, Rmult_1_r.
Qed.
Section Member.
Variable m : nat.
Hypothesis Hm : (1 <= m)%nat.

(** A polynomial inequality for u >= 0, from two on [0, 1]. *)
Lemma everywhere (p q : R -> R) : (forall t, 0 <= t <= 1 -> 0 <= p t) -> (forall t, 0 <= t <= 1 -> 0 <= q t) ->
  (forall u, 1 < u -> p u = u ^ (2 * m) * q (/ u)) -> forall u, 0 <= u -> 0 <= p u.
Proof.
  intros Hp Hq E u Hu. destruct (Rle_dec u 1) as [K|K]; [apply Hp; lra|]. rewrite E by lra. apply Rmult_le_pos; [apply pow_le; lra|].
  apply Hq. split; [left; apply Rinv_0_lt_compat; lra|]. rewrite <- Rinv_1. apply Rinv_le_contravar; lra.
Qed.
Theorem h_at_most c : 0 <= c ->
  (forall t, 0 <= t <= 1 -> 0 <= c ^ 2 * (1 + t ^ m) ^ 2 - t ^ (2 * m - 1) * (1 + t)) ->
  (forall t, 0 <= t <= 1 -> 0 <= c ^ 2 * (1 + t ^ m) ^ 2 - (1 + t)) -> forall x, Rabs (h m x) <= c.
Proof.
  intros Hc H1 H2. apply (h_bounded_by m Hm); auto. intros u Hu.
  assert (0 <= c ^ 2 * (1 + u ^ m) ^ 2 - u ^ (2 * m - 1) * (1 + u)); [|lra].
  refine (everywhere (fun u => c ^ 2 * (1 + u ^ m) ^ 2 - u ^ (2 * m - 1) * (1 + u)) (fun t => c ^ 2 * (1 + t ^ m) ^ 2 - (1 + t)) H1 H2 _ u Hu).
  intros v Hv. cbv beta. set (t := / v).
  assert (E0 : v * t = 1) by (apply Rinv_r; lra).
  assert (E1 : v ^ (2 * m - 1) = v ^ (2 * m) * t).
  { rewrite (inverse_power v (2 * m) (2 * m - 1)) by (lra || lia). replace (2 * m - (2 * m - 1))%nat with 1%nat by lia. now rewrite pow_1. }
  assert (E2 : v ^ m = v ^ m * v ^ m * t ^ m).
  { rewrite Rmult_assoc, <- Rpow_mult_distr, E0, pow1. ring. }
  assert (E3 : v ^ m * t ^ m = 1) by (rewrite <- Rpow_mult_distr, E0; apply pow1).
  assert (E4 : v ^ (2 * m) = v ^ m * v ^ m) by (rewrite <- pow_add; f_equal; lia).
  rewrite E1, E4. replace (v ^ m * v ^ m * t * (1 + v)) with (v ^ m * v ^ m * (t + v * t)) by ring. rewrite E0.
  replace (v ^ m * v ^ m * (c ^ 2 * (1 + t ^ m) ^ 2 - (1 + t))) with
    (c ^ 2 * (v ^ m + v ^ m * t ^ m) ^ 2 - v ^ m * v ^ m * (1 + t)) by ring. rewrite E3. ring.
Qed.

(** h_m' as a function of u *)
Lemma dh_square x : dh m x = (INR (2 * m - 1) * (sinh x ^ 2) ^ (m - 1) + INR (2 * m) * (sinh x ^ 2) ^ m - (sinh x ^ 2) ^ (2 * m - 1)) / (1 + (sinh x ^ 2) ^ m) ^ 2.
Proof.
  unfold dh, bottom. rewrite <- !pow_mult. replace (2 * (m - 1))%nat with (2 * m - 2)%nat by lia.
  replace (2 * (2 * m - 1))%nat with (4 * m - 2)%nat by lia. reflexivity.
Qed.
Theorem dh_at_most c :
  (forall t, 0 <= t <= 1 -> 0 <= c * (1 + t ^ m) ^ 2 - (INR (2 * m - 1) * t ^ (m - 1) + INR (2 * m) * t ^ m - t ^ (2 * m - 1))) ->
  (forall t, 0 <= t <= 1 -> 0 <= c * (1 + t ^ m) ^ 2 - (INR (2 * m - 1) * t ^ (m + 1) + INR (2 * m) * t ^ m - t)) ->
  (forall t, 0 <= t <= 1 -> 0 <= c * (1 + t ^ m) ^ 2 + (INR (2 * m - 1) * t ^ (m - 1) + INR (2 * m) * t ^ m - t ^ (2 * m - 1))) ->
  (forall t, 0 <= t <= 1 -> 0 <= c * (1 + t ^ m) ^ 2 + (INR (2 * m - 1) * t ^ (m + 1) + INR (2 * m) * t ^ m - t)) ->
  forall x, Rabs (dh m x) <= c.
Proof.
  intros H1 H2 H3 H4 x. rewrite dh_square. set (u := sinh x ^ 2). assert (Hu : 0 <= u) by apply pow2_ge_0.
  assert (D : 0 < (1 + u ^ m) ^ 2) by (apply pow_lt; assert (0 <= u ^ m) by (apply pow_le; lra); lra).
  assert (T : forall v, 1 < v -> v ^ m * (/ v) ^ m = 1) by (intros v Hv; rewrite <- Rpow_mult_distr, Rinv_r by lra; apply pow1).
  assert (T1 : forall v, 1 < v -> v ^ (m - 1) = v ^ (2 * m) * (/ v) ^ (m + 1)).
  { intros v Hv. rewrite (inverse_power v (2 * m) (m - 1)) by (lra || lia). do 2 f_equal. lia. }
  assert (T2 : forall v, 1 < v -> v ^ m = v ^ (2 * m) * (/ v) ^ m).
  { intros v Hv. rewrite (inverse_power v (2 * m) m) at 1 by (lra || lia). do 2 f_equal. lia. }
  assert (T3 : forall v, 1 < v -> v ^ (2 * m - 1) = v ^ (2 * m) * / v).
  { intros v Hv. rewrite (inverse_power v (2 * m) (2 * m - 1)) by (lra || lia). replace (2 * m - (2 * m - 1))%nat with 1%nat by lia. now rewrite pow_1. }
  assert (T4 : forall v, 1 < v -> (1 + v ^ m) ^ 2 = v ^ (2 * m) * (1 + (/ v) ^ m) ^ 2).
  { intros v Hv. replace (v ^ (2 * m)) with (v ^ m * v ^ m) by (rewrite <- pow_add; f_equal; lia).
    replace (v ^ m * v ^ m * (1 + (/ v) ^ m) ^ 2) with ((v ^ m + v ^ m * (/ v) ^ m) ^ 2) by ring. rewrite T by auto. ring. }
  apply Rabs_le. split.
  - apply Rle_div_r; auto. enough (0 <= c * (1 + u ^ m) ^ 2 + (INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1))) by lra.
    refine (everywhere (fun u => c * (1 + u ^ m) ^ 2 + (INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1))) _ H3 H4 _ u Hu).
    intros v Hv. cbv beta. rewrite (T1 v Hv), (T3 v Hv), (T4 v Hv). rewrite (T2 v Hv). ring.
  - apply Rle_div_l; auto. enough (0 <= c * (1 + u ^ m) ^ 2 - (INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1))) by lra.
    refine (everywhere (fun u => c * (1 + u ^ m) ^ 2 - (INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1))) _ H1 H2 _ u Hu).
    intros v Hv. cbv beta. rewrite (T1 v Hv), (T3 v Hv), (T4 v Hv). rewrite (T2 v Hv). ring.
Qed.

(** |h_m(x)| <= c |x|: near 0 by sinh x <= x cosh x, far away by |h_m| <= g, in between as it stands. *)
Lemma sinh_below x : 0 <= x -> sinh x <= x * cosh x.
Proof.
  intros H. destruct (MVT_gen sinh 0 x cosh) as (z & Hz & E).
  - intros; apply is_derive_sinh.
  - intros y _. apply derivable_continuous_pt. exists (cosh y). apply is_derive_Reals, is_derive_sinh.
  - rewrite Rmin_left, Rmax_right in Hz by lra. rewrite sinh_0, !Rminus_0_r in E. rewrite E, Rmult_comm. apply Rmult_le_compat_l; [lra|].
    assert (S : 0 <= sinh z <= sinh x).
    { split; [destruct (Req_dec z 0) as [->|N]; [rewrite sinh_0; lra|left; apply Family.sinh_pos; lra]|].
      unfold sinh. destruct (Req_dec z x) as [->|N]; [lra|].
      assert (exp z < exp x) by (apply exp_increasing; lra). assert (exp (- x) < exp (- z)) by (apply exp_increasing; lra). lra. }
    pose proof (cosh2 z). pose proof (cosh2 x). pose proof (cosh_pos z). pose proof (cosh_pos x). nra.
Qed.
Lemma abs_odd x : Rabs (h m x) = h m (Rabs x).
Proof.
  unfold Rabs at 2. destruct (Rcase_abs x) as [K|K].
  - rewrite (h_odd m Hm). apply Rabs_left. pose proof (h_sign m Hm x ltac:(lra)). nra.
  - apply Rabs_right. destruct (Req_dec x 0) as [->|N]; [rewrite (h_zero m Hm); lra|]. left. apply (h_pos m). lra.
Qed.
Theorem secant_at_most c a b g : 0 < a -> 0 < c -> (forall x, Rabs (h m x) <= g) -> g <= c * b ->
  (forall x, 0 <= x <= a -> sinh x ^ (2 * m - 2) * cosh x ^ 2 <= c) ->
  (forall x, a <= x <= b -> h m x <= c * x) -> forall x, Rabs (h m x) <= c * Rabs x.
Proof.
  intros Ha Hc Hg Hgc H1 H2 x. rewrite abs_odd. set (y := Rabs x). assert (Hy : 0 <= y) by apply Rabs_pos. clearbody y. clear x.
  destruct (Rle_dec y a) as [K|K]; [|destruct (Rle_dec y b) as [K'|K']; [apply H2; lra|]].
  - specialize (H1 y ltac:(lra)). unfold h. pose proof (bottom_pos m y) as B. pose proof (cosh_pos y) as Cp.
    assert (S0 : 0 <= sinh y) by (destruct (Req_dec y 0) as [->|N]; [rewrite sinh_0; lra|left; apply Family.sinh_pos; lra]).
    replace (2 * m - 1)%nat with (S (2 * m - 2)) by lia. rewrite <- tech_pow_Rmult.
    assert (P : 0 <= sinh y ^ (2 * m - 2)) by (apply pow_le; auto).
    apply Rle_trans with (sinh y * sinh y ^ (2 * m - 2) * cosh y).
    + apply Rle_div_l; [lra|]. assert (Z : 0 <= sinh y * sinh y ^ (2 * m - 2) * cosh y) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra).
      rewrite <- (Rmult_1_r (sinh y * sinh y ^ (2 * m - 2) * cosh y)) at 1. apply Rmult_le_compat_l; auto.
    + apply Rle_trans with (y * (sinh y ^ (2 * m - 2) * cosh y ^ 2)); [|rewrite (Rmult_comm c); apply Rmult_le_compat_l; auto].
      replace (y * (sinh y ^ (2 * m - 2) * cosh y ^ 2)) with (y * cosh y * (sinh y ^ (2 * m - 2) * cosh y)) by ring.
      rewrite Rmult_assoc. apply Rmult_le_compat_r; [apply Rmult_le_pos; lra|now apply sinh_below].
  - eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply Hg|]. eapply Rle_trans; [exact Hgc|]. apply Rmult_le_compat_l; lra.
Qed.
End Member.

(** m = 1: h = tanh, and each bound is 1. *)
Lemma secant_1 x : Rabs (h 1 x) <= Rabs x.
Proof.
  rewrite (abs_odd 1 ltac:(lia)). set (y := Rabs x). assert (Hy : 0 <= y) by apply Rabs_pos.
  unfold h, bottom. replace (2 * 1 - 1)%nat with 1%nat by lia. rewrite pow_1. replace (2 * 1)%nat with 2%nat by lia.
  rewrite <- cosh2. pose proof (cosh_pos y). replace (sinh y * cosh y / cosh y ^ 2) with (sinh y / cosh y) by (field; lra).
  apply Rle_div_l; [lra|]. now apply sinh_below.
Qed.

(** ** Suprema *)
Lemma sup_upper (P : R -> Prop) f c : (exists x, P x) -> (forall x, P x -> f x <= c) -> sup P f <= c.
Proof.
  intros [x0 H0] H. unfold sup. destruct (Lub_Rbar_correct (fun y => exists x, P x /\ y = f x)) as [U0 L0].
  specialize (L0 c ltac:(intros y (x & Hx & ->); simpl; auto)). specialize (U0 (f x0) (ex_intro _ x0 (conj H0 eq_refl))).
  destruct (Lub_Rbar _); simpl in *; auto; tauto.
Qed.
Lemma sup_lower (P : R -> Prop) f c x : (forall y, P y -> f y <= c) -> P x -> f x <= sup P f.
Proof.
  intros H Hx. unfold sup. destruct (Lub_Rbar_correct (fun y => exists x, P x /\ y = f x)) as [U0 L0].
  specialize (L0 c ltac:(intros y (z & Hz & ->); simpl; auto)). specialize (U0 (f x) (ex_intro _ x (conj Hx eq_refl))).
  destruct (Lub_Rbar _); simpl in *; auto; tauto.
Qed.
Section Suprema.
Variable m : nat.
Hypothesis Hm : (1 <= m)%nat.
Theorem h_le_gamma x : h m x <= gamma m.
Proof. apply sup_lower with (sqrt 2); auto. intros y _. eapply Rle_trans; [apply Rle_abs|apply (h_lt_sqrt2 m Hm)]. Qed.
Theorem abs_h_le_gamma x : Rabs (h m x) <= gamma m.
Proof. rewrite (abs_odd m Hm). apply h_le_gamma. Qed.
Theorem gamma_le c : (forall x, Rabs (h m x) <= c) -> gamma m <= c.
Proof. intros H. apply sup_upper; [now exists 0|]. intros x _. eapply Rle_trans; [apply Rle_abs|apply H]. Qed.
Theorem dh_le_rho x : Rabs (dh m x) <= rho m.
Proof. apply (sup_lower (fun _ => True) (fun x => Rabs (dh m x)) (4 * INR m)); auto. intros y _. apply (dh_bounded m Hm). Qed.
Theorem rho_le c : (forall x, Rabs (dh m x) <= c) -> rho m <= c.
Proof. intros H. apply sup_upper; [now exists 0|auto]. Qed.
Theorem L_le c : (forall x, Rabs (h m x) <= c * Rabs x) -> L m <= c.
Proof.
  intros H. apply sup_upper; [exists 1; lra|]. intros x Hx. apply Rle_div_l; auto. specialize (H x).
  rewrite (Rabs_pos_eq x) in H by lra. eapply Rle_trans; [apply Rle_abs|exact H].
Qed.
Theorem secant_le_L x : 0 < x -> h m x / x <= L m.
Proof.
  intros Hx. apply (sup_lower (fun x => 0 < x) (fun x => h m x / x) (4 * INR m)); auto. intros y Hy. apply Rle_div_l; auto.
  pose proof (h_lipschitz_at_0 m Hm y) as K. rewrite (Rabs_pos_eq y) in K by lra. eapply Rle_trans; [apply Rle_abs|exact K].
Qed.
End Suprema.

(** ** Tactics: numbers in the place of m, and then interval arithmetic *)
Ltac spell m := simpl INR; repeat match goal with |- context [INR ?k] => let v := eval compute in (Z.of_nat k) in
    replace (INR k) with (IZR v) by (rewrite INR_IZR_INZ; reflexivity) end;
  repeat match goal with |- context [?x ^ ?k] => let v := eval compute in k in progress change (x ^ k) with (x ^ v) end.
Ltac on_unit := let t := fresh "t" in let H := fresh "H" in intros t H; spell 0%nat;
  first [interval with (i_bisect t, i_autodiff t, i_prec 40, i_depth 25) | nra].
Ltac prove_h_at_most := apply h_at_most; [lia|lra|on_unit|on_unit].
Ltac prove_dh_at_most := apply dh_at_most; [lia|on_unit|on_unit|on_unit|on_unit].
