(** The closed loop (11) for every number of joints: dV/dt along any solution, and a small enough eps0. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Open Scope R_scope.
Arguments alpha_pos {n}. Arguments beta_pos {n}. Arguments kc_pos {n}. Arguments b_min_pos {n}. Arguments M_sym {n}.
Arguments M_low {n}. Arguments M_up {n}. Arguments M_rate {n}. Arguments C_up {n}. Arguments b_order {n}. Arguments b_range {n}.

(** ** Vectors and matrices, by coordinates *)
Lemma sum_ext k f g : (forall i, (i < k)%nat -> f i = g i) -> sum k f = sum k g.
Proof. intros H; induction k; simpl; auto. rewrite IHk, H; auto. Qed.
Lemma sum_plus k f g : sum k (fun i => f i + g i) = sum k f + sum k g.
Proof. induction k; simpl; [|rewrite IHk]; ring. Qed.
Lemma sum_minus k f g : sum k (fun i => f i - g i) = sum k f - sum k g.
Proof. induction k; simpl; [|rewrite IHk]; ring. Qed.
Lemma sum_scal k c f : sum k (fun i => c * f i) = c * sum k f.
Proof. induction k; simpl; [|rewrite IHk]; ring. Qed.
Lemma sum_le k f g : (forall i, (i < k)%nat -> f i <= g i) -> sum k f <= sum k g.
Proof. intros H; induction k; simpl; [lra|]. pose proof (H k ltac:(lia)). assert (sum k f <= sum k g) by auto. lra. Qed.
Lemma sum_nonneg k f : (forall i, 0 <= f i) -> 0 <= sum k f.
Proof. intros H; induction k; simpl; [lra|]. specialize (H k). lra. Qed.
Lemma sum_swap k l (f : nat -> nat -> R) :
  sum k (fun i => sum l (fun j => f i j)) = sum l (fun j => sum k (fun i => f i j)).
Proof.
  induction k; simpl.
  - induction l; simpl; [|rewrite <- IHl]; ring.
  - now rewrite IHk, <- sum_plus.
Qed.
Lemma sum_const k c : sum k (fun _ => c) = INR k * c.
Proof. induction k; [simpl; ring|]. rewrite S_INR. simpl. rewrite IHk. ring. Qed.
Lemma term_le_sum k f i : (forall j, 0 <= f j) -> (i < k)%nat -> f i <= sum k f.
Proof.
  intros H Hi; induction k; [lia|]. simpl. destruct (PeanoNat.Nat.eq_dec i k) as [->|].
  - pose proof (sum_nonneg k f H). lra.
  - assert (f i <= sum k f) by (apply IHk; lia). specialize (H k). lra.
Qed.
Lemma is_derive_sum k (f : nat -> R -> R) df t :
  (forall i, (i < k)%nat -> is_derive (f i) t (df i)) -> is_derive (fun t => sum k (fun i => f i t)) t (sum k df).
Proof.
  intros H; induction k; simpl; [apply (is_derive_const (V := R_NormedModule) 0)|].
  apply (is_derive_plus (fun t => sum k (fun i => f i t)) (f k)); auto.
Qed.

Section Vectors.
Variable n : nat.
Lemma dot_sym x y : dot n x y = dot n y x.
Proof. apply sum_ext; intros; ring. Qed.
Lemma dot_pos x : 0 <= dot n x x.
Proof. apply sum_nonneg; intros; nra. Qed.
Lemma norm_pos x : 0 <= norm n x. Proof. apply sqrt_pos. Qed.
Lemma norm2 x : norm n x * norm n x = dot n x x. Proof. apply sqrt_sqrt, dot_pos. Qed.
Lemma dot_combine x y s : dot n (fun i => x i - s * y i) (fun i => x i - s * y i) = dot n x x - 2 * s * dot n x y + s * s * dot n y y.
Proof.
  unfold dot. rewrite <- !sum_scal, <- sum_minus, <- sum_plus. apply sum_ext; intros; ring.
Qed.
Lemma cauchy_schwarz x y : dot n x y <= norm n x * norm n y.
Proof.
  pose proof (dot_pos x) as X. pose proof (dot_pos y) as Y.
  assert (K : forall s, 0 <= dot n x x - 2 * s * dot n x y + s * s * dot n y y) by (intros; rewrite <- dot_combine; apply dot_pos).
  assert (S : dot n x y * dot n x y <= dot n x x * dot n y y).
  { destruct (Req_dec (dot n y y) 0) as [Z|Z].
    - rewrite Z in *. destruct (Req_dec (dot n x y) 0) as [->|N]; [lra|].
      specialize (K ((dot n x x + 1) / (2 * dot n x y))).
      replace (2 * ((dot n x x + 1) / (2 * dot n x y)) * dot n x y) with (dot n x x + 1) in K by (field; auto). lra.
    - specialize (K (dot n x y / dot n y y)).
      replace (dot n x x - 2 * (dot n x y / dot n y y) * dot n x y + dot n x y / dot n y y * (dot n x y / dot n y y) * dot n y y)
        with ((dot n x x * dot n y y - dot n x y * dot n x y) / dot n y y) in K by (field; auto).
      assert (0 < dot n y y) by lra. apply Rmult_le_compat_r with (r := dot n y y) in K; [|lra].
      unfold Rdiv in K. rewrite Rmult_assoc, Rinv_l in K by lra. lra. }
  unfold norm. rewrite <- sqrt_mult by auto.
  destruct (Rle_dec 0 (dot n x y)) as [P|P].
  - rewrite <- (sqrt_square (dot n x y)) by auto. apply sqrt_le_1; nra.
  - pose proof (sqrt_pos (dot n x x * dot n y y)). lra.
Qed.
Lemma dot_scal_r c x y : dot n x (fun i => c * y i) = c * dot n x y.
Proof. unfold dot. rewrite <- sum_scal. apply sum_ext; intros; ring. Qed.
Lemma norm_scal c x : 0 <= c -> norm n (fun i => c * x i) = c * norm n x.
Proof.
  intros H. unfold norm. rewrite dot_scal_r, dot_sym, dot_scal_r.
  replace (c * (c * dot n x x)) with (c * c * dot n x x) by ring.
  rewrite sqrt_mult by (try apply dot_pos; nra). now rewrite sqrt_square.
Qed.
Lemma norm_le x y : (forall i, Rabs (x i) <= Rabs (y i)) -> norm n x <= norm n y.
Proof.
  intros H. apply sqrt_le_1; try apply dot_pos. apply sum_le. intros i _.
  rewrite <- (Rabs_pos_eq (x i * x i)), <- (Rabs_pos_eq (y i * y i)), !Rabs_mult by nra.
  pose proof (Rabs_pos (x i)). specialize (H i). nra.
Qed.
Lemma norm_abs x : norm n (fun i => Rabs (x i)) = norm n x.
Proof.
  unfold norm, dot. f_equal. apply sum_ext; intros. rewrite <- Rabs_mult. apply Rabs_pos_eq. nra.
Qed.
Lemma norm_plus x y : norm n (fun i => x i + y i) <= norm n x + norm n y.
Proof.
  pose proof (cauchy_schwarz x y). pose proof (norm_pos x). pose proof (norm_pos y).
  apply Rsqr_incr_0_var; [|lra]. unfold Rsqr. rewrite norm2.
  replace (dot n (fun i => x i + y i) (fun i => x i + y i)) with (dot n x x + 2 * dot n x y + dot n y y).
  - pose proof (norm2 x). pose proof (norm2 y). nra.
  - unfold dot. rewrite <- sum_scal, <- !sum_plus. apply sum_ext; intros; ring.
Qed.
Lemma norm_minus x y : norm n (fun i => x i - y i) <= norm n x + norm n y.
Proof.
  assert (E : norm n y = norm n (fun i => - y i)) by (unfold norm, dot; f_equal; apply sum_ext; intros; ring).
  rewrite E. apply (norm_plus x (fun i => - y i)).
Qed.
Lemma dot_ge x y : - (norm n x * norm n y) <= dot n x y.
Proof.
  assert (E : norm n y = norm n (fun i => - y i)) by (unfold norm, dot; f_equal; apply sum_ext; intros; ring).
  pose proof (cauchy_schwarz x (fun i => - y i)) as K. rewrite <- E in K.
  assert (dot n x (fun i => - y i) = - dot n x y); [|lra].
  replace (- dot n x y) with (-1 * dot n x y) by ring. rewrite <- dot_scal_r. apply sum_ext; intros; ring.
Qed.
Lemma apply_minus A x y i : apply_ n A (fun j => x j - y j) i = apply_ n A x i - apply_ n A y i.
Proof. unfold apply_, dot. rewrite <- sum_minus. apply sum_ext; intros; ring. Qed.
Lemma apply_scal A c x i : apply_ n A (fun j => c * x j) i = c * apply_ n A x i.
Proof. unfold apply_. apply dot_scal_r. Qed.
Lemma bounded_norm x c : 0 <= c -> (forall i, Rabs (x i) <= c) -> norm n x <= sqrt (INR n) * c.
Proof.
  intros Hc H. rewrite <- (sqrt_square c) by auto. rewrite <- sqrt_mult by (try apply pos_INR; nra).
  apply sqrt_le_1; [apply dot_pos|pose proof (pos_INR n); nra|].
  unfold dot. rewrite <- sum_const. apply sum_le. intros i _. specialize (H i).
  apply Rabs_le_between in H. nra.
Qed.

(** ** The function, the gains and the loop *)
Record member := Member {
  hf : R -> R; dhf : R -> R; Uf : R -> R; gammaf : R; rhof : R; Lf : R;
  gamma_pos : 0 <= gammaf; rho_pos : 0 <= rhof; L_pos : 0 < Lf;
  h_rate : forall x, is_derive hf x (dhf x); U_rate : forall x, is_derive Uf x (hf x);
  h_sign : forall x, x <> 0 -> 0 < x * hf x; h_zero : hf 0 = 0; U_pos : forall x, x <> 0 -> 0 < Uf x; U_zero : Uf 0 = 0;
  h_up : forall x, Rabs (hf x) <= gammaf; dh_up : forall x, Rabs (dhf x) <= rhof; h_lip : forall x, Rabs (hf x) <= Lf * Rabs x }.
Record gains := Gains { kp : vec; kv : vec; kp_min : R; kv_max : R; kp_min_pos : 0 < kp_min;
  kv_order : 0 <= kv_max; kp_low : forall i, (i < n)%nat -> kp_min <= kp i; kv_range : forall i, (i < n)%nat -> 0 <= kv i <= kv_max }.

Variable rb : robot n.
Variable f : member.
Variable g : gains.

Definition hv (e : vec) : vec := fun i => hf f (e i).

(** *** eps h is differentiable, also where e = 0 and the norm is not *)
Lemma product_flat (u v : R -> R) t dv : continuous u t -> u t = 0 -> is_derive v t dv -> v t = 0 ->
  is_derive (fun s => u s * v s) t 0.
Proof.
  intros Hu Hu0 Hv Hv0. apply is_derive_Reals. apply is_derive_Reals in Hv.
  intros eta Heta. destruct (Hv 1 ltac:(lra)) as [d1 H1].
  assert (Hc : 0 < eta / (Rabs dv + 1)) by (apply Rdiv_lt_0_compat; auto; pose proof (Rabs_pos dv); lra).
  assert (Hloc : locally t (fun s => Rabs (u s) < eta / (Rabs dv + 1))).
  { specialize (Hu (fun z => Rabs z < eta / (Rabs dv + 1))). apply Hu.
    exists (mkposreal _ Hc). intros z Hz. rewrite Hu0 in Hz. unfold ball in Hz; simpl in Hz.
    unfold AbsRing_ball, abs, minus, plus, opp in Hz; simpl in Hz. now rewrite Ropp_0, Rplus_0_r in Hz. }
  destruct Hloc as [d2 H2].
  assert (Hd : 0 < Rmin d1 d2) by (apply Rmin_pos; [apply d1|apply d2]).
  exists (mkposreal _ Hd). intros s Hs0 Hs. simpl in Hs.
  assert (Hs1 : Rabs s < d1) by (eapply Rlt_le_trans; [exact Hs|apply Rmin_l]).
  assert (Hs2 : Rabs s < d2) by (eapply Rlt_le_trans; [exact Hs|apply Rmin_r]).
  specialize (H1 s Hs0 Hs1). rewrite Hv0, Rminus_0_r in H1.
  assert (H3 : Rabs (u (t + s)) < eta / (Rabs dv + 1)).
  { apply H2. unfold ball; simpl. unfold AbsRing_ball, abs, minus, plus, opp; simpl.
    now replace (t + s + - t) with s by ring. }
  rewrite Hu0, Rmult_0_l, !Rminus_0_r. replace (u (t + s) * v (t + s) / s) with (u (t + s) * (v (t + s) / s)) by (field; auto).
  rewrite Rabs_mult. assert (H4 : Rabs (v (t + s) / s) < Rabs dv + 1).
  { pose proof (Rabs_triang (v (t + s) / s - dv) dv). replace (v (t + s) / s - dv + dv) with (v (t + s) / s) in H by ring. lra. }
  pose proof (Rabs_pos (u (t + s))). pose proof (Rabs_pos (v (t + s) / s)). pose proof (Rabs_pos dv).
  apply Rle_lt_trans with (Rabs (u (t + s)) * (Rabs dv + 1)); [apply Rmult_le_compat_l; lra|].
  apply Rmult_lt_compat_r with (r := Rabs dv + 1) in H3; [|lra].
  replace (eta / (Rabs dv + 1) * (Rabs dv + 1)) with eta in H3 by (field; lra). exact H3.
Qed.
Lemma norm_zero x : norm n x = 0 -> forall i, (i < n)%nat -> x i = 0.
Proof.
  intros H i Hi. pose proof (norm2 x) as K. rewrite H, Rmult_0_l in K.
  pose proof (term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi). unfold dot in K. simpl in *. nra.
Qed.
Section Along.
Variables (goal dq e w : R -> vec).                    (* the goal, dq/dt, the error, its velocity *)
Definition q_along (t : R) : vec := fun j => goal t j - e t j.
Variable on : R -> Prop.                            (* the times at which the loop is closed *)
Hypothesis S : forall t, on t -> closed_at n (M rb) (C rb) (b rb) (hf f) (kp g) (kv g) (q_along t) (dq t) e w t.
Hypothesis goal_rate : forall t i, on t -> (i < n)%nat -> is_derive (fun s => goal s i) t (dq t i - w t i).
Definition dw (t : R) : vec := fun i => Derive (fun s => w s i) t.
Lemma e_rate t i : on t -> (i < n)%nat -> is_derive (fun s => e s i) t (- w t i).
Proof. intros Ht Hi. now destruct (S t Ht i Hi). Qed.
Lemma w_rate t i : on t -> (i < n)%nat -> is_derive (fun s => w s i) t (dw t i).
Proof. intros Ht Hi. destruct (S t Ht i Hi) as (_ & D & _). now apply Derive_correct. Qed.
Lemma newton t i : on t -> (i < n)%nat -> apply_ n (M rb (q_along t)) (dw t) i =
    kp g i * hf f (e t i) - kv g i * hf f (w t i) - b rb i * w t i - apply_ n (C rb (q_along t) (dq t)) (w t) i.
Proof. intros Ht Hi. now destruct (S t Ht i Hi) as (_ & _ & D). Qed.
Variable eps0 : R.
Hypothesis eps0_pos : 0 < eps0.

Lemma norm2_rate t : on t -> is_derive (fun s => dot n (e s) (e s)) t (2 * - dot n (e t) (w t)).
Proof.
  intros Ht. evar_last.
  - apply (is_derive_sum n (fun i s => e s i * e s i) (fun i => - w t i * e t i + e t i * - w t i)).
    intros i Hi. apply (is_derive_mult (fun s => e s i) (fun s => e s i)); try apply (e_rate); auto.
    intros; apply Rmult_comm.
  - unfold dot. rewrite <- Ropp_mult_distr_r, <- Ropp_mult_distr_l_reverse. rewrite <- sum_scal. apply sum_ext; intros; ring.
Qed.
Lemma norm_continuous t : on t -> continuous (fun s => norm n (e s)) t.
Proof.
  intros Ht.
  apply (continuous_comp (fun s => dot n (e s) (e s)) sqrt); [|apply continuous_sqrt].
  apply (ex_derive_continuous (V := R_NormedModule)). eexists; apply norm2_rate; auto.
Qed.
Definition eps_rate (t : R) : R :=
  if Req_EM_T (norm n (e t)) 0 then 0 else eps0 * (dot n (e t) (w t) / norm n (e t)) / (1 + norm n (e t)) ^ 2.
Definition gr (t : R) : vec := fun i =>
  eps n eps0 (e t) * (dhf f (e t i) * - w t i) + eps_rate t * hf f (e t i).
Lemma hi_rate t i : on t -> (i < n)%nat -> is_derive (fun s => hf f (e s i)) t (dhf f (e t i) * - w t i).
Proof.
  intros Ht Hi. evar_last; [apply (is_derive_comp (hf f) (fun s => e s i)); [apply h_rate|apply (e_rate); auto]|].
  unfold scal; simpl; unfold mult; simpl; ring.
Qed.
Lemma g_rate t i : on t -> (i < n)%nat -> is_derive (fun s => eps n eps0 (e s) * hf f (e s i)) t (gr t i).
Proof.
  intros Ht Hi. unfold gr, eps_rate. pose proof (norm_pos (e t)) as Hp. destruct (Req_EM_T (norm n (e t)) 0) as [Z|Z].
  - assert (Ei : e t i = 0) by (apply norm_zero; auto).
    evar_last.
    + apply (is_derive_ext (fun s => eps0 * hf f (e s i) - (eps0 * norm n (e s) / (1 + norm n (e s))) * hf f (e s i))).
      { intros s. unfold eps. pose proof (norm_pos (e s)). simpl. field. lra. }
      apply (is_derive_minus (fun s => eps0 * hf f (e s i))
              (fun s => (eps0 * norm n (e s) / (1 + norm n (e s))) * hf f (e s i)) t (eps0 * (dhf f (e t i) * - w t i)) 0).
      * apply (is_derive_scal (fun s => hf f (e s i))). apply hi_rate; auto.
      * apply product_flat with (dhf f (e t i) * - w t i); [|rewrite Z; unfold Rdiv; ring|apply hi_rate; auto|rewrite Ei; apply h_zero].
        apply (continuous_comp (fun s => norm n (e s)) (fun r => eps0 * r / (1 + r))); [apply norm_continuous; auto|].
        apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. rewrite Z. lra.
    + unfold minus, plus, opp; simpl. unfold eps. rewrite Z. field.
  - assert (Hn : 0 < norm n (e t)) by lra.
    assert (Hnr : is_derive (fun s => norm n (e s)) t (- dot n (e t) (w t) / norm n (e t))).
    { unfold norm at 1. evar_last; [apply (is_derive_sqrt (fun s => dot n (e s) (e s))); [apply norm2_rate; auto|]|].
      - rewrite <- norm2. nra.
      - change (sqrt (dot n (e t) (e t))) with (norm n (e t)). field. lra. }
    assert (He : is_derive (fun s => eps n eps0 (e s)) t (eps0 * (dot n (e t) (w t) / norm n (e t)) / (1 + norm n (e t)) ^ 2)).
    { unfold eps. evar_last.
      - apply (is_derive_comp (fun r => eps0 / (1 + r)) (fun s => norm n (e s)) t (- eps0 / (1 + norm n (e t)) ^ 2)); [|exact Hnr].
        auto_derive; [lra|]. field. lra.
      - unfold scal; simpl; unfold mult; simpl. field. lra. }
    evar_last.
    + apply (is_derive_mult (fun s => eps n eps0 (e s)) (fun s => hf f (e s i))); [exact He|apply hi_rate; auto|intros; apply Rmult_comm].
    + unfold plus, mult; simpl. ring.
Qed.
Lemma eps_range t : 0 < eps n eps0 (e t) <= eps0.
Proof.
  unfold eps. pose proof (norm_pos (e t)). split; [apply Rdiv_lt_0_compat; lra|].
  apply Rle_div_l; [lra|]. nra.
Qed.
Definition reach : R := sqrt (INR n) * gammaf f.
Definition G : R := reach * Lf f / (reach + Lf f).
Lemma hv_bound x : norm n (hv x) <= reach.
Proof. apply bounded_norm; [apply gamma_pos|intros; apply h_up]. Qed.
Lemma reach_pos : 0 <= reach.
Proof. apply Rmult_le_pos; [apply sqrt_pos|apply gamma_pos]. Qed.
Lemma G_pos : 0 <= G.
Proof. pose proof reach_pos. pose proof (L_pos f). unfold G. apply Rmult_le_pos; [nra|left; apply Rinv_0_lt_compat; lra]. Qed.
Lemma hv_lip x : norm n (hv x) <= Lf f * norm n x.
Proof.
  rewrite <- norm_scal by (left; apply L_pos). rewrite <- (norm_abs (fun i => Lf f * x i)). apply norm_le. intros i.
  rewrite Rabs_Rabsolu, Rabs_mult, (Rabs_pos_eq (Lf f)) by (left; apply L_pos). apply h_lip.
Qed.
(** |h(e)| / (1 + |e|) <= G: both |h| <= reach and |h| <= L |e|. *)
Lemma hv_share x : norm n (hv x) / (1 + norm n x) <= G.
Proof.
  pose proof (hv_bound x). pose proof (hv_lip x). pose proof reach_pos. pose proof (L_pos f). pose proof (norm_pos x). pose proof (norm_pos (hv x)).
  unfold G. apply Rle_div_l; [lra|]. replace (reach * Lf f / (reach + Lf f) * (1 + norm n x)) with (reach * Lf f * (1 + norm n x) / (reach + Lf f)) by (field; lra).
  apply Rle_div_r; [lra|]. set (a := norm n (hv x)) in *. set (r := norm n x) in *.
  assert (a * Lf f <= reach * Lf f) by (apply Rmult_le_compat_r; lra).
  assert (a * reach <= Lf f * r * reach) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma eps_rate_bound t : Rabs (eps_rate t) <= eps n eps0 (e t) * norm n (w t) / (1 + norm n (e t)).
Proof.
  pose proof (eps_range t). pose proof (norm_pos (w t)) as W. pose proof (norm_pos (e t)) as E.
  assert (Z0 : 0 <= eps n eps0 (e t) * norm n (w t) / (1 + norm n (e t))).
  { apply Rmult_le_pos; [apply Rmult_le_pos; lra|left; apply Rinv_0_lt_compat; lra]. }
  unfold eps_rate. destruct (Req_EM_T _ _) as [Z|Z]; [now rewrite Rabs_R0|].
  pose proof (cauchy_schwarz (e t) (w t)) as U1. pose proof (dot_ge (e t) (w t)) as U2.
  assert (K : Rabs (dot n (e t) (w t) / norm n (e t)) <= norm n (w t)).
  { apply Rabs_le. split; [apply Rle_div_r|apply Rle_div_l]; nra. }
  replace (eps0 * (dot n (e t) (w t) / norm n (e t)) / (1 + norm n (e t)) ^ 2)
    with (eps n eps0 (e t) / (1 + norm n (e t)) * (dot n (e t) (w t) / norm n (e t))) by (unfold eps; field; lra).
  replace (eps n eps0 (e t) * norm n (w t) / (1 + norm n (e t))) with (eps n eps0 (e t) / (1 + norm n (e t)) * norm n (w t)) by (field; lra).
  assert (0 <= eps n eps0 (e t) / (1 + norm n (e t))) by (apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
  rewrite Rabs_mult, (Rabs_pos_eq (eps n eps0 (e t) / _)) by auto. apply Rmult_le_compat_l; auto.
Qed.
Lemma gr_bound t : norm n (gr t) <= eps n eps0 (e t) * (rhof f + G) * norm n (w t).
Proof.
  pose proof (eps_range t) as E. pose proof (eps_rate_bound t) as R. pose proof (norm_pos (w t)) as W.
  pose proof (norm_pos (hv (e t))) as H. pose proof (norm_pos (e t)) as N. pose proof (hv_share (e t)) as Sh. pose proof G_pos as Gp.
  set (d := eps n eps0 (e t) * norm n (w t) / (1 + norm n (e t))) in *.
  assert (D : 0 <= d) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|left; apply Rinv_0_lt_compat; lra]).
  apply Rle_trans with (norm n (fun i => eps n eps0 (e t) * (rhof f * w t i)) + norm n (fun i => d * hv (e t) i)).
  - eapply Rle_trans; [apply (norm_plus (fun i => eps n eps0 (e t) * (dhf f (e t i) * - w t i)) (fun i => eps_rate t * hf f (e t i)))|].
    apply Rplus_le_compat; apply norm_le; intros i.
    + rewrite !Rabs_mult, Rabs_Ropp. apply Rmult_le_compat_l; [apply Rabs_pos|].
      apply Rmult_le_compat_r; [apply Rabs_pos|]. rewrite (Rabs_pos_eq (rhof f)) by apply rho_pos. apply dh_up.
    + rewrite !Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|]. now rewrite (Rabs_pos_eq d).
  - rewrite norm_scal, norm_scal, norm_scal by (try apply rho_pos; auto; lra).
    replace (d * norm n (hv (e t))) with (eps n eps0 (e t) * norm n (w t) * (norm n (hv (e t)) / (1 + norm n (e t)))) by (unfold d; field; lra).
    assert (eps n eps0 (e t) * norm n (w t) * (norm n (hv (e t)) / (1 + norm n (e t))) <= eps n eps0 (e t) * norm n (w t) * G) by (apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|auto]).
    lra.
Qed.

(** *** dV/dt, exactly *)
Definition yt (t : R) : vec := y_of n (hf f) eps0 (e t) (w t).
Definition rate_along (t : R) : R :=
  sum n (fun i => - (eps n eps0 (e t) * kp g i * (hf f (e t i) * hf f (e t i))) - yt t i * (kv g i * hf f (w t i) + b rb i * w t i))
  - eps n eps0 (e t) * dot n (yt t) (apply_ n (C rb (q_along t) (dq t)) (hv (e t)))
  - dot n (yt t) (apply_ n (M rb (q_along t)) (gr t)).
Lemma q_rate t i : on t -> (i < n)%nat -> is_derive (fun s => q_along s i) t (dq t i).
Proof.
  intros Ht Hi. unfold q_along. evar_last.
  - apply (is_derive_minus (fun s => goal s i) (fun s => e s i)); [now apply goal_rate|apply (e_rate); auto].
  - unfold minus, plus, opp; simpl. ring.
Qed.
Theorem V_rate_along t : on t -> is_derive (fun s => V n (M rb) (hf f) (Uf f) (kp g) (goal s) eps0 (e s) (w s)) t (rate_along t).
Proof.
  intros Ht.
  set (y := yt t). set (dy := fun i => dw t i - gr t i).
  set (Mt := M rb (q_along t)). set (Ct := C rb (q_along t) (dq t)).
  assert (Hy : forall i, (i < n)%nat -> is_derive (fun s => yt s i) t (dy i)).
  { intros i Hi. apply (is_derive_minus (fun s => w s i) (fun s => eps n eps0 (e s) * hf f (e s i))); [apply (w_rate); auto|apply g_rate; auto]. }
  assert (HV : is_derive (fun s => V n (M rb) (hf f) (Uf f) (kp g) (goal s) eps0 (e s) (w s)) t
     (/ 2 * sum n (fun i => dy i * apply_ n Mt y i + y i * sum n (fun j => (Ct i j + Ct j i) * y j + Mt i j * dy j))
      + sum n (fun i => kp g i * (hf f (e t i) * - w t i)))).
  { unfold V. apply (is_derive_plus (fun s => / 2 * dot n (yt s) (apply_ n (M rb (q_along s)) (yt s))) (fun s => sum n (fun i => kp g i * Uf f (e s i)))).
    - apply (is_derive_scal (fun s => dot n (yt s) (apply_ n (M rb (q_along s)) (yt s)))).
      apply (is_derive_sum n (fun i s => yt s i * apply_ n (M rb (q_along s)) (yt s) i)). intros i Hi.
      apply (is_derive_mult (fun s => yt s i) (fun s => apply_ n (M rb (q_along s)) (yt s) i)); [now apply Hy| |intros; apply Rmult_comm].
      apply (is_derive_sum n (fun j s => M rb (q_along s) i j * yt s j)). intros j Hj.
      apply (is_derive_mult (fun s => M rb (q_along s) i j) (fun s => yt s j)); [|now apply Hy|intros; apply Rmult_comm].
      apply (M_rate rb q_along t (dq t)); auto. intros; now apply q_rate.
    - apply (is_derive_sum n (fun i s => kp g i * Uf f (e s i))). intros i Hi.
      apply (is_derive_scal (fun s => Uf f (e s i))). evar_last.
      + apply (is_derive_comp (Uf f) (fun s => e s i)); [apply U_rate|apply (e_rate); auto].
      + unfold scal; simpl; unfold mult; simpl; ring. }
  evar_last; [exact HV|].
  (* the two halves: symmetry of M, and C + C^T *)
  assert (E1 : sum n (fun i => dy i * apply_ n Mt y i + y i * sum n (fun j => (Ct i j + Ct j i) * y j + Mt i j * dy j))
     = 2 * (dot n y (apply_ n Mt dy) + dot n y (apply_ n Ct y))).
  { assert (A1 : sum n (fun i => dy i * apply_ n Mt y i) = dot n y (apply_ n Mt dy)).
    { unfold dot, apply_, dot. transitivity (sum n (fun i => sum n (fun j => dy i * (Mt i j * y j)))).
      { apply sum_ext; intros. now rewrite <- sum_scal. }
      rewrite sum_swap. apply sum_ext; intros j Hj. rewrite <- sum_scal. apply sum_ext; intros i Hi.
      unfold Mt. rewrite (M_sym rb _ i j) by auto. ring. }
    assert (A2 : sum n (fun i => y i * sum n (fun j => Ct j i * y j)) = dot n y (apply_ n Ct y)).
    { unfold dot, apply_, dot. transitivity (sum n (fun i => sum n (fun j => y i * (Ct j i * y j)))).
      { apply sum_ext; intros. now rewrite <- sum_scal. }
      rewrite sum_swap. apply sum_ext; intros j Hj. rewrite <- sum_scal. apply sum_ext; intros i Hi. ring. }
    rewrite sum_plus, A1.
    transitivity (dot n y (apply_ n Mt dy) + (dot n y (apply_ n Ct y) + sum n (fun i => y i * sum n (fun j => Ct j i * y j)) + dot n y (apply_ n Mt dy))).
    - f_equal. unfold dot at 1 2. rewrite <- !sum_plus. apply sum_ext; intros i Hi. unfold apply_, dot.
      rewrite <- !Rmult_plus_distr_l, <- !sum_plus. f_equal. apply sum_ext; intros; ring.
    - rewrite A2. ring. }
  rewrite E1. clear HV E1 Hy.
  (* Newton *)
  assert (E2 : dot n y (apply_ n Mt dy) = sum n (fun i => y i * (kp g i * hf f (e t i) - kv g i * hf f (w t i) - b rb i * w t i))
       - dot n y (apply_ n Ct (w t)) - dot n y (apply_ n Mt (gr t))).
  { unfold dot at 1. unfold dot at 1 2. rewrite <- !sum_minus. apply sum_ext; intros i Hi.
    unfold dy. rewrite apply_minus. unfold Mt. rewrite (newton t i) by auto. unfold Ct. ring. }
  assert (E3 : dot n y (apply_ n Ct y) = dot n y (apply_ n Ct (w t)) - eps n eps0 (e t) * dot n y (apply_ n Ct (hv (e t)))).
  { rewrite <- dot_scal_r. unfold dot at 1 2 3. rewrite <- sum_minus. apply sum_ext; intros i Hi.
    rewrite <- (apply_scal Ct (eps n eps0 (e t)) (hv (e t)) i), <- Rmult_minus_distr_l. f_equal.
    symmetry. rewrite <- (apply_minus Ct (w t)). reflexivity. }
  rewrite E2, E3. unfold rate_along. fold y Mt Ct.
  match goal with |- ?l = ?r => replace l with
    (sum n (fun i => y i * (kp g i * hf f (e t i) - kv g i * hf f (w t i) - b rb i * w t i)) + sum n (fun i => kp g i * (hf f (e t i) * - w t i))
     - eps n eps0 (e t) * dot n y (apply_ n Ct (hv (e t))) - dot n y (apply_ n Mt (gr t))) by field end.
  f_equal. f_equal. rewrite <- sum_plus. apply sum_ext; intros i Hi.
  replace (yt t i) with (y i) by reflexivity. unfold y, yt, y_of. ring.
Qed.

(** *** dV/dt < 0 away from the origin, for every small eps0 *)
Definition drift : R := kc rb * reach + beta rb * (rhof f + G).
Definition cross : R := kv_max g * Lf f + b_max rb.

Lemma kv_max_pos : 0 <= kv_max g. Proof. apply kv_order. Qed.
Lemma b_max_pos : 0 <= b_max rb. Proof. pose proof (b_order rb). pose proof (b_min_pos rb). lra. Qed.
Lemma drift_pos : 0 <= drift.
Proof.
  pose proof reach_pos. pose proof G_pos. pose proof (kc_pos rb). pose proof (beta_pos rb). pose proof (rho_pos f).
  unfold drift. apply Rplus_le_le_0_compat; apply Rmult_le_pos; lra.
Qed.
Lemma term_bound ep hi hwi wi k v bb : 0 < ep -> 0 <= wi * hwi -> Rabs hwi <= Lf f * Rabs wi ->
  kp_min g <= k -> 0 <= v <= kv_max g -> b_min rb <= bb <= b_max rb ->
  - (ep * k * (hi * hi)) - (wi - ep * hi) * (v * hwi + bb * wi)
  <= - (ep * kp_min g) * (hi * hi) + - b_min rb * (wi * wi) + ep * cross * (Rabs hi * Rabs wi).
Proof.
  intros He Hs Hl Hk Hv Hb. unfold cross.
  assert (T1 : hi * hwi <= Rabs hi * (Lf f * Rabs wi)).
  { eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos|exact Hl]. }
  assert (T2 : hi * wi <= Rabs hi * Rabs wi) by (eapply Rle_trans; [apply Rle_abs|rewrite Rabs_mult; lra]).
  set (u := Rabs hi * Rabs wi) in *. assert (Hu : 0 <= u) by (apply Rmult_le_pos; apply Rabs_pos).
  pose proof (L_pos f) as HL. pose proof b_max_pos. pose proof kv_max_pos. pose proof (b_min_pos rb).
  assert (T1' : v * (hi * hwi) <= kv_max g * (Lf f * u)).
  { apply Rle_trans with (v * (Lf f * u)); [apply Rmult_le_compat_l; [lra|unfold u; lra]|].
    apply Rmult_le_compat_r; [apply Rmult_le_pos; lra|lra]. }
  assert (T2' : bb * (hi * wi) <= b_max rb * u).
  { apply Rle_trans with (bb * u); [apply Rmult_le_compat_l; lra|apply Rmult_le_compat_r; lra]. }
  assert (T3 : ep * (v * (hi * hwi) + bb * (hi * wi)) <= ep * (kv_max g * (Lf f * u) + b_max rb * u)) by (apply Rmult_le_compat_l; lra).
  assert (T4 : 0 <= v * (wi * hwi)) by (apply Rmult_le_pos; lra).
  assert (T5 : b_min rb * (wi * wi) <= bb * (wi * wi)) by (apply Rmult_le_compat_r; nra).
  assert (T6 : ep * kp_min g * (hi * hi) <= ep * k * (hi * hi)) by (apply Rmult_le_compat_r; nra).
  lra.
Qed.
(** A goal that moves, |r'| <= vd, adds to both terms with h(e). *)
Theorem rate_bound_along vd t : norm n (dq t) <= vd + norm n (w t) -> 0 <= vd ->
  let a := norm n (hv (e t)) in let v := norm n (w t) in let ep := eps n eps0 (e t) in
  rate_along t <= - (ep * (kp_min g - ep * (kc rb * vd)) * a ^ 2) - b_min rb * v ^ 2 + ep * (cross + kc rb * vd) * (a * v)
    + ep * drift * v ^ 2 + ep ^ 2 * drift * (a * v).
Proof.
  intros Hq Hvd a v ep. fold v in Hq. pose proof (eps_range t) as [E0 E1]. fold ep in E0, E1.
  pose proof (norm_pos (hv (e t))) as A0. pose proof (norm_pos (w t)) as V0. fold a in A0. fold v in V0.
  pose proof (hv_bound (e t)) as A1. fold a in A1. pose proof b_max_pos. pose proof kv_max_pos.
  pose proof (kc_pos rb). pose proof (beta_pos rb). pose proof (rho_pos f). pose proof (L_pos f). pose proof reach_pos. pose proof drift_pos.
  (* the sum *)
  assert (P1 : sum n (fun i => - (ep * kp g i * (hf f (e t i) * hf f (e t i))) - yt t i * (kv g i * hf f (w t i) + b rb i * w t i))
     <= - (ep * kp_min g * a ^ 2) - b_min rb * v ^ 2 + ep * cross * (a * v)).
  { eapply Rle_trans.
    - apply sum_le. intros i Hi. unfold yt, y_of. apply term_bound; auto.
      + destruct (Req_dec (w t i) 0) as [->|Z]; [rewrite h_zero; lra|left; now apply h_sign].
      + apply h_lip.
      + now apply kp_low.
      + now apply kv_range.
      + now apply b_range.
    - rewrite !sum_plus, !sum_scal.
      change (sum n (fun i => hf f (e t i) * hf f (e t i))) with (dot n (hv (e t)) (hv (e t))).
      change (sum n (fun i => w t i * w t i)) with (dot n (w t) (w t)).
      change (sum n (fun i => Rabs (hf f (e t i)) * Rabs (w t i))) with (dot n (fun i => Rabs (hv (e t) i)) (fun i => Rabs (w t i))).
      rewrite <- !norm2. fold a v ep.
      assert (K : dot n (fun i => Rabs (hv (e t) i)) (fun i => Rabs (w t i)) <= a * v).
      { eapply Rle_trans; [apply cauchy_schwarz|]. rewrite !norm_abs. unfold a, v. lra. }
      assert (0 <= ep * cross) by (apply Rmult_le_pos; [lra|unfold cross; apply Rplus_le_le_0_compat; [apply Rmult_le_pos; lra|lra]]).
      apply Rmult_le_compat_l with (r := ep * cross) in K; auto. lra. }
  (* the norm n of y *)
  assert (Y : norm n (yt t) <= v + ep * a).
  { unfold yt, y_of. eapply Rle_trans; [apply (norm_minus (w t) (fun i => ep * hv (e t) i))|]. rewrite norm_scal by lra. unfold v, a. lra. }
  pose proof (norm_pos (yt t)) as Y0.
  assert (P2 : - (ep * dot n (yt t) (apply_ n (C rb (q_along t) (dq t)) (hv (e t)))) <= ep * ((v + ep * a) * (kc rb * (vd + v) * a))).
  { pose proof (dot_ge (yt t) (apply_ n (C rb (q_along t) (dq t)) (hv (e t)))) as D.
    pose proof (C_up rb (q_along t) (dq t) (hv (e t))) as K. fold a in K.
    assert (kc rb * norm n (dq t) * a <= kc rb * (vd + v) * a) by (apply Rmult_le_compat_r; [lra|apply Rmult_le_compat_l; lra]).
    pose proof (norm_pos (apply_ n (C rb (q_along t) (dq t)) (hv (e t)))).
    assert (norm n (yt t) * norm n (apply_ n (C rb (q_along t) (dq t)) (hv (e t))) <= (v + ep * a) * (kc rb * (vd + v) * a)) by (apply Rmult_le_compat; auto; lra).
    rewrite Ropp_mult_distr_r. apply Rmult_le_compat_l; lra. }
  assert (P3 : - dot n (yt t) (apply_ n (M rb (q_along t)) (gr t)) <= (v + ep * a) * (beta rb * (ep * (rhof f + G) * v))).
  { pose proof (dot_ge (yt t) (apply_ n (M rb (q_along t)) (gr t))) as D.
    pose proof (M_up rb (q_along t) (gr t)) as K. pose proof (gr_bound t) as Gb. fold ep a v in Gb.
    pose proof (norm_pos (apply_ n (M rb (q_along t)) (gr t))).
    assert (beta rb * norm n (gr t) <= beta rb * (ep * (rhof f + G) * v)) by (apply Rmult_le_compat_l; auto).
    assert (norm n (yt t) * norm n (apply_ n (M rb (q_along t)) (gr t)) <= (v + ep * a) * (beta rb * (ep * (rhof f + G) * v))) by (apply Rmult_le_compat; lra).
    lra. }
  assert (Z : 0 <= ep * ((v + ep * a) * v)) by (apply Rmult_le_pos; [lra|apply Rmult_le_pos; [apply Rplus_le_le_0_compat; [lra|apply Rmult_le_pos; lra]|lra]]).
  assert (Q : kc rb * a + beta rb * (rhof f + G) <= drift).
  { unfold drift. apply Rplus_le_compat_r, Rmult_le_compat_l; lra. }
  apply Rmult_le_compat_l with (r := ep * ((v + ep * a) * v)) in Q; auto.
  unfold rate_along. fold ep. nra.
Qed.

(** *** dV/dt is as negative as a form allows, for every eps up to some bar *)
Lemma cross_pos : 0 <= cross.
Proof.
  pose proof kv_max_pos. pose proof b_max_pos. pose proof (L_pos f). unfold cross. apply Rplus_le_le_0_compat; [apply Rmult_le_pos; lra|lra].
Qed.
Lemma form_decreases kp0 d bar c1 c2 ep a v : 0 <= d -> 0 < ep <= bar -> 0 <= a -> 0 <= v ->
  c1 < kp0 -> bar * (d + bar * drift) ^ 2 <= 4 * (kp0 - c1) * (b_min rb - c2 - bar * drift) ->
  - (ep * kp0 * a ^ 2) - b_min rb * v ^ 2 + ep * d * (a * v) + ep * drift * v ^ 2 + ep ^ 2 * drift * (a * v)
  <= - (c1 * ep * a ^ 2) - c2 * v ^ 2.
Proof.
  intros C0 [E0 E1] A0 V0 K H. pose proof drift_pos as D0.
  set (k := kp0 - c1) in *. set (c := drift) in *. set (bm := b_min rb) in *.
  assert (Hk : 0 < k) by (unfold k; lra).
  assert (M1 : d + ep * c <= d + bar * c) by (apply Rplus_le_compat_l, Rmult_le_compat_r; lra).
  assert (M2 : 0 <= d + ep * c) by (apply Rplus_le_le_0_compat; [|apply Rmult_le_pos]; lra).
  assert (M3 : ep * (d + ep * c) ^ 2 <= bar * (d + bar * c) ^ 2).
  { apply Rmult_le_compat; [lra|apply pow2_ge_0|lra|apply pow_incr; lra]. }
  assert (M4 : k * (bm - c2 - bar * c) <= k * (bm - c2 - ep * c)).
  { apply Rmult_le_compat_l; [lra|]. assert (ep * c <= bar * c) by (apply Rmult_le_compat_r; lra). lra. }
  assert (B2 : (d + ep * c) * (a * v) <= k * a ^ 2 + (d + ep * c) ^ 2 / (4 * k) * v ^ 2).
  { assert (0 <= (2 * k * a - (d + ep * c) * v) ^ 2 / (4 * k)) by (apply Rmult_le_pos; [apply pow2_ge_0|left; apply Rinv_0_lt_compat; lra]).
    replace ((2 * k * a - (d + ep * c) * v) ^ 2 / (4 * k)) with (k * a ^ 2 - (d + ep * c) * (a * v) + (d + ep * c) ^ 2 / (4 * k) * v ^ 2) in H0 by (field; lra). lra. }
  apply Rmult_le_compat_l with (r := ep) in B2; [|lra].
  assert (B3 : ep * ((d + ep * c) ^ 2 / (4 * k)) <= bm - c2 - ep * c).
  { replace (ep * ((d + ep * c) ^ 2 / (4 * k))) with (ep * (d + ep * c) ^ 2 / (4 * k)) by (field; lra). apply Rle_div_l; lra. }
  apply Rmult_le_compat_r with (r := v ^ 2) in B3; [|apply pow2_ge_0].
  replace (- (ep * kp0 * a ^ 2)) with (- (c1 * ep * a ^ 2) - ep * (k * a ^ 2)) by (unfold k; ring). lra.
Qed.
End Along.

(** *** The goal at rest: (11) *)
Definition q_of (qd : vec) (e : R -> vec) (t : R) : vec := fun j => qd j - e t j.
Definition rate (qd : vec) (e w : R -> vec) : R -> R -> R := rate_along (fun _ => qd) w e w.
Lemma at_rest (qd : vec) (w : R -> vec) t i : is_derive (fun _ : R => qd i) t (w t i - w t i).
Proof. evar_last; [apply (is_derive_const (V := R_NormedModule))|]. unfold zero; simpl. ring. Qed.
Theorem V_rate qd e w (on : R -> Prop) : (forall t, on t -> solves_at n (M rb) (C rb) (b rb) (hf f) (kp g) (kv g) qd e w t) ->
  forall eps0 t, on t -> is_derive (fun s => V n (M rb) (hf f) (Uf f) (kp g) qd eps0 (e s) (w s)) t (rate qd e w eps0 t).
Proof. intros S eps0 t Ht. apply (V_rate_along (fun _ => qd) w e w on S); auto using at_rest. Qed.
Theorem rate_bound qd e w eps0 : 0 < eps0 -> forall t, let a := norm n (hv (e t)) in let v := norm n (w t) in let ep := eps n eps0 (e t) in
  rate qd e w eps0 t <= - (ep * kp_min g * a ^ 2) - b_min rb * v ^ 2 + ep * cross * (a * v) + ep * drift * v ^ 2 + ep ^ 2 * drift * (a * v).
Proof.
  intros P t a v ep. pose proof (rate_bound_along (fun _ => qd) w e w eps0 P 0 t ltac:(lra) ltac:(lra)) as K. cbv zeta in K.
  fold a v ep in K. unfold rate. rewrite !Rmult_0_r, Rminus_0_r, Rplus_0_r in K. exact K.
Qed.

(** There is a small enough eps0, for all positive gains and all velocities of the goal: no bound of K_v is needed. *)
Theorem small_exists vd : 0 <= vd -> exists eps0 c1 c2, 0 < eps0 /\ 0 < c1 /\ 0 < c2 /\ c1 < kp_min g - eps0 * (kc rb * vd) /\
  eps0 * (cross + kc rb * vd + eps0 * drift) ^ 2 <= 4 * (kp_min g - eps0 * (kc rb * vd) - c1) * (b_min rb - c2 - eps0 * drift).
Proof.
  intros Hvd. pose proof drift_pos as D. pose proof (kp_min_pos g) as K. pose proof (b_min_pos rb) as B. pose proof cross_pos as C0. pose proof (kc_pos rb) as Pc.
  set (u := kc rb * vd). assert (U0 : 0 <= u) by (apply Rmult_le_pos; auto).
  set (q := (cross + u + drift) ^ 2). assert (Q0 : 0 <= q) by apply pow2_ge_0.
  set (k := kp_min g) in *. set (bm := b_min rb) in *.
  set (x := k * bm / (2 * q + 2 * k * drift + 4 * bm * u + 1)).
  assert (P : 0 < 2 * q + 2 * k * drift + 4 * bm * u + 1).
  { assert (0 <= 2 * k * drift) by (apply Rmult_le_pos; lra). assert (0 <= 4 * bm * u) by (apply Rmult_le_pos; lra). lra. }
  assert (X0 : 0 < x) by (apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat|]; lra).
  exists (Rmin 1 x), (k / 4), (bm / 2). pose proof (Rmin_l 1 x). pose proof (Rmin_r 1 x). set (e := Rmin 1 x) in *.
  assert (E0 : 0 < e) by (apply Rmin_pos; lra).
  assert (S3 : e * (2 * q + 2 * k * drift + 4 * bm * u + 1) <= k * bm).
  { apply Rle_trans with (x * (2 * q + 2 * k * drift + 4 * bm * u + 1)); [apply Rmult_le_compat_r; lra|]. right. unfold x. field. lra. }
  assert (T1 : 0 <= e * q) by (apply Rmult_le_pos; lra). assert (T2 : 0 <= e * (k * drift)) by (apply Rmult_le_pos; [|apply Rmult_le_pos]; lra).
  assert (T3 : 0 <= e * u) by (apply Rmult_le_pos; lra).
  assert (S4 : 4 * (e * u) <= k).
  { apply Rmult_le_reg_l with bm; [lra|]. nra. }
  assert (S5 : 2 * (e * drift) <= bm).
  { apply Rmult_le_reg_l with k; [lra|]. nra. }
  assert (S1 : (cross + u + e * drift) ^ 2 <= q).
  { assert (0 <= e * drift) by (apply Rmult_le_pos; lra). assert (e * drift <= 1 * drift) by (apply Rmult_le_compat_r; lra). apply pow_incr. lra. }
  assert (S2 : e * (cross + u + e * drift) ^ 2 <= e * q) by (apply Rmult_le_compat_l; lra).
  repeat split; try lra.
  eapply Rle_trans; [exact S2|]. apply Rle_trans with (4 * (k / 2) * (bm - bm / 2 - e * drift)).
  - nra.
  - apply Rmult_le_compat_r; lra.
Qed.
End Vectors.
