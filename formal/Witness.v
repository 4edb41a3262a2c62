(** The hypotheses of S_suffices can be met: a gravity with its bounds, and a motion. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions SampledDefinitions.
Require Import Loop.
Require Import Sampled Rests Goal.
Open Scope R_scope.

(** g_i = a_i sin q_i *)
Definition pendulum_gravity (n : nat) (a : vec) : gravity n.
Proof.
  refine (Gravity n (fun q => sum n (fun i => a i * (1 - cos (q i)))) (fun q i => a i * sin (q i)) _).
  intros q t v H. apply (is_derive_sum n (fun i s => a i * (1 - cos (q s i))) (fun i => a i * sin (q t i) * v i)). intros i Hi.
  evar_last.
  - apply (is_derive_comp (fun x => a i * (1 - cos x)) (fun s => q s i) t (a i * sin (q t i)) (v i)); [auto_derive; auto; ring|now apply H].
  - unfold scal; simpl; unfold mult; simpl; ring.
Defined.
Definition pendulum_steepness (n : nat) (a : vec) : steepness n (pendulum_gravity n a).
Proof.
  refine (Steepness n _ (fun i j => if Nat.eqb j i then Rabs (a i) else 0) _ _ _).
  - intros i j. destruct (Nat.eqb j i); [apply Rabs_pos|lra].
  - intros i j. destruct (PeanoNat.Nat.eq_dec i j) as [->|N]; [reflexivity|].
    rewrite (proj2 (PeanoNat.Nat.eqb_neq j i)), (proj2 (PeanoNat.Nat.eqb_neq i j)) by auto. reflexivity.
  - intros x y i Hi. simpl. replace (a i * sin (x i) - a i * sin (y i)) with (a i * (sin (x i) - sin (y i))) by ring. rewrite Rabs_mult.
    apply Rle_trans with (Rabs (a i) * Rabs (x i - y i)).
    + apply Rmult_le_compat_l; [apply Rabs_pos|]. destruct (MVT_gen sin (y i) (x i) cos) as (s & _ & E).
      * intros; auto_derive; auto; ring.
      * intros z _. apply continuity_pt_filterlim. apply continuous_sin.
      * rewrite E, Rabs_mult. pose proof (COS_bound s). assert (Rabs (cos s) <= 1) by (apply Rabs_le; lra). pose proof (Rabs_pos (x i - y i)). nra.
    + right. symmetry. rewrite <- (sum_delta n (fun j => Rabs (a i) * Rabs (x j - y j)) i Hi). apply sum_ext. intros j Hj. destruct (Nat.eqb j i); ring.
Defined.
(** At the goal the loop rests, and this is a motion. *)
Theorem rest_runs n rb (G : gravity n) f g qd J d fl T : 0 < T -> runs n rb G f g qd J d fl T (fun k => INR k * T) (fun _ => qd) (fun _ => qd) (fun _ _ => 0).
Proof.
  intros HT. assert (Z : forall k (c : nat -> R), sum k (fun i => c i * 0) = 0) by (intros; induction k; simpl; [|rewrite IHk]; ring).
  split; [split; [|split; [|split]]|].
  - intros k. rewrite S_INR. nra.
  - reflexivity.
  - intros t i _ _. split; [apply (is_derive_const (V := R_NormedModule))|apply continuous_const].
  - intros k t _ i Hi. split; [exists 0; apply (is_derive_const (V := R_NormedModule))|].
    assert (A0 : forall A : mat, apply_ n A (fun _ => 0) i = 0) by (intros A; apply (Z n (A i))).
    replace (fun j : nat => Derive (fun _ : R => 0) t) with (fun _ : nat => 0) by (apply FunctionalExtensionality.functional_extensionality; intros; symmetry; apply Derive_const).
    rewrite !A0. unfold torque.
    assert (V0 : velocity J fl T (fun _ => qd) k i = 0).
    { unfold velocity. assert (E : sum J (fun l => fl l * (qd i - qd i)) = 0) by (transitivity (sum J (fun l => fl l * 0)); [apply sum_ext; intros; ring|apply Z]). rewrite E. unfold Rdiv. ring. }
    rewrite V0. replace (qd i - qd i) with 0 by ring. rewrite h_zero. ring.
  - intros t. destruct (nfloor_ex (Rabs t / T)) as [k [_ Hk]]; [apply Rmult_le_pos; [apply Rabs_pos|left; now apply Rinv_0_lt_compat]|].
    exists (S k). rewrite S_INR. apply Rle_trans with (Rabs t); [apply Rle_abs|]. left. apply Rlt_div_l in Hk; lra.
Qed.
