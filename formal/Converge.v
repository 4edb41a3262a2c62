(** Lyapunov's direct method for the closed loop, without existence theory: every solution converges to the
    origin, and solutions that start near it stay near. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Require Import Loop.
Open Scope R_scope.

(** ** Lemmas about functions of one variable *)
Lemma falls v dv c t1 t2 : t1 <= t2 -> (forall t, t1 <= t <= t2 -> is_derive v t (dv t)) -> (forall t, t1 <= t <= t2 -> dv t <= - c) ->
  v t2 <= v t1 - c * (t2 - t1).
Proof.
  intros H D B. destruct (MVT_gen v t1 t2 dv) as (s & Hs & E).
  - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by auto. apply D. lra.
  - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by auto. apply derivable_continuous_pt. exists (dv x). now apply is_derive_Reals, D.
  - rewrite Rmin_left, Rmax_right in Hs by auto. specialize (B s Hs). nra.
Qed.
Lemma away (phi : R -> R) z r : (forall x, continuity_pt phi x) -> (forall x, x <> 0 -> 0 < phi x) -> 0 < z ->
  exists m, 0 < m /\ forall x, z <= Rabs x <= r -> m <= phi x.
Proof.
  intros C P Z. destruct (Rle_dec z r) as [K|K]; [|exists 1; split; [lra|intros; lra]].
  destruct (continuity_ab_min phi z r K ltac:(intros; apply C)) as (x1 & H1 & B1).
  destruct (continuity_ab_min phi (- r) (- z) ltac:(lra) ltac:(intros; apply C)) as (x2 & H2 & B2).
  exists (Rmin (phi x1) (phi x2)). split; [apply Rmin_pos; apply P; lra|].
  intros x [X1 X2]. unfold Rabs in X1, X2. destruct (Rcase_abs x).
  - eapply Rle_trans; [apply Rmin_r|]. apply H2. lra.
  - eapply Rle_trans; [apply Rmin_l|]. apply H1. lra.
Qed.
Lemma near_zero (phi : R -> R) d : continuity_pt phi 0 -> phi 0 = 0 -> 0 < d -> exists z, 0 < z /\ forall x, Rabs x <= z -> phi x < d.
Proof.
  intros C P D. destruct (C d D) as (a & Ha & H). exists (a / 2). split; [lra|]. intros x Hx.
  destruct (Req_dec x 0) as [->|N]; [lra|]. specialize (H x). simpl in H. unfold R_dist in H. rewrite P in H.
  assert (Rabs (phi x - 0) < d); [|apply Rabs_def2 in H0; lra].
  apply H. split; [split; [exact I|auto]|]. rewrite Rminus_0_r. lra.
Qed.
Lemma sum_le_in k u v : (forall i, (i < k)%nat -> u i <= v i) -> sum k u <= sum k v.
Proof. intros H; induction k; simpl; [lra|]. pose proof (H k ltac:(lia)). assert (sum k u <= sum k v) by (apply IHk; intros; apply H; lia). lra. Qed.
Lemma sum_nonneg_in k u : (forall i, (i < k)%nat -> 0 <= u i) -> 0 <= sum k u.
Proof. intros H; induction k; simpl; [lra|]. pose proof (H k ltac:(lia)). assert (0 <= sum k u) by auto. lra. Qed.
Lemma term_le_sum_in k u i : (forall j, (j < k)%nat -> 0 <= u j) -> (i < k)%nat -> u i <= sum k u.
Proof.
  intros H Hi; induction k; [lia|]. simpl. destruct (PeanoNat.Nat.eq_dec i k) as [->|].
  - pose proof (sum_nonneg_in k u ltac:(intros; apply H; lia)). lra.
  - assert (u i <= sum k u) by (apply IHk; auto; lia). specialize (H k ltac:(lia)). lra.
Qed.
Lemma bounded_norm_in n x c : 0 <= c -> (forall i, (i < n)%nat -> Rabs (x i) <= c) -> norm n x <= sqrt (INR n) * c.
Proof.
  intros Hc H. rewrite <- (sqrt_square c) by auto. rewrite <- sqrt_mult by (try apply pos_INR; nra).
  apply sqrt_le_1; [apply dot_pos|pose proof (pos_INR n); nra|].
  unfold dot. rewrite <- sum_const. apply sum_le_in. intros i Hi. specialize (H i Hi). apply Rabs_le_between in H. nra.
Qed.
Lemma entry_le_norm n x i : (i < n)%nat -> Rabs (x i) <= norm n x.
Proof.
  intros Hi. rewrite <- sqrt_Rsqr_abs. apply sqrt_le_1; [apply Rle_0_sqr|apply dot_pos|].
  unfold Rsqr. apply (term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi).
Qed.
Lemma square_lt x c : 0 <= x -> 0 < c -> x * x < c * c -> x < c.
Proof. intros. nra. Qed.

Section Loop.
Variable n : nat.
Variable rb : robot n.
Variable f : member.
Variable g : gains n.
Variable qd : vec.
Hypothesis U_proper : forall K, exists r, forall x, Uf f x <= K -> Rabs x <= r.

Lemma h_continuous x : continuity_pt (fun x => Rabs (hf f x)) x.
Proof.
  apply (continuity_pt_comp (hf f) Rabs); [|apply Rcontinuity_abs].
  apply derivable_continuous_pt. exists (dhf f x). apply is_derive_Reals, h_rate.
Qed.
Lemma U_continuous x : continuity_pt (Uf f) x.
Proof. apply derivable_continuous_pt. exists (hf f x). apply is_derive_Reals, U_rate. Qed.
Lemma U_nonneg x : 0 <= Uf f x.
Proof. destruct (Req_dec x 0) as [->|N]; [rewrite U_zero; lra|left; now apply U_pos]. Qed.
Lemma U_away z : 0 < z -> exists m, 0 < m /\ forall x, z <= Rabs x -> m <= Uf f x.
Proof.
  intros Z. destruct (U_proper 1) as [r Hr]. destruct (away (Uf f) z r U_continuous (U_pos f) Z) as (m & Pm & Hm).
  exists (Rmin 1 m). split; [apply Rmin_pos; lra|]. intros x Hx. destruct (Rle_dec (Uf f x) 1) as [K|K].
  - eapply Rle_trans; [apply Rmin_r|]. apply Hm. split; auto.
  - eapply Rle_trans; [apply Rmin_l|lra].
Qed.

Section Eps.
Variable eps0 : R.
Hypothesis eps0_pos : 0 < eps0.
Notation V := (V n (M rb) (hf f) (Uf f) (kp n g) qd eps0).
Notation y := (y_of n (hf f) eps0).
Notation hv := (hv f).
Notation rate := (rate n rb f g qd).

(** *** V from below and from above *)
Lemma potential_pos e : 0 <= sum n (fun i => kp n g i * Uf f (e i)).
Proof. apply sum_nonneg_in. intros i Hi. apply Rmult_le_pos; [|apply U_nonneg]. pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). lra. Qed.
Lemma V_low_kinetic e w : alpha rb / 2 * dot n (y e w) (y e w) <= V e w.
Proof. unfold Definitions.V. pose proof (M_low rb (fun j => qd j - e j) (y e w)). pose proof (potential_pos e). lra. Qed.
Lemma V_low_potential e w i : (i < n)%nat -> kp_min n g * Uf f (e i) <= V e w.
Proof.
  intros Hi. unfold Definitions.V. pose proof (M_low rb (fun j => qd j - e j) (y e w)) as K. pose proof (dot_pos n (y e w)) as D.
  pose proof (alpha_pos rb). assert (0 <= alpha rb * dot n (y e w) (y e w)) by (apply Rmult_le_pos; lra).
  pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). pose proof (U_nonneg (e i)).
  assert (kp_min n g * Uf f (e i) <= kp n g i * Uf f (e i)) by (apply Rmult_le_compat_r; auto).
  assert (kp n g i * Uf f (e i) <= sum n (fun i => kp n g i * Uf f (e i))).
  { apply (term_le_sum_in n (fun i => kp n g i * Uf f (e i))); auto. intros j Hj. apply Rmult_le_pos; [|apply U_nonneg]. pose proof (kp_low n g j Hj). lra. }
  lra.
Qed.
Theorem V_nonneg e w : 0 <= V e w.
Proof. eapply Rle_trans; [|apply V_low_kinetic]. apply Rmult_le_pos; [pose proof (alpha_pos rb); lra|apply dot_pos]. Qed.
Lemma eps_01 e : 0 < eps n eps0 e <= eps0.
Proof. exact (eps_range n (fun _ => e) eps0 eps0_pos 0). Qed.
Definition high : R := beta rb * (1 + eps0 * eps0).
Lemma high_pos : 0 <= high.
Proof. unfold high. apply Rmult_le_pos; [apply beta_pos|nra]. Qed.
Lemma V_high e w : V e w <= high * (norm n (hv e) ^ 2 + norm n w ^ 2) + sum n (fun i => kp n g i * Uf f (e i)).
Proof.
  unfold Definitions.V. apply Rplus_le_compat_r. set (yy := y e w).
  assert (D : dot n yy (apply_ n (M rb (fun j => qd j - e j)) yy) <= beta rb * (norm n yy * norm n yy)).
  { eapply Rle_trans; [apply cauchy_schwarz|]. pose proof (M_up rb (fun j => qd j - e j) yy). pose proof (norm_pos n yy).
    apply Rle_trans with (norm n yy * (beta rb * norm n yy)); [apply Rmult_le_compat_l; auto|lra]. }
  pose proof (norm_pos n yy). pose proof (norm_pos n w). pose proof (norm_pos n (hv e)). pose proof (beta_pos rb).
  assert (Y : norm n yy <= norm n w + eps0 * norm n (hv e)).
  { unfold yy, y_of. pose proof (eps_01 e) as [E0 E1].
    eapply Rle_trans; [apply (norm_minus n w (fun i => eps n eps0 e * hv e i))|]. rewrite norm_scal by lra.
    apply Rplus_le_compat_l, Rmult_le_compat_r; lra. }
  set (a := norm n (hv e)) in *. set (v := norm n w) in *.
  assert (Q : norm n yy * norm n yy <= 2 * ((1 + eps0 * eps0) * (a ^ 2 + v ^ 2))).
  { apply Rle_trans with ((v + eps0 * a) * (v + eps0 * a)); [apply Rmult_le_compat; lra|].
    pose proof (pow2_ge_0 (v - eps0 * a)). assert (0 <= eps0 * eps0 * v ^ 2) by (apply Rmult_le_pos; [nra|apply pow2_ge_0]).
    pose proof (pow2_ge_0 a). nra. }
  apply Rmult_le_compat_l with (r := beta rb) in Q; auto. unfold high. lra.
Qed.
(** Small V means a small state. *)
Lemma small_V eta : 0 < eta -> exists d, 0 < d /\ forall e w, V e w < d -> forall i, (i < n)%nat -> Rabs (e i) < eta /\ Rabs (w i) < eta.
Proof.
  intros Heta. pose proof (L_pos f) as HL. pose proof (alpha_pos rb) as Ha. pose proof (kp_min_pos n g) as Hk.
  set (z := eta / (2 * (eps0 * Lf f + 1))). assert (He : 0 < eps0 * Lf f) by (apply Rmult_lt_0_compat; lra).
  assert (Hz : 0 < z) by (apply Rdiv_lt_0_compat; lra).
  assert (Hz1 : (eps0 * Lf f + 1) * z = eta / 2) by (unfold z; field; lra).
  destruct (U_away z Hz) as (m & Pm & Hm).
  exists (Rmin (kp_min n g * m) (alpha rb / 2 * (eta / 2 * (eta / 2)))).
  split; [apply Rmin_pos; [apply Rmult_lt_0_compat; lra|apply Rmult_lt_0_compat; nra]|].
  intros e w HV i Hi.
  assert (V1 : V e w < kp_min n g * m) by (eapply Rlt_le_trans; [exact HV|apply Rmin_l]).
  assert (V2 : V e w < alpha rb / 2 * (eta / 2 * (eta / 2))) by (eapply Rlt_le_trans; [exact HV|apply Rmin_r]).
  assert (E : Rabs (e i) < z).
  { destruct (Rlt_dec (Rabs (e i)) z) as [|N]; auto. pose proof (Hm (e i) ltac:(lra)). pose proof (V_low_potential e w i Hi).
    assert (kp_min n g * m <= kp_min n g * Uf f (e i)) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Y : norm n (y e w) < eta / 2).
  { apply square_lt; [apply norm_pos|lra|]. rewrite norm2. pose proof (V_low_kinetic e w).
    apply Rmult_lt_reg_l with (alpha rb / 2); lra. }
  pose proof (entry_le_norm n (y e w) i Hi) as Yi. pose proof (Rabs_pos (e i)). pose proof (h_lip f (e i)) as Li.
  pose proof (eps_01 e) as [E0 E1].
  assert (Wi : Rabs (w i) <= Rabs (y e w i) + eps0 * Rabs (hf f (e i))).
  { replace (w i) with (y e w i + eps n eps0 e * hf f (e i)) by (unfold y_of; ring). eapply Rle_trans; [apply Rabs_triang|].
    apply Rplus_le_compat_l. rewrite Rabs_mult, (Rabs_pos_eq (eps _ _ _)) by lra. apply Rmult_le_compat_r; [apply Rabs_pos|lra]. }
  assert (eps0 * Rabs (hf f (e i)) <= eps0 * (Lf f * Rabs (e i))) by (apply Rmult_le_compat_l; lra).
  assert (eps0 * (Lf f * Rabs (e i)) <= eps0 * Lf f * z) by (rewrite <- Rmult_assoc; apply Rmult_le_compat_l; lra).
  assert (0 <= eps0 * Lf f * z) by (apply Rmult_le_pos; lra). split; lra.
Qed.
(** V is positive definite and radially unbounded. *)
Theorem V_positive e w : (exists i, (i < n)%nat /\ (e i <> 0 \/ w i <> 0)) -> 0 < V e w.
Proof.
  intros (i & Hi & H). set (eta := Rmax (Rabs (e i)) (Rabs (w i))).
  assert (P : 0 < eta).
  { destruct H as [H|H]; apply Rabs_pos_lt in H; eapply Rlt_le_trans; [exact H|apply Rmax_l|exact H|apply Rmax_r]. }
  destruct (small_V eta P) as (d & Pd & Hd). destruct (Rlt_dec (V e w) d) as [K|K]; [|lra].
  destruct (Hd e w K i Hi) as [K1 K2]. exfalso. unfold eta in K1, K2.
  destruct (Rle_dec (Rabs (e i)) (Rabs (w i))); [rewrite Rmax_right in K2 by auto|rewrite Rmax_left in K1 by lra]; lra.
Qed.
Theorem V_unbounded K : exists r, forall e w, V e w <= K -> forall i, (i < n)%nat -> Rabs (e i) <= r /\ Rabs (w i) <= r.
Proof.
  destruct (U_proper (K / kp_min n g)) as [r1 H1]. pose proof (kp_min_pos n g) as Hk. pose proof (alpha_pos rb) as Ha.
  set (r2 := sqrt (2 * Rabs K / alpha rb) + eps0 * gammaf f). exists (Rmax r1 r2). intros e w HV i Hi. split.
  - eapply Rle_trans; [|apply Rmax_l]. apply H1. apply Rle_div_r; [lra|]. pose proof (V_low_potential e w i Hi). lra.
  - eapply Rle_trans; [|apply Rmax_r]. pose proof (entry_le_norm n (y e w) i Hi) as Yi. pose proof (eps_01 e) as [E0 E1].
    assert (Wi : Rabs (w i) <= Rabs (y e w i) + eps0 * Rabs (hf f (e i))).
    { replace (w i) with (y e w i + eps n eps0 e * hf f (e i)) by (unfold y_of; ring). eapply Rle_trans; [apply Rabs_triang|].
      apply Rplus_le_compat_l. rewrite Rabs_mult, (Rabs_pos_eq (eps _ _ _)) by lra. apply Rmult_le_compat_r; [apply Rabs_pos|lra]. }
    assert (eps0 * Rabs (hf f (e i)) <= eps0 * gammaf f) by (apply Rmult_le_compat_l; [lra|apply h_up]). assert (norm n (y e w) <= sqrt (2 * Rabs K / alpha rb)); [|unfold r2; lra].
    apply sqrt_le_1; [apply dot_pos| |].
    + apply Rmult_le_pos; [pose proof (Rabs_pos K); lra|left; apply Rinv_0_lt_compat; lra].
    + apply Rle_div_r; [lra|]. pose proof (V_low_kinetic e w). pose proof (Rle_abs K). lra.
Qed.
(** A small state means small V. *)
Lemma small_state d : 0 < d -> exists z, 0 < z /\ forall e w, (forall i, (i < n)%nat -> Rabs (e i) <= z) ->
   norm n (hv e) ^ 2 + norm n w ^ 2 <= z -> V e w < d.
Proof.
  intros Hd. set (Ks := sum n (kp n g)). pose proof high_pos as Hb. pose proof (kp_min_pos n g) as Hk.
  assert (HKs : 0 <= Ks) by (apply sum_nonneg_in; intros i Hi; pose proof (kp_low n g i Hi); lra).
  destruct (near_zero (Uf f) (d / (2 * (Ks + 1))) (U_continuous 0) (U_zero f)) as (z & Pz & Hz); [apply Rdiv_lt_0_compat; lra|].
  set (z2 := d / (4 * (high + 1))). assert (Hz2 : 0 < z2) by (apply Rdiv_lt_0_compat; lra).
  exists (Rmin z z2). split; [apply Rmin_pos; auto|]. intros e w He Hs.
  eapply Rle_lt_trans; [apply V_high|].
  assert (A : high * (norm n (hv e) ^ 2 + norm n w ^ 2) <= d / 4).
  { apply Rle_trans with (high * z2); [apply Rmult_le_compat_l; auto; eapply Rle_trans; [exact Hs|apply Rmin_r]|].
    apply Rle_trans with ((high + 1) * z2); [apply Rmult_le_compat_r; lra|]. right. unfold z2. field. lra. }
  assert (B : sum n (fun i => kp n g i * Uf f (e i)) <= d / 2).
  { apply Rle_trans with (sum n (fun i => d / (2 * (Ks + 1)) * kp n g i)).
    - apply sum_le_in. intros i Hi. pose proof (kp_low n g i Hi). rewrite Rmult_comm. apply Rmult_le_compat_r; [lra|].
      left. apply Hz. eapply Rle_trans; [apply He; auto|apply Rmin_l].
    - rewrite sum_scal. fold Ks. assert (0 < d / (2 * (Ks + 1))) by (apply Rdiv_lt_0_compat; lra).
      apply Rle_trans with (d / (2 * (Ks + 1)) * (Ks + 1)); [apply Rmult_le_compat_l; lra|]. right. field. lra. }
  lra.
Qed.

(** All that is asked of dV/dt. *)
Variables c1 c2 : R.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Hypothesis dec : forall e w t, rate e w eps0 t <= - (c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Notation solution := (solution n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd).

Section Trajectory.
Variables (e w : R -> vec).
Hypothesis S : solution e w.
Notation v := (fun t => V (e t) (w t)).
Notation dv := (rate e w eps0).
Lemma v_rate t : 0 <= t -> is_derive v t (dv t).
Proof. intros. apply (V_rate n rb f g qd e w (fun t => 0 <= t) S eps0 t). auto. Qed.
Lemma dv_nonpos t : dv t <= 0.
Proof.
  eapply Rle_trans; [apply dec|]. pose proof (eps_01 (e t)).
  assert (0 <= c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|apply pow2_ge_0]).
  assert (0 <= c2 * norm n (w t) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). lra.
Qed.
Lemma v_falls t1 t2 : 0 <= t1 -> t1 <= t2 -> v t2 <= v t1.
Proof. intros H0 H. pose proof (falls v dv 0 t1 t2 H ltac:(intros; apply v_rate; lra) ltac:(intros; pose proof (dv_nonpos t); lra)). lra. Qed.

Theorem converges eta : 0 < eta -> exists T, forall t, T <= t -> forall i, (i < n)%nat -> Rabs (e t i) < eta /\ Rabs (w t i) < eta.
Proof.
  intros Heta. destruct (small_V eta Heta) as (d & Pd & Hd). destruct (small_state d Pd) as (z & Pz & Hz).
  pose proof (kp_min_pos n g) as Hk. pose proof (b_min_pos rb) as Hb.
  destruct (U_proper (v 0 / kp_min n g)) as [r Hr].
  assert (Bound : forall t, 0 <= t -> forall i, (i < n)%nat -> Rabs (e t i) <= Rabs r).
  { intros t Ht i Hi. eapply Rle_trans; [|apply Rle_abs]. apply Hr. apply Rle_div_r; [lra|].
    pose proof (V_low_potential (e t) (w t) i Hi). pose proof (v_falls 0 t (Rle_refl 0) Ht). simpl in *. lra. }
  set (e1 := eps0 / (1 + sqrt (INR n) * Rabs r)).
  assert (Hs : 0 <= sqrt (INR n) * Rabs r) by (apply Rmult_le_pos; [apply sqrt_pos|apply Rabs_pos]).
  assert (He1 : 0 < e1) by (apply Rdiv_lt_0_compat; lra).
  assert (Heps : forall t, 0 <= t -> e1 <= eps n eps0 (e t)).
  { intros t Ht. unfold e1, eps. apply Rmult_le_compat_l; [lra|]. pose proof (norm_pos n (e t)). apply Rinv_le_contravar; [lra|].
    apply Rplus_le_compat_l. apply bounded_norm_in; [apply Rabs_pos|]. now apply Bound. }
  destruct (away (fun x => Rabs (hf f x)) z (Rabs r) h_continuous) as (m & Pm & Hm).
  { intros x Hx. apply Rabs_pos_lt. pose proof (h_sign f x Hx). intros K. rewrite K in H. lra. }
  { exact Pz. }
  set (w0 := Rmin (m * m) z). assert (Hw0 : 0 < w0) by (apply Rmin_pos; nra).
  assert (Far : forall t, 0 <= t -> d <= v t -> w0 <= norm n (hv (e t)) ^ 2 + norm n (w t) ^ 2).
  { intros t Ht Hv. destruct (Rle_dec w0 (norm n (hv (e t)) ^ 2 + norm n (w t) ^ 2)) as [|N]; auto. exfalso.
    assert (V (e t) (w t) < d); [|simpl in Hv; lra]. apply Hz.
    - intros i Hi. destruct (Rle_dec (Rabs (e t i)) z) as [|K]; auto. exfalso. apply N.
      pose proof (Hm (e t i) ltac:(split; [lra|now apply Bound])) as A. pose proof (entry_le_norm n (hv (e t)) i Hi) as B.
      unfold Loop.hv in B at 1. pose proof (pow2_ge_0 (norm n (w t))). assert (w0 <= m * m) by apply Rmin_l.
      assert (m * m <= norm n (hv (e t)) * norm n (hv (e t))) by (apply Rmult_le_compat; lra). simpl. lra.
    - assert (w0 <= z) by apply Rmin_r. lra. }
  set (lam := Rmin (e1 * c1) c2).
  assert (Hlam : 0 < lam) by (apply Rmin_pos; [apply Rmult_lt_0_compat|]; lra).
  assert (Fast : forall t, 0 <= t -> d <= v t -> dv t <= - (lam * w0)).
  { intros t Ht Hv. pose proof (Far t Ht Hv) as F. pose proof (Heps t Ht) as E. eapply Rle_trans; [apply dec|].
    pose proof (pow2_ge_0 (norm n (hv (e t)))) as A2. pose proof (pow2_ge_0 (norm n (w t))) as V2.
    set (A := norm n (hv (e t)) ^ 2) in *. set (W := norm n (w t) ^ 2) in *.
    assert (lam * A <= c1 * eps n eps0 (e t) * A).
    { apply Rmult_le_compat_r; auto. eapply Rle_trans; [apply Rmin_l|]. rewrite Rmult_comm. apply Rmult_le_compat_l; lra. }
    assert (lam * W <= c2 * W) by (apply Rmult_le_compat_r; auto; apply Rmin_r).
    assert (lam * w0 <= lam * (A + W)) by (apply Rmult_le_compat_l; lra). lra. }
  set (T := (v 0 + 1) / (lam * w0)). pose proof (V_nonneg (e 0) (w 0)) as V0.
  assert (Hlw : 0 < lam * w0) by (apply Rmult_lt_0_compat; auto).
  assert (HT : 0 <= T) by (apply Rlt_le, Rdiv_lt_0_compat; simpl; lra).
  assert (HvT : v T < d).
  { destruct (Rlt_dec (v T) d) as [|N]; auto. exfalso.
    assert (K : v T <= v 0 - lam * w0 * (T - 0)).
    { apply (falls v dv (lam * w0) 0 T HT); [intros; apply v_rate; lra|]. intros t Ht. apply Fast; [lra|].
      pose proof (v_falls t T ltac:(lra) ltac:(lra)). simpl in *. lra. }
    replace (lam * w0 * (T - 0)) with (v 0 + 1) in K by (unfold T; field; split; lra).
    pose proof (V_nonneg (e T) (w T)). simpl in *. lra. }
  exists T. intros t Ht i Hi. apply (Hd (e t) (w t)); auto. pose proof (v_falls T t HT Ht). simpl in *. lra.
Qed.
End Trajectory.

Theorem stays eta : 0 < eta -> exists z, 0 < z /\ forall e w, solution e w ->
  (forall i, (i < n)%nat -> Rabs (e 0 i) <= z) -> norm n (hv (e 0)) ^ 2 + norm n (w 0) ^ 2 <= z ->
  forall t, 0 <= t -> forall i, (i < n)%nat -> Rabs (e t i) < eta /\ Rabs (w t i) < eta.
Proof.
  intros Heta. destruct (small_V eta Heta) as (d & Pd & Hd). destruct (small_state d Pd) as (z & Pz & Hz).
  exists z. split; auto. intros e w S He Hs t Ht i Hi. apply (Hd (e t) (w t)); auto.
  eapply Rle_lt_trans; [eapply (v_falls e w S 0 t (Rle_refl 0) Ht)|]. now apply Hz.
Qed.

(** *** The same with norms *)
Lemma norm_small x eta : 0 < eta -> (forall i, (i < n)%nat -> Rabs (x i) < eta / (sqrt (INR n) + 1)) -> norm n x < eta.
Proof.
  intros P H. pose proof (sqrt_pos (INR n)) as S. eapply Rle_lt_trans.
  - apply (bounded_norm_in n x (eta / (sqrt (INR n) + 1))); [left; apply Rdiv_lt_0_compat; lra|]. intros i Hi. left. now apply H.
  - apply Rlt_le_trans with ((sqrt (INR n) + 1) * (eta / (sqrt (INR n) + 1))); [|right; field; lra].
    apply Rmult_lt_compat_r; [apply Rdiv_lt_0_compat; lra|lra].
Qed.
Theorem gas : globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  pose proof (sqrt_pos (INR n)) as Sn. split.
  - intros eta P. set (eta' := eta / (sqrt (INR n) + 1)). assert (P' : 0 < eta') by (apply Rdiv_lt_0_compat; lra).
    destruct (stays eta' P') as (z & Pz & H). pose proof (L_pos f) as HL.
    set (q := Rmin 1 (z / (Lf f * Lf f + 1))). assert (Q0 : 0 < q) by (apply Rmin_pos; [lra|apply Rdiv_lt_0_compat; nra]).
    assert (Q1 : q <= 1) by apply Rmin_l.
    assert (Q2 : q * (Lf f * Lf f + 1) <= z).
    { apply Rle_trans with (z / (Lf f * Lf f + 1) * (Lf f * Lf f + 1)); [apply Rmult_le_compat_r; [nra|apply Rmin_r]|]. right; field; nra. }
    exists q. split; auto. intros e w S He Hw t Ht.
    assert (K : forall i, (i < n)%nat -> Rabs (e t i) < eta' /\ Rabs (w t i) < eta').
    { apply (H e w S); auto.
      - intros i Hi. eapply Rle_trans; [apply (entry_le_norm n (e 0) i Hi)|]. assert (q * 1 <= q * (Lf f * Lf f + 1)) by (apply Rmult_le_compat_l; nra). lra.
      - pose proof (hv_lip n f (e 0)) as A. pose proof (norm_pos n (hv (e 0))). pose proof (norm_pos n (e 0)). pose proof (norm_pos n (w 0)).
        assert (A1 : norm n (hv (e 0)) <= Lf f * q) by (eapply Rle_trans; [exact A|apply Rmult_le_compat_l; lra]).
        assert (A2 : norm n (hv (e 0)) ^ 2 <= (Lf f * q) ^ 2) by (apply pow_incr; lra).
        assert (A3 : norm n (w 0) ^ 2 <= q ^ 2) by (apply pow_incr; lra).
        apply Rle_trans with (q * (q * (Lf f * Lf f + 1))); [simpl in *; lra|].
        apply Rle_trans with (1 * (q * (Lf f * Lf f + 1))); [apply Rmult_le_compat_r; nra|lra]. }
    split; apply norm_small; auto; intros i Hi; now apply K.
  - intros e w S eta P. set (eta' := eta / (sqrt (INR n) + 1)). assert (P' : 0 < eta') by (apply Rdiv_lt_0_compat; lra).
    destruct (converges e w S eta' P') as [T H]. exists T. intros t Ht. specialize (H t Ht).
    split; apply norm_small; auto; intros i Hi; now apply H.
Qed.
Theorem falls_everywhere : decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0.
Proof.
  intros e w t S (i & Hi & Hz). exists (rate e w eps0 t). split.
  - apply (V_rate n rb f g qd e w (fun s => s = t)); auto. intros s ->. exact S.
  - eapply Rle_lt_trans; [apply dec|]. pose proof (eps_01 (e t)).
    assert (N : forall x : vec, x i <> 0 -> 0 < norm n x ^ 2).
    { intros x Hx. replace (norm n x ^ 2) with (norm n x * norm n x) by ring. rewrite norm2.
      pose proof (term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi). simpl in *. unfold dot. nra. }
    pose proof (pow2_ge_0 (norm n (hv (e t)))). pose proof (pow2_ge_0 (norm n (w t))).
    assert (P : 0 < c1 * eps n eps0 (e t)) by (apply Rmult_lt_0_compat; lra). destruct Hz as [Hz|Hz].
    + assert (0 < norm n (hv (e t)) ^ 2).
      { apply N. unfold Loop.hv. intros Hh. pose proof (h_sign f (e t i) Hz) as Hs. rewrite Hh in Hs. lra. }
      assert (0 < c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) by (apply Rmult_lt_0_compat; lra).
      assert (0 <= c2 * norm n (w t) ^ 2) by (apply Rmult_le_pos; lra). lra.
    + pose proof (N (w t) Hz). assert (0 < c2 * norm n (w t) ^ 2) by (apply Rmult_lt_0_compat; lra).
      assert (0 <= c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) by (apply Rmult_le_pos; lra). lra.
Qed.
End Eps.

(** *** From norms alone *)
Section Norms.
Variables eps0 c1 c2 : R.
Hypothesis eps0_pos : 0 < eps0.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Hypothesis c1_small : c1 < kp_min n g.
Hypothesis condition : eps0 * (cross n rb f g + eps0 * drift n rb f) ^ 2
  <= 4 * (kp_min n g - c1) * (b_min rb - c2 - eps0 * drift n rb f).
Lemma norms_decrease e w t : rate n rb f g qd e w eps0 t
  <= - (c1 * eps n eps0 (e t) * norm n (hv f (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Proof.
  eapply Rle_trans; [apply (rate_bound n rb f g qd e w eps0 eps0_pos t)|]. cbv zeta.
  apply form_decreases with (bar := eps0); auto using norm_pos. exact (eps_range n e eps0 eps0_pos t).
Qed.
Theorem stable_by_norms :
  decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0 /\
  globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  split; [apply (falls_everywhere eps0 eps0_pos c1 c2)|apply (gas eps0 eps0_pos c1 c2)]; auto using norms_decrease.
Qed.
End Norms.
Theorem stable_for_some_eps0 : exists eps0, 0 < eps0 /\
  decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0 /\
  globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  destruct (small_exists n rb f g) as (eps0 & c1 & c2 & P & P1 & P2 & P3 & Q). exists eps0. split; auto.
  apply (stable_by_norms eps0 c1 c2); auto.
Qed.
End Loop.
