(** (S) from booleans of rational numbers: the loop on a computer of SampledDefinitions.v, with bounds of gravity that are known
    or found in a potential. *)
From Coq Require Import Reals QArith Qreals Qabs Qminmax List Lra Lia Psatz Bool ZArith FunctionalExtensionality.
From Coquelicot Require Import Coquelicot.
Require Import Definitions GateDefinitions SampledDefinitions.
Require Family Stability Loop Converge.
Require Import Arm Gravity Gate Sampled Rests Goal Steep.
Import ListNotations.
Open Scope R_scope.
Local Arguments Qred : simpl never. Local Arguments Q2R : simpl never. Local Arguments Qplus : simpl never.
Local Arguments Qminus : simpl never. Local Arguments Qmult : simpl never. Local Arguments Qopp : simpl never.

Lemma Q2R_min x y : Q2R (Qmin x y) = Rmin (Q2R x) (Q2R y).
Proof.
  destruct (Q.min_spec x y) as [[L E]|[L E]].
  - rewrite (Qeq_eqR _ _ E), Rmin_left; [reflexivity|now apply Rlt_le, Qlt_Rlt].
  - rewrite (Qeq_eqR _ _ E), Rmin_right; [reflexivity|now apply Qle_Rle].
Qed.
Definition Qsum (m : nat) (f : nat -> Q) : Q := fold_right (fun i s => Qred (f i + s)) 0%Q (seq 0 m).
Lemma Qsum_up m f : Q2R (Qsum m f) = sum m (fun i => Q2R (f i)).
Proof.
  unfold Qsum. assert (K : forall l a, Q2R (fold_right (fun i s => Qred (f i + s)) 0%Q (l ++ [a])) = Q2R (fold_right (fun i s => Qred (f i + s)) 0%Q l) + Q2R (f a)).
  { induction l as [|b l IH]; intros a; cbn [fold_right app]; rewrite !Q2R_red, !Q2R_plus; [rewrite Q2R_0; lra|rewrite IH; lra]. }
  induction m as [|m IH]; [simpl; now rewrite Q2R_0|]. rewrite seq_S, K, IH. reflexivity.
Qed.

Section Period.
Variable D : computed.
Notation n := (joints_of D).
Notation m := (its_m D).
Notation J := (length (taps D)).
Notation at_ l i := (nth i l 0%Q).
Variables ro Lp ga : Q.
Variable k : list Q.
(** What each b_i must exceed. *)
Definition steep_Q (i : nat) : Q := Qsum n (fun j => Qmin (Qabs (at_ k i)) (Qabs (at_ k j))).
Definition spread_Q : Q := Qsum J (fun l => Qabs (at_ (rev (taps D)) l)).
Definition needed (i : nat) : Q := (stretch D * (Lp * at_ (its_kv D) i * spread_Q +
  ((1 # 2) + inject_Z (Z.of_nat (late D))) * period D * (at_ (its_kp D) i * ro + steep_Q i)))%Q.
Definition less (x y : Q) : bool := negb (Qle_bool y x).
Definition check_S : bool := less 0 (stretch D) && Qle_bool 0 ro && less 0 Lp && Qle_bool 0 ga && forall_to n (fun i =>
  less 0 (at_ (its_kp D) i) && less 0 (at_ (its_kv D) i) && less (needed i) (at_ (least_b D) i)).
Hypothesis m_pos : (1 <= m)%nat.
Hypothesis h_bound : forall x, Rabs (h m x) <= Q2R ga.
Hypothesis dh_bound : forall x, Rabs (dh m x) <= Q2R ro.
Hypothesis secant : forall x, Rabs (h m x) <= Q2R Lp * Rabs x.
Hypothesis checked : check_S = true.
Variable G : gravity n.
Hypothesis R0 : revolute n G.
Hypothesis k_up : forall q i, (i < n)%nat -> Rabs (grav G q i) <= entries k i.
Notation St := (steepness_of n G R0 (entries k) k_up).

Lemma parts : 0 < Q2R (stretch D) /\ 0 <= Q2R ro /\ 0 < Q2R Lp /\ 0 <= Q2R ga /\ forall i, (i < n)%nat ->
  0 < entries (its_kp D) i /\ 0 < entries (its_kv D) i /\ Q2R (needed i) < entries (least_b D) i.
Proof.
  pose proof checked as H. unfold check_S, less in H. repeat (apply andb_prop in H; let K := fresh "K" in destruct H as [H K]).
  apply less_Q in H, K1. apply le_Q in K0, K2. rewrite Q2R_0 in *. repeat split; auto; pose proof (forall_to_true _ _ K i H0) as A; cbv beta in A;
    apply andb_prop in A; destruct A as [A A3]; apply andb_prop in A; destruct A as [A1 A2]; apply less_Q in A1, A2, A3; rewrite ?Q2R_0 in *; auto.
Qed.
Definition f0 : Loop.member := let P := parts in
  Goal.family m m_pos (Q2R ga) (Q2R ro) (Q2R Lp) (proj1 (proj2 (proj2 (proj2 P)))) (proj1 (proj2 P)) (proj1 (proj2 (proj2 P))) h_bound dh_bound secant.
Definition fl (l : nat) : R := Q2R (stretch D) * entries (rev (taps D)) l.
Section Loop.
Variables (T : R) (rb : robot n) (g : Loop.gains n).
Hypothesis ok : admitted D T rb.
Hypothesis kp_is : Loop.kp n g = entries (its_kp D).
Hypothesis kv_is : Loop.kv n g = entries (its_kv D).
Notation T' := (Q2R (stretch D) * T).
Lemma T_pos : 0 < T'. Proof. destruct ok as [[A _] _]. destruct parts as [B _]. now apply Rmult_lt_0_compat. Qed.
Lemma same_torque Gm qd p : torque n Gm f0 g qd J fl T' p = held D Gm qd T p.
Proof.
  assert (V : forall j, velocity J fl T' p j = speed D T p j).
  { intros j. apply functional_extensionality. intros i. unfold velocity, speed, fl. destruct ok as [[A _] _]. destruct parts as [B _].
    rewrite (Loop.sum_ext J _ (fun l => Q2R (stretch D) * (entries (rev (taps D)) l * (p (S (j + l)) i - p (j + l)%nat i)))) by (intros; ring).
    rewrite Loop.sum_scal. field. lra. }
  apply functional_extensionality. intros j. apply functional_extensionality. intros i. unfold torque, held. now rewrite V, kp_is, kv_is.
Qed.
Lemma spread_is : spread J fl = Q2R (stretch D) * Q2R spread_Q.
Proof.
  unfold spread, spread_Q, fl. destruct parts as [B _]. rewrite Qsum_up, <- Loop.sum_scal. apply Loop.sum_ext. intros l _.
  rewrite Rabs_mult, (Rabs_pos_eq (Q2R (stretch D))) by lra. now rewrite Q2R_abs.
Qed.
Lemma Gam_is i : Gam n G St i = Q2R (steep_Q i).
Proof.
  unfold Gam, steep_Q. rewrite Qsum_up. apply Loop.sum_ext. intros j _. rewrite Q2R_min, !Q2R_abs. reflexivity.
Qed.
Lemma S_here i : (i < n)%nat -> Loop.Lf f0 * Loop.kv n g i * spread J fl + (/ 2 + INR (late D)) * T' * stiff n G St f0 g i < b rb i.
Proof.
  intros Hi. destruct ok as [[A1 A2] B]. specialize (B i Hi). destruct parts as (P1 & P2 & P3 & P4 & P5). destruct (P5 i Hi) as (K1 & K2 & K3).
  unfold stiff. rewrite kp_is, kv_is, spread_is, Gam_is. change (Loop.Lf f0) with (Q2R Lp). change (Loop.rhof f0) with (Q2R ro).
  unfold needed in K3. repeat (rewrite ?Q2R_mult, ?Q2R_plus in K3). rewrite Q2R_inject, <- INR_IZR_INZ in K3. replace (Q2R (1 # 2)) with (/ 2) in K3 by (unfold Q2R; simpl; lra).
  assert (G0 : 0 <= Q2R (steep_Q i)) by (rewrite <- Gam_is; apply Gam_pos).
  set (late_ := / 2 + INR (late D)) in *. assert (L0 : 0 <= late_) by (unfold late_; pose proof (pos_INR (late D)); lra).
  fold (entries (its_kp D) i) (entries (its_kv D) i) in K3. change (Q2R (at_ (its_kp D) i)) with (entries (its_kp D) i) in K3. change (Q2R (at_ (its_kv D) i)) with (entries (its_kv D) i) in K3.
  set (x := entries (its_kp D) i * Q2R ro + Q2R (steep_Q i)) in *. assert (X0 : 0 <= x) by (unfold x; assert (0 <= entries (its_kp D) i * Q2R ro) by (apply Rmult_le_pos; lra); lra).
  assert (Q2R (stretch D) * (late_ * T * x) <= Q2R (stretch D) * (late_ * Q2R (period D) * x)).
  { apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_r; auto. apply Rmult_le_compat_l; auto. }
  lra.
Qed.
Definition kg0 : R := sum n (fun i => Rabs (entries k i)).
Lemma kg_up q i : (i < n)%nat -> Rabs (grav G q i) <= kg0.
Proof.
  intros Hi. eapply Rle_trans; [now apply k_up|]. eapply Rle_trans; [apply Rle_abs|].
  exact (Loop.term_le_sum n (fun i => Rabs (entries k i)) i ltac:(intros; apply Rabs_pos) Hi).
Qed.
Lemma same_motion Gt qd tk p phi q w : moves D rb Gt G qd T tk p phi q w ->
  sampled n rb Gt G f0 g qd J (late D) fl T' tk p phi q w /\ forall t, exists j, t <= tk j.
Proof.
  intros (A & B & C & E & F). split; [|exact B]. split; [exact A|]. split; [exact C|]. split; [exact E|]. intros j t Ht. rewrite same_torque. exact (F j t Ht).
Qed.
End Loop.
Lemma gains_exist : exists g : Loop.gains n, Loop.kp n g = entries (its_kp D) /\ Loop.kv n g = entries (its_kv D).
Proof. destruct parts as (_ & _ & _ & _ & P). apply Stability.some_gains; intros i Hi; destruct (P i Hi) as (A & B & _); lra. Qed.

Theorem goal_reached : sampled_goal D G.
Proof.
  intros T rb qd ok. destruct gains_exist as (g & Kp & Kv). pose proof (S_here T rb g ok Kp Kv) as HS. pose proof (T_pos T rb ok) as HT. split.
  - intros eta He. destruct (Goal.is_stable n rb G St f0 g qd J (late D) fl _ HT (Stability.proper m m_pos) HS eta He) as (z & Z & H).
    exists z. split; auto. intros tk p q w M. apply H. now apply same_motion.
  - intros tk p q w M. apply (Goal.is_attractive n rb G St f0 g qd J (late D) fl _ kg0 HT (Stability.proper m m_pos) kg_up HS tk p q w). now apply same_motion.
Qed.
Theorem rest_reached : sampled_rest D G.
Proof.
  intros T rb qd Gt ok [[top Top] _] [kt Kt] tk p phi q w M Fr eta He. destruct gains_exist as (g & Kp & Kv). pose proof (S_here T rb g ok Kp Kv) as HS.
  destruct (same_motion T rb g ok Kp Kv Gt qd tk p phi q w M) as [M' C]. destruct (to_spare n rb G St f0 g J (late D) fl _ HS) as (c & C0 & HC).
  pose proof R0 as [[top' Top'] _].
  destruct (comes_to_rest n rb Gt G St f0 g qd J (late D) fl _ (T_pos T rb ok) c C0 HC (Rmax kt kg0) (- top - top')) with (tk := tk) (p := p) (phi := phi) (q := q) (w := w) (eta := eta) as (t1 & _ & H); auto.
  - intros x i Hi. eapply Rle_trans; [now apply Kt|apply Rmax_l].
  - intros x i Hi. eapply Rle_trans; [now apply kg_up|apply Rmax_r].
  - intros x. unfold potential. pose proof (Top x) as A. pose proof (Top' x) as B. apply Rabs_le_between in A, B.
    assert (0 <= sum n (fun i => Loop.kp n g i * Loop.Uf f0 (qd i - x i))); [|lra]. apply Converge.sum_nonneg_in. intros i Hi.
    apply Rmult_le_pos; [pose proof (Sampled.kp_pos n g i Hi); lra|apply Converge.U_nonneg].
  - now exists t1.
Qed.
End Period.

(** ** The gravity of a potential with parameters *)
Section Potential.
Variable n : nat.
Variable pot : list monomial.
Variable ranges : list (Q * Q).
Notation mine := (groups (items n (fun us => us) pot)).
Definition simple : bool := short ranges mine && forallb (fun it : item => forallb (fun t : harmonic =>
  forall_to n (fun j => Z.leb (Z.abs (nth j (fst (fst t)) 0%Z)) 1)) (snd it)) mine.
Definition pulls_kept (k : list Q) : bool := forall_to n (fun i => let gs := groups (items n (map (slope i)) pot) in
  short ranges gs && Qle_bool (size_with ranges gs) (nth i k 0%Q)).
Variables (p : vec) (G : gravity n).
Hypothesis Hp : in_ranges ranges p.
Hypothesis HP : forall q, P G q = poly_with n pot p q.
Lemma phase_turned j t q l : (j < n)%nat -> phase n l (turned j t q) = phase n l q + IZR (nth j l 0%Z) * t.
Proof.
  intros Hj. unfold phase, turned. transitivity (sum n (fun i => IZR (nth i l 0%Z) * q i) + sum n (fun i => IZR (nth i l 0%Z) * t * (if Nat.eqb i j then 1 else 0))).
  - rewrite <- Loop.sum_plus. apply Loop.sum_ext. intros i _. destruct (Nat.eqb i j); ring.
  - f_equal. exact (sum_delta n (fun i => IZR (nth i l 0%Z) * t) j Hj).
Qed.
Lemma wave_circle j q (t : harmonic) : (j < n)%nat -> (Z.abs (nth j (fst (fst t)) 0%Z) <= 1)%Z ->
  exists x y z, forall s, wave n (turned j s q) t = x + y * cos s + z * sin s.
Proof.
  intros Hj Hk. destruct t as [[l a] c]. cbn [fst] in Hk. unfold wave.
  assert (C : (nth j l 0 = -1 \/ nth j l 0 = 0 \/ nth j l 0 = 1)%Z) by lia. set (u := phase n l q). destruct C as [C|[C|C]].
  - exists 0, (Q2R a * cos u + Q2R c * sin u), (Q2R a * sin u - Q2R c * cos u). intros s. rewrite phase_turned, C by auto. fold u. replace (u + -1 * s) with (u - s) by ring. rewrite cos_minus, sin_minus. ring.
  - exists (Q2R a * cos u + Q2R c * sin u), 0, 0. intros s. rewrite phase_turned, C by auto. fold u. replace (u + 0 * s) with u by ring. ring.
  - exists 0, (Q2R a * cos u + Q2R c * sin u), (Q2R c * cos u - Q2R a * sin u). intros s. rewrite phase_turned, C by auto. fold u. replace (u + 1 * s) with (u + s) by ring. rewrite cos_plus, sin_plus. ring.
Qed.
Lemma total_circle j q ts : (j < n)%nat -> forallb (fun t : harmonic => forall_to n (fun j => Z.leb (Z.abs (nth j (fst (fst t)) 0%Z)) 1)) ts = true ->
  exists x y z, forall s, total n (turned j s q) ts = x + y * cos s + z * sin s.
Proof.
  intros Hj. induction ts as [|t ts IH]; intros H; [exists 0, 0, 0; intros; simpl; ring|]. cbn [forallb] in H. apply andb_prop in H. destruct H as [H1 H2].
  pose proof (forall_to_true _ _ H1 j Hj) as B. cbv beta in B. apply Z.leb_le in B.
  destruct (IH H2) as (x & y & z & E). destruct (wave_circle j q t Hj B) as (x' & y' & z' & E'). exists (x + x'), (y + y'), (z + z'). intros s.
  cbn [total fold_right]. fold (total n (turned j s q) ts). rewrite E'. change (fold_right _ 0 ts) with (total n (turned j s q) ts). rewrite E. ring.
Qed.
Lemma P_worth q : P G q = worth n p q mine.
Proof. rewrite HP, poly_items. symmetry. apply worth_groups. Qed.
Lemma simple_revolute : simple = true -> revolute n G.
Proof.
  intros H. apply andb_prop in H. destruct H as [H1 H2]. split.
  - exists (Q2R (size_with ranges mine)). intros q. rewrite P_worth. now apply size_with_up.
  - intros q j Hj. clear H1. enough (K : exists x y z, forall t, worth n p (turned j t q) mine = x + y * cos t + z * sin t).
    { destruct K as (x & y & z & E). exists x, y, z. intros t. now rewrite P_worth. }
    revert H2. induction mine as [|it its IH]; intros H2; [exists 0, 0, 0; intros; simpl; ring|]. cbn [forallb] in H2. apply andb_prop in H2. destruct H2 as [A B].
    destruct (IH B) as (x & y & z & E). destruct (total_circle j q (snd it) Hj A) as (x' & y' & z' & E'). set (c := factor p (fst it)).
    exists (c * x' + x), (c * y' + y), (c * z' + z). intros t. rewrite worth_cons, E, E'. fold c. ring.
Qed.
Lemma pulls_up k : pulls_kept k = true -> forall q i, (i < n)%nat -> Rabs (grav G q i) <= entries k i.
Proof.
  intros H q i Hi. pose proof (forall_to_true _ _ H i Hi) as K. cbv zeta beta in K. apply andb_prop in K. destruct K as [K1 K2].
  replace (grav G q i) with (worth n p q (groups (items n (map (slope i)) pot))); [eapply Rle_trans; [exact (size_with_up n ranges _ p q Hp K1)|exact (le_Q _ _ K2)]|].
  rewrite worth_groups, <- (partial_items n p q pot i Hi). symmetry. rewrite <- (partial_along (Arm n [] []) (P G) (grav G q) i q Hi).
  - unfold partial. apply Derive_ext. intros t. apply HP.
  - intros c t v E Dv. evar_last; [exact (P_rate G c t v Dv)|]. unfold dot. apply Loop.sum_ext. intros l Hl. f_equal.
    replace (c t) with q; [reflexivity|]. apply functional_extensionality. intros o. now rewrite E.
Qed.
End Potential.

(** There is such a gravity. *)
Definition gravity_in n pot p : gravity n := Gravity n (poly_with n pot p) (fun q i => worth n p q (items n (map (slope i)) pot))
  (fun q t v D => is_derive_ext _ _ _ _ (fun s => eq_sym (poly_items n p (q s) pot)) (worth_rate n p q t v pot D)).

(** ** What is printed *)
Section Printed.
Variables (D : computed) (ro Lp ga : Q) (k : list Q).
Hypothesis m_pos : (1 <= its_m D)%nat.
Hypothesis h_bound : forall x, Rabs (h (its_m D) x) <= Q2R ga.
Hypothesis dh_bound : forall x, Rabs (dh (its_m D) x) <= Q2R ro.
Hypothesis secant : forall x, Rabs (h (its_m D) x) <= Q2R Lp * Rabs x.
Hypothesis checked : check_S D ro Lp ga k = true.
Theorem bounds_goal : of_bounds D k sampled_goal.
Proof. intros G R K. now apply (goal_reached D ro Lp ga k). Qed.
Theorem bounds_rest : of_bounds D k sampled_rest.
Proof. intros G R K. now apply (rest_reached D ro Lp ga k). Qed.
Variables (pot : list monomial) (ranges : list (Q * Q)).
Hypothesis gravity_checked : simple (joints_of D) pot ranges && pulls_kept (joints_of D) pot ranges k = true.
Theorem potential_goal : of_potential D pot ranges sampled_goal.
Proof.
  apply andb_prop in gravity_checked. destruct gravity_checked as [S K]. intros p G Hp HP.
  apply bounds_goal; [now apply (simple_revolute _ pot ranges p)|now apply (pulls_up _ pot ranges p)].
Qed.
Theorem potential_rest : of_potential D pot ranges sampled_rest.
Proof.
  apply andb_prop in gravity_checked. destruct gravity_checked as [S K]. intros p G Hp HP.
  apply bounds_rest; [now apply (simple_revolute _ pot ranges p)|now apply (pulls_up _ pot ranges p)].
Qed.
End Printed.
