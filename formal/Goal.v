(** (S) and the goal: stable, and every motion of the loop on a computer tends to it. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions SampledDefinitions.
Require Import Loop.
Require Converge Stability Family.
Require Import Sampled Rests.
Open Scope R_scope.

Section Goal.
Variable n : nat.
Variable rb : robot n.
Variable G : gravity n.                            (* the arm's, and the controller's *)
Variable S0 : steepness n G.
Variable f : member.
Variable g : gains n.
Variable qd : vec.
Variables (J d : nat) (fl : nat -> R) (T kg : R).
Hypothesis T_pos : 0 < T.
Hypothesis U_proper : forall K, exists r, forall x, Uf f x <= K -> Rabs x <= r.
Hypothesis G_up : forall x i, (i < n)%nat -> Rabs (grav G x i) <= kg.
(** (S) *)
Hypothesis S_holds : forall i, (i < n)%nat -> Lf f * kv n g i * spread J fl + (/ 2 + INR d) * T * stiff n G S0 f g i < b rb i.

(** A motion of the loop: at most T between two readings, and no end to them. *)
Definition runs (tk : nat -> R) (p : nat -> vec) (q w : R -> vec) : Prop :=
  sampled n rb G G f g qd J d fl T tk p (fun _ _ => 0) q w /\ forall t, exists k, t <= tk k.
Definition near (z : R) (q w : vec) : Prop := forall i, (i < n)%nat -> Rabs (qd i - q i) < z /\ Rabs (w i) < z.
Definition sampled_stable : Prop := forall eta, 0 < eta -> exists z, 0 < z /\ forall tk p q w, runs tk p q w ->
  near z (q (tk 0%nat)) (w (tk 0%nat)) -> (forall l i, (l < J + d)%nat -> (i < n)%nat -> Rabs (p (S l) i - p l i) < z) ->
  forall t, tk 0%nat <= t -> near eta (q t) (w t).
Definition sampled_attractive : Prop := forall tk p q w, runs tk p q w ->
  forall eta, 0 < eta -> exists t2, forall t, t2 <= t -> near eta (q t) (w t).

Lemma to_spare : exists c, 0 < c /\ forall i, (i < n)%nat -> c + Lf f * kv n g i * spread J fl + (/ 2 + INR d) * T * stiff n G S0 f g i <= b rb i.
Proof.
  assert (A : forall k, (k <= n)%nat -> exists c, 0 < c /\ forall i, (i < k)%nat -> c + Lf f * kv n g i * spread J fl + (/ 2 + INR d) * T * stiff n G S0 f g i <= b rb i).
  { induction k; intros Hk; [exists 1; split; [lra|intros; lia]|]. destruct (IHk ltac:(lia)) as (c & P & H). pose proof (S_holds k ltac:(lia)) as K.
    set (u := Lf f * kv n g k * spread J fl + (/ 2 + INR d) * T * stiff n G S0 f g k) in *.
    exists (Rmin c (b rb k - u)). split; [apply Rmin_pos; lra|]. intros i Hi. destruct (PeanoNat.Nat.eq_dec i k) as [->|].
    - pose proof (Rmin_r c (b rb k - u)). unfold u in *. lra.
    - pose proof (Rmin_l c (b rb k - u)). specialize (H i ltac:(lia)). lra. }
  exact (A n (le_n n)).
Qed.
Lemma low x : 0 <= potential n G G f g qd x.
Proof.
  unfold potential. assert (0 <= sum n (fun i => kp n g i * Uf f (qd i - x i))); [|lra]. apply Converge.sum_nonneg_in. intros i Hi.
  apply Rmult_le_pos; [pose proof (kp_pos n g i Hi); lra|apply Converge.U_nonneg].
Qed.
Lemma energy_w q w i : (i < n)%nat -> alpha rb / 2 * w i ^ 2 <= energy n rb G G f g qd q w.
Proof.
  intros Hi. pose proof (low q) as A. unfold potential in A. unfold energy, kinetic. pose proof (M_low rb q w) as B. pose proof (entry_2 n w i Hi) as D. pose proof (alpha_pos rb).
  apply Rmult_le_compat_l with (r := alpha rb / 2) in D; lra.
Qed.
Lemma energy_e q w i : (i < n)%nat -> kp_min n g * Uf f (qd i - q i) <= energy n rb G G f g qd q w.
Proof.
  intros Hi. unfold energy, kinetic. pose proof (M_low rb q w) as B. pose proof (dot_pos n w) as D. pose proof (alpha_pos rb).
  assert (0 <= alpha rb * dot n w w) by (apply Rmult_le_pos; lra).
  assert (kp n g i * Uf f (qd i - q i) <= sum n (fun i => kp n g i * Uf f (qd i - q i))).
  { apply (Converge.term_le_sum_in n (fun i => kp n g i * Uf f (qd i - q i))); auto. intros j Hj. apply Rmult_le_pos; [pose proof (kp_pos n g j Hj); lra|apply Converge.U_nonneg]. }
  assert (kp_min n g * Uf f (qd i - q i) <= kp n g i * Uf f (qd i - q i)) by (apply Rmult_le_compat_r; [apply Converge.U_nonneg|now apply kp_low]). lra.
Qed.
Lemma small_energy eta : 0 < eta -> exists del, 0 < del /\ forall q w, energy n rb G G f g qd q w < del -> near eta q w.
Proof.
  intros H. destruct (Converge.U_away f U_proper eta H) as (m & Pm & Hm). pose proof (kp_min_pos n g). pose proof (alpha_pos rb).
  assert (0 < eta * eta) by nra.
  exists (Rmin (kp_min n g * m) (alpha rb / 2 * (eta * eta))). split; [apply Rmin_pos; apply Rmult_lt_0_compat; lra|]. intros q w HE i Hi.
  pose proof (Rmin_l (kp_min n g * m) (alpha rb / 2 * (eta * eta))). pose proof (Rmin_r (kp_min n g * m) (alpha rb / 2 * (eta * eta))). split.
  - destruct (Rlt_dec (Rabs (qd i - q i)) eta) as [|N]; auto. pose proof (Hm (qd i - q i) ltac:(lra)) as U1. pose proof (energy_e q w i Hi).
    apply Rmult_le_compat_l with (r := kp_min n g) in U1; lra.
  - pose proof (energy_w q w i Hi). assert (w i ^ 2 < eta * eta) by (apply Rmult_lt_reg_l with (alpha rb / 2); lra).
    apply Converge.square_lt; [apply Rabs_pos|auto|]. pose proof (pow2_abs (w i)). simpl in *. lra.
Qed.
Definition charges : R := sum n (fun i => sum (J + d) (fun l => sum (S l) (weight n G S0 f g J fl T i))).
Lemma charges_pos : 0 <= charges.
Proof. unfold charges. apply Converge.sum_nonneg_in. intros i Hi. apply sum_nonneg. intros l. apply sum_nonneg. intros; now apply weight_pos. Qed.
Lemma small_start del : 0 < del -> exists z, 0 < z /\ forall tk p q w, near z (q (tk 0%nat)) (w (tk 0%nat)) ->
  (forall l i, (l < J + d)%nat -> (i < n)%nat -> Rabs (p (S l) i - p l i) < z) -> W n rb G G S0 f g qd J d fl T tk p q w 0 < del.
Proof.
  intros H. pose proof charges_pos as Q. pose proof (beta_pos rb) as B. pose proof (pos_INR n) as Nn.
  set (Ks := sum n (kp n g)). assert (HK : 0 <= Ks) by (apply Converge.sum_nonneg_in; intros i Hi; pose proof (kp_pos n g i Hi); lra).
  destruct (Converge.near_zero (Uf f) (del / (4 * (Ks + 1))) (Converge.U_continuous f 0) (U_zero f)) as (z1 & P1 & H1); [apply Rdiv_lt_0_compat; lra|].
  set (tot := charges + beta rb * INR n + 1). assert (P2 : 0 < tot) by (unfold tot; assert (0 <= beta rb * INR n) by (apply Rmult_le_pos; auto); lra).
  set (z := Rmin (Rmin 1 z1) (del / (4 * tot))). assert (Z0 : 0 < z) by (repeat apply Rmin_pos; try lra; apply Rdiv_lt_0_compat; lra).
  pose proof (Rmin_l (Rmin 1 z1) (del / (4 * tot))) as Z1. pose proof (Rmin_r (Rmin 1 z1) (del / (4 * tot))) as Z2. pose proof (Rmin_l 1 z1) as Z3. pose proof (Rmin_r 1 z1) as Z4. fold z in Z1, Z2.
  assert (Zt : tot * z <= del / 4).
  { apply Rle_trans with (tot * (del / (4 * tot))); [apply Rmult_le_compat_l; lra|right; field; lra]. }
  assert (Sq : forall x, Rabs x < z -> x ^ 2 <= z).
  { intros x Hx. rewrite <- pow2_abs. pose proof (Rabs_pos x). simpl. nra. }
  exists z. split; auto. intros tk p q w Hn Hp. unfold W, energy.
  assert (A1 : kinetic n rb (q (tk 0%nat)) (w (tk 0%nat)) <= beta rb * INR n * z).
  { unfold kinetic. set (v := w (tk 0%nat)) in *. pose proof (cauchy_schwarz n v (apply_ n (M rb (q (tk 0%nat))) v)) as C1. pose proof (M_up rb (q (tk 0%nat)) v) as C2. pose proof (norm_pos n v) as C3.
    apply Rmult_le_compat_l with (r := norm n v) in C2; auto. assert (C4 : norm n v * norm n v <= INR n * z).
    { rewrite norm2. unfold dot. rewrite <- sum_const. apply sum_le. intros i Hi. destruct (Hn i Hi) as [_ Hw]. pose proof (Sq _ Hw) as Sv. replace (v i * v i) with (v i ^ 2) by ring. exact Sv. }
    apply Rmult_le_compat_l with (r := beta rb) in C4; auto. assert (0 <= beta rb * (INR n * z)) by (apply Rmult_le_pos; [auto|apply Rmult_le_pos; lra]). lra. }
  assert (A2 : sum n (fun i => kp n g i * Uf f (qd i - q (tk 0%nat) i)) <= del / 4).
  { apply Rle_trans with (sum n (fun i => del / (4 * (Ks + 1)) * kp n g i)).
    - apply sum_le. intros i Hi. rewrite Rmult_comm. apply Rmult_le_compat_r; [pose proof (kp_pos n g i Hi); lra|]. left. apply H1. destruct (Hn i Hi). lra.
    - rewrite sum_scal. fold Ks. apply Rle_trans with (del / (4 * (Ks + 1)) * (Ks + 1)); [apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat|]; lra|right; field; lra]. }
  assert (A3 : stored n G S0 f g J d fl T p 0 <= charges * z).
  { unfold stored, charges. rewrite Rmult_comm, <- sum_scal. apply sum_le. intros i Hi. rewrite <- sum_scal. apply sum_le. intros l Hl. rewrite Rmult_comm.
    apply Rmult_le_compat_r; [apply sum_nonneg; intros; now apply weight_pos|]. apply Sq. now apply Hp. }
  unfold tot in Zt. lra.
Qed.
Section Motion.
Variables (tk : nat -> R) (p : nat -> vec) (q w : R -> vec).
Hypothesis R0 : runs tk p q w.
Lemma no_friction_pos : forall t i, tk 0%nat <= t -> (i < n)%nat -> 0 <= (fun (_ : R) (_ : nat) => 0) t i * w t i.
Proof. intros. lra. Qed.
Lemma below t : tk 0%nat <= t -> energy n rb G G f g qd (q t) (w t) <= W n rb G G S0 f g qd J d fl T tk p q w 0.
Proof.
  destruct R0 as [Mv Cv]. destruct to_spare as (c & Pc & Hc).
  destruct (X_exists n rb G G f g qd J d fl T tk p (fun _ _ => 0) q w Mv) as [X HX].
  exact (E_start n rb G G S0 f g qd J d fl T T_pos c Pc Hc tk p (fun _ _ => 0) q w Mv no_friction_pos Cv X HX t).
Qed.
End Motion.
Theorem is_stable : sampled_stable.
Proof.
  intros eta H. destruct (small_energy eta H) as (del & Pd & Hd). destruct (small_start del Pd) as (z & Pz & Hz). exists z. split; auto.
  intros tk p q w R0 Hn Hp t Ht. apply Hd. eapply Rle_lt_trans; [apply (below tk p q w R0 t Ht)|]. now apply Hz.
Qed.
Theorem is_attractive : sampled_attractive.
Proof.
  intros tk p q w R0 eta H. pose proof R0 as [Mv Cv]. destruct to_spare as (c & Pc & Hc). pose proof (kp_min_pos n g) as Kp.
  set (W0 := W n rb G G S0 f g qd J d fl T tk p q w 0). destruct (U_proper (W0 / kp_min n g)) as [r Hr].
  destruct (Converge.away (fun x => Rabs (hf f x)) eta r (Converge.h_continuous f)) as (m & Pm & Hm).
  { intros x Hx. apply Rabs_pos_lt. pose proof (h_sign f x Hx). intros E. rewrite E in H0. lra. }
  { exact H. }
  destruct (settles n rb G G S0 f g qd J d fl T T_pos c Pc Hc kg 0 G_up G_up low tk p (fun _ _ => 0) q w Mv ltac:(intros; lra) Cv S0 ltac:(reflexivity) (kp_min n g * m / 2)) as (t2 & T2 & H2).
  { apply Rdiv_lt_0_compat; [now apply Rmult_lt_0_compat|lra]. }
  destruct (comes_to_rest n rb G G S0 f g qd J d fl T T_pos c Pc Hc kg 0 G_up G_up low tk p (fun _ _ => 0) q w Mv ltac:(intros; lra) Cv eta H) as (t3 & T3 & H3).
  exists (Rmax t2 t3). intros t Ht i Hi. pose proof (Rmax_l t2 t3). pose proof (Rmax_r t2 t3). split.
  - destruct (Rlt_dec (Rabs (qd i - q t i)) eta) as [|Nl]; auto. exfalso. specialize (H2 t ltac:(lra) i Hi).
    assert (Re : Rabs (qd i - q t i) <= r).
    { apply Hr. pose proof (energy_e (q t) (w t) i Hi). pose proof (below tk p q w R0 t ltac:(lra)). fold W0 in H5. apply Rle_div_r; [auto|]. lra. }
    pose proof (Hm (qd i - q t i) ltac:(lra)) as K. unfold pull in H2.
    replace (kp n g i * hf f (qd i - q t i) + grav G (q t) i - grav G (q t) i) with (kp n g i * hf f (qd i - q t i)) in H2 by ring.
    rewrite Rabs_mult in H2. pose proof (kp_low n g i Hi) as Kl. rewrite (Rabs_pos_eq (kp n g i)) in H2 by lra.
    assert (kp_min n g * m <= kp n g i * Rabs (hf f (qd i - q t i))) by (apply Rmult_le_compat; lra).
    assert (0 < kp_min n g * m) by (apply Rmult_lt_0_compat; auto). lra.
  - eapply Rle_lt_trans; [apply (Converge.entry_le_norm n (w t) i Hi)|]. apply H3. lra.
Qed.
End Goal.

(** ** The family: h_m with any bounds Lp of h(x)/x, ro of |h'|, ga of |h| *)
Definition family (m : nat) (Hm : (1 <= m)%nat) (ga ro Lp : R) (G0 : 0 <= ga) (R0 : 0 <= ro) (L0 : 0 < Lp)
  (Hg : forall x, Rabs (h m x) <= ga) (Hr : forall x, Rabs (dh m x) <= ro) (Hl : forall x, Rabs (h m x) <= Lp * Rabs x) : member :=
  Member (h m) (dh m) (U m) ga ro Lp G0 R0 L0 (Family.h_derive m Hm) (Family.U_derive m Hm) (h_sign (Stability.hyperbolic m Hm)) (h_zero (Stability.hyperbolic m Hm))
    (U_pos (Stability.hyperbolic m Hm)) (U_zero (Stability.hyperbolic m Hm)) Hg Hr Hl.
(** For every n, every m >= 1, every robot with Properties 2.1 to 2.7, every gravity with Property 2.8 and bounded partial derivatives,
    every number d of samples of delay, every filter, every goal: (S) suffices. *)
Theorem S_suffices m (Hm : (1 <= m)%nat) ga ro Lp G0 R0 L0 Hg Hr Hl n (rb : robot n) (G : gravity n) (St : steepness n G) (g : gains n) qd J d fl T kg : 0 < T ->
  (forall x i, (i < n)%nat -> Rabs (grav G x i) <= kg) ->
  (forall i, (i < n)%nat -> Lp * kv n g i * spread J fl + (/ 2 + INR d) * T * (kp n g i * ro + Gam n G St i) < b rb i) ->
  let f := family m Hm ga ro Lp G0 R0 L0 Hg Hr Hl in
  sampled_stable n rb G f g qd J d fl T /\ sampled_attractive n rb G f g qd J d fl T.
Proof.
  intros HT HG HS f. split; [apply (is_stable n rb G St f g qd J d fl T HT)|apply (is_attractive n rb G St f g qd J d fl T kg HT)]; auto; exact (Stability.proper m Hm).
Qed.
