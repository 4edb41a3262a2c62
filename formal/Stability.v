(** The paper's proposition for its own family, every m >= 1; and a robot that meets the hypotheses. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Require Family Loop Converge.
Import Loop.
Open Scope R_scope.

(** h_m with bounds that hold for every m; sharper ones for single m are in Sharp.v. *)
Definition hyperbolic (m : nat) (Hm : (1 <= m)%nat) : member.
Proof.
  refine (Member (h m) (dh m) (U m) (sqrt 2) (4 * INR m) (4 * INR m)
    (sqrt_pos 2) _ _ (Family.h_derive m Hm) (Family.U_derive m Hm) _ _ _ (Family.U_zero m Hm)
    (Family.h_lt_sqrt2 m Hm) (Family.dh_bounded m Hm) _).
  - pose proof (pos_INR m). lra.
  - assert (0 < INR m) by (apply lt_0_INR; lia). lra.
  - intros x. apply Family.h_sign; auto.
  - apply Family.h_zero; auto.
  - intros x. apply Family.U_pos; auto.
  - intros x. apply Family.h_lipschitz_at_0; auto.
Defined.

Theorem proper m (Hm : (1 <= m)%nat) : forall K, exists r, forall x, U m x <= K -> Rabs x <= r.
Proof. intros K. exists (K + ln 4). intros x H. pose proof (Family.U_grows m Hm x). lra. Qed.

(** Positive gains have a least and a largest. *)
Lemma some_gains n kp kv : (forall i, (i < n)%nat -> 0 < kp i) -> (forall i, (i < n)%nat -> 0 <= kv i) ->
  exists g : gains n, Loop.kp n g = kp /\ Loop.kv n g = kv.
Proof.
  intros Hp Hv.
  assert (A : exists lo, 0 < lo /\ forall i, (i < n)%nat -> lo <= kp i).
  { clear Hv kv. induction n as [|k IH]; [exists 1; split; [lra|intros; lia]|].
    destruct IH as (lo & P & H); [intros; apply Hp; lia|]. exists (Rmin lo (kp k)). split; [apply Rmin_pos; auto|].
    intros i Hi. destruct (PeanoNat.Nat.eq_dec i k) as [->|]; [apply Rmin_r|]. eapply Rle_trans; [apply Rmin_l|]. apply H. lia. }
  assert (B : exists hi, 0 <= hi /\ forall i, (i < n)%nat -> kv i <= hi).
  { clear Hp A kp. induction n as [|k IH]; [exists 0; split; [lra|intros; lia]|].
    destruct IH as (hi & P & H); [intros; apply Hv; lia|]. exists (Rmax hi (kv k)). split; [eapply Rle_trans; [exact P|apply Rmax_l]|].
    intros i Hi. destruct (PeanoNat.Nat.eq_dec i k) as [->|]; [apply Rmax_r|]. eapply Rle_trans; [|apply Rmax_l]. apply H. lia. }
  destruct A as (lo & P & A), B as (hi & Q & B).
  exists (Gains n kp kv lo hi P Q A (fun i Hi => conj (Hv i Hi) (B i Hi))). auto.
Qed.

Section Member.
Variable m : nat.
Hypothesis Hm : (1 <= m)%nat.

(** For every n, every m >= 1, every robot with Properties 2.1 to 2.7, all positive gains and every goal. *)
Theorem proposition_of_the_paper n : every_robot_is_stable n m.
Proof.
  intros rb kp kv qd Hp Hv. destruct (some_gains n kp kv Hp) as (g & <- & <-); [intros i Hi; left; auto|].
  destruct (Converge.stable_for_some_eps0 n rb (hyperbolic m Hm) g (proper m Hm) qd) as (eps0 & _ & _ & S). exact S.
Qed.
(** And V of (13) shows it, with some eps0. *)
Theorem V_of_the_paper n (rb : robot n) kp kv qd : positive n kp -> positive n kv ->
  exists eps0, 0 < eps0 /\ decreasing n (M rb) (C rb) (b rb) (h m) (U m) kp kv qd eps0.
Proof.
  intros Hp Hv. destruct (some_gains n kp kv Hp) as (g & <- & <-); [intros i Hi; left; auto|].
  destruct (Converge.stable_for_some_eps0 n rb (hyperbolic m Hm) g (proper m Hm) qd) as (eps0 & P & D & _). eauto.
Qed.
(** (21): every goal of bounded velocity is tracked, from wherever and whenever a motion starts. *)
Theorem tracking_of_the_paper n : every_robot_tracks n m.
Proof.
  intros rb kp kv Hp Hv r v vd H. destruct (some_gains n kp kv Hp) as (g & <- & <-); [intros i Hi; left; auto|].
  exact (Converge.tracks_for_some_eps0 n rb (hyperbolic m Hm) g (proper m Hm) r v vd H).
Qed.

Lemma not_away n e w : ~ away n e w -> forall i, (i < n)%nat -> e i = 0 /\ w i = 0.
Proof.
  intros H i Hi. split; [destruct (Req_dec (e i) 0)|destruct (Req_dec (w i) 0)]; auto; exfalso; apply H; exists i; auto.
Qed.
Lemma sum_0 k f : (forall i, (i < k)%nat -> f i = 0) -> sum k f = 0.
Proof. intros H. rewrite (sum_ext k f (fun _ => 0) H), sum_const. ring. Qed.
Lemma dot_0 n x y : (forall i, (i < n)%nat -> x i = 0) -> dot n x y = 0.
Proof. intros H. apply sum_0. intros i Hi. rewrite (H i Hi). ring. Qed.
Lemma norm_0 n x : (forall i, (i < n)%nat -> x i = 0) -> norm n x = 0.
Proof. intros H. unfold norm. rewrite dot_0 by auto. apply sqrt_0. Qed.

Theorem V_is_positive_definite : V_positive_definite m.
Proof.
  intros n rb kp qd eps0 Hp P e w. destruct (some_gains n kp (fun _ => 0) Hp) as (g & <- & _); [intros; lra|]. split.
  - exact (Converge.V_positive n rb (hyperbolic m Hm) g (proper m Hm) eps0 P qd e w).
  - intros H. pose proof (not_away n e w H) as Z. unfold V.
    assert (Y : forall i, (i < n)%nat -> y_of n (h m) eps0 e w i = 0).
    { intros i Hi. unfold y_of. destruct (Z i Hi) as [-> ->]. rewrite (Family.h_zero m Hm). ring. }
    rewrite (dot_0 n _ _ Y), sum_0; [ring|]. intros i Hi. destruct (Z i Hi) as [-> _]. rewrite (Family.U_zero m Hm). ring.
Qed.
Theorem V_is_radially_unbounded : V_radially_unbounded m.
Proof.
  intros n rb kp qd eps0 Hp P K. destruct (some_gains n kp (fun _ => 0) Hp) as (g & <- & _); [intros; lra|].
  destruct (Converge.V_unbounded n rb (hyperbolic m Hm) g (proper m Hm) eps0 P K) as [r H].
  exists (sqrt (INR n) * Rabs r). intros e w HV. pose proof (H qd e w HV) as B.
  split; apply Converge.bounded_norm_in; try apply Rabs_pos; intros i Hi; (eapply Rle_trans; [apply (B i Hi)|apply Rle_abs]).
Qed.
(** V for the robot with M = c I. *)
Lemma V_like_definite n kp eps0 c : positive n kp -> 0 < eps0 -> 0 < c -> definite n (V_like n m kp eps0 c).
Proof.
  intros Hp P Hc e w. assert (T : forall i, (i < n)%nat -> 0 <= kp i * U m (e i)).
  { intros i Hi. apply Rmult_le_pos; [left; now apply Hp|]. destruct (Req_dec (e i) 0) as [->|N]; [rewrite (Family.U_zero m Hm); lra|left; now apply (Family.U_pos m Hm)]. }
  pose proof (dot_pos n (y_of n (h m) eps0 e w)) as Y. pose proof (Converge.sum_nonneg_in n _ T) as S0. unfold V_like. split.
  - intros (i & Hi & Hz). destruct (Req_dec (e i) 0) as [E|E].
    + assert (W : w i <> 0) by (destruct Hz; [contradiction|auto]).
      assert (0 < dot n (y_of n (h m) eps0 e w) (y_of n (h m) eps0 e w)).
      { pose proof (term_le_sum n (fun j => y_of n (h m) eps0 e w j * y_of n (h m) eps0 e w j) i ltac:(intros; nra) Hi) as K.
        unfold dot. cbv beta in K. unfold y_of at 1 2 in K. rewrite E, (Family.h_zero m Hm), Rmult_0_r, Rminus_0_r in K. nra. }
      assert (0 < c / 2 * dot n (y_of n (h m) eps0 e w) (y_of n (h m) eps0 e w)) by (apply Rmult_lt_0_compat; lra). lra.
    + assert (0 < kp i * U m (e i)) by (apply Rmult_lt_0_compat; [now apply Hp|now apply (Family.U_pos m Hm)]).
      pose proof (Converge.term_le_sum_in n (fun i => kp i * U m (e i)) i T Hi). cbv beta in *.
      assert (0 <= c / 2 * dot n (y_of n (h m) eps0 e w) (y_of n (h m) eps0 e w)) by (apply Rmult_le_pos; lra). lra.
  - intros H. pose proof (not_away n e w H) as Z. rewrite dot_0, sum_0; [ring| |].
    + intros i Hi. destruct (Z i Hi) as [-> _]. rewrite (Family.U_zero m Hm). ring.
    + intros i Hi. unfold y_of. destruct (Z i Hi) as [-> ->]. rewrite (Family.h_zero m Hm). ring.
Qed.
Theorem V_is_bounded_below : V_bounded_below m.
Proof.
  intros n rb kp eps0 Hp P. exists (alpha rb). split; [apply V_like_definite; auto using alpha_pos|]. intros qd e w. unfold V_like, V.
  apply Rplus_le_compat_r. set (y := y_of n (h m) eps0 e w). pose proof (M_low rb (fun j => qd j - e j) y). lra.
Qed.
Theorem V_is_bounded_above : V_bounded_above m.
Proof.
  intros n rb kp eps0 Hp P. exists (beta rb + 1). pose proof (beta_pos rb). split; [apply V_like_definite; auto; lra|]. intros qd e w. unfold V_like, V.
  apply Rplus_le_compat_r. set (y := y_of n (h m) eps0 e w). set (My := apply_ n (M rb (fun j => qd j - e j)) y).
  pose proof (cauchy_schwarz n y My). pose proof (M_up rb (fun j => qd j - e j) y) as K. fold My in K. pose proof (norm_pos n y). pose proof (norm2 n y). nra.
Qed.
Theorem origin_is_equilibrium_of_tracking : equilibrium_of_tracking m.
Proof.
  intros n rb kp kv r v e w H t _ i Hi. pose proof (not_away n e w H) as Z. destruct (Z i Hi) as [Ei Wi]. split; [|split].
  - rewrite Wi. evar_last; [apply (is_derive_const (V := R_NormedModule))|]. unfold zero; simpl. ring.
  - eexists. apply (is_derive_const (V := R_NormedModule)).
  - unfold apply_. rewrite (dot_sym n (M rb _ i)), (dot_sym n (C rb _ _ i)), !dot_0.
    + rewrite Ei, Wi, (Family.h_zero m Hm). ring.
    + intros j Hj. apply (Z j Hj).
    + intros j Hj. apply Derive_const.
Qed.
Theorem origin_is_only_equilibrium : only_equilibrium m.
Proof.
  intros n rb kp kv qd Hp Hv e w. split.
  - intros S (i & Hi & Hz).
    assert (W : forall j, (j < n)%nat -> w j = 0).
    { intros j Hj. destruct (S j Hj) as (D & _ & _). pose proof (is_derive_unique _ _ _ D) as E. rewrite Derive_const in E. lra. }
    destruct Hz as [Hz|Hz]; [|now apply Hz, W]. destruct (S i Hi) as (_ & _ & N).
    assert (N0 : apply_ n (M rb (fun j => qd j - e j)) (fun j => Derive (fun _ : R => w j) 0) i = 0).
    { unfold apply_, dot. apply sum_0. intros j Hj. rewrite Derive_const. ring. }
    assert (C0 : apply_ n (C rb (fun j => qd j - e j) w) w i = 0).
    { unfold apply_, dot. apply sum_0. intros j Hj. rewrite (W j Hj). ring. }
    cbv zeta in N. rewrite N0, C0, (W i Hi), (Family.h_zero m Hm) in N.
    pose proof (Family.h_sign m Hm (e i) Hz). pose proof (Hp i Hi). assert (kp i * h m (e i) = 0) by lra.
    destruct (Rmult_integral _ _ H1); [lra|]. rewrite H2 in H. lra.
  - intros H i Hi. pose proof (not_away n e w H) as Z. destruct (Z i Hi) as [Ei Wi]. split; [|split].
    + rewrite Wi. evar_last; [apply (is_derive_const (V := R_NormedModule))|]. unfold zero; simpl. ring.
    + eexists. apply (is_derive_const (V := R_NormedModule)).
    + cbv zeta. assert (N0 : apply_ n (M rb (fun j => qd j - e j)) (fun j => Derive (fun _ : R => w j) 0) i = 0).
      { unfold apply_, dot. apply sum_0. intros j Hj. rewrite Derive_const. ring. }
      assert (C0 : apply_ n (C rb (fun j => qd j - e j) w) w i = 0).
      { unfold apply_, dot. apply sum_0. intros j Hj. rewrite (proj2 (Z j Hj)). ring. }
      rewrite N0, C0, Ei, Wi, (Family.h_zero m Hm). ring.
Qed.
End Member.

(** The hypotheses can be met: n equal pendulums, M = I, C = 0, B = I. *)
Definition diag1 : mat := fun i j => if Nat.eqb i j then 1 else 0.
Lemma diag1_row n x i : dot n (diag1 i) x = if Nat.ltb i n then x i else 0.
Proof.
  unfold dot. induction n; [destruct (Nat.ltb_spec i 0); [lia|reflexivity]|].
  simpl sum. rewrite IHn. unfold diag1. destruct (Nat.eqb_spec i n) as [->|N].
  - destruct (Nat.ltb_spec n n), (Nat.ltb_spec n (S n)); try lia. ring.
  - destruct (Nat.ltb_spec i n), (Nat.ltb_spec i (S n)); try lia; ring.
Qed.
Lemma sum_in k u v : (forall i, (i < k)%nat -> u i = v i) -> sum k u = sum k v.
Proof. intros H; induction k; simpl; auto. rewrite IHk, H; auto. Qed.
Lemma diag1_dot n x : dot n x (apply_ n diag1 x) = dot n x x.
Proof.
  unfold dot at 1 2. apply sum_in. intros i Hi. unfold apply_. rewrite diag1_row.
  destruct (Nat.ltb_spec i n); [reflexivity|lia].
Qed.
Lemma diag1_norm n x : norm n (apply_ n diag1 x) = norm n x.
Proof.
  unfold norm. f_equal. unfold dot. apply sum_in. intros i Hi. unfold apply_. rewrite diag1_row.
  destruct (Nat.ltb_spec i n); [reflexivity|lia].
Qed.
Definition pendulums (n : nat) : robot n.
Proof.
  refine (Robot n (fun _ => diag1) (fun _ _ _ _ => 0) (fun _ => 1) 1 1 0 1 1 _ _ _ _ _ _ _ _ _ _ _); try lra.
  - intros _ i j _ _. unfold diag1. now rewrite Nat.eqb_sym.
  - intros _ x. rewrite diag1_dot. lra.
  - intros _ x. rewrite diag1_norm. lra.
  - intros q t v _ i j _ _. evar_last; [apply (is_derive_const (V := R_NormedModule))|]. unfold zero; simpl. ring.
  - intros _ x y. replace (norm n (apply_ n (fun _ _ => 0) y)) with 0; [lra|].
    unfold norm. replace (dot n (apply_ n (fun _ _ => 0) y) (apply_ n (fun _ _ => 0) y)) with 0; [now rewrite sqrt_0|]. symmetry.
    assert (Z : forall u : vec, dot n (fun _ => 0) u = 0).
    { intros u. unfold dot. rewrite (sum_ext n _ (fun _ => 0)) by (intros; ring). rewrite sum_const. ring. }
    unfold dot at 1. rewrite (sum_ext n _ (fun _ => 0)); [rewrite sum_const; ring|]. intros i Hi. unfold apply_. rewrite Z. ring.
  - intros; lra.
Defined.

