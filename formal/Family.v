(** The family h_m for every m >= 1, through p = sinh^(2m) x and u = sinh^2 x. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Open Scope R_scope.
Local Arguments Nat.mul : simpl never.
Local Arguments Nat.sub : simpl never.
Local Arguments INR : simpl never.
Local Arguments pow : simpl never.

Lemma cosh2 x : cosh x ^ 2 = 1 + sinh x ^ 2.
Proof. unfold cosh, sinh. assert (exp x * exp (- x) = 1) by (rewrite <- exp_plus, Rplus_opp_r; apply exp_0). nra. Qed.
Lemma cosh_pos x : 0 < cosh x.
Proof. unfold cosh. pose proof (exp_pos x). pose proof (exp_pos (- x)). lra. Qed.
Lemma cosh_ge1 x : 1 <= cosh x.
Proof. pose proof (cosh2 x). pose proof (cosh_pos x). nra. Qed.
Lemma sinh_odd x : sinh (- x) = - sinh x.
Proof. unfold sinh. rewrite Ropp_involutive. lra. Qed.
Lemma cosh_even x : cosh (- x) = cosh x.
Proof. unfold cosh. rewrite Ropp_involutive. lra. Qed.
Lemma sinh_pos x : 0 < x -> 0 < sinh x.
Proof. intros H. unfold sinh. assert (exp (- x) < exp x) by (apply exp_increasing; lra). lra. Qed.
Lemma even_pow x m : x ^ (2 * m) = (x ^ 2) ^ m.
Proof. now rewrite pow_mult. Qed.
Lemma even_pow_pos x m : 0 <= x ^ (2 * m).
Proof. rewrite even_pow. apply pow_le, pow2_ge_0. Qed.
Lemma bottom_pos m x : 1 <= bottom m x.
Proof. unfold bottom. pose proof (even_pow_pos (sinh x) m). lra. Qed.

Lemma is_derive_sinh x : is_derive sinh x (cosh x).
Proof. unfold sinh, cosh. auto_derive; auto. field. Qed.
Lemma is_derive_cosh x : is_derive cosh x (sinh x).
Proof. unfold sinh, cosh. auto_derive; auto. field. Qed.

Section Member.
Variable m : nat.
Hypothesis Hm : (1 <= m)%nat.

Lemma INR2m : 0 < INR (2 * m).
Proof. apply lt_0_INR. lia. Qed.

(** *** h is odd, and has the sign of its argument *)
Theorem h_odd x : h m (- x) = - h m x.
Proof.
  unfold h, bottom. rewrite sinh_odd, cosh_even.
  replace (2 * m - 1)%nat with (S (2 * (m - 1))) by lia.
  replace (- sinh x) with (-1 * sinh x) by ring. rewrite !Rpow_mult_distr.
  rewrite !even_pow. change ((-1) ^ S (2 * (m - 1))) with (-1 * (-1) ^ (2 * (m - 1))).
  rewrite even_pow. replace ((-1) ^ 2) with 1 by ring. rewrite !pow1. unfold Rdiv. ring_simplify.
  rewrite !Rmult_1_l. ring.
Qed.
Theorem h_pos x : 0 < x -> 0 < h m x.
Proof.
  intros H. unfold h. apply Rdiv_lt_0_compat; [|pose proof (bottom_pos m x); lra].
  apply Rmult_lt_0_compat; [apply pow_lt, sinh_pos; auto|apply cosh_pos].
Qed.
Theorem h_zero : h m 0 = 0.
Proof. pose proof (h_odd 0). rewrite Ropp_0 in H. lra. Qed.
Theorem h_sign x : x <> 0 -> 0 < x * h m x.
Proof.
  intros H. destruct (Rtotal_order x 0) as [K|[K|K]]; [|tauto|].
  - assert (0 < h m (- x)) by (apply h_pos; lra). rewrite h_odd in H0. nra.
  - pose proof (h_pos x K). nra.
Qed.

Theorem dh_even x : dh m (- x) = dh m x.
Proof.
  unfold dh, bottom. rewrite sinh_odd.
  assert (E : forall k, (- sinh x) ^ (2 * k) = sinh x ^ (2 * k)) by (intros k; rewrite !even_pow; f_equal; ring).
  replace (2 * m - 2)%nat with (2 * (m - 1))%nat by lia. replace (4 * m - 2)%nat with (2 * (2 * m - 1))%nat by lia. now rewrite !E.
Qed.

(** *** Derivatives *)
Lemma is_derive_bottom x :
  is_derive (bottom m) x (INR (2 * m) * (sinh x ^ (2 * m - 1) * cosh x)).
Proof.
  unfold bottom. evar_last.
  - apply (is_derive_plus (fun _ => 1) (fun t => sinh t ^ (2 * m)) x 0 (INR (2 * m) * cosh x * sinh x ^ pred (2 * m))).
    + apply (is_derive_const (V := R_NormedModule) 1).
    + apply is_derive_pow, is_derive_sinh.
  - replace (pred (2 * m)) with (2 * m - 1)%nat by lia. unfold plus; simpl. ring.
Qed.
Theorem U_derive x : is_derive (U m) x (h m x).
Proof.
  unfold U, h. pose proof (bottom_pos m x). pose proof INR2m.
  evar_last.
  - apply (is_derive_ext (fun t => / INR (2 * m) * ln (bottom m t))).
    { intros. unfold Rdiv. apply Rmult_comm. }
    apply (is_derive_scal (fun t => ln (bottom m t))).
    apply (is_derive_comp ln (bottom m) x (/ bottom m x)); [|apply is_derive_bottom].
    apply is_derive_Reals. apply derivable_pt_lim_ln. lra.
  - unfold scal; simpl; unfold mult; simpl. field. split; lra.
Qed.
Theorem U_nonneg x : 0 <= U m x.
Proof.
  unfold U. apply Rdiv_le_0_compat; [|exact INR2m].
  rewrite <- ln_1. apply Rcomplements.ln_le; [lra|apply bottom_pos].
Qed.
Theorem U_zero : U m 0 = 0.
Proof.
  unfold U, bottom. rewrite sinh_0, pow_i by lia. rewrite Rplus_0_r, ln_1. unfold Rdiv. ring.
Qed.
Theorem U_pos x : x <> 0 -> 0 < U m x.
Proof.
  intros H. unfold U. apply Rdiv_lt_0_compat; [|exact INR2m].
  rewrite <- ln_1. apply ln_increasing; [lra|]. unfold bottom.
  assert (sinh x <> 0).
  { destruct (Rtotal_order x 0) as [K|[K|K]]; [|tauto|pose proof (sinh_pos x K); lra].
    pose proof (sinh_pos (- x) ltac:(lra)). rewrite sinh_odd in H0. lra. }
  assert (0 < sinh x ^ (2 * m)) by (rewrite even_pow; apply pow_lt, pow2_gt_0; auto). lra.
Qed.
Theorem h_derive x : is_derive (h m) x (dh m x).
Proof.
  pose proof (bottom_pos m x) as Hb.
  assert (Hsh : is_derive (fun t => sinh t ^ (2 * m - 1) * cosh t) x
     (INR (2 * m - 1) * sinh x ^ (2 * m - 2) * cosh x ^ 2 + sinh x ^ (2 * m))).
  { evar_last.
    - apply (is_derive_mult (fun t => sinh t ^ (2 * m - 1)) cosh x
        (INR (2 * m - 1) * cosh x * sinh x ^ pred (2 * m - 1)) (sinh x));
        [apply is_derive_pow, is_derive_sinh|apply is_derive_cosh|intros; apply Rmult_comm].
    - unfold plus, mult; simpl. replace (pred (2 * m - 1)) with (2 * m - 2)%nat by lia.
      assert (E : sinh x ^ (2 * m) = sinh x * sinh x ^ (2 * m - 1)) by (rewrite tech_pow_Rmult; f_equal; lia).
      rewrite E. ring. }
  unfold h. evar_last.
  - apply (is_derive_div _ _ _ _ _ Hsh (is_derive_bottom x)). lra.
  - unfold dh. set (s := sinh x). set (c := cosh x). set (k := INR (2 * m)).
    replace (INR (2 * m - 1)) with (k - 1) by (unfold k; rewrite minus_INR by lia; change (INR 1) with 1; ring).
    set (p := s ^ (2 * m - 2)).
    assert (E1 : s ^ (2 * m) = p * s ^ 2) by (unfold p; rewrite <- pow_add; f_equal; lia).
    assert (E2 : s ^ (2 * m - 1) = p * s) by (unfold p; rewrite Rmult_comm, tech_pow_Rmult; f_equal; lia).
    assert (E3 : s ^ (4 * m - 2) = p * (p * s ^ 2)) by (rewrite <- E1; unfold p; rewrite <- pow_add; f_equal; lia).
    assert (Eb : bottom m x = 1 + p * s ^ 2) by (unfold bottom; fold s; now rewrite E1).
    pose proof (cosh2 x) as Ec. fold s c in Ec.
    assert (Eb' : 1 + p * s ^ 2 <> 0) by (rewrite <- Eb; lra).
    fold s. rewrite E1, E2, E3, Eb. clearbody p c s k. clear -Ec Eb'.
    assert (Ec' : c ^ 2 = 1 + s ^ 2) by exact Ec.
    field_simplify_eq; [|exact Eb']. 
    replace (c * c) with (c ^ 2) by ring. 
    ring_simplify. repeat rewrite Ec'. ring.
Qed.

(** *** |h| <= sqrt 2, and the algebraic description of gamma_m in u = sinh^2 x *)
Lemma h_square x : h m x ^ 2 = (sinh x ^ 2) ^ (2 * m - 1) * (1 + sinh x ^ 2) / (1 + (sinh x ^ 2) ^ m) ^ 2.
Proof.
  unfold h, bottom. rewrite even_pow. rewrite <- (cosh2 x).
  replace ((sinh x ^ 2) ^ (2 * m - 1)) with ((sinh x ^ (2 * m - 1)) ^ 2) by (rewrite <- !pow_mult; f_equal; lia).
  assert (0 <= (sinh x ^ 2) ^ m) by (apply pow_le, pow2_ge_0). field. lra.
Qed.
Theorem h_bounded_by u_bound : 0 <= u_bound ->
  (forall u, 0 <= u -> u ^ (2 * m - 1) * (1 + u) <= u_bound ^ 2 * (1 + u ^ m) ^ 2) ->
  forall x, Rabs (h m x) <= u_bound.
Proof.
  intros Hb H x.
  assert (h m x ^ 2 <= u_bound ^ 2).
  { rewrite h_square. apply Rle_div_l.
    - assert (0 <= (sinh x ^ 2) ^ m) by (apply pow_le, pow2_ge_0). nra.
    - apply H, pow2_ge_0. }
  apply Rabs_le. nra.
Qed.
Theorem h_lt_sqrt2 x : Rabs (h m x) <= sqrt 2.
Proof.
  apply h_bounded_by; [apply sqrt_pos|]. intros u Hu. rewrite <- Rsqr_pow2, Rsqr_sqrt by lra.
  assert (E : u ^ (2 * m - 1) * u = (u ^ m) ^ 2).
  { rewrite <- pow_mult, Rmult_comm, tech_pow_Rmult. f_equal. lia. }
  assert (P : 0 <= u ^ m) by (apply pow_le; lra). assert (Q : 0 <= u ^ (2 * m - 1)) by (apply pow_le; lra).
  destruct (Rle_dec u 1) as [K|K].
  - assert (u ^ (2 * m - 1) <= 1) by (rewrite <- (pow1 (2 * m - 1)); apply pow_incr; lra). nra.
  - nra.
Qed.
(** *** |h'| <= 4 m and |h x| <= 4 m |x|: crude, but for every m at once *)
Lemma pow_between s : 0 <= sinh s ^ (2 * m - 2) <= bottom m s.
Proof.
  unfold bottom. replace (2 * m - 2)%nat with (2 * (m - 1))%nat by lia.
  split; [apply even_pow_pos|]. rewrite !even_pow. set (v := sinh s ^ 2).
  assert (Hv : 0 <= v) by apply pow2_ge_0. destruct (Rle_dec v 1) as [K|K].
  - assert (v ^ (m - 1) <= 1) by (rewrite <- (pow1 (m - 1)); apply pow_incr; lra).
    assert (0 <= v ^ m) by (apply pow_le; lra). lra.
  - assert (v ^ (m - 1) <= v ^ m) by (apply Rle_pow; [lra|lia]). lra.
Qed.
Theorem dh_bounded x : Rabs (dh m x) <= 4 * INR m.
Proof.
  pose proof (bottom_pos m x) as Hb. pose proof (pow_between x) as [Q0 Q1].
  unfold dh. set (q := sinh x ^ (2 * m - 2)) in *. set (p := sinh x ^ (2 * m)).
  assert (P0 : 0 <= p) by apply even_pow_pos. assert (Eb : bottom m x = 1 + p) by reflexivity.
  assert (Er : sinh x ^ (4 * m - 2) = q * p) by (unfold q, p; rewrite <- pow_add; f_equal; lia).
  rewrite Er. assert (M1 : 1 <= INR m) by (change 1 with (INR 1); apply le_INR; lia).
  assert (E2 : INR (2 * m) = 2 * INR m) by (rewrite mult_INR; change (INR 2) with (1 + 1); ring).
  assert (E3 : INR (2 * m - 1) = 2 * INR m - 1) by (rewrite minus_INR, E2 by lia; change (INR 1) with 1; ring).
  rewrite E2, E3, Eb in *. set (k := INR m) in *. clearbody k p q.
  assert (D : 0 < (1 + p) ^ 2) by nra.
  assert (q * p <= (1 + p) * p) by (apply Rmult_le_compat_r; lra).
  assert (0 <= q * p) by (apply Rmult_le_pos; lra).
  assert (0 <= k * q /\ k * q <= k * (1 + p)) by (split; nra).
  assert (0 <= k * p /\ k * (1 + p) <= k * (1 + p) ^ 2) by (split; nra).
  apply Rabs_le. split.
  - apply Rle_div_r; [lra|]. nra.
  - apply Rle_div_l; [lra|]. nra.
Qed.
Theorem h_lipschitz_at_0 x : Rabs (h m x) <= 4 * INR m * Rabs x.
Proof.
  destruct (MVT_gen (h m) 0 x (dh m)) as (c & _ & E).
  - intros; apply h_derive.
  - intros y _. apply derivable_continuous_pt. exists (dh m y). apply is_derive_Reals, h_derive.
  - rewrite h_zero, !Rminus_0_r in E. rewrite E, Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos|apply dh_bounded].
Qed.
(** *** U grows without bound: U x >= |x| - ln 4 *)
Theorem U_grows x : Rabs x - ln 4 <= U m x.
Proof.
  assert (E : U m x = U m (Rabs x)).
  { unfold Rabs. destruct (Rcase_abs x); auto. unfold U, bottom. rewrite sinh_odd.
    replace (- sinh x) with (-1 * sinh x) by ring. rewrite Rpow_mult_distr, (even_pow (-1)).
    replace ((-1) ^ 2) with 1 by ring. now rewrite pow1, Rmult_1_l. }
  rewrite E. set (y := Rabs x). assert (Hy : 0 <= y) by apply Rabs_pos. clearbody y. clear x E.
  unfold U. apply Rle_div_r; [exact INR2m|].
  assert (G : (exp y / 4) ^ (2 * m) <= bottom m y).
  { assert (Ey : 1 <= exp y) by (rewrite <- exp_0; destruct (Req_dec y 0) as [->|]; [lra|left; apply exp_increasing; lra]).
    unfold bottom. destruct (Rle_dec (exp y) 4) as [K|K].
    - assert ((exp y / 4) ^ (2 * m) <= 1) by (rewrite <- (pow1 (2 * m)); apply pow_incr; lra).
      pose proof (even_pow_pos (sinh y) m). lra.
    - assert ((exp y / 4) ^ (2 * m) <= sinh y ^ (2 * m)); [|lra].
      apply pow_incr. split; [lra|]. unfold sinh.
      assert (exp (- y) <= 1) by (rewrite <- exp_0; destruct (Req_dec y 0) as [->|]; [rewrite Ropp_0; lra|left; apply exp_increasing; lra]).
      lra. }
  pose proof (exp_pos y). apply Rcomplements.ln_le in G; [|apply pow_lt; lra].
  rewrite ln_pow in G by lra. unfold Rdiv in G. rewrite ln_mult, ln_exp, ln_Rinv in G by lra. lra.
Qed.
End Member.
