(** The loop on a computer: torque held between readings, [d] readings late, velocity by (filtered) backward difference.
    The energy inequality over one interval and over any number of them, for every n, every function, every robot. *)
From Coq Require Import Reals Lra Lia Psatz FunctionalExtensionality.
From Coquelicot Require Import Coquelicot.
Require Import Definitions SampledDefinitions.
Require Import Loop.
Open Scope R_scope.

(** ** Bounds [Gb i j] of |dg_i/dq_j|, as differences *)
Record steepness (n : nat) (G : gravity n) := Steepness { Gb : mat;
  Gb_pos : forall i j, 0 <= Gb i j; Gb_sym : forall i j, Gb i j = Gb j i;
  Gb_up : forall x y i, (i < n)%nat -> Rabs (grav G x i - grav G y i) <= sum n (fun j => Gb i j * Rabs (x j - y j)) }.
Arguments Gb {n G}. Arguments Gb_pos {n G}. Arguments Gb_sym {n G}. Arguments Gb_up {n G}.

(** ** Lemmas about functions of one variable *)
Lemma falls_open (f df : R -> R) a b : a <= b -> (forall t, a < t < b -> is_derive f t (df t)) ->
  (forall t, a <= t <= b -> continuous f t) -> (forall t, a < t < b -> df t <= 0) -> f b <= f a.
Proof.
  intros H D C N. destruct (Req_dec a b) as [->|Ne]; [lra|].
  set (dg := fun t => if Rlt_dec a t then if Rlt_dec t b then df t else 0 else 0).
  destruct (MVT_gen f a b dg) as (s & Hs & E).
  - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra. unfold dg. destruct (Rlt_dec a x); [|lra]. destruct (Rlt_dec x b); [|lra]. now apply D.
  - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra. apply continuity_pt_filterlim. now apply C.
  - assert (dg s <= 0); [|nra]. unfold dg. destruct (Rlt_dec a s); [|lra]. destruct (Rlt_dec s b); [|lra]. now apply N.
Qed.
(** f' <= c x on (0, 1): f 1 <= f 0 + c / 2 *)
Lemma half_square (f df : R -> R) c : (forall t, is_derive f t (df t)) -> (forall t, 0 < t < 1 -> df t <= c * t) -> f 1 <= f 0 + c / 2.
Proof.
  intros D N. set (g := fun t => f t - c / 2 * (t * t)).
  assert (K : g 1 <= g 0); [|unfold g in K; lra].
  assert (Dg : forall t, is_derive g t (df t - c * t)).
  { intros t. unfold g. evar_last.
    - apply (is_derive_minus f (fun t => c / 2 * (t * t)) t (df t) (c * t)); [apply D|]. auto_derive; auto. field.
    - unfold minus, plus, opp; simpl; ring. }
  apply (falls_open g (fun t => df t - c * t) 0 1); [lra|intros; apply Dg| |].
  - intros t _. apply (ex_derive_continuous (V := R_NormedModule)). eexists; apply Dg.
  - intros t Ht. specialize (N t Ht). lra.
Qed.

Lemma lin_rate (x : R -> R) (A B E tq s dx : R) : is_derive x s dx -> is_derive (fun s => A * (B * x s - E * s) - tq * x s) s (A * (B * dx - E) - tq * dx).
Proof.
  intros D. apply (is_derive_ext (fun s => (A * B - tq) * x s - A * E * s)); [intros; simpl; ring|].
  replace (A * (B * dx - E) - tq * dx) with ((A * B - tq) * dx - A * E) by ring.
  apply (is_derive_minus (fun s => (A * B - tq) * x s) (fun s => A * E * s)); [now apply (is_derive_scal x)|auto_derive; auto; ring].
Qed.

(** ** What a member of the family gives *)
Lemma h_steep f x y : Rabs (hf f x - hf f y) <= rhof f * Rabs (x - y).
Proof.
  destruct (MVT_gen (hf f) y x (dhf f)) as (s & _ & E).
  - intros; apply h_rate.
  - intros z _. apply derivable_continuous_pt. exists (dhf f z). apply is_derive_Reals, h_rate.
  - rewrite E, Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|apply dh_up].
Qed.
Lemma U_above f x y : Uf f y <= Uf f x + hf f x * (y - x) + rhof f / 2 * (y - x) ^ 2.
Proof.
  set (z := fun s => x + s * (y - x)). set (df := fun s => (hf f (z s) - hf f x) * (y - x)).
  assert (D : forall s, is_derive (fun s => Uf f (z s) - s * (hf f x * (y - x))) s (df s)).
  { intros s. evar_last.
    - apply (is_derive_minus (fun s => Uf f (z s)) (fun s => s * (hf f x * (y - x))) s (hf f (z s) * (y - x)) (hf f x * (y - x))).
      + evar_last; [apply (is_derive_comp (Uf f) z s); [apply U_rate|unfold z; auto_derive; auto; reflexivity]|]. unfold scal; simpl; unfold mult; simpl; ring.
      + auto_derive; auto. ring.
    - unfold df, minus, plus, opp; simpl; ring. }
  pose proof (half_square _ df (rhof f * (y - x) ^ 2) D) as K. cbv beta in K; unfold z in K.
  replace (x + 1 * (y - x)) with y in K by ring. replace (x + 0 * (y - x)) with x in K by ring.
  assert (forall t, 0 < t < 1 -> df t <= rhof f * (y - x) ^ 2 * t); [|specialize (K H); lra].
  intros t Ht. unfold df. eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult.
  pose proof (h_steep f (z t) x) as S. replace (z t - x) with (t * (y - x)) in S by (unfold z; ring). rewrite Rabs_mult, (Rabs_pos_eq t) in S by lra.
  apply Rle_trans with (rhof f * (t * Rabs (y - x)) * Rabs (y - x)); [apply Rmult_le_compat_r; [apply Rabs_pos|exact S]|].
  right. rewrite <- (pow2_abs (y - x)). ring.
Qed.

(** ** Sums *)
Lemma sum_abs k u : Rabs (sum k u) <= sum k (fun i => Rabs (u i)).
Proof. induction k; simpl; [rewrite Rabs_R0; lra|]. eapply Rle_trans; [apply Rabs_triang|lra]. Qed.
Lemma young a b : a * b <= / 2 * (a ^ 2 + b ^ 2).
Proof. pose proof (pow2_ge_0 (a - b)). lra. Qed.
Lemma young_abs a b : Rabs a * Rabs b <= / 2 * (a ^ 2 + b ^ 2).
Proof. pose proof (young (Rabs a) (Rabs b)). now rewrite !pow2_abs in H. Qed.

Section Steep.
Variable n : nat.
Variable G : gravity n.
Variable S : steepness n G.
(** Gamma_i = sum over j of Gb i j *)
Definition Gam (i : nat) : R := sum n (fun j => Gb S i j).
Lemma Gam_pos i : 0 <= Gam i.
Proof. apply sum_nonneg. intros; apply Gb_pos. Qed.
(** by rows only, as the bounds are symmetric *)
Lemma rows x y : sum n (fun i => Rabs (x i) * sum n (fun j => Gb S i j * Rabs (y j))) <= / 2 * sum n (fun i => Gam i * (x i ^ 2 + y i ^ 2)).
Proof.
  apply Rle_trans with (sum n (fun i => sum n (fun j => / 2 * (Gb S i j * x i ^ 2) + / 2 * (Gb S i j * y j ^ 2)))).
  - apply sum_le. intros i Hi. rewrite <- sum_scal. apply sum_le. intros j Hj.
    pose proof (young_abs (x i) (y j)) as Y. pose proof (Gb_pos S i j). apply Rmult_le_compat_l with (r := Gb S i j) in Y; [|auto]. lra.
  - right. transitivity (sum n (fun i => / 2 * (Gam i * x i ^ 2)) + sum n (fun i => / 2 * (Gam i * y i ^ 2))).
    + rewrite <- sum_plus. transitivity (sum n (fun i => sum n (fun j => / 2 * (Gb S i j * x i ^ 2)) + sum n (fun j => / 2 * (Gb S i j * y j ^ 2)))).
      { apply sum_ext; intros. now rewrite sum_plus. }
      rewrite !sum_plus. f_equal.
      * apply sum_ext; intros. unfold Gam. rewrite sum_scal. f_equal. rewrite Rmult_comm, <- sum_scal. apply sum_ext; intros; ring.
      * rewrite sum_swap. apply sum_ext; intros j Hj. unfold Gam. rewrite sum_scal. f_equal. rewrite Rmult_comm, <- sum_scal. apply sum_ext; intros i Hi. rewrite (Gb_sym S j i). ring.
    + rewrite <- sum_plus, <- sum_scal. apply sum_ext; intros; ring.
Qed.
(** - P(y) <= - P(x) - g(x).(y - x) + sum of Gamma_i (y_i - x_i)^2 / 2 *)
Lemma P_above x y : - P G y <= - P G x - dot n (grav G x) (fun i => y i - x i) + sum n (fun i => Gam i / 2 * (y i - x i) ^ 2).
Proof.
  set (z := fun (s : R) (i : nat) => x i + s * (y i - x i)).
  set (df := fun s => dot n (grav G x) (fun i => y i - x i) - dot n (grav G (z s)) (fun i => y i - x i)).
  assert (D : forall s, is_derive (fun s => s * dot n (grav G x) (fun i => y i - x i) - P G (z s)) s (df s)).
  { intros s. evar_last.
    - apply (is_derive_minus (fun s => s * dot n (grav G x) (fun i => y i - x i)) (fun s => P G (z s)) s (dot n (grav G x) (fun i => y i - x i)) (dot n (grav G (z s)) (fun i => y i - x i))).
      + auto_derive; auto. ring.
      + apply (P_rate G z s). intros i Hi. unfold z. auto_derive; auto. ring.
    - unfold df, minus, plus, opp; simpl; ring. }
  pose proof (half_square _ df (sum n (fun i => Gam i * (y i - x i) ^ 2)) D) as K.
  assert (H : forall t, 0 < t < 1 -> df t <= sum n (fun i => Gam i * (y i - x i) ^ 2) * t).
  { intros t Ht. unfold df, dot. rewrite <- sum_minus.
    apply Rle_trans with (sum n (fun i => Rabs (y i - x i) * sum n (fun j => Gb S i j * Rabs (t * (y j - x j))))).
    - apply sum_le. intros i Hi. eapply Rle_trans; [apply Rle_abs|]. rewrite <- Rmult_minus_distr_r, Rabs_mult, Rmult_comm.
      apply Rmult_le_compat_l; [apply Rabs_pos|]. rewrite Rabs_minus_sym. eapply Rle_trans; [apply (Gb_up S); auto|].
      right. apply sum_ext; intros j Hj. f_equal. f_equal. unfold z. ring.
    - apply Rle_trans with (t * sum n (fun i => Rabs (y i - x i) * sum n (fun j => Gb S i j * Rabs (y j - x j)))).
      + right. rewrite <- sum_scal. apply sum_ext; intros i Hi.
        replace (t * (Rabs (y i - x i) * sum n (fun j => Gb S i j * Rabs (y j - x j)))) with (Rabs (y i - x i) * (t * sum n (fun j => Gb S i j * Rabs (y j - x j)))) by ring.
        f_equal. rewrite <- sum_scal. apply sum_ext; intros j Hj. rewrite Rabs_mult, (Rabs_pos_eq t) by lra. ring.
      + rewrite Rmult_comm. apply Rmult_le_compat_r; [lra|]. eapply Rle_trans; [apply (rows (fun i => y i - x i) (fun i => y i - x i))|].
        right. rewrite <- sum_scal. apply sum_ext; intros; field. }
  specialize (K H). cbv beta in K.
  assert (Ez1 : P G (z 1) = P G y) by (f_equal; apply functional_extensionality; intros i; unfold z; ring).
  assert (Ez0 : P G (z 0) = P G x) by (f_equal; apply functional_extensionality; intros i; unfold z; ring).
  rewrite Ez1, Ez0 in K.
  assert (sum n (fun i => Gam i * (y i - x i) ^ 2) / 2 = sum n (fun i => Gam i / 2 * (y i - x i) ^ 2)).
  { unfold Rdiv. rewrite Rmult_comm, <- sum_scal. apply sum_ext; intros; field. }
  lra.
Qed.
End Steep.

(** ** Kinetic energy and momentum along a curve *)
Section Rates.
Variable n : nat.
Variable rb : robot n.
Definition kinetic (q w : vec) : R := / 2 * dot n w (apply_ n (M rb q) w).
Variables (q w : R -> vec) (a : vec) (t : R).
Hypothesis Hq : forall i, (i < n)%nat -> is_derive (fun s => q s i) t (w t i).
Notation Mt := (M rb (q t)).
Notation Ct := (C rb (q t) (w t)).
Lemma M_moves i j : (i < n)%nat -> (j < n)%nat -> is_derive (fun s => M rb (q s) i j) t (Ct i j + Ct j i).
Proof. intros Hi Hj. now apply (M_rate rb q t (w t)). Qed.
Hypothesis Hw : forall i, (i < n)%nat -> is_derive (fun s => w s i) t (a i).
Lemma momentum_rate i : (i < n)%nat ->
  is_derive (fun s => apply_ n (M rb (q s)) (w s) i) t (sum n (fun j => (Ct i j + Ct j i) * w t j + Mt i j * a j)).
Proof.
  intros Hi. apply (is_derive_sum n (fun j s => M rb (q s) i j * w s j)). intros j Hj.
  apply (is_derive_mult (fun s => M rb (q s) i j) (fun s => w s j)); [now apply M_moves|now apply Hw|intros; apply Rmult_comm].
Qed.
Theorem kinetic_rate : is_derive (fun s => kinetic (q s) (w s)) t (sum n (fun i => w t i * (apply_ n Mt a i + apply_ n Ct (w t) i))).
Proof.
  unfold kinetic. evar_last.
  - apply (is_derive_scal (fun s => dot n (w s) (apply_ n (M rb (q s)) (w s)))).
    apply (is_derive_sum n (fun i s => w s i * apply_ n (M rb (q s)) (w s) i)
      (fun i => a i * apply_ n Mt (w t) i + w t i * sum n (fun j => (Ct i j + Ct j i) * w t j + Mt i j * a j))). intros i Hi.
    apply (is_derive_mult (fun s => w s i) (fun s => apply_ n (M rb (q s)) (w s) i)); [now apply Hw|now apply momentum_rate|intros; apply Rmult_comm].
  - assert (A1 : sum n (fun i => a i * apply_ n Mt (w t) i) = sum n (fun i => w t i * apply_ n Mt a i)).
    { unfold apply_, dot. transitivity (sum n (fun i => sum n (fun j => a i * (Mt i j * w t j)))).
      { apply sum_ext; intros. now rewrite <- sum_scal. }
      rewrite sum_swap. apply sum_ext; intros j Hj. rewrite <- sum_scal. apply sum_ext; intros i Hi. rewrite (M_sym rb _ i j) by auto. ring. }
    assert (A2 : sum n (fun i => w t i * sum n (fun j => Ct j i * w t j)) = sum n (fun i => w t i * apply_ n Ct (w t) i)).
    { unfold apply_, dot. transitivity (sum n (fun i => sum n (fun j => w t i * (Ct j i * w t j)))).
      { apply sum_ext; intros. now rewrite <- sum_scal. }
      rewrite sum_swap. apply sum_ext; intros j Hj. rewrite <- sum_scal. apply sum_ext; intros i Hi. ring. }
    assert (A3 : sum n (fun i => w t i * sum n (fun j => (Ct i j + Ct j i) * w t j + Mt i j * a j))
      = sum n (fun i => w t i * apply_ n Ct (w t) i) + sum n (fun i => w t i * sum n (fun j => Ct j i * w t j)) + sum n (fun i => w t i * apply_ n Mt a i)).
    { rewrite <- !sum_plus. apply sum_ext; intros i Hi. unfold apply_, dot. rewrite <- !Rmult_plus_distr_l, <- !sum_plus. f_equal. apply sum_ext; intros; ring. }
    rewrite sum_plus, A1, A3, A2.
    replace (sum n (fun i => w t i * (apply_ n Mt a i + apply_ n Ct (w t) i)))
      with (sum n (fun i => w t i * apply_ n Mt a i) + sum n (fun i => w t i * apply_ n Ct (w t) i)) by (rewrite <- sum_plus; apply sum_ext; intros; ring).
    unfold scal; simpl; unfold mult; simpl. field.
Qed.
End Rates.

(** ** The motion under a held torque *)
Section Held.
Variable n : nat.
Variable rb : robot n.
Variable Gt : gravity n.                           (* the gravity that acts *)
(** Newton's law at time t under the torque tau and further torques -phi. *)
Definition driven_at (tau phi : vec) (q w : R -> vec) (t : R) : Prop := forall i, (i < n)%nat ->
  ex_derive (fun s => w s i) t /\
  apply_ n (M rb (q t)) (fun j => Derive (fun s => w s j) t) i
    = tau i - grav Gt (q t) i - phi i - b rb i * w t i - apply_ n (C rb (q t) (w t)) (w t) i.
Variables (q w phi : R -> vec) (X : R -> R) (tau : vec) (a0 b0 c : R).
Hypothesis order : a0 < b0.
Hypothesis Hq : forall t i, a0 <= t <= b0 -> (i < n)%nat -> is_derive (fun s => q s i) t (w t i).
Hypothesis Hw : forall t i, a0 <= t <= b0 -> (i < n)%nat -> continuous (fun s => w s i) t.
Hypothesis HX : forall t, a0 <= t <= b0 -> is_derive X t (dot n (w t) (w t)).
Hypothesis newton : forall t, a0 < t < b0 -> driven_at tau (phi t) q w t.
Hypothesis friction : forall t i, a0 < t < b0 -> (i < n)%nat -> 0 <= phi t i * w t i.
Hypothesis c_low : forall i, (i < n)%nat -> c <= b rb i.

Lemma continuous_sum (u : nat -> R -> R) k t : (forall i, (i < k)%nat -> continuous (u i) t) -> continuous (fun s => sum k (fun i => u i s)) t.
Proof.
  intros H; induction k; simpl; [apply continuous_const|].
  apply (continuous_plus (fun s => sum k (fun i => u i s)) (u k)); auto.
Qed.
Lemma kinetic_continuous t : a0 <= t <= b0 -> continuous (fun s => kinetic n rb (q s) (w s)) t.
Proof.
  intros Ht. apply (continuous_scal_r (/ 2) (fun s => dot n (w s) (apply_ n (M rb (q s)) (w s)))).
  apply (continuous_sum (fun i s => w s i * apply_ n (M rb (q s)) (w s) i)). intros i Hi.
  apply (continuous_mult (fun s => w s i)); [now apply Hw|].
  apply (continuous_sum (fun j s => M rb (q s) i j * w s j)). intros j Hj.
  apply (continuous_mult (fun s => M rb (q s) i j)); [|now apply Hw].
  apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply (M_moves n rb q w); auto.
Qed.
(** The work over a part of one interval: no integral, no M^-1; -b w^2 <= -b (2 w v - v^2) with the mean velocity v. *)
Theorem energy_held :
  kinetic n rb (q b0) (w b0) + P Gt (q b0) + c * (X b0 - X a0) + sum n (fun i => (b rb i - c) * (q b0 i - q a0 i) ^ 2 / (b0 - a0))
  <= kinetic n rb (q a0) (w a0) + P Gt (q a0) + sum n (fun i => tau i * (q b0 i - q a0 i)).
Proof.
  set (v := fun i => (q b0 i - q a0 i) / (b0 - a0)).
  set (lin := fun (s : R) => sum n (fun i => (b rb i - c) * (2 * v i * q s i - v i ^ 2 * s) - tau i * q s i)).
  set (f := fun s => kinetic n rb (q s) (w s) + (P Gt (q s) + (c * X s + lin s))).
  set (rest := fun s => dot n (grav Gt (q s)) (w s) + (c * dot n (w s) (w s) + sum n (fun i => (b rb i - c) * (2 * v i * w s i - v i ^ 2) - tau i * w s i))).
  assert (Dr : forall s, a0 <= s <= b0 -> is_derive (fun s => P Gt (q s) + (c * X s + lin s)) s (rest s)).
  { intros s Hs. apply (is_derive_plus (fun s => P Gt (q s)) (fun s => c * X s + lin s)); [apply (P_rate Gt); auto|].
    apply (is_derive_plus (fun s => c * X s) lin); [apply (is_derive_scal X); auto|].
    apply (is_derive_sum n (fun i s => (b rb i - c) * (2 * v i * q s i - v i ^ 2 * s) - tau i * q s i)). intros i Hi.
    apply (lin_rate (fun s => q s i)). now apply Hq. }
  assert (K : f b0 <= f a0).
  { apply (falls_open f (fun s => sum n (fun i => - (phi s i * w s i) - (b rb i - c) * (w s i - v i) ^ 2)) a0 b0); [lra| | |].
    - intros s Hs. evar_last.
      + apply (is_derive_plus (fun s => kinetic n rb (q s) (w s)) (fun s => P Gt (q s) + (c * X s + lin s))); [|apply Dr; lra].
        apply (kinetic_rate n rb q w (fun j => Derive (fun s => w s j) s)); [intros; apply Hq; auto; lra|].
        intros i Hi. apply Derive_correct. now destruct (newton s Hs i Hi).
      + unfold plus; simpl. unfold rest, dot. rewrite <- sum_scal, <- !sum_plus. apply sum_ext; intros i Hi.
        destruct (newton s Hs i Hi) as [_ ->]. ring.
    - intros s Hs. apply (continuous_plus (fun s => kinetic n rb (q s) (w s)) (fun s => P Gt (q s) + (c * X s + lin s))); [now apply kinetic_continuous|].
      apply (ex_derive_continuous (V := R_NormedModule)). eexists. now apply Dr.
    - intros s Hs. rewrite <- (Rmult_0_r (INR n)), <- sum_const. apply sum_le. intros i Hi.
      pose proof (friction s i Hs Hi). pose proof (c_low i Hi). assert (0 <= (b rb i - c) * (w s i - v i) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). lra. }
  unfold f in K.
  assert (E : lin b0 - lin a0 = sum n (fun i => (b rb i - c) * (q b0 i - q a0 i) ^ 2 / (b0 - a0)) - sum n (fun i => tau i * (q b0 i - q a0 i))).
  { unfold lin. rewrite <- !sum_minus. apply sum_ext; intros i Hi. unfold v. field. lra. }
  lra.
Qed.
End Held.

(** ** The loop of a computer *)
Lemma sum_split a b u : sum (a + b) u = sum a u + sum b (fun j => u (a + j)%nat).
Proof. induction b; simpl; [rewrite PeanoNat.Nat.add_0_r; ring|]. rewrite PeanoNat.Nat.add_succ_r. simpl. rewrite IHb. ring. Qed.
Lemma telescope (p : nat -> vec) s d i : Rabs (p (s + d)%nat i - p s i) <= sum d (fun j => Rabs (p (S (s + j)) i - p (s + j)%nat i)).
Proof.
  induction d; simpl; [rewrite PeanoNat.Nat.add_0_r, Rminus_diag_eq, Rabs_R0 by auto; lra|].
  rewrite PeanoNat.Nat.add_succ_r.
  replace (p (S (s + d)) i - p s i) with ((p (S (s + d)) i - p (s + d)%nat i) + (p (s + d)%nat i - p s i)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.
(** What is charged to readings of the past is put by for them when they are the present. *)
Lemma memory D (u y : nat -> R) k : sum D (fun l => sum (S l) u * y (S k + l)%nat)
  = sum D (fun l => sum (S l) u * y (k + l)%nat) + sum D u * y (k + D)%nat - sum D (fun l => u l * y (k + l)%nat).
Proof.
  induction D; [simpl; ring|]. change (sum (S D) (fun l => sum (S l) u * y (S k + l)%nat)) with (sum D (fun l => sum (S l) u * y (S k + l)%nat) + sum (S D) u * y (S k + D)%nat).
  rewrite IHD. change (sum (S D) (fun l => sum (S l) u * y (k + l)%nat)) with (sum D (fun l => sum (S l) u * y (k + l)%nat) + sum (S D) u * y (k + D)%nat).
  change (sum (S D) (fun l => u l * y (k + l)%nat)) with (sum D (fun l => u l * y (k + l)%nat) + u D * y (k + D)%nat).
  replace (k + S D)%nat with (S k + D)%nat by lia. simpl. ring.
Qed.

Section Sampled.
Variable n : nat.
Variable rb : robot n.
Variables Gt Gm : gravity n.                       (* the gravity that acts, and the one that the controller knows *)
Variable St : steepness n Gm.
Variable f : member.
Variable g : gains n.
Variable qd : vec.
Variables (J d : nat) (fl : nat -> R) (T : R).     (* J differences with the weights fl, oldest first; d samples late; T the period *)
Hypothesis T_pos : 0 < T.
Notation kpi := (kp n g).
Notation kvi := (kv n g).
Notation Gami := (Gam n Gm St).
(** The torque held over interval k, from the readings p k, ..., p (k + J); the newest reading then is p (k + (J + d)). *)
Definition velocity (p : nat -> vec) (k : nat) : vec := fun i => sum J (fun l => fl l * (p (S (k + l)) i - p (k + l)%nat i)) / T.
Definition torque (p : nat -> vec) (k : nat) : vec := fun i =>
  kpi i * hf f (qd i - p (k + J)%nat i) - kvi i * hf f (velocity p k i) + grav Gm (p (k + J)%nat) i.
(** A motion: readings at tk 0 < tk 1 < ..., at most T apart; those before tk 0 are whatever they are. *)
Definition sampled (tk : nat -> R) (p : nat -> vec) (phi q w : R -> vec) : Prop :=
  (forall k, tk k < tk (S k) <= tk k + T) /\ (forall k, p (k + (J + d))%nat = q (tk k)) /\
  (forall t i, tk 0%nat <= t -> (i < n)%nat -> is_derive (fun s => q s i) t (w t i) /\ continuous (fun s => w s i) t) /\
  (forall k t, tk k < t < tk (S k) -> driven_at n rb Gt (torque p k) (phi t) q w t).

Definition energy (q w : vec) : R := kinetic n rb q w + P Gt q - P Gm q + sum n (fun i => kpi i * Uf f (qd i - q i)).
Definition stiff (i : nat) : R := kpi i * rhof f + Gami i.
Definition weight (i l : nat) : R := if Nat.ltb l J then / 2 * (kvi i * Lf f / T * Rabs (fl l)) else / 2 * stiff i.
Definition spread : R := sum J (fun l => Rabs (fl l)).
Lemma kp_pos i : (i < n)%nat -> 0 < kpi i.
Proof. intros Hi. pose proof (kp_low n g i Hi). pose proof (kp_min_pos n g). lra. Qed.
Lemma stiff_pos i : (i < n)%nat -> 0 <= stiff i.
Proof. intros Hi. pose proof (kp_pos i Hi). unfold stiff. apply Rplus_le_le_0_compat; [apply Rmult_le_pos; [lra|apply rho_pos]|apply Gam_pos]. Qed.
Lemma weight_pos i l : (i < n)%nat -> 0 <= weight i l.
Proof.
  intros Hi. unfold weight. destruct (Nat.ltb l J).
  - pose proof (kv_range n g i Hi). pose proof (L_pos f). apply Rmult_le_pos; [lra|]. apply Rmult_le_pos; [|apply Rabs_pos].
    apply Rmult_le_pos; [apply Rmult_le_pos; lra|left; now apply Rinv_0_lt_compat].
  - pose proof (stiff_pos i Hi). lra.
Qed.
Lemma weight_split i (u : nat -> R) : sum (J + d) (fun l => weight i l * u l)
  = sum J (fun l => / 2 * (kvi i * Lf f / T * Rabs (fl l)) * u l) + sum d (fun j => / 2 * stiff i * u (J + j)%nat).
Proof.
  rewrite sum_split. f_equal; apply sum_ext; intros l Hl; unfold weight.
  - rewrite (proj2 (PeanoNat.Nat.ltb_lt l J)) by auto. reflexivity.
  - rewrite (proj2 (PeanoNat.Nat.ltb_ge (J + l) J)) by lia. reflexivity.
Qed.
Lemma weight_total i : sum (J + d) (weight i) = / 2 * (kvi i * Lf f / T * spread) + / 2 * (INR d * stiff i).
Proof.
  transitivity (sum (J + d) (fun l => weight i l * 1)); [apply sum_ext; intros; ring|]. rewrite weight_split. f_equal.
  - unfold spread. rewrite <- !sum_scal. apply sum_ext; intros; ring.
  - rewrite sum_const. ring.
Qed.

(** *** The potential: over a step from x to y the held torque of the present reading does not gain more than a square *)
Lemma potential_step x y : - P Gm y + sum n (fun i => kpi i * Uf f (qd i - y i))
  <= - P Gm x + sum n (fun i => kpi i * Uf f (qd i - x i))
     - sum n (fun i => (y i - x i) * (grav Gm x i + kpi i * hf f (qd i - x i))) + sum n (fun i => / 2 * stiff i * (y i - x i) ^ 2).
Proof.
  pose proof (P_above n Gm St x y) as A.
  assert (B : sum n (fun i => kpi i * Uf f (qd i - y i)) <= sum n (fun i => kpi i * Uf f (qd i - x i) - (y i - x i) * (kpi i * hf f (qd i - x i)) + / 2 * (kpi i * rhof f) * (y i - x i) ^ 2)).
  { apply sum_le. intros i Hi. pose proof (U_above f (qd i - x i) (qd i - y i)) as U. pose proof (kp_pos i Hi) as K.
    replace (qd i - y i - (qd i - x i)) with (- (y i - x i)) in U by ring. apply Rmult_le_compat_l with (r := kpi i) in U; [|lra].
    replace ((- (y i - x i)) ^ 2) with ((y i - x i) ^ 2) in U by ring. lra. }
  rewrite sum_plus, sum_minus in B.
  assert (E1 : sum n (fun i => (y i - x i) * (grav Gm x i + kpi i * hf f (qd i - x i))) = dot n (grav Gm x) (fun i => y i - x i) + sum n (fun i => (y i - x i) * (kpi i * hf f (qd i - x i)))).
  { unfold dot. rewrite <- sum_plus. apply sum_ext; intros; ring. }
  assert (E2 : sum n (fun i => / 2 * stiff i * (y i - x i) ^ 2) = sum n (fun i => / 2 * (kpi i * rhof f) * (y i - x i) ^ 2) + sum n (fun i => Gami i / 2 * (y i - x i) ^ 2)).
  { rewrite <- sum_plus. apply sum_ext; intros; unfold stiff; field. }
  lra.
Qed.

Section Along.
Variables (tk : nat -> R) (p : nat -> vec) (phi q w : R -> vec).
Hypothesis moves : sampled tk p phi q w.
Hypothesis friction : forall t i, tk 0%nat <= t -> (i < n)%nat -> 0 <= phi t i * w t i.
Definition step (s i : nat) : R := p (S s) i - p s i.

(** *** Old readings and velocities cost squares of past steps *)
Lemma late_costs k (x y : vec) : x = p (k + (J + d))%nat ->
  sum n (fun i => y i * (torque p k i - (grav Gm x i + kpi i * hf f (qd i - x i)))) <= sum n (fun i => sum (J + d) (fun l => weight i l * (y i ^ 2 + step (k + l) i ^ 2))).
Proof.
  intros ->. set (x := p (k + (J + d))%nat). set (old := p (k + J)%nat).
  assert (Tel : forall i, Rabs (old i - x i) <= sum d (fun j => Rabs (step (k + (J + j)) i))).
  { intros i. rewrite Rabs_minus_sym. unfold x, old. rewrite PeanoNat.Nat.add_assoc. eapply Rle_trans; [apply telescope|].
    right. apply sum_ext; intros j Hj. unfold step. now rewrite PeanoNat.Nat.add_assoc. }
  assert (Pos : forall i, (i < n)%nat -> y i * (kpi i * (hf f (qd i - old i) - hf f (qd i - x i))) <= sum d (fun j => / 2 * (kpi i * rhof f) * (y i ^ 2 + step (k + (J + j)) i ^ 2))).
  { intros i Hi. pose proof (kp_pos i Hi) as K. pose proof (rho_pos f) as R0. eapply Rle_trans; [apply Rle_abs|]. rewrite !Rabs_mult, (Rabs_pos_eq (kpi i)) by lra.
    pose proof (h_steep f (qd i - old i) (qd i - x i)) as Hs. replace (qd i - old i - (qd i - x i)) with (- (old i - x i)) in Hs by ring. rewrite Rabs_Ropp in Hs.
    apply Rle_trans with (kpi i * rhof f * (Rabs (y i) * sum d (fun j => Rabs (step (k + (J + j)) i)))).
    - apply Rle_trans with (Rabs (y i) * (kpi i * (rhof f * sum d (fun j => Rabs (step (k + (J + j)) i))))); [|right; ring].
      apply Rmult_le_compat_l; [apply Rabs_pos|]. apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [exact Hs|]. apply Rmult_le_compat_l; [auto|apply Tel].
    - rewrite <- !sum_scal. apply sum_le. intros j Hj. pose proof (young_abs (y i) (step (k + (J + j)) i)) as Y.
      apply Rmult_le_compat_l with (r := kpi i * rhof f) in Y; [|apply Rmult_le_pos; lra]. lra. }
  assert (Vel : forall i, (i < n)%nat -> y i * - (kvi i * hf f (velocity p k i)) <= sum J (fun l => / 2 * (kvi i * Lf f / T * Rabs (fl l)) * (y i ^ 2 + step (k + l) i ^ 2))).
  { intros i Hi. pose proof (kv_range n g i Hi) as [K _]. pose proof (L_pos f) as L0. eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult, Rabs_Ropp, Rabs_mult, (Rabs_pos_eq (kvi i)) by lra.
    pose proof (h_lip f (velocity p k i)) as Hl.
    assert (Hv : Rabs (velocity p k i) <= sum J (fun l => Rabs (fl l) * Rabs (step (k + l) i)) / T).
    { unfold velocity, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ T)) by (left; now apply Rinv_0_lt_compat). apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat|].
      eapply Rle_trans; [apply sum_abs|]. right. apply sum_ext; intros l Hl0. rewrite Rabs_mult. reflexivity. }
    apply Rle_trans with (Rabs (y i) * (kvi i * (Lf f * (sum J (fun l => Rabs (fl l) * Rabs (step (k + l) i)) / T)))).
    - apply Rmult_le_compat_l; [apply Rabs_pos|]. apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [exact Hl|]. apply Rmult_le_compat_l; lra.
    - replace (Rabs (y i) * (kvi i * (Lf f * (sum J (fun l => Rabs (fl l) * Rabs (step (k + l) i)) / T))))
        with (kvi i * Lf f / T * Rabs (y i) * sum J (fun l => Rabs (fl l) * Rabs (step (k + l) i))) by (field; lra).
      rewrite <- sum_scal. apply sum_le. intros l Hl0. pose proof (young_abs (y i) (step (k + l) i)) as Y.
      apply Rmult_le_compat_l with (r := kvi i * Lf f / T * Rabs (fl l)) in Y; [lra|].
      apply Rmult_le_pos; [|apply Rabs_pos]. apply Rmult_le_pos; [apply Rmult_le_pos; lra|left; now apply Rinv_0_lt_compat]. }
  assert (Gra : sum n (fun i => y i * (grav Gm old i - grav Gm x i)) <= sum n (fun i => sum d (fun j => / 2 * Gami i * (y i ^ 2 + step (k + (J + j)) i ^ 2)))).
  { apply Rle_trans with (sum n (fun i => sum d (fun j => Rabs (y i) * sum n (fun m => Gb St i m * Rabs (step (k + (J + j)) m))))).
    - apply sum_le. intros i Hi. eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult, sum_scal. apply Rmult_le_compat_l; [apply Rabs_pos|].
      eapply Rle_trans; [apply (Gb_up St); auto|]. rewrite sum_swap. apply sum_le. intros m Hm. rewrite sum_scal. apply Rmult_le_compat_l; [apply Gb_pos|apply Tel].
    - rewrite sum_swap. rewrite (sum_swap n d). apply sum_le. intros j Hj. eapply Rle_trans; [apply (rows n Gm St y (fun m => step (k + (J + j)) m))|].
      right. rewrite <- sum_scal. apply sum_ext; intros; ring. }
  apply Rle_trans with (sum n (fun i => y i * (kpi i * (hf f (qd i - old i) - hf f (qd i - x i))) + y i * - (kvi i * hf f (velocity p k i))) + sum n (fun i => y i * (grav Gm old i - grav Gm x i))).
  { right. rewrite <- sum_plus. apply sum_ext; intros i Hi. unfold torque. fold old. ring. }
  apply Rle_trans with (sum n (fun i => sum d (fun j => / 2 * (kpi i * rhof f) * (y i ^ 2 + step (k + (J + j)) i ^ 2)) + sum J (fun l => / 2 * (kvi i * Lf f / T * Rabs (fl l)) * (y i ^ 2 + step (k + l) i ^ 2)))
     + sum n (fun i => sum d (fun j => / 2 * Gami i * (y i ^ 2 + step (k + (J + j)) i ^ 2)))).
  { apply Rplus_le_compat; [|exact Gra]. apply sum_le. intros i Hi. apply Rplus_le_compat; [now apply Pos|now apply Vel]. }
  right. rewrite <- sum_plus. apply sum_ext; intros i Hi. rewrite (weight_split i (fun l => y i ^ 2 + step (k + l) i ^ 2)).
  replace (sum d (fun j => / 2 * stiff i * (y i ^ 2 + step (k + (J + j)) i ^ 2)))
    with (sum d (fun j => / 2 * (kpi i * rhof f) * (y i ^ 2 + step (k + (J + j)) i ^ 2)) + sum d (fun j => / 2 * Gami i * (y i ^ 2 + step (k + (J + j)) i ^ 2))); [ring|].
  rewrite <- sum_plus. apply sum_ext; intros; unfold stiff; ring.
Qed.

(** *** The energy with what is put by for the past, and the inequality *)
Definition stored (k : nat) : R := sum n (fun i => sum (J + d) (fun l => sum (S l) (weight i) * step (k + l) i ^ 2)).
Definition W (k : nat) : R := energy (q (tk k)) (w (tk k)) + stored k.
Variable X : R -> R.                               (* an integral of |w|^2 *)
Hypothesis X_rate : forall t, tk 0%nat <= t -> is_derive X t (dot n (w t) (w t)).
Variable c : R.
(** (S), with c to spare: b_i >= c + L k_vi sum |f| + (1/2 + d) T (rho k_pi + Gamma_i) *)
Hypothesis condition : forall i, (i < n)%nat -> c + Lf f * kvi i * spread + (/ 2 + INR d) * T * stiff i <= b rb i.

Lemma tk_order k : tk 0%nat <= tk k.
Proof. destruct moves as (O & _). induction k; [lra|]. destruct (O k). lra. Qed.
Lemma spread_pos : 0 <= spread.
Proof. apply sum_nonneg. intros; apply Rabs_pos. Qed.
Lemma interval k t : tk k < t <= tk (S k) ->
  energy (q t) (w t) + c * (X t - X (tk k)) + sum n (fun i => sum (J + d) (weight i) * (q t i - q (tk k) i) ^ 2)
  <= energy (q (tk k)) (w (tk k)) + sum n (fun i => sum (J + d) (fun l => weight i l * step (k + l) i ^ 2)).
Proof.
  intros Ht. destruct moves as (O & R & D & N). pose proof (tk_order k) as O0. destruct (O k) as [O1 O2].
  assert (C0 : forall i, (i < n)%nat -> c <= b rb i).
  { intros i Hi. specialize (condition i Hi). pose proof (stiff_pos i Hi). pose proof (kv_range n g i Hi) as [K _]. pose proof (L_pos f). pose proof spread_pos. pose proof (pos_INR d).
    assert (0 <= Lf f * kvi i * spread) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra).
    assert (0 <= (/ 2 + INR d) * T * stiff i) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra). lra. }
  pose proof (energy_held n rb Gt q w phi X (torque p k) (tk k) t c ltac:(lra)
    ltac:(intros s i Hs Hi; apply D; auto; lra) ltac:(intros s i Hs Hi; apply D; auto; lra) ltac:(intros s Hs; apply X_rate; lra)
    ltac:(intros s Hs; apply N; lra) ltac:(intros s i Hs Hi; apply friction; auto; lra) C0) as A.
  pose proof (potential_step (q (tk k)) (q t)) as B.
  pose proof (late_costs k (q (tk k)) (fun i => q t i - q (tk k) i) (eq_sym (R k))) as L1.
  assert (E1 : sum n (fun i => (q t i - q (tk k) i) * (torque p k i - (grav Gm (q (tk k)) i + kpi i * hf f (qd i - q (tk k) i))))
    = sum n (fun i => torque p k i * (q t i - q (tk k) i)) - sum n (fun i => (q t i - q (tk k) i) * (grav Gm (q (tk k)) i + kpi i * hf f (qd i - q (tk k) i)))).
  { rewrite <- sum_minus. apply sum_ext; intros; ring. }
  assert (E2 : sum n (fun i => sum (J + d) (fun l => weight i l * ((q t i - q (tk k) i) ^ 2 + step (k + l) i ^ 2)))
    = sum n (fun i => sum (J + d) (weight i) * (q t i - q (tk k) i) ^ 2) + sum n (fun i => sum (J + d) (fun l => weight i l * step (k + l) i ^ 2))).
  { rewrite <- sum_plus. apply sum_ext; intros i Hi. rewrite Rmult_comm, <- sum_scal, <- sum_plus. apply sum_ext; intros; ring. }
  assert (E3 : sum n (fun i => / 2 * stiff i * (q t i - q (tk k) i) ^ 2) + 2 * sum n (fun i => sum (J + d) (weight i) * (q t i - q (tk k) i) ^ 2)
    <= sum n (fun i => (b rb i - c) * (q t i - q (tk k) i) ^ 2 / (t - tk k))).
  { rewrite <- sum_scal, <- sum_plus. apply sum_le. intros i Hi. rewrite weight_total. specialize (condition i Hi). pose proof (pow2_ge_0 (q t i - q (tk k) i)) as Q.
    set (z := (q t i - q (tk k) i) ^ 2) in *.
    apply Rle_trans with ((b rb i - c) * z / T).
    - replace (/ 2 * stiff i * z + 2 * ((/ 2 * (kvi i * Lf f / T * spread) + / 2 * (INR d * stiff i)) * z)) with ((Lf f * kvi i * spread + (/ 2 + INR d) * T * stiff i) * z / T) by (field; lra).
      unfold Rdiv. apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat|]. apply Rmult_le_compat_r; lra.
    - unfold Rdiv. apply Rmult_le_compat_l; [apply Rmult_le_pos; [specialize (C0 i Hi); lra|auto]|]. apply Rinv_le_contravar; lra. }
  unfold energy. lra.
Qed.
Lemma weight_sum i l : (i < n)%nat -> weight i l <= sum (S l) (weight i).
Proof. intros Hi. simpl. assert (0 <= sum l (weight i)); [|lra]. apply sum_nonneg. intros; now apply weight_pos. Qed.
(** Between the readings the energy stays below W. *)
Theorem between k t : tk k <= t <= tk (S k) -> energy (q t) (w t) + c * (X t - X (tk k)) <= W k.
Proof.
  intros Ht. assert (A : sum n (fun i => sum (J + d) (fun l => weight i l * step (k + l) i ^ 2)) <= stored k).
  { apply sum_le. intros i Hi. apply sum_le. intros l Hl. apply Rmult_le_compat_r; [apply pow2_ge_0|]. now apply weight_sum. }
  assert (Z : forall u : vec, 0 <= sum n (fun i => sum (J + d) (weight i) * u i ^ 2)).
  { intros u. rewrite <- (Rmult_0_r (INR n)), <- sum_const. apply sum_le. intros i Hi. apply Rmult_le_pos; [|apply pow2_ge_0]. apply sum_nonneg. intros; now apply weight_pos. }
  unfold W. destruct (Req_dec t (tk k)) as [->|N].
  - assert (0 <= sum n (fun i => sum (J + d) (fun l => weight i l * step (k + l) i ^ 2))).
    { rewrite <- (Rmult_0_r (INR n)), <- sum_const. apply sum_le. intros i Hi. apply sum_nonneg. intros l. apply Rmult_le_pos; [now apply weight_pos|apply pow2_ge_0]. }
    lra.
  - pose proof (interval k t ltac:(lra)) as I. specialize (Z (fun i => q t i - q (tk k) i)). cbv beta in Z. lra.
Qed.
(** From reading to reading W falls by c times the integral of |w|^2 at least. *)
Theorem energy_step k : W (S k) + c * (X (tk (S k)) - X (tk k)) <= W k.
Proof.
  destruct moves as (O & R & _ & _). destruct (O k) as [O1 O2]. pose proof (interval k (tk (S k)) ltac:(lra)) as I.
  assert (E : stored (S k) = stored k + sum n (fun i => sum (J + d) (weight i) * (q (tk (S k)) i - q (tk k) i) ^ 2) - sum n (fun i => sum (J + d) (fun l => weight i l * step (k + l) i ^ 2))).
  { unfold stored. rewrite <- sum_plus, <- sum_minus. apply sum_ext; intros i Hi.
    rewrite (memory (J + d) (weight i) (fun s => step s i ^ 2) k). do 2 f_equal. f_equal. unfold step. rewrite <- (R k), <- (R (S k)). simpl. reflexivity. }
  unfold W. rewrite E. lra.
Qed.
Theorem energy_sum N : W N + c * (X (tk N) - X (tk 0%nat)) <= W 0.
Proof. induction N; [lra|]. pose proof (energy_step N). lra. Qed.
End Along.
End Sampled.
