(** How steep the gravity of a serial revolute arm is: |dg_i/dq_j| is at most any bound of |g_i|, and of |g_j|. *)
From Coq Require Import Reals Lra Lia Psatz FunctionalExtensionality.
From Coquelicot Require Import Coquelicot.
Require Import Definitions SampledDefinitions.
Require Import Loop Sampled Rests.
Open Scope R_scope.

(** |f'| <= k everywhere: |f b - f a| <= k |b - a| *)
Lemma lipschitz (f df : R -> R) k a b : (forall t, is_derive f t (df t)) -> (forall t, Rabs (df t) <= k) -> Rabs (f b - f a) <= k * Rabs (b - a).
Proof.
  intros D K. destruct (MVT_gen f a b df) as (s & _ & E).
  - intros x _. apply D.
  - intros x _. apply continuity_pt_filterlim, (ex_derive_continuous (V := R_NormedModule)). eexists; apply D.
  - rewrite E, Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|apply K].
Qed.
Lemma circle_rate x y z t : is_derive (fun t => x + y * cos t + z * sin t) t (- y * sin t + z * cos t).
Proof. auto_derive; auto. ring. Qed.
Lemma cos_later t : cos (t + PI / 2) = - sin t. Proof. rewrite cos_plus, cos_PI2, sin_PI2. ring. Qed.
Lemma sin_later t : sin (t + PI / 2) = cos t. Proof. rewrite sin_plus, cos_PI2, sin_PI2. ring. Qed.
Lemma cos_before t : cos (t - PI / 2) = sin t. Proof. rewrite cos_minus, cos_PI2, sin_PI2. ring. Qed.
Lemma sin_before t : sin (t - PI / 2) = - cos t. Proof. rewrite sin_minus, cos_PI2, sin_PI2. ring. Qed.

Section Steep.
Variable n : nat.
Variable G : gravity n.
Hypothesis R0 : revolute n G.
Variable k : vec.
Hypothesis k_up : forall q i, (i < n)%nat -> Rabs (grav G q i) <= k i.

Lemma turned_0 j q : turned j 0 q = q.
Proof. apply functional_extensionality. intros i. unfold turned. destruct (Nat.eqb i j); ring. Qed.
Lemma turned_both i j s t q : turned i s (turned j t q) = turned j t (turned i s q).
Proof. apply functional_extensionality. intros l. unfold turned. destruct (Nat.eqb l i), (Nat.eqb l j); ring. Qed.
Lemma turned_more j s t q : turned j s (turned j t q) = turned j (t + s) q.
Proof. apply functional_extensionality. intros l. unfold turned. destruct (Nat.eqb l j); ring. Qed.
Lemma turn_rate j q t : (j < n)%nat -> is_derive (fun s => P G (turned j s q)) t (grav G (turned j t q) j).
Proof.
  intros Hj. evar_last.
  - apply (P_rate G (fun s => turned j s q) t (fun i => if Nat.eqb i j then 1 else 0)). intros i _. unfold turned. destruct (Nat.eqb i j); auto_derive; auto; ring.
  - unfold dot. rewrite <- (sum_delta n (fun i => grav G (turned j t q) i) j Hj). apply sum_ext. intros i _. destruct (Nat.eqb i j); ring.
Qed.
(** A torque is half the difference of the potential a quarter of a turn away. *)
Lemma quarter q i : (i < n)%nat -> grav G q i = (P G (turned i (PI / 2) q) - P G (turned i (- (PI / 2)) q)) / 2.
Proof.
  intros Hi. destruct R0 as [_ C]. destruct (C q i Hi) as (x & y & z & E). rewrite !E, cos_neg, sin_neg, cos_PI2, sin_PI2.
  assert (D : is_derive (fun s => P G (turned i s q)) 0 (- y * sin 0 + z * cos 0)).
  { apply (is_derive_ext (fun t => x + y * cos t + z * sin t)); [intros; symmetry; apply E|apply circle_rate]. }
  pose proof (is_derive_unique _ _ _ (turn_rate i q 0 Hi)) as U. rewrite (is_derive_unique _ _ _ D), turned_0, sin_0, cos_0 in U. lra.
Qed.
Lemma torque_circle q i j : (i < n)%nat -> (j < n)%nat -> exists x y z, forall t, grav G (turned j t q) i = x + y * cos t + z * sin t.
Proof.
  intros Hi Hj. destruct R0 as [_ C]. destruct (C (turned i (PI / 2) q) j Hj) as (x1 & y1 & z1 & E1). destruct (C (turned i (- (PI / 2)) q) j Hj) as (x2 & y2 & z2 & E2).
  exists ((x1 - x2) / 2), ((y1 - y2) / 2), ((z1 - z2) / 2). intros t. rewrite quarter by auto. rewrite !(turned_both i j), E1, E2. field.
Qed.
(** ... by its own bound *)
Lemma steep_own q i j s : (i < n)%nat -> (j < n)%nat -> Rabs (grav G (turned j s q) i - grav G q i) <= k i * Rabs s.
Proof.
  intros Hi Hj. destruct (torque_circle q i j Hi Hj) as (x & y & z & E).
  pose proof (lipschitz (fun t => x + y * cos t + z * sin t) (fun t => - y * sin t + z * cos t) (k i) 0 s (circle_rate x y z)) as L.
  cbv beta in L. rewrite <- !E, turned_0, Rminus_0_r in L. apply L. intros t.
  replace (- y * sin t + z * cos t) with ((grav G (turned j (t + PI / 2) q) i - grav G (turned j (t - PI / 2) q) i) / 2)
    by (rewrite !E, cos_later, sin_later, cos_before, sin_before; field).
  pose proof (k_up (turned j (t + PI / 2) q) i Hi) as A. pose proof (k_up (turned j (t - PI / 2) q) i Hi) as B. apply Rabs_le_between in A, B. apply Rabs_le. lra.
Qed.
(** ... and by that of the joint that turns *)
Lemma steep_other q i j s : (i < n)%nat -> (j < n)%nat -> Rabs (grav G (turned j s q) i - grav G q i) <= k j * Rabs s.
Proof.
  intros Hi Hj. rewrite !quarter by auto. rewrite !(turned_both i j).
  assert (L : forall y, Rabs (P G (turned j s y) - P G y) <= k j * Rabs s).
  { intros y. pose proof (lipschitz (fun t => P G (turned j t y)) (fun t => grav G (turned j t y) j) (k j) 0 s) as L. cbv beta in L.
    rewrite turned_0, Rminus_0_r in L. apply L; intros; [now apply turn_rate|now apply k_up]. }
  pose proof (L (turned i (PI / 2) q)) as A. pose proof (L (turned i (- (PI / 2)) q)) as B. apply Rabs_le_between in A, B. apply Rabs_le. lra.
Qed.
(** Entries beyond the joints do not matter. *)
Lemma P_joints x y : (forall i, (i < n)%nat -> x i = y i) -> P G x = P G y.
Proof.
  intros E. set (f := fun s : R => P G (fun i => if Nat.ltb i n then x i else if Rlt_dec s 1 then x i else y i)).
  assert (D : forall s, is_derive f s 0).
  { intros s. evar_last.
    - apply (P_rate G (fun s i => if Nat.ltb i n then x i else if Rlt_dec s 1 then x i else y i) s (fun _ => 0)). intros i Hi.
      apply PeanoNat.Nat.ltb_lt in Hi. rewrite Hi. apply (is_derive_const (V := R_NormedModule)).
    - unfold dot. rewrite (sum_ext n _ (fun _ => 0)) by (intros; ring). rewrite sum_const. ring. }
  pose proof (lipschitz f (fun _ => 0) 0 0 2 D ltac:(intros; cbv beta; rewrite Rabs_R0; lra)) as L. rewrite Rmult_0_l in L.
  assert (F : f 2 - f 0 = 0) by (pose proof (Rabs_pos (f 2 - f 0)); apply Rabs_eq_0; lra). unfold f in F.
  replace (P G x) with (P G (fun i => if Nat.ltb i n then x i else if Rlt_dec 0 1 then x i else y i)).
  - replace (P G y) with (P G (fun i => if Nat.ltb i n then x i else if Rlt_dec 2 1 then x i else y i)); [lra|].
    f_equal. apply functional_extensionality. intros i. destruct (Nat.ltb i n) eqn:L0; [apply E; now apply PeanoNat.Nat.ltb_lt|]. destruct (Rlt_dec 2 1); lra.
  - f_equal. apply functional_extensionality. intros i. destruct (Nat.ltb i n); auto. destruct (Rlt_dec 0 1); lra.
Qed.
Lemma grav_joints x y i : (i < n)%nat -> (forall j, (j < n)%nat -> x j = y j) -> grav G x i = grav G y i.
Proof.
  intros Hi E. rewrite !quarter by auto. assert (K : forall s, P G (turned i s x) = P G (turned i s y)); [|now rewrite !K].
  intros s. apply P_joints. intros j Hj. unfold turned. now rewrite E.
Qed.
Definition steepest (i j : nat) : R := Rmin (Rabs (k i)) (Rabs (k j)).
Lemma steep_one q i j s : (i < n)%nat -> (j < n)%nat -> Rabs (grav G (turned j s q) i - grav G q i) <= steepest i j * Rabs s.
Proof.
  intros Hi Hj. pose proof (Rabs_pos s). assert (A : forall l, k l <= Rabs (k l)) by (intros; apply Rle_abs). unfold steepest, Rmin. destruct (Rle_dec _ _).
  - eapply Rle_trans; [now apply steep_own|]. now apply Rmult_le_compat_r.
  - eapply Rle_trans; [now apply steep_other|]. now apply Rmult_le_compat_r.
Qed.
(** From y to x, one joint after the other. *)
Lemma steep_all x y i : (i < n)%nat -> Rabs (grav G x i - grav G y i) <= sum n (fun j => steepest i j * Rabs (x j - y j)).
Proof.
  intros Hi. set (mix := fun (m j : nat) => if Nat.ltb j m then x j else y j).
  assert (K : forall m, (m <= n)%nat -> Rabs (grav G (mix m) i - grav G y i) <= sum m (fun j => steepest i j * Rabs (x j - y j))).
  { induction m as [|m IH]; intros Hm.
    - rewrite (grav_joints (mix 0%nat) y i Hi) by reflexivity. simpl. rewrite Rminus_diag_eq, Rabs_R0 by reflexivity. lra.
    - specialize (IH ltac:(lia)). cbn [sum]. replace (mix (S m)) with (turned m (x m - y m) (mix m)).
      + pose proof (steep_one (mix m) i m (x m - y m) Hi ltac:(lia)) as A. eapply Rle_trans; [|apply Rplus_le_compat; [exact IH|exact A]].
        replace (grav G (turned m (x m - y m) (mix m)) i - grav G y i) with ((grav G (mix m) i - grav G y i) + (grav G (turned m (x m - y m) (mix m)) i - grav G (mix m) i)) by ring. apply Rabs_triang.
      + apply functional_extensionality. intros j. unfold turned, mix. destruct (PeanoNat.Nat.eq_dec j m) as [->|N].
        * rewrite PeanoNat.Nat.eqb_refl, PeanoNat.Nat.ltb_irrefl. replace (Nat.ltb m (S m)) with true by (symmetry; apply PeanoNat.Nat.ltb_lt; lia). ring.
        * rewrite (proj2 (PeanoNat.Nat.eqb_neq j m) N). destruct (Nat.ltb j m) eqn:L1, (Nat.ltb j (S m)) eqn:L2; auto;
          [apply PeanoNat.Nat.ltb_lt in L1; apply PeanoNat.Nat.ltb_ge in L2; lia|apply PeanoNat.Nat.ltb_ge in L1; apply PeanoNat.Nat.ltb_lt in L2; lia]. }
  specialize (K n (le_n n)). rewrite (grav_joints (mix n) x i Hi) in K; [exact K|]. intros j Hj. unfold mix. now rewrite (proj2 (PeanoNat.Nat.ltb_lt j n) Hj).
Qed.
Lemma steepest_pos i j : 0 <= steepest i j. Proof. apply Rmin_glb; apply Rabs_pos. Qed.
Lemma steepest_sym i j : steepest i j = steepest j i. Proof. apply Rmin_comm. Qed.
Definition steepness_of : steepness n G := Steepness n G steepest steepest_pos steepest_sym steep_all.
End Steep.
