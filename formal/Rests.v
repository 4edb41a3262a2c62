(** The loop on a computer comes to rest, with an unknown payload as without one; with the right gravity it comes to rest at the goal. *)
From Coq Require Import Reals Lra Lia Psatz FunctionalExtensionality.
From Coquelicot Require Import Coquelicot.
Require Import Definitions SampledDefinitions.
Require Import Loop.
Require Converge.
Require Import Sampled.
Open Scope R_scope.

(** ** An integral of |w|^2 exists *)
Lemma max_continuous (a t : R) : continuous (fun s => Rmax a s) t.
Proof.
  apply (continuous_ext (fun s : R => (a + s + Rabs (s - a)) * / 2)).
  { intros s. unfold Rmax. destruct (Rle_dec a s); [rewrite Rabs_pos_eq by lra|rewrite Rabs_left by lra]; lra. }
  apply (continuous_mult (fun s : R => a + s + Rabs (s - a)) (fun _ => / 2)); [|apply continuous_const].
  apply (continuous_plus (fun s : R => a + s) (fun s => Rabs (s - a))).
  - apply (continuous_plus (fun _ : R => a) (fun s => s)); [apply continuous_const|apply continuous_id].
  - apply (continuous_comp (fun s : R => s - a) Rabs); [|apply continuous_Rabs].
    apply (continuous_minus (fun s : R => s) (fun _ => a)); [apply continuous_id|apply continuous_const].
Qed.
Lemma integral_exists (u : R -> R) a : (forall t, a <= t -> continuous u t) -> exists X, forall t, a <= t -> is_derive X t (u t).
Proof.
  intros C. set (v := fun s => u (Rmax a s)).
  assert (Cv : forall t, continuous v t).
  { intros t. apply (continuous_comp (fun s => Rmax a s) u); [apply max_continuous|apply C, Rmax_l]. }
  exists (fun t => RInt v a t). intros t Ht. replace (u t) with (v t) by (unfold v; now rewrite Rmax_right).
  apply (is_derive_RInt v (fun t => RInt v a t) a t); [|apply Cv].
  exists (mkposreal 1 Rlt_0_1). intros s _. apply (RInt_correct v). apply ex_RInt_continuous. intros; apply Cv.
Qed.

(** ** From pieces to the whole *)
Section Pieces.
Variable tk : nat -> R.
Hypothesis order : forall k, tk k < tk (S k).
Lemma tk_mono k l : (k <= l)%nat -> tk k <= tk l.
Proof. induction 1; [lra|]. pose proof (order m). lra. Qed.
Hypothesis covers : forall t, exists k, t <= tk k.
Lemma which t : tk 0%nat <= t -> exists k, tk k <= t <= tk (S k).
Proof.
  intros H. destruct (covers t) as [k Hk]. induction k; [exists 0%nat; pose proof (order 0); lra|].
  destruct (Rle_dec t (tk k)); [auto|exists k; lra].
Qed.
Lemma which_after N t : tk N <= t -> exists k, (N <= k)%nat /\ tk k <= t <= tk (S k).
Proof.
  intros H. destruct (covers t) as [k Hk]. induction k.
  - exists N. split; [lia|]. pose proof (tk_mono 0 N ltac:(lia)). pose proof (order N). lra.
  - destruct (Rle_dec t (tk k)); [auto|]. destruct (Compare_dec.le_lt_dec N k); [exists k; split; [auto|lra]|].
    pose proof (tk_mono (S k) N ltac:(lia)). exists N. split; [lia|]. pose proof (order N). lra.
Qed.
Lemma glue (f : R -> R) A B : tk 0%nat <= A -> (forall k a b, A <= a -> a <= b -> b <= B -> tk k <= a -> b <= tk (S k) -> f b <= f a) ->
  forall a b, A <= a -> a <= b -> b <= B -> f b <= f a.
Proof.
  intros HA H. assert (K : forall k a b, A <= a -> a <= b -> b <= B -> b <= tk k -> f b <= f a).
  { induction k; intros a b Ha Hab Hb Hk.
    - replace b with a by lra. lra.
    - destruct (Rle_dec b (tk k)); [auto|]. destruct (Rle_dec (tk k) a); [apply (H k); auto|].
      apply Rle_trans with (f (tk k)); [apply (H k); lra|apply IHk; lra]. }
  intros a b Ha Hab Hb. destruct (covers b) as [k Hk]. apply (K k); auto.
Qed.
End Pieces.

(** A function that is continuous, with a derivative at most r inside, grows at most by r. *)
Lemma grows (f df : R -> R) r a b : a <= b -> (forall t, a < t < b -> is_derive f t (df t)) ->
  (forall t, a <= t <= b -> continuous f t) -> (forall t, a < t < b -> df t <= r) -> f b - r * b <= f a - r * a.
Proof.
  intros H D C N. apply (falls_open (fun t => f t - r * t) (fun t => df t - r) a b H).
  - intros t Ht. evar_last; [apply (is_derive_minus f (fun t => r * t) t (df t) r); [now apply D|auto_derive; auto; ring]|]. reflexivity.
  - intros t Ht. apply (continuous_minus f (fun t => r * t)); [now apply C|]. apply (ex_derive_continuous (V := R_NormedModule) (fun t : R => r * t)). auto_derive; auto.
  - intros t Ht. specialize (N t Ht). lra.
Qed.
Lemma entry_2 n (w : vec) i : (i < n)%nat -> w i ^ 2 <= dot n w w.
Proof. intros Hi. pose proof (term_le_sum n (fun j => w j * w j) i ltac:(intros; nra) Hi) as K. unfold dot. simpl in *. lra. Qed.

Section Rests.
Variable n : nat.
Variable rb : robot n.
Variables Gt Gm : gravity n.
Variable Stm : steepness n Gm.
Variable f : member.
Variable g : gains n.
Variable qd : vec.
Variables (J d : nat) (fl : nat -> R) (T : R).
Hypothesis T_pos : 0 < T.
Variable c : R.
Hypothesis c_pos : 0 < c.
Hypothesis condition : forall i, (i < n)%nat -> c + Lf f * kv n g i * spread J fl + (/ 2 + INR d) * T * stiff n Gm Stm f g i <= b rb i.
(** Property 2.8, for both gravities, and a potential that is bounded from below *)
Variables (kg low : R).
Hypothesis Gt_up : forall x i, (i < n)%nat -> Rabs (grav Gt x i) <= kg.
Hypothesis Gm_up : forall x i, (i < n)%nat -> Rabs (grav Gm x i) <= kg.
Definition potential (x : vec) : R := P Gt x - P Gm x + sum n (fun i => kp n g i * Uf f (qd i - x i)).
Hypothesis low_bound : forall x, low <= potential x.

Variables (tk : nat -> R) (p : nat -> vec) (phi q w : R -> vec).
Hypothesis moves : sampled n rb Gt Gm f g qd J d fl T tk p phi q w.
Hypothesis friction : forall t i, tk 0%nat <= t -> (i < n)%nat -> 0 <= phi t i * w t i.
Hypothesis covers : forall t, exists k, t <= tk k.
Notation Wk := (W n rb Gt Gm Stm f g qd J d fl T tk p q w).
Notation K := (fun t => kinetic n rb (q t) (w t)).
Notation E := (fun t => energy n rb Gt Gm f g qd (q t) (w t)).

Lemma order k : tk k < tk (S k).
Proof. destruct moves as (O & _). now destruct (O k). Qed.
Lemma start k : tk 0%nat <= tk k.
Proof. apply (tk_mono tk order). lia. Qed.
Lemma X_exists : exists X, forall t, tk 0%nat <= t -> is_derive X t (dot n (w t) (w t)).
Proof.
  apply (integral_exists (fun t => dot n (w t) (w t))). intros t Ht. destruct moves as (_ & _ & D & _).
  apply (continuous_sum (fun i s => w s i * w s i)). intros i Hi. apply (continuous_mult (fun s => w s i)); now apply D.
Qed.
Lemma K_low t : alpha rb / 2 * dot n (w t) (w t) <= K t.
Proof. unfold kinetic. pose proof (M_low rb (q t) (w t)). lra. Qed.
Lemma K_pos t : 0 <= K t.
Proof. eapply Rle_trans; [|apply K_low]. pose proof (alpha_pos rb). apply Rmult_le_pos; [lra|apply dot_pos]. Qed.
Lemma K_up t : K t <= beta rb / 2 * dot n (w t) (w t).
Proof.
  unfold kinetic. pose proof (cauchy_schwarz n (w t) (apply_ n (M rb (q t)) (w t))) as A. pose proof (M_up rb (q t) (w t)) as B.
  pose proof (norm_pos n (w t)) as N. rewrite <- norm2. apply Rmult_le_compat_l with (r := norm n (w t)) in B; auto. lra.
Qed.
Lemma stored_pos k : 0 <= stored n Gm Stm f g J d fl T p k.
Proof.
  unfold stored. rewrite <- (Rmult_0_r (INR n)), <- sum_const. apply sum_le. intros i Hi. apply sum_nonneg. intros l.
  apply Rmult_le_pos; [|apply pow2_ge_0]. apply sum_nonneg. intros; now apply weight_pos.
Qed.

Section X.
Variable X : R -> R.
Hypothesis X_rate : forall t, tk 0%nat <= t -> is_derive X t (dot n (w t) (w t)).
Lemma X_grows a b : tk 0%nat <= a -> a <= b -> X a <= X b.
Proof.
  intros Ha Hb. assert (H : (fun t => - X t) b <= (fun t => - X t) a); [|cbv beta in H; lra].
  apply (falls_open (fun t => - X t) (fun t => - dot n (w t) (w t)) a b Hb).
  - intros t Ht. apply (is_derive_opp X). apply X_rate. lra.
  - intros t Ht. apply (ex_derive_continuous (V := R_NormedModule) (fun t => - X t)). exists (- dot n (w t) (w t)). apply (is_derive_opp X). apply X_rate. lra.
  - intros t Ht. pose proof (dot_pos n (w t)). lra.
Qed.
Lemma W_falls k : Wk (S k) + c * (X (tk (S k)) - X (tk k)) <= Wk k.
Proof. apply (energy_step n rb Gt Gm Stm f g qd J d fl T T_pos tk p phi q w moves friction X X_rate c condition). Qed.
Lemma E_between k t : tk k <= t <= tk (S k) -> E t <= Wk k.
Proof.
  intros Ht. pose proof (between n rb Gt Gm Stm f g qd J d fl T T_pos tk p phi q w moves friction X X_rate c condition k t Ht) as B.
  pose proof (X_grows (tk k) t (start k) ltac:(lra)). assert (0 <= c * (X t - X (tk k))) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma W_decreasing : Un_decreasing Wk.
Proof.
  intros k. pose proof (W_falls k). pose proof (order k). pose proof (X_grows (tk k) (tk (S k)) (start k) ltac:(lra)).
  assert (0 <= c * (X (tk (S k)) - X (tk k))) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma W_low k : low <= Wk k.
Proof. unfold W, energy. pose proof (stored_pos k). pose proof (K_pos (tk k)). pose proof (low_bound (q (tk k))) as B. unfold potential in B. cbv beta in *. lra. Qed.
Lemma W_cauchy del : 0 < del -> exists N, forall k, (N <= k)%nat -> Wk N - Wk k <= del.
Proof.
  intros D. destruct (decreasing_cv Wk W_decreasing) as [l Hl].
  { exists (- low). intros x [k ->]. unfold opp_seq. pose proof (W_low k). lra. }
  destruct (Hl del D) as [N HN]. exists N. intros k Hk. specialize (HN N (le_n N)). unfold R_dist in HN. apply Rabs_def2 in HN.
  pose proof (decreasing_ineq Wk l W_decreasing Hl k). lra.
Qed.
Lemma X_total N k : (N <= k)%nat -> Wk k + c * (X (tk k) - X (tk N)) <= Wk N.
Proof. induction 1; [lra|]. pose proof (W_falls m). lra. Qed.
Lemma X_cauchy del : 0 < del -> exists t1, tk 0%nat <= t1 /\ forall a b, t1 <= a -> a <= b -> X b - X a <= del.
Proof.
  intros D. destruct (W_cauchy (c * del) ltac:(now apply Rmult_lt_0_compat)) as [N HN]. exists (tk N). split; [apply start|].
  intros a b Ha Hb. destruct (covers b) as [k Hk]. pose proof (start N).
  set (l := Nat.max N k). assert (L1 : tk k <= tk l) by (apply (tk_mono tk order); lia).
  pose proof (X_grows (tk N) a ltac:(lra) Ha). pose proof (X_grows b (tk l) ltac:(lra) ltac:(lra)).
  pose proof (HN l ltac:(lia)). pose proof (X_total N l ltac:(lia)).
  apply Rmult_le_reg_l with c; [auto|]. assert (c * (X b - X a) <= c * (X (tk l) - X (tk N))) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(** *** The kinetic energy is bounded and cannot grow fast: so it tends to 0 *)
Lemma E_start t : tk 0%nat <= t -> E t <= Wk 0%nat.
Proof.
  intros Ht. destruct (which tk order covers t Ht) as [k Hk]. eapply Rle_trans; [apply (E_between k t Hk)|].
  apply (decreasing_prop Wk 0 k W_decreasing). lia.
Qed.
Definition top : R := 2 * (Wk 0%nat - low) / alpha rb.
Lemma w2_bound t : tk 0%nat <= t -> dot n (w t) (w t) <= top.
Proof.
  intros Ht. pose proof (E_start t Ht) as A. pose proof (K_low t) as B. pose proof (low_bound (q t)) as D. unfold potential in D. unfold energy in A. cbv beta in *.
  pose proof (alpha_pos rb). unfold top. apply Rle_div_r; [lra|]. lra.
Qed.
Definition push (i : nat) : R := kp n g i * gammaf f + kv n g i * gammaf f + 2 * kg.
Lemma torque_up k t i : (i < n)%nat -> Rabs (torque n Gm f g qd J fl T p k i - grav Gt (q t) i) <= push i.
Proof.
  intros Hi. unfold torque, push. set (x := p (k + J)%nat). pose proof (h_up f (qd i - x i)) as A. pose proof (h_up f (velocity J fl T p k i)) as B.
  pose proof (kp_pos n g i Hi) as Kp. pose proof (kv_range n g i Hi) as [Kv _]. pose proof (Gt_up (q t) i Hi) as C1. pose proof (Gm_up x i Hi) as C2.
  apply Rabs_le_between in A, B, C1, C2. apply Rabs_le.
  assert (kp n g i * hf f (qd i - x i) <= kp n g i * gammaf f) by (apply Rmult_le_compat_l; lra).
  assert (kp n g i * - gammaf f <= kp n g i * hf f (qd i - x i)) by (apply Rmult_le_compat_l; lra).
  assert (kv n g i * hf f (velocity J fl T p k i) <= kv n g i * gammaf f) by (apply Rmult_le_compat_l; lra).
  assert (kv n g i * - gammaf f <= kv n g i * hf f (velocity J fl T p k i)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Definition fast : R := sum n (fun i => push i * (top + 1)) + 1.
Lemma top_pos : 0 <= top.
Proof. eapply Rle_trans; [apply (dot_pos n (w (tk 0%nat)))|apply w2_bound; lra]. Qed.
Lemma push_pos i : (i < n)%nat -> 0 <= push i.
Proof. intros Hi. eapply Rle_trans; [apply Rabs_pos|apply (torque_up 0 0 i Hi)]. Qed.
Lemma fast_pos : 1 <= fast.
Proof.
  unfold fast. assert (0 <= sum n (fun i => push i * (top + 1))); [|lra]. rewrite <- (Rmult_0_r (INR n)), <- sum_const. apply sum_le. intros i Hi.
  apply Rmult_le_pos; [now apply push_pos|pose proof top_pos; lra].
Qed.
Lemma K_slow a0 b0 : tk 0%nat <= a0 -> a0 <= b0 -> K b0 - fast * b0 <= K a0 - fast * a0.
Proof.
  intros Ha Hb. apply (glue tk covers (fun t => K t - fast * t) a0 b0 Ha); [|lra|auto|lra].
  intros k a' b' A1 A2 A3 A4 A5. destruct moves as (_ & _ & D & N).
  apply (grows (fun t => K t) (fun s => sum n (fun i => w s i * (torque n Gm f g qd J fl T p k i - grav Gt (q s) i) - phi s i * w s i - b rb i * w s i ^ 2)) fast a' b' A2).
  - intros s Hs. specialize (N k s ltac:(lra)). evar_last.
    + apply (kinetic_rate n rb q w (fun j => Derive (fun s => w s j) s)); [intros; apply D; auto; lra|].
      intros i Hi. apply Derive_correct. now destruct (N i Hi).
    + apply sum_ext; intros i Hi. destruct (N i Hi) as [_ ->]. ring.
  - intros s Hs. apply (kinetic_continuous n rb q w a' b'); [intros; apply D; auto; lra|intros; apply D; auto; lra|auto].
  - intros s Hs. unfold fast. apply Rle_trans with (sum n (fun i => push i * (top + 1))); [|lra]. apply sum_le. intros i Hi.
    pose proof (friction s i ltac:(lra) Hi) as Fr. pose proof (b_range rb i Hi) as [B0 _]. pose proof (b_min_pos rb) as B1.
    assert (0 <= b rb i * w s i ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]).
    assert (w s i * (torque n Gm f g qd J fl T p k i - grav Gt (q s) i) <= push i * (top + 1)); [|lra].
    eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult, Rmult_comm. pose proof (torque_up k s i Hi). pose proof (push_pos i Hi).
    apply Rmult_le_compat; try apply Rabs_pos; auto.
    pose proof (entry_2 n (w s) i Hi). pose proof (w2_bound s ltac:(lra)). pose proof top_pos. pose proof (pow2_abs (w s i)). pose proof (pow2_ge_0 (Rabs (w s i) - 1)). nra.
Qed.
Lemma K_vanishes ka : 0 < ka -> exists t1, tk 0%nat <= t1 /\ forall t, t1 <= t -> K t < ka.
Proof.
  intros Hk. pose proof fast_pos as F. pose proof (beta_pos rb) as Hb. set (s := ka / fast). assert (S0 : 0 < s) by (apply Rdiv_lt_0_compat; lra).
  assert (Es : fast * s = ka) by (unfold s; field; lra).
  destruct (X_cauchy (ka * s / (2 * (beta rb + 1)))) as (t1 & T1 & H); [apply Rdiv_lt_0_compat; [now apply Rmult_lt_0_compat|lra]|].
  exists (t1 + s). split; [lra|]. intros t Ht. destruct (Rlt_dec (K t) ka) as [|N]; auto. exfalso. cbv beta in N.
  (* on [t - s, t]: K(u) >= ka - fast (t - u), so X grows by ka s / (beta + 1) at least *)
  set (Y := fun u => - X u + / (beta rb + 1) * (fast * (t - u) ^ 2)).
  assert (Hf : Y t - - (2 * ka / (beta rb + 1)) * t <= Y (t - s) - - (2 * ka / (beta rb + 1)) * (t - s)).
  { apply (grows Y (fun u => - dot n (w u) (w u) + - (/ (beta rb + 1) * (2 * (fast * (t - u))))) (- (2 * ka / (beta rb + 1))) (t - s) t); [lra| | |].
    - intros u Hu. evar_last.
      + apply (is_derive_plus (fun u => - X u) (fun u => / (beta rb + 1) * (fast * (t - u) ^ 2)) u (- dot n (w u) (w u)) (- (/ (beta rb + 1) * (2 * (fast * (t - u)))))).
        * apply (is_derive_opp X). apply X_rate. lra.
        * auto_derive; auto. ring.
      + unfold plus; simpl; ring.
    - intros u Hu. apply (continuous_plus (fun u => - X u) (fun u => / (beta rb + 1) * (fast * (t - u) ^ 2))).
      + apply (continuous_opp X). apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply X_rate. lra.
      + apply (ex_derive_continuous (V := R_NormedModule) (fun u => / (beta rb + 1) * (fast * (t - u) ^ 2))). auto_derive; auto.
    - intros u Hu. pose proof (K_slow u t ltac:(lra) ltac:(lra)) as Sl. pose proof (K_up u) as Up. cbv beta in *. pose proof (dot_pos n (w u)) as Dp.
      assert (ka - fast * (t - u) <= (beta rb + 1) / 2 * dot n (w u) (w u)) by lra.
      assert (/ (beta rb + 1) * (2 * (ka - fast * (t - u))) <= dot n (w u) (w u)).
      { apply Rmult_le_reg_l with ((beta rb + 1) / 2); [lra|]. replace ((beta rb + 1) / 2 * (/ (beta rb + 1) * (2 * (ka - fast * (t - u))))) with (ka - fast * (t - u)) by (field; lra). auto. }
      unfold Rdiv. set (iv := / (beta rb + 1)) in *. clearbody iv. set (dd := dot n (w u) (w u)) in *. clearbody dd. lra. }
  unfold Y in Hf. specialize (H (t - s) t ltac:(lra) ltac:(lra)).
  replace (t - (t - s)) with s in Hf by ring. replace (t - t) with 0 in Hf by ring.
  replace (fast * s ^ 2) with (ka * s) in Hf by (rewrite <- Es; ring).
  assert (2 * ka / (beta rb + 1) * s - / (beta rb + 1) * (ka * s) <= X t - X (t - s)) by lra.
  replace (2 * ka / (beta rb + 1) * s - / (beta rb + 1) * (ka * s)) with (2 * (ka * s / (2 * (beta rb + 1)))) in H0 by (field; lra).
  assert (0 < ka * s / (2 * (beta rb + 1))) by (apply Rdiv_lt_0_compat; [now apply Rmult_lt_0_compat|lra]). lra.
Qed.
End X.
(** The arm comes to rest. *)
Theorem comes_to_rest eta : 0 < eta -> exists t1, tk 0%nat <= t1 /\ forall t, t1 <= t -> norm n (w t) < eta.
Proof.
  intros H. destruct X_exists as [X HX]. pose proof (alpha_pos rb).
  destruct (K_vanishes X HX (alpha rb / 2 * (eta * eta))) as (t1 & T1 & Ht); [apply Rmult_lt_0_compat; nra|].
  exists t1. split; auto. intros t Hl. specialize (Ht t Hl). pose proof (K_low t). cbv beta in *.
  apply Converge.square_lt; [apply norm_pos|auto|]. rewrite norm2. apply Rmult_lt_reg_l with (alpha rb / 2); lra.
Qed.

(** ** Where it rests: K_p h(e) + (the controller's gravity) - (the arm's) tends to 0 *)
Variable Stt : steepness n Gt.
Hypothesis no_friction : forall t i, tk 0%nat <= t -> (i < n)%nat -> phi t i = 0.
Definition pull (x : vec) (i : nat) : R := kp n g i * hf f (qd i - x i) + grav Gm x i - grav Gt x i.
Lemma tk_back m j : tk (m + j)%nat <= tk m + INR j * T.
Proof.
  destruct moves as (O & _). induction j; [rewrite PeanoNat.Nat.add_0_r; simpl; lra|]. rewrite PeanoNat.Nat.add_succ_r, S_INR. destruct (O (m + j)%nat). lra.
Qed.
Lemma moved t1 om : tk 0%nat <= t1 -> (forall t, t1 <= t -> norm n (w t) <= om) ->
  forall x y i, (i < n)%nat -> t1 <= x -> t1 <= y -> Rabs (q x i - q y i) <= om * Rabs (x - y).
Proof.
  intros T1 H x y i Hi Hx Hy. destruct moves as (_ & _ & D & _).
  assert (B : forall s, Rmin y x <= s <= Rmax y x -> t1 <= s) by (intros s [Hs _]; pose proof (Rmin_glb y x t1 Hy Hx); lra).
  destruct (MVT_gen (fun s => q s i) y x (fun s => w s i)) as (s & Hs & E).
  - intros s Hs. apply D; auto. apply Rle_trans with t1; auto. apply B. lra.
  - intros s Hs. apply derivable_continuous_pt. exists (w s i). apply is_derive_Reals, D; auto. apply Rle_trans with t1; auto.
  - rewrite E, Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|]. eapply Rle_trans; [apply (Converge.entry_le_norm n (w s) i Hi)|]. auto.
Qed.
Lemma sum_delta k (u : vec) i : (i < k)%nat -> sum k (fun j => u j * (if Nat.eqb j i then 1 else 0)) = u i.
Proof.
  intros Hi. induction k; [lia|]. simpl. destruct (PeanoNat.Nat.eq_dec i k) as [->|Ne].
  - rewrite PeanoNat.Nat.eqb_refl. replace (sum k (fun j => u j * (if Nat.eqb j k then 1 else 0))) with (sum k (fun _ => 0)).
    + rewrite sum_const. ring.
    + apply sum_ext. intros j Hj. rewrite (proj2 (PeanoNat.Nat.eqb_neq j k)) by lia. ring.
  - rewrite IHk by lia. rewrite (proj2 (PeanoNat.Nat.eqb_neq k i)) by lia. ring.
Qed.
Lemma turning x y i : (i < n)%nat -> Rabs (sum n (fun j => C rb x y j i * y j)) <= kc rb * (norm n y * norm n y).
Proof.
  intros Hi. set (dl := fun j : nat => if Nat.eqb j i then 1 else 0).
  assert (N1 : norm n dl = 1).
  { assert (Z : dot n dl dl = dl i) by exact (sum_delta n dl i Hi). unfold norm. rewrite Z. unfold dl. rewrite PeanoNat.Nat.eqb_refl. apply sqrt_1. }
  assert (E : sum n (fun j => C rb x y j i * y j) = dot n y (apply_ n (C rb x y) dl)).
  { apply sum_ext. intros j Hj. assert (Z : apply_ n (C rb x y) dl j = C rb x y j i) by exact (sum_delta n (C rb x y j) i Hi). rewrite Z. ring. }
  rewrite E. pose proof (cauchy_schwarz n y (apply_ n (C rb x y) dl)). pose proof (dot_ge n y (apply_ n (C rb x y) dl)).
  pose proof (C_up rb x y dl) as K. rewrite N1, Rmult_1_r in K. pose proof (norm_pos n y) as P0. apply Rmult_le_compat_l with (r := norm n y) in K; auto.
  apply Rabs_le. lra.
Qed.
Definition reachback : R := 1 + INR (S d) * T.
Definition slack (i : nat) : R :=
  kp n g i * rhof f * reachback + kv n g i * Lf f * spread J fl + Gam n Gm Stm i * reachback + Gam n Gt Stt i.
Lemma gravity_steps (G : gravity n) (S : steepness n G) x y r i : (i < n)%nat -> (forall j, (j < n)%nat -> Rabs (x j - y j) <= r) ->
  Rabs (grav G x i - grav G y i) <= Gam n G S i * r.
Proof.
  intros Hi H. eapply Rle_trans; [apply (Gb_up S); auto|]. unfold Gam. rewrite Rmult_comm, <- sum_scal. apply sum_le. intros j Hj.
  rewrite (Rmult_comm r). apply Rmult_le_compat_l; [apply Gb_pos|auto].
Qed.
Lemma torque_near t1 om N k t s i : tk 0%nat <= t1 -> 0 <= om -> (forall t, t1 <= t -> norm n (w t) <= om) -> t1 <= tk N -> (N + (J + d) <= k)%nat ->
  t1 <= t -> t <= s <= t + 1 -> tk k <= s <= tk (S k) -> (i < n)%nat ->
  Rabs (torque n Gm f g qd J fl T p k i - grav Gt (q s) i - pull (q t) i) <= slack i * om.
Proof.
  intros T1 O0 H HN Hk Ht Hs Hsk Hi. destruct moves as (O & R & _). destruct (O k) as [_ O2]. pose proof (moved t1 om T1 H) as Mv.
  set (m := (k - d)%nat). assert (Em : (k + J = m + (J + d))%nat) by (unfold m; lia). assert (Km : k = (m + d)%nat) by (unfold m; lia).
  assert (Tm : t1 <= tk m) by (eapply Rle_trans; [exact HN|apply (tk_mono tk order); unfold m; lia]).
  assert (Mm : tk m <= tk k) by (apply (tk_mono tk order); lia).
  assert (Bm : tk k <= tk m + INR d * T) by (rewrite Km at 1; apply tk_back).
  assert (Y0 : Rabs (tk m - t) <= reachback).
  { unfold reachback. rewrite S_INR. pose proof (pos_INR d). assert (0 <= INR d * T) by (apply Rmult_le_pos; lra). apply Rabs_le. lra. }
  assert (Yp : 0 <= reachback) by (eapply Rle_trans; [apply Rabs_pos|exact Y0]).
  assert (D1 : forall j, (j < n)%nat -> Rabs (q (tk m) j - q t j) <= reachback * om).
  { intros j Hj. eapply Rle_trans; [apply Mv; auto|]. rewrite Rmult_comm. apply Rmult_le_compat_r; auto. }
  assert (D2 : forall j, (j < n)%nat -> Rabs (q s j - q t j) <= 1 * om).
  { intros j Hj. eapply Rle_trans; [apply Mv; auto; lra|]. rewrite Rmult_comm. apply Rmult_le_compat_r; auto. apply Rabs_le. lra. }
  pose proof (gravity_steps Gm Stm _ _ _ i Hi D1) as G1. pose proof (gravity_steps Gt Stt _ _ _ i Hi D2) as G2.
  pose proof (kp_pos n g i Hi) as Kp. pose proof (kv_range n g i Hi) as [Kv _]. pose proof (rho_pos f) as R0. pose proof (L_pos f) as L0.
  assert (Hh : Rabs (kp n g i * (hf f (qd i - q (tk m) i) - hf f (qd i - q t i))) <= kp n g i * rhof f * reachback * om).
  { rewrite Rabs_mult, (Rabs_pos_eq (kp n g i)) by lra. pose proof (h_steep f (qd i - q (tk m) i) (qd i - q t i)) as Hq.
    replace (qd i - q (tk m) i - (qd i - q t i)) with (- (q (tk m) i - q t i)) in Hq by ring. rewrite Rabs_Ropp in Hq.
    apply Rle_trans with (kp n g i * (rhof f * (reachback * om))); [|right; ring]. apply Rmult_le_compat_l; [lra|].
    eapply Rle_trans; [exact Hq|]. apply Rmult_le_compat_l; auto. }
  assert (Hv : Rabs (velocity J fl T p k i) <= spread J fl * om).
  { unfold velocity, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ T)) by (left; now apply Rinv_0_lt_compat).
    apply Rle_trans with (spread J fl * (om * T) * / T); [|right; field; lra]. apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat|].
    eapply Rle_trans; [apply sum_abs|]. unfold spread. rewrite Rmult_comm, <- sum_scal. apply sum_le. intros l Hl. rewrite Rabs_mult, (Rmult_comm (om * T)).
    apply Rmult_le_compat_l; [apply Rabs_pos|]. set (z := (k + l - (J + d))%nat). assert (Ez : (k + l = z + (J + d))%nat) by (unfold z; lia).
    rewrite Ez. change (S (z + (J + d))) with (S z + (J + d))%nat. rewrite !R. destruct (O z) as [Z1 Z2].
    assert (Tz : t1 <= tk z) by (eapply Rle_trans; [exact HN|apply (tk_mono tk order); unfold z; lia]).
    eapply Rle_trans; [apply Mv; auto; lra|]. apply Rmult_le_compat_l; auto. apply Rabs_le. lra. }
  assert (Hk2 : Rabs (kv n g i * hf f (velocity J fl T p k i)) <= kv n g i * Lf f * spread J fl * om).
  { rewrite Rabs_mult, (Rabs_pos_eq (kv n g i)) by lra. apply Rle_trans with (kv n g i * (Lf f * (spread J fl * om))); [|right; ring].
    apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [apply h_lip|]. apply Rmult_le_compat_l; lra. }
  unfold torque, pull. rewrite Em, R. apply Rabs_le_between in Hh, Hk2, G1, G2. unfold slack. apply Rabs_le. lra.
Qed.
Definition room (i : nat) : R := slack i + b_max rb + kc rb + 2 * beta rb.
Lemma pull_small t1 om N t i sg : tk 0%nat <= t1 -> 0 <= om <= 1 -> (forall t, t1 <= t -> norm n (w t) <= om) -> t1 <= tk N -> tk (N + (J + d))%nat <= t -> (i < n)%nat ->
  sg * sg = 1 -> sg * pull (q t) i <= room i * om.
Proof.
  intros T1 Om H HN Ht Hi Sg. assert (T0 : t1 <= t) by (eapply Rle_trans; [exact HN|eapply Rle_trans; [apply (tk_mono tk order N (N + (J + d))); lia|exact Ht]]).
  assert (S1 : sg = 1 \/ sg = -1) by (assert ((sg - 1) * (sg + 1) = 0) by lra; apply Rmult_integral in H0; destruct H0; [left|right]; lra).
  assert (Sa : forall x y, Rabs x <= y -> sg * x <= y) by (intros x y A; apply Rabs_le_between in A; destruct S1 as [->| ->]; lra).
  assert (Sb : forall x y, Rabs x <= y -> - y <= sg * x) by (intros x y A; apply Rabs_le_between in A; destruct S1 as [->| ->]; lra).
  set (mom := fun s => apply_ n (M rb (q s)) (w s) i). set (r := sg * pull (q t) i - (slack i + b_max rb + kc rb) * om).
  destruct moves as (O & R & D & Nw).
  assert (A : - sg * mom (t + 1) - - r * (t + 1) <= - sg * mom t - - r * t).
  { apply (glue tk covers (fun s => - sg * mom s - - r * s) t (t + 1)); try lra.
    intros k x y X1 X2 X3 X4 X5. destruct (Req_dec x y) as [->|Ne]; [lra|].
    assert (Hk : (N + (J + d) <= k)%nat).
    { destruct (Compare_dec.le_lt_dec (N + (J + d)) k) as [|Lt]; auto. pose proof (tk_mono tk order (S k) (N + (J + d)) ltac:(lia)). lra. }
    assert (Rate : forall s, x < s < y -> is_derive mom s (torque n Gm f g qd J fl T p k i - grav Gt (q s) i - b rb i * w s i + sum n (fun j => C rb (q s) (w s) j i * w s j))).
    { intros s Hs. specialize (Nw k s ltac:(lra)). pose proof (start k). evar_last.
      - apply (momentum_rate n rb q w (fun j => Derive (fun s => w s j) s)); auto; [intros; apply D; auto; lra|].
        intros j Hj. apply Derive_correct. now destruct (Nw j Hj).
      - destruct (Nw i Hi) as [_ E]. rewrite (no_friction s i ltac:(lra) Hi) in E. unfold apply_ at 1 in E. unfold apply_ at 1 in E. unfold dot in E.
        transitivity (sum n (fun j => M rb (q s) i j * Derive (fun s0 => w s0 j) s) + sum n (fun j => C rb (q s) (w s) i j * w s j) + sum n (fun j => C rb (q s) (w s) j i * w s j)).
        + rewrite <- !sum_plus. apply sum_ext; intros; ring.
        + rewrite E. ring. }
    apply (grows (fun s => - sg * mom s) (fun s => - sg * (torque n Gm f g qd J fl T p k i - grav Gt (q s) i - b rb i * w s i + sum n (fun j => C rb (q s) (w s) j i * w s j))) (- r) x y X2).
    - intros s Hs. apply (is_derive_scal mom). now apply Rate.
    - intros s Hs. apply (continuous_mult (fun _ => - sg) mom); [apply continuous_const|]. unfold mom.
      apply (continuous_sum (fun j s => M rb (q s) i j * w s j)). intros j Hj. pose proof (start k).
      apply (continuous_mult (fun s => M rb (q s) i j)); [|apply D; auto; lra].
      apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply (M_moves n rb q w); auto. intros; apply D; auto; lra.
    - intros s Hs. pose proof (torque_near t1 om N k t s i T1 ltac:(lra) H HN Hk T0 ltac:(lra) ltac:(lra) Hi) as Q1.
      pose proof (turning (q s) (w s) i Hi) as Q2. pose proof (H s ltac:(lra)) as Hw. pose proof (norm_pos n (w s)) as Hp. pose proof (kc_pos rb) as Pc.
      assert (Q3 : Rabs (b rb i * w s i) <= b_max rb * om).
      { rewrite Rabs_mult. pose proof (b_range rb i Hi). pose proof (b_min_pos rb). rewrite (Rabs_pos_eq (b rb i)) by lra.
        pose proof (Converge.entry_le_norm n (w s) i Hi). apply Rmult_le_compat; try apply Rabs_pos; lra. }
      assert (Q4 : kc rb * (norm n (w s) * norm n (w s)) <= kc rb * om) by (apply Rmult_le_compat_l; auto; nra).
      apply Sb in Q1. apply Sa in Q3. assert (Q5 := Sb _ _ Q2). unfold r. lra. }
  assert (Bd : forall s, t1 <= s -> Rabs (mom s) <= beta rb * om).
  { intros s Hs. unfold mom. eapply Rle_trans; [apply (Converge.entry_le_norm n (apply_ n (M rb (q s)) (w s)) i Hi)|].
    eapply Rle_trans; [apply M_up|]. apply Rmult_le_compat_l; [apply beta_pos|auto]. }
  pose proof (Sa _ _ (Bd (t + 1) ltac:(lra))). pose proof (Sb _ _ (Bd t T0)). unfold room, r in *. lra.
Qed.
Theorem settles eta : 0 < eta -> exists t2, tk 0%nat <= t2 /\ forall t, t2 <= t -> forall i, (i < n)%nat -> Rabs (pull (q t) i) <= eta.
Proof.
  intros He. set (tot := sum n (fun i => Rabs (room i)) + 1). assert (P1 : 1 <= tot) by (unfold tot; pose proof (sum_nonneg n (fun i => Rabs (room i)) ltac:(intros; apply Rabs_pos)); lra).
  set (om := Rmin 1 (eta / tot)). assert (O1 : 0 < om) by (apply Rmin_pos; [lra|apply Rdiv_lt_0_compat; lra]).
  destruct (comes_to_rest om O1) as (t1 & T1 & H). destruct (covers t1) as [N HN]. exists (tk (N + (J + d))%nat). split; [apply start|].
  intros t Ht i Hi. assert (Hr : room i * om <= eta).
  { apply Rle_trans with (tot * om).
    - apply Rmult_le_compat_r; [lra|]. unfold tot. pose proof (Rle_abs (room i)). pose proof (term_le_sum n (fun i => Rabs (room i)) i ltac:(intros; apply Rabs_pos) Hi). simpl in *. lra.
    - apply Rle_trans with (tot * (eta / tot)); [apply Rmult_le_compat_l; [lra|apply Rmin_r]|right; field; lra]. }
  assert (H' : forall t, t1 <= t -> norm n (w t) <= om) by (intros s Hs; left; auto).
  assert (O2 : 0 <= om <= 1) by (split; [lra|apply Rmin_l]).
  pose proof (pull_small t1 om N t i 1 T1 O2 H' HN Ht Hi ltac:(ring)). pose proof (pull_small t1 om N t i (-1) T1 O2 H' HN Ht Hi ltac:(ring)).
  apply Rabs_le. lra.
Qed.
End Rests.
