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
Notation V := (fun qd => V n (M rb) (hf f) (Uf f) (kp n g) qd eps0).
Notation y := (y_of n (hf f) eps0).
Notation hv := (hv f).

(** *** V from below and from above *)
Lemma potential_pos e : 0 <= sum n (fun i => kp n g i * Uf f (e i)).
Proof. apply sum_nonneg_in. intros i Hi. apply Rmult_le_pos; [|apply U_nonneg]. pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). lra. Qed.
Lemma V_low_kinetic qd e w : alpha rb / 2 * dot n (y e w) (y e w) <= V qd e w.
Proof. unfold Definitions.V. pose proof (M_low rb (fun j => qd j - e j) (y e w)). pose proof (potential_pos e). lra. Qed.
Lemma V_low_potential qd e w i : (i < n)%nat -> kp_min n g * Uf f (e i) <= V qd e w.
Proof.
  intros Hi. unfold Definitions.V. pose proof (M_low rb (fun j => qd j - e j) (y e w)) as K. pose proof (dot_pos n (y e w)) as D.
  pose proof (alpha_pos rb). assert (0 <= alpha rb * dot n (y e w) (y e w)) by (apply Rmult_le_pos; lra).
  pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). pose proof (U_nonneg (e i)).
  assert (kp_min n g * Uf f (e i) <= kp n g i * Uf f (e i)) by (apply Rmult_le_compat_r; auto).
  assert (kp n g i * Uf f (e i) <= sum n (fun i => kp n g i * Uf f (e i))).
  { apply (term_le_sum_in n (fun i => kp n g i * Uf f (e i))); auto. intros j Hj. apply Rmult_le_pos; [|apply U_nonneg]. pose proof (kp_low n g j Hj). lra. }
  lra.
Qed.
Theorem V_nonneg qd e w : 0 <= V qd e w.
Proof. eapply Rle_trans; [|apply V_low_kinetic]. apply Rmult_le_pos; [pose proof (alpha_pos rb); lra|apply dot_pos]. Qed.
Lemma eps_01 e : 0 < eps n eps0 e <= eps0.
Proof. exact (eps_range n (fun _ => e) eps0 eps0_pos 0). Qed.
Definition high : R := beta rb * (1 + eps0 * eps0).
Lemma high_pos : 0 <= high.
Proof. unfold high. apply Rmult_le_pos; [apply beta_pos|nra]. Qed.
Lemma V_high qd e w : V qd e w <= high * (norm n (hv e) ^ 2 + norm n w ^ 2) + sum n (fun i => kp n g i * Uf f (e i)).
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
Lemma small_V eta : 0 < eta -> exists d, 0 < d /\ forall qd e w, V qd e w < d -> forall i, (i < n)%nat -> Rabs (e i) < eta /\ Rabs (w i) < eta.
Proof.
  intros Heta. pose proof (L_pos f) as HL. pose proof (alpha_pos rb) as Ha. pose proof (kp_min_pos n g) as Hk.
  set (z := eta / (2 * (eps0 * Lf f + 1))). assert (He : 0 < eps0 * Lf f) by (apply Rmult_lt_0_compat; lra).
  assert (Hz : 0 < z) by (apply Rdiv_lt_0_compat; lra).
  assert (Hz1 : (eps0 * Lf f + 1) * z = eta / 2) by (unfold z; field; lra).
  destruct (U_away z Hz) as (m & Pm & Hm).
  exists (Rmin (kp_min n g * m) (alpha rb / 2 * (eta / 2 * (eta / 2)))).
  split; [apply Rmin_pos; [apply Rmult_lt_0_compat; lra|apply Rmult_lt_0_compat; nra]|].
  intros qd e w HV i Hi.
  assert (V1 : V qd e w < kp_min n g * m) by (eapply Rlt_le_trans; [exact HV|apply Rmin_l]).
  assert (V2 : V qd e w < alpha rb / 2 * (eta / 2 * (eta / 2))) by (eapply Rlt_le_trans; [exact HV|apply Rmin_r]).
  assert (E : Rabs (e i) < z).
  { destruct (Rlt_dec (Rabs (e i)) z) as [|N]; auto. pose proof (Hm (e i) ltac:(lra)). pose proof (V_low_potential qd e w i Hi).
    assert (kp_min n g * m <= kp_min n g * Uf f (e i)) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Y : norm n (y e w) < eta / 2).
  { apply square_lt; [apply norm_pos|lra|]. rewrite norm2. pose proof (V_low_kinetic qd e w).
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
Theorem V_positive qd e w : (exists i, (i < n)%nat /\ (e i <> 0 \/ w i <> 0)) -> 0 < V qd e w.
Proof.
  intros (i & Hi & H). set (eta := Rmax (Rabs (e i)) (Rabs (w i))).
  assert (P : 0 < eta).
  { destruct H as [H|H]; apply Rabs_pos_lt in H; eapply Rlt_le_trans; [exact H|apply Rmax_l|exact H|apply Rmax_r]. }
  destruct (small_V eta P) as (d & Pd & Hd). destruct (Rlt_dec (V qd e w) d) as [K|K]; [|lra].
  destruct (Hd qd e w K i Hi) as [K1 K2]. exfalso. unfold eta in K1, K2.
  destruct (Rle_dec (Rabs (e i)) (Rabs (w i))); [rewrite Rmax_right in K2 by auto|rewrite Rmax_left in K1 by lra]; lra.
Qed.
Theorem V_unbounded K : exists r, forall qd e w, V qd e w <= K -> forall i, (i < n)%nat -> Rabs (e i) <= r /\ Rabs (w i) <= r.
Proof.
  destruct (U_proper (K / kp_min n g)) as [r1 H1]. pose proof (kp_min_pos n g) as Hk. pose proof (alpha_pos rb) as Ha.
  set (r2 := sqrt (2 * Rabs K / alpha rb) + eps0 * gammaf f). exists (Rmax r1 r2). intros qd e w HV i Hi. split.
  - eapply Rle_trans; [|apply Rmax_l]. apply H1. apply Rle_div_r; [lra|]. pose proof (V_low_potential qd e w i Hi). lra.
  - eapply Rle_trans; [|apply Rmax_r]. pose proof (entry_le_norm n (y e w) i Hi) as Yi. pose proof (eps_01 e) as [E0 E1].
    assert (Wi : Rabs (w i) <= Rabs (y e w i) + eps0 * Rabs (hf f (e i))).
    { replace (w i) with (y e w i + eps n eps0 e * hf f (e i)) by (unfold y_of; ring). eapply Rle_trans; [apply Rabs_triang|].
      apply Rplus_le_compat_l. rewrite Rabs_mult, (Rabs_pos_eq (eps _ _ _)) by lra. apply Rmult_le_compat_r; [apply Rabs_pos|lra]. }
    assert (eps0 * Rabs (hf f (e i)) <= eps0 * gammaf f) by (apply Rmult_le_compat_l; [lra|apply h_up]). assert (norm n (y e w) <= sqrt (2 * Rabs K / alpha rb)); [|unfold r2; lra].
    apply sqrt_le_1; [apply dot_pos| |].
    + apply Rmult_le_pos; [pose proof (Rabs_pos K); lra|left; apply Rinv_0_lt_compat; lra].
    + apply Rle_div_r; [lra|]. pose proof (V_low_kinetic qd e w). pose proof (Rle_abs K). lra.
Qed.
(** A small state means small V. *)
Lemma small_state d : 0 < d -> exists z, 0 < z /\ forall qd e w, (forall i, (i < n)%nat -> Rabs (e i) <= z) ->
   norm n (hv e) ^ 2 + norm n w ^ 2 <= z -> V qd e w < d.
Proof.
  intros Hd. set (Ks := sum n (kp n g)). pose proof high_pos as Hb. pose proof (kp_min_pos n g) as Hk.
  assert (HKs : 0 <= Ks) by (apply sum_nonneg_in; intros i Hi; pose proof (kp_low n g i Hi); lra).
  destruct (near_zero (Uf f) (d / (2 * (Ks + 1))) (U_continuous 0) (U_zero f)) as (z & Pz & Hz); [apply Rdiv_lt_0_compat; lra|].
  set (z2 := d / (4 * (high + 1))). assert (Hz2 : 0 < z2) by (apply Rdiv_lt_0_compat; lra).
  exists (Rmin z z2). split; [apply Rmin_pos; auto|]. intros qd e w He Hs.
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

(** *** The same with norms *)
Lemma norm_small x eta : 0 < eta -> (forall i, (i < n)%nat -> Rabs (x i) < eta / (sqrt (INR n) + 1)) -> norm n x < eta.
Proof.
  intros P H. pose proof (sqrt_pos (INR n)) as S. eapply Rle_lt_trans.
  - apply (bounded_norm_in n x (eta / (sqrt (INR n) + 1))); [left; apply Rdiv_lt_0_compat; lra|]. intros i Hi. left. now apply H.
  - apply Rlt_le_trans with ((sqrt (INR n) + 1) * (eta / (sqrt (INR n) + 1))); [|right; field; lra].
    apply Rmult_lt_compat_r; [apply Rdiv_lt_0_compat; lra|lra].
Qed.
Lemma ends eta : 0 < eta -> exists d, 0 < d /\ forall qd e w, V qd e w < d -> norm n e < eta /\ norm n w < eta.
Proof.
  intros P. pose proof (sqrt_pos (INR n)). destruct (small_V (eta / (sqrt (INR n) + 1))) as (d & Pd & Hd); [apply Rdiv_lt_0_compat; lra|].
  exists d. split; auto. intros qd e w HV. split; apply norm_small; auto; intros i Hi; now apply (Hd qd e w).
Qed.
Lemma starts d : 0 < d -> exists q, 0 < q /\ forall qd e w, norm n e < q -> norm n w < q -> V qd e w < d.
Proof.
  intros P. destruct (small_state d P) as (z & Pz & H). pose proof (L_pos f) as HL.
  set (q := Rmin 1 (z / (Lf f * Lf f + 1))). assert (Q0 : 0 < q) by (apply Rmin_pos; [lra|apply Rdiv_lt_0_compat; nra]).
  assert (Q1 : q <= 1) by apply Rmin_l.
  assert (Q2 : q * (Lf f * Lf f + 1) <= z).
  { apply Rle_trans with (z / (Lf f * Lf f + 1) * (Lf f * Lf f + 1)); [apply Rmult_le_compat_r; [nra|apply Rmin_r]|]. right; field; nra. }
  exists q. split; auto. intros qd e w He Hw. apply H.
  - intros i Hi. eapply Rle_trans; [apply (entry_le_norm n e i Hi)|]. assert (q * 1 <= q * (Lf f * Lf f + 1)) by (apply Rmult_le_compat_l; nra). lra.
  - pose proof (hv_lip n f e) as A. pose proof (norm_pos n (hv e)). pose proof (norm_pos n e). pose proof (norm_pos n w).
    assert (A1 : norm n (hv e) <= Lf f * q) by (eapply Rle_trans; [exact A|apply Rmult_le_compat_l; lra]).
    assert (A2 : norm n (hv e) ^ 2 <= (Lf f * q) ^ 2) by (apply pow_incr; lra).
    assert (A3 : norm n w ^ 2 <= q ^ 2) by (apply pow_incr; lra).
    apply Rle_trans with (q * (q * (Lf f * Lf f + 1))); [simpl in *; lra|].
    apply Rle_trans with (1 * (q * (Lf f * Lf f + 1))); [apply Rmult_le_compat_r; nra|lra].
Qed.
(** On bounded states V is bounded. *)
Lemma V_below z : exists K, forall qd e w, norm n e < z -> norm n w < z -> V qd e w <= K.
Proof.
  destruct (continuity_ab_maj (Uf f) (- Rabs z) (Rabs z)) as (x0 & Hx & _); [pose proof (Rabs_pos z); lra|intros; apply U_continuous|].
  exists (high * (reach n f ^ 2 + z ^ 2) + sum n (fun i => kp n g i * Uf f x0)). intros qd e w He Hw.
  eapply Rle_trans; [apply V_high|]. apply Rplus_le_compat.
  - apply Rmult_le_compat_l; [apply high_pos|]. pose proof (norm_pos n w). pose proof (norm_pos n (hv e)).
    apply Rplus_le_compat; apply pow_incr; [split; [auto|apply hv_bound]|lra].
  - apply sum_le_in. intros i Hi. pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). apply Rmult_le_compat_l; [lra|]. apply Hx.
    pose proof (entry_le_norm n e i Hi). pose proof (Rle_abs z). apply Rabs_le_between. lra.
Qed.

Lemma form_negative c1 c2 e w : 0 < c1 -> 0 < c2 -> Definitions.away n e w ->
  - (c1 * eps n eps0 e * norm n (hv e) ^ 2) - c2 * norm n w ^ 2 < 0.
Proof.
  intros c1_pos c2_pos (i & Hi & Hz). pose proof (eps_01 e).
  assert (N : forall x : vec, x i <> 0 -> 0 < norm n x ^ 2).
  { intros x Hx. replace (norm n x ^ 2) with (norm n x * norm n x) by ring. rewrite norm2.
    pose proof (term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi). simpl in *. unfold dot. nra. }
  pose proof (pow2_ge_0 (norm n (hv e))). pose proof (pow2_ge_0 (norm n w)).
  assert (P : 0 < c1 * eps n eps0 e) by (apply Rmult_lt_0_compat; lra). destruct Hz as [Hz|Hz].
  - assert (0 < norm n (hv e) ^ 2).
    { apply N. unfold Loop.hv. intros Hh. pose proof (h_sign f (e i) Hz) as Hs. rewrite Hh in Hs. lra. }
    assert (0 < c1 * eps n eps0 e * norm n (hv e) ^ 2) by (apply Rmult_lt_0_compat; lra).
    assert (0 <= c2 * norm n w ^ 2) by (apply Rmult_le_pos; lra). lra.
  - pose proof (N w Hz). assert (0 < c2 * norm n w ^ 2) by (apply Rmult_lt_0_compat; lra).
    assert (0 <= c1 * eps n eps0 e * norm n (hv e) ^ 2) by (apply Rmult_le_pos; lra). lra.
Qed.

(** ** A goal that moves, and all that is asked of dV/dt: q' is a function of time and w *)
Section Moving.
Variable goal : R -> vec.
Variable turning : R -> vec -> vec.
Hypothesis goal_rate : forall (w : vec) t i, 0 <= t -> (i < n)%nat -> is_derive (fun s => goal s i) t (turning t w i - w i).
Notation rate := (fun e w => rate_along n rb f g goal (fun t => turning t (w t)) e w eps0).
Variables c1 c2 : R.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Hypothesis dec : forall e w t, 0 <= t -> rate e w t <= - (c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Definition moves (t0 : R) (e w : R -> vec) : Prop := forall t, t0 <= t ->
  closed_at n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) (fun j => goal t j - e t j) (turning t (w t)) e w t.

Section Trajectory.
Variables (t0 : R) (e w : R -> vec).
Hypothesis t0_pos : 0 <= t0.
Hypothesis S : moves t0 e w.
Notation v := (fun t => V (goal t) (e t) (w t)).
Notation dv := (rate e w).
Lemma v_rate t : t0 <= t -> is_derive v t (dv t).
Proof.
  intros Ht. apply (V_rate_along n rb f g goal (fun t => turning t (w t)) e w (fun t => t0 <= t) S); auto.
  intros s i Hs Hi. apply goal_rate; auto. lra.
Qed.
Lemma dv_nonpos t : t0 <= t -> dv t <= 0.
Proof.
  intros Ht. eapply Rle_trans; [apply dec; lra|]. pose proof (eps_01 (e t)).
  assert (0 <= c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|apply pow2_ge_0]).
  assert (0 <= c2 * norm n (w t) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). lra.
Qed.
Lemma v_falls t1 t2 : t0 <= t1 -> t1 <= t2 -> v t2 <= v t1.
Proof. intros H0 H. pose proof (falls v dv 0 t1 t2 H ltac:(intros; apply v_rate; lra) ltac:(intros s Hs; pose proof (dv_nonpos s ltac:(lra)); lra)). lra. Qed.
End Trajectory.

Theorem stays eta : 0 < eta -> exists z, 0 < z /\ forall t0 e w, 0 <= t0 -> moves t0 e w -> within n z e w t0 ->
  forall t, t0 <= t -> within n eta e w t.
Proof.
  intros P. destruct (ends eta P) as (d & Pd & Hd). destruct (starts d Pd) as (z & Pz & Hz). exists z. split; auto.
  intros t0 e w P0 S [He Hw] t Ht. apply (Hd (goal t)). eapply Rle_lt_trans; [apply (v_falls t0 e w P0 S t0 t (Rle_refl t0) Ht)|]. now apply Hz.
Qed.
Theorem bounded z : exists eta, forall t0 e w, 0 <= t0 -> moves t0 e w -> within n z e w t0 -> forall t, t0 <= t -> within n eta e w t.
Proof.
  destruct (V_below z) as [K HK]. destruct (V_unbounded K) as [r Hr]. exists (sqrt (INR n) * Rabs r + 1).
  intros t0 e w P0 S [He Hw] t Ht.
  assert (B : V (goal t) (e t) (w t) <= K) by (eapply Rle_trans; [apply (v_falls t0 e w P0 S t0 t (Rle_refl t0) Ht)|now apply HK]).
  split; (eapply Rle_lt_trans; [apply (bounded_norm_in n _ (Rabs r)); [apply Rabs_pos|]|lra]);
    intros i Hi; (eapply Rle_trans; [apply (Hr _ _ _ B i Hi)|apply Rle_abs]).
Qed.
Theorem converges z eta : 0 < eta -> exists T, 0 <= T /\ forall t0 e w, 0 <= t0 -> moves t0 e w -> within n z e w t0 ->
  forall t, t0 + T <= t -> within n eta e w t.
Proof.
  intros Heta. destruct (ends eta Heta) as (d & Pd & Hd). destruct (small_state d Pd) as (y & Py & Hy).
  destruct (V_below z) as [K' HK']. set (K := Rabs K'). assert (HK : 0 <= K) by apply Rabs_pos.
  pose proof (kp_min_pos n g) as Hk. pose proof (b_min_pos rb) as Hb.
  destruct (U_proper (K / kp_min n g)) as [r Hr].
  set (e1 := eps0 / (1 + sqrt (INR n) * Rabs r)).
  assert (Hs : 0 <= sqrt (INR n) * Rabs r) by (apply Rmult_le_pos; [apply sqrt_pos|apply Rabs_pos]).
  assert (He1 : 0 < e1) by (apply Rdiv_lt_0_compat; lra).
  destruct (away (fun x => Rabs (hf f x)) y (Rabs r) h_continuous) as (m & Pm & Hm).
  { intros x Hx. apply Rabs_pos_lt. pose proof (h_sign f x Hx). intros E. rewrite E in H. lra. }
  { exact Py. }
  set (w0 := Rmin (m * m) y). assert (Hw0 : 0 < w0) by (apply Rmin_pos; nra).
  set (lam := Rmin (e1 * c1) c2).
  assert (Hlam : 0 < lam) by (apply Rmin_pos; [apply Rmult_lt_0_compat|]; lra).
  assert (Hlw : 0 < lam * w0) by (apply Rmult_lt_0_compat; auto).
  set (T := (K + 1) / (lam * w0)). assert (HT : 0 <= T) by (apply Rlt_le, Rdiv_lt_0_compat; lra).
  exists T. split; auto. intros t0 e w P0 S [He Hw]. set (v := fun t => V (goal t) (e t) (w t)).
  assert (Start : v t0 <= K) by (eapply Rle_trans; [apply (HK' (goal t0)); auto|apply Rle_abs]).
  assert (Falls : forall t1 t2, t0 <= t1 -> t1 <= t2 -> v t2 <= v t1) by (exact (v_falls t0 e w P0 S)).
  assert (Bound : forall t, t0 <= t -> forall i, (i < n)%nat -> Rabs (e t i) <= Rabs r).
  { intros t Ht i Hi. eapply Rle_trans; [|apply Rle_abs]. apply Hr. apply Rle_div_r; [lra|].
    pose proof (V_low_potential (goal t) (e t) (w t) i Hi). pose proof (Falls t0 t (Rle_refl t0) Ht). unfold v in *. simpl in *. lra. }
  assert (Heps : forall t, t0 <= t -> e1 <= eps n eps0 (e t)).
  { intros t Ht. unfold e1, eps. apply Rmult_le_compat_l; [lra|]. pose proof (norm_pos n (e t)). apply Rinv_le_contravar; [lra|].
    apply Rplus_le_compat_l. apply bounded_norm_in; [apply Rabs_pos|]. now apply Bound. }
  assert (Far : forall t, t0 <= t -> d <= v t -> w0 <= norm n (hv (e t)) ^ 2 + norm n (w t) ^ 2).
  { intros t Ht Hv. destruct (Rle_dec w0 (norm n (hv (e t)) ^ 2 + norm n (w t) ^ 2)) as [|N]; auto. exfalso.
    assert (V (goal t) (e t) (w t) < d); [|unfold v in Hv; simpl in Hv; lra]. apply Hy.
    - intros i Hi. destruct (Rle_dec (Rabs (e t i)) y) as [|E]; auto. exfalso. apply N.
      pose proof (Hm (e t i) ltac:(split; [lra|now apply Bound])) as A. pose proof (entry_le_norm n (hv (e t)) i Hi) as B.
      unfold Loop.hv in B at 1. pose proof (pow2_ge_0 (norm n (w t))). assert (w0 <= m * m) by apply Rmin_l.
      assert (m * m <= norm n (hv (e t)) * norm n (hv (e t))) by (apply Rmult_le_compat; lra). simpl. lra.
    - assert (w0 <= y) by apply Rmin_r. lra. }
  assert (Fast : forall t, t0 <= t -> d <= v t -> rate e w t <= - (lam * w0)).
  { intros t Ht Hv. pose proof (Far t Ht Hv) as F. pose proof (Heps t Ht) as E. eapply Rle_trans; [apply dec; lra|].
    pose proof (pow2_ge_0 (norm n (hv (e t)))) as A2. pose proof (pow2_ge_0 (norm n (w t))) as V2.
    set (A := norm n (hv (e t)) ^ 2) in *. set (W := norm n (w t) ^ 2) in *.
    assert (lam * A <= c1 * eps n eps0 (e t) * A).
    { apply Rmult_le_compat_r; auto. eapply Rle_trans; [apply Rmin_l|]. rewrite Rmult_comm. apply Rmult_le_compat_l; lra. }
    assert (lam * W <= c2 * W) by (apply Rmult_le_compat_r; auto; apply Rmin_r).
    assert (lam * w0 <= lam * (A + W)) by (apply Rmult_le_compat_l; lra). lra. }
  assert (HvT : v (t0 + T) < d).
  { destruct (Rlt_dec (v (t0 + T)) d) as [|N]; auto. exfalso.
    assert (F : v (t0 + T) <= v t0 - lam * w0 * (t0 + T - t0)).
    { apply (falls v (rate e w) (lam * w0) t0 (t0 + T)); [lra|intros; apply (v_rate t0 e w P0 S); lra|]. intros t Ht. apply Fast; [lra|].
      pose proof (Falls t (t0 + T) ltac:(lra) ltac:(lra)). lra. }
    replace (lam * w0 * (t0 + T - t0)) with (K + 1) in F by (unfold T; field; split; lra).
    pose proof (V_nonneg (goal (t0 + T)) (e (t0 + T)) (w (t0 + T))). unfold v in *. simpl in *. lra. }
  intros t Ht. apply (Hd (goal t)). pose proof (Falls (t0 + T) t ltac:(lra) Ht). unfold v in *. simpl in *. lra.
Qed.
End Moving.

(** ** The goal at rest *)
Section AtRest.
Variable qd : vec.
Variables c1 c2 : R.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Notation rate := (rate n rb f g qd).
Hypothesis dec : forall e w t, rate e w eps0 t <= - (c1 * eps n eps0 (e t) * norm n (hv (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Theorem gas : globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  assert (G : forall (w : vec) t i, 0 <= t -> (i < n)%nat -> is_derive (fun _ => qd i) t ((fun (_ : R) w => w) t w i - w i)).
  { intros w t i _ _. exact (at_rest qd (fun _ => w) t i). }
  pose proof (fun e w t (_ : 0 <= t) => dec e w t) as D. split.
  - intros eta P. destruct (stays (fun _ => qd) (fun _ w => w) G c1 c2 c1_pos c2_pos D eta P) as (z & Pz & H).
    exists z. split; auto. intros e w S He Hw t Ht. apply (H 0 e w (Rle_refl 0) S (conj He Hw) t Ht).
  - intros e w S eta P. set (z := Rmax (norm n (e 0)) (norm n (w 0)) + 1).
    destruct (converges (fun _ => qd) (fun _ w => w) G c1 c2 c1_pos c2_pos D z eta P) as (T & _ & H).
    pose proof (Rmax_l (norm n (e 0)) (norm n (w 0))). pose proof (Rmax_r (norm n (e 0)) (norm n (w 0))).
    exists T. intros t Ht. apply (H 0 e w (Rle_refl 0) S); [split; unfold z; lra|lra].
Qed.
Theorem falls_everywhere : decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0.
Proof.
  intros e w t S A. exists (rate e w eps0 t). split.
  - apply (V_rate n rb f g qd e w (fun s => s = t)); auto. intros s ->. exact S.
  - eapply Rle_lt_trans; [apply dec|now apply form_negative].
Qed.
End AtRest.
End Eps.

(** *** From norms alone *)
Section Norms.
Variable qd : vec.
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
  apply form_decreases with (bar := eps0); auto using norm_pos, cross_pos. exact (eps_range n e eps0 eps0_pos t).
Qed.
Theorem stable_by_norms :
  decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0 /\
  globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  split; [apply (falls_everywhere eps0 eps0_pos qd c1 c2)|apply (gas eps0 eps0_pos qd c1 c2)]; auto using norms_decrease.
Qed.
End Norms.
Theorem stable_for_some_eps0 qd : exists eps0, 0 < eps0 /\
  decreasing n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) qd eps0 /\
  globally_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) qd.
Proof.
  destruct (small_exists n rb f g 0 (Rle_refl 0)) as (eps0 & c1 & c2 & P & P1 & P2 & P3 & Q).
  rewrite !Rmult_0_r, ?Rminus_0_r, ?Rplus_0_r in *. exists eps0. split; auto.
  apply (stable_by_norms qd eps0 c1 c2); auto.
Qed.

(** *** A goal that moves: |v| <= vd *)
Section Tracking.
Variables (r v : R -> vec) (vd : R).
Hypothesis moving : goal_moves n r v vd.
Lemma vd_pos : 0 <= vd.
Proof. eapply Rle_trans; [apply (norm_pos n (v 0))|apply moving; lra]. Qed.
Variables eps0 c1 c2 : R.
Hypothesis eps0_pos : 0 < eps0.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Hypothesis c1_small : c1 < kp_min n g - eps0 * (kc rb * vd).
Hypothesis condition : eps0 * (cross n rb f g + kc rb * vd + eps0 * drift n rb f) ^ 2
  <= 4 * (kp_min n g - eps0 * (kc rb * vd) - c1) * (b_min rb - c2 - eps0 * drift n rb f).
Lemma turning_rate (w : vec) t i : 0 <= t -> (i < n)%nat -> is_derive (fun s => r s i) t (v t i + w i - w i).
Proof. intros Ht Hi. evar_last; [now apply moving|ring]. Qed.
Lemma tracking_decreases e w t : 0 <= t -> rate_along n rb f g r (fun t j => v t j + w t j) e w eps0 t
  <= - (c1 * eps n eps0 (e t) * norm n (hv f (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Proof.
  intros Ht. pose proof (eps_range n e eps0 eps0_pos t) as [E0 E1]. pose proof vd_pos as P. pose proof (kc_pos rb) as Pc.
  assert (Pv : 0 <= kc rb * vd) by (apply Rmult_le_pos; auto).
  eapply Rle_trans; [apply (rate_bound_along n rb f g r (fun t j => v t j + w t j) e w eps0 eps0_pos vd t); auto|].
  { eapply Rle_trans; [apply (norm_plus n (v t) (w t))|]. apply Rplus_le_compat_r, moving; auto. }
  cbv zeta. eapply Rle_trans; [|apply (form_decreases n rb f (kp_min n g - eps0 * (kc rb * vd)) (cross n rb f g + kc rb * vd) eps0); eauto using norm_pos].
  - set (ep := eps n eps0 (e t)) in *. set (a := norm n (hv f (e t))).
    assert (ep * (kp_min n g - eps0 * (kc rb * vd)) * a ^ 2 <= ep * (kp_min n g - ep * (kc rb * vd)) * a ^ 2); [|lra].
    apply Rmult_le_compat_r; [apply pow2_ge_0|]. apply Rmult_le_compat_l; [lra|]. assert (ep * (kc rb * vd) <= eps0 * (kc rb * vd)) by (apply Rmult_le_compat_r; lra). lra.
  - pose proof (cross_pos n rb f g). lra.
Qed.
Theorem tracking_falls : decreasing_along n (M rb) (C rb) (b rb) (hf f) (Uf f) (kp n g) (kv n g) r v eps0.
Proof.
  intros e w t Ht S A. eexists. split.
  - apply (V_rate_along n rb f g r (fun t j => v t j + w t j) e w (fun s => s = t)); [intros s ->; exact S| |reflexivity].
    intros s i -> Hi. exact (turning_rate (w t) t i Ht Hi).
  - eapply Rle_lt_trans; [exact (tracking_decreases e w t Ht)|]. now apply form_negative.
Qed.
Theorem tracks_by_norms : globally_uniformly_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) r v.
Proof.
  pose proof turning_rate as G. pose proof tracking_decreases as D. set (turning := fun t (w : vec) j => v t j + w j). split; [|split].
  - exact (stays eps0 eps0_pos r turning G c1 c2 c1_pos c2_pos D).
  - exact (bounded eps0 eps0_pos r turning G c1 c2 c1_pos c2_pos D).
  - exact (converges eps0 eps0_pos r turning G c1 c2 c1_pos c2_pos D).
Qed.
End Tracking.
Theorem tracks_for_some_eps0 r v vd : goal_moves n r v vd ->
  globally_uniformly_asymptotically_stable n (M rb) (C rb) (b rb) (hf f) (kp n g) (kv n g) r v.
Proof.
  intros H. destruct (small_exists n rb f g vd (vd_pos r v vd H)) as (eps0 & c1 & c2 & P & P1 & P2 & P3 & Q).
  apply (tracks_by_norms r v vd H eps0 c1 c2); auto.
Qed.
End Loop.
