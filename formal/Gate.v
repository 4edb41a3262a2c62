(** What the gate accepts, from booleans of rational numbers: gravity kept and known, (10p), (10i), (19), no command beyond a limit;
    and what it rejects. *)
From Coq Require Import Reals QArith Qreals List Lra Lia Psatz Bool ZArith.
From Coquelicot Require Import Coquelicot.
Require Import Definitions GateDefinitions.
Require Family Bounds.
Require Import Arm Gravity.
Import ListNotations.
Open Scope R_scope.
Local Arguments Qred : simpl never. Local Arguments Q2R : simpl never. Local Arguments Qplus : simpl never.
Local Arguments Qminus : simpl never. Local Arguments Qmult : simpl never. Local Arguments Qopp : simpl never.

Lemma less_Q x y : negb (Qle_bool y x) = true -> Q2R x < Q2R y.
Proof.
  intros H. destruct (Rlt_dec (Q2R x) (Q2R y)) as [|N]; auto. exfalso. assert (K : (y <= x)%Q) by (apply Rle_Qle; lra). apply Qle_bool_iff in K. rewrite K in H. discriminate.
Qed.
Section Gate.
Variable D : gated.
Notation n := (axes D).
Notation m := (family D).
Notation q_at l i := (nth i l 0%Q).
Definition positive_b (l : list Q) : bool := forall_to n (fun i => negb (Qle_bool (q_at l i) 0)).
Definition kept_b : bool := forall_to n (fun i => torque_kept n (ranges D) (nth i (torques D) []) (q_at (k_g D) i)).
Definition known_b : bool := forall_to n (fun i => torque_known n (pull D) (nth i (torques D) []) i).
Variables ga root : Q.                             (* gamma_m <= ga, sqrt n <= root *)
Definition reach (i : nat) : Q := ((q_at (k_p D) i + q_at (k_v D) i) * ga)%Q.
Definition check_10i : bool := forall_to n (fun i => Qle_bool (reach i + q_at (k_g D) i) (q_at (limit D) i)).
Definition check_10p : bool := forall_to n (fun i => negb (Qle_bool (q_at (limit D) i) (root * reach i + q_at (k_g D) i))).
Definition check_19 : bool := Nat.eqb (length (friction D)) n &&
  forall_to n (fun i => forall_to n (fun j => negb (Qle_bool (fst (nth j (friction D) (0, 0)%Q)) (q_at (k_v D) i * (root * ga))))).
Definition check_root : bool := Qle_bool 1 root && Qle_bool (inject_Z (Z.of_nat n)) (root * root).
Lemma positive_true l : positive_b l = true -> positive n (entries l).
Proof. intros H i Hi. pose proof (forall_to_true _ _ H i Hi) as K. apply less_Q in K. rewrite Q2R_0 in K. exact K. Qed.
Hypothesis m_pos : (1 <= m)%nat.
Lemma gamma_positive : 0 < gamma m.
Proof. eapply Rlt_le_trans; [|apply (Bounds.h_le_gamma m m_pos 1)]. apply Family.h_pos. lra. Qed.
Lemma root_positive i : (i < n)%nat -> 0 < root_n D.
Proof. intros Hi. apply sqrt_lt_R0. apply lt_0_INR. lia. Qed.
Lemma denominator i : (i < n)%nat -> 0 < root_n D * gamma m.
Proof. intros Hi. apply Rmult_lt_0_compat; [now apply (root_positive i)|apply gamma_positive]. Qed.
Section Accepts.
Hypothesis h_bound : forall x, Rabs (h m x) <= Q2R ga.
Hypothesis Pp : positive_b (k_p D) = true.
Hypothesis Pv : positive_b (k_v D) = true.
Lemma gamma_up : gamma m <= Q2R ga. Proof. apply Bounds.gamma_le; auto. Qed.
Lemma root_up : check_root = true -> 1 <= Q2R root /\ root_n D <= Q2R root.
Proof.
  intros H. apply andb_prop in H. destruct H as [H1 H2]. apply le_Q in H1, H2. replace (Q2R 1) with 1 in H1 by (unfold Q2R; simpl; lra).
  rewrite Q2R_mult, Arm.Q2R_inject, <- INR_IZR_INZ in H2. split; [exact H1|].
  unfold root_n. rewrite <- (sqrt_square (Q2R root)) by lra. now apply sqrt_le_1_alt.
Qed.
Lemma gains i : (i < n)%nat -> 0 < entries (k_p D) i /\ 0 < entries (k_v D) i.
Proof. intros Hi. split; [now apply (positive_true _ Pp)|now apply (positive_true _ Pv)]. Qed.
Lemma reach_up i : (i < n)%nat -> (entries (k_p D) i + entries (k_v D) i) * gamma m <= Q2R (reach i) /\ 0 < Q2R (reach i).
Proof.
  intros Hi. unfold reach. rewrite Q2R_mult, Q2R_plus. change (Q2R (q_at (k_p D) i)) with (entries (k_p D) i). change (Q2R (q_at (k_v D) i)) with (entries (k_v D) i).
  pose proof (gains i Hi). pose proof gamma_up. pose proof gamma_positive. split; [apply Rmult_le_compat_l; lra|apply Rmult_lt_0_compat; lra].
Qed.
Lemma prove_10i : check_10i = true -> holds_10i D.
Proof.
  intros H i Hi. pose proof (forall_to_true _ _ H i Hi) as K. apply le_Q in K. rewrite Q2R_plus in K. destruct (reach_up i Hi) as [A _].
  apply Rle_div_r; [apply gamma_positive|]. unfold entries in *. lra.
Qed.
Lemma prove_10p : check_root = true -> check_10p = true -> holds_10p D.
Proof.
  intros Hr H i Hi. pose proof (forall_to_true _ _ H i Hi) as K. apply less_Q in K. rewrite Q2R_plus, Q2R_mult in K. destruct (reach_up i Hi) as [A P]. destruct (root_up Hr) as [R1 R2].
  apply (proj1 (Rlt_div_r _ _ _ (denominator i Hi))). unfold entries in *. pose proof (root_positive i Hi) as R0.
  assert (root_n D * (Q2R (q_at (k_p D) i) + Q2R (q_at (k_v D) i)) * gamma m <= Q2R root * Q2R (reach i)).
  { rewrite Rmult_assoc. apply Rmult_le_compat; try lra. pose proof (gains i Hi). unfold entries in *. pose proof gamma_positive. nra. }
  lra.
Qed.
Lemma prove_19 : check_root = true -> check_19 = true -> holds_19 D.
Proof.
  intros Hr H b Hb i j Hi Hj. apply andb_prop in H. destruct H as [L H]. apply PeanoNat.Nat.eqb_eq in L.
  pose proof (forall_to_true _ _ (forall_to_true _ _ H i Hi) j Hj) as K. cbv beta in K. apply less_Q in K. rewrite !Q2R_mult in K.
  destruct (Hb j ltac:(lia)) as [B _]. pose proof (gains i Hi) as [_ G]. destruct (root_up Hr) as [R1 R2]. pose proof (root_positive i Hi). pose proof gamma_positive. pose proof gamma_up.
  apply (proj1 (Rlt_div_r _ _ _ (denominator i Hi))). unfold entries in *.
  assert (root_n D * gamma m <= Q2R root * Q2R ga) by (apply Rmult_le_compat; lra).
  assert (Q2R (q_at (k_v D) i) * (root_n D * gamma m) <= Q2R (q_at (k_v D) i) * (Q2R root * Q2R ga)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma clip_id top u : Rabs u <= top -> clip top u = u.
Proof. intros H. apply Rabs_le_between in H. unfold clip. rewrite Rmin_right, Rmax_right by lra. reflexivity. Qed.
(** |K_p h(e) - K_v h(w) + g(q)| <= (k_p + k_v) gamma_m + k_g, entry by entry, at every state. *)
Lemma stay_within p : gravity_kept D p -> holds_10i D -> within_limits D p.
Proof.
  intros G H e w q i Hi. specialize (H i Hi). specialize (G q i Hi). pose proof (gains i Hi) as [P1 P2]. pose proof gamma_positive as Gp.
  apply Rle_div_r in H; [|exact Gp]. pose proof (Bounds.abs_h_le_gamma m m_pos (e i)) as A1. pose proof (Bounds.abs_h_le_gamma m m_pos (w i)) as A2.
  assert (L : Rabs (command D p e w q i) <= entries (limit D) i).
  { apply Rabs_le_between in G, A1, A2. unfold command. apply Rabs_le. set (kp := entries (k_p D) i) in *. set (kv := entries (k_v D) i) in *. split; nra. }
  split; [exact L|now apply clip_id].
Qed.
Lemma p_implies_i : check_root = true -> check_10p = true -> check_10i = true.
Proof.
  intros Hr H0. unfold check_10i, forall_to. rewrite forallb_forall. intros i Hi. apply in_seq in Hi.
  pose proof (forall_to_true _ _ H0 i ltac:(lia)) as H. cbv beta in H. apply Qle_bool_iff, Rle_Qle. apply less_Q in H. rewrite Q2R_plus, Q2R_mult in H. rewrite Q2R_plus. destruct (reach_up i ltac:(lia)) as [_ P]. destruct (root_up Hr) as [R1 _]. nra.
Qed.
(** *** The theorem *)
Theorem accepts c : kept_b && known_b && check_root && (implb (by_10p c) check_10p && implb (by_10i c) check_10i && implb (by_19 c) check_19) = true -> gate_accepts D c.
Proof.
  intros H. apply andb_prop in H. destruct H as [H C]. apply andb_prop in H. destruct H as [H Kr]. apply andb_prop in H. destruct H as [K1 K2].
  apply andb_prop in C. destruct C as [C K19]. apply andb_prop in C. destruct C as [K10p K10i].
  assert (G : forall p, in_ranges (ranges D) p -> gravity_kept D p).
  { intros p Hp q i Hi. apply (torque_kept_true n (ranges D)); auto. exact (forall_to_true _ _ K1 i Hi). }
  split; [auto using positive_true|]. split; [auto using positive_true|]. split; [|split; [|split]].
  - intros p Hp. split; [|split; [auto|]].
    + intros q i Hi. apply torque_known_true; auto. exact (forall_to_true _ _ K2 i Hi).
    + intros E. apply stay_within; auto. apply prove_10i. destruct E as [E|E]; rewrite E in *; simpl in *; auto using p_implies_i.
  - intros E. rewrite E in K10p. now apply prove_10p.
  - intros E. rewrite E in K10i. now apply prove_10i.
  - intros E. rewrite E in K19. now apply prove_19.
Qed.
End Accepts.

(** ** What the gate rejects *)
(** e_i = x, w_i = -x, a posture of quarters of a turn and parameters in their ranges saturate motor i, on one side or the other. *)
Definition in_ranges_b (ps : list Q) : bool := forall_to (length (ranges D)) (fun k =>
  Qle_bool (fst (nth k (ranges D) (0, 0)%Q)) (q_at ps k) && Qle_bool (q_at ps k) (snd (nth k (ranges D) (0, 0)%Q))).
Theorem saturated i x low ps z (up : bool) : Q2R low <= h m x ->
  Nat.ltb i n && positive_b (k_p D) && positive_b (k_v D) && in_ranges_b ps && negb (Qle_bool ((q_at (k_p D) i + q_at (k_v D) i) * low
    + (if up then value_at n ps z (nth i (torques D) []) else - value_at n ps z (nth i (torques D) [])))%Q (q_at (limit D) i)) = true -> saturates D i.
Proof.
  intros Hx H. repeat (apply andb_prop in H; destruct H as [H ?]). apply PeanoNat.Nat.ltb_lt in H. apply less_Q in H0. rewrite Q2R_plus, Q2R_mult, Q2R_plus in H0.
  pose proof (positive_true _ H3 i H) as A. pose proof (positive_true _ H2 i H) as B.
  set (y := if up then x else - x). exists (entries ps), (fun _ => y), (fun _ => - y), (quarters z). split.
  - intros k Hk. pose proof (forall_to_true _ _ H1 k Hk) as K. cbv beta in K. apply andb_prop in K. destruct K as [K1 K2]. apply le_Q in K1, K2. split; [exact K1|exact K2].
  - unfold command, gravity_at. rewrite value_at_up. assert (Odd : forall u, h m (- u) = - h m u) by (intros; apply Family.h_odd; lia). rewrite (Odd y). unfold entries in *.
    set (kp := Q2R (q_at (k_p D) i)) in *. set (kv := Q2R (q_at (k_v D) i)) in *.
    assert (M : (kp + kv) * Q2R low <= (kp + kv) * h m x) by (apply Rmult_le_compat_l; lra).
    destruct up; subst y.
    + eapply Rlt_le_trans; [exact H0|]. eapply Rle_trans; [|apply Rle_abs]. lra.
    + rewrite Q2R_opp in H0. rewrite (Odd x). eapply Rlt_le_trans; [exact H0|]. rewrite <- Rabs_Ropp. eapply Rle_trans; [|apply Rle_abs]. lra.
Qed.
Theorem saturated_rejects i c : (i < n)%nat -> by_10p c = true \/ by_10i c = true -> saturates D i -> ~ gate_accepts D c.
Proof. intros Hi Hc (p & e & w & q & Hp & H) (_ & _ & A & _). destruct (A p Hp) as (_ & _ & W). destruct (W Hc e w q i Hi) as [K _]. lra. Qed.
(** A condition fails, by gamma_m from below and, for (10p) and (19), sqrt n from below. *)
Definition low_root_b (r : Q) : bool := Qle_bool 0 r && Qle_bool (r * r) (inject_Z (Z.of_nat n)).
Lemma low_root r : low_root_b r = true -> 0 <= Q2R r <= root_n D.
Proof.
  intros H. apply andb_prop in H. destruct H as [H1 H2]. apply le_Q in H1, H2. rewrite Q2R_0 in H1. rewrite Q2R_mult, Arm.Q2R_inject, <- INR_IZR_INZ in H2. split; [exact H1|].
  unfold root_n. rewrite <- (sqrt_square (Q2R r)) by auto. now apply sqrt_le_1_alt.
Qed.
Theorem broken_10i i low c : by_10i c = true -> Q2R low <= gamma m -> Nat.ltb i n && positive_b (k_p D) && positive_b (k_v D) &&
  negb (Qle_bool ((q_at (k_p D) i + q_at (k_v D) i) * low + q_at (k_g D) i) (q_at (limit D) i)) = true -> ~ gate_accepts D c.
Proof.
  intros Hc Hg H (_ & _ & _ & _ & K & _). repeat (apply andb_prop in H; destruct H as [H ?]). apply PeanoNat.Nat.ltb_lt in H. specialize (K Hc i H). apply Rle_div_r in K; [|apply gamma_positive].
  apply less_Q in H0. rewrite !Q2R_plus, Q2R_mult, Q2R_plus in H0. pose proof (positive_true _ H2 i H). pose proof (positive_true _ H1 i H). unfold entries in *.
  assert ((Q2R (q_at (k_p D) i) + Q2R (q_at (k_v D) i)) * Q2R low <= (Q2R (q_at (k_p D) i) + Q2R (q_at (k_v D) i)) * gamma m) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Theorem broken_10p i low r c : by_10p c = true -> Q2R low <= gamma m -> low_root_b r && Qle_bool 0 low && Nat.ltb i n && positive_b (k_p D) && positive_b (k_v D) &&
  Qle_bool (q_at (limit D) i) ((q_at (k_p D) i + q_at (k_v D) i) * (r * low) + q_at (k_g D) i) = true -> ~ gate_accepts D c.
Proof.
  intros Hc Hg H (_ & _ & _ & K & _). do 5 (apply andb_prop in H; destruct H as [H ?]). apply PeanoNat.Nat.ltb_lt in H3. specialize (K Hc i H3).
  apply (proj2 (Rlt_div_r _ _ _ (denominator i H3))) in K. apply low_root in H. apply le_Q in H0, H4. rewrite Q2R_0 in H4. rewrite !Q2R_plus, !Q2R_mult, Q2R_plus in H0.
  pose proof (positive_true _ H2 i H3). pose proof (positive_true _ H1 i H3). unfold entries in *.
  assert (Q2R r * Q2R low <= root_n D * gamma m) by (apply Rmult_le_compat; lra).
  assert ((Q2R (q_at (k_p D) i) + Q2R (q_at (k_v D) i)) * (Q2R r * Q2R low) <= (Q2R (q_at (k_p D) i) + Q2R (q_at (k_v D) i)) * (root_n D * gamma m)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Theorem broken_19 i j low r c : by_19 c = true -> Q2R low <= gamma m -> low_root_b r && Qle_bool 0 low && Nat.ltb i n && Nat.ltb j n && positive_b (k_v D) &&
  forallb (fun s => Qle_bool (fst s) (snd s)) (friction D) && Nat.eqb (length (friction D)) n &&
  Qle_bool (fst (nth j (friction D) (0, 0)%Q)) (q_at (k_v D) i * (r * low)) = true -> ~ gate_accepts D c.
Proof.
  intros Hc Hg H (_ & _ & _ & _ & _ & K). do 7 (apply andb_prop in H; destruct H as [H ?]). apply PeanoNat.Nat.ltb_lt in H4, H5. apply PeanoNat.Nat.eqb_eq in H1.
  assert (B : in_ranges (friction D) (fun k => Q2R (fst (nth k (friction D) (0, 0)%Q)))).
  { intros k Hk. split; [lra|]. rewrite forallb_forall in H2. apply le_Q. apply H2. now apply nth_In. }
  specialize (K Hc _ B i j H5 H4). cbv beta in K. apply (proj2 (Rlt_div_r _ _ _ (denominator i H5))) in K. apply low_root in H. apply le_Q in H0, H6. rewrite Q2R_0 in H6. rewrite !Q2R_mult in H0.
  pose proof (positive_true _ H3 i H5). unfold entries in *. assert (Q2R r * Q2R low <= root_n D * gamma m) by (apply Rmult_le_compat; lra).
  assert (Q2R (q_at (k_v D) i) * (Q2R r * Q2R low) <= Q2R (q_at (k_v D) i) * (root_n D * gamma m)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
End Gate.
(** |tanh| <= 1 without intervals, so that no floating point enters. *)
Lemma tanh_bound x : Rabs (h 1 x) <= Q2R 1.
Proof.
  unfold h, bottom. cbv [Nat.mul Nat.sub Nat.add]. pose proof (Family.cosh2 x) as E. set (s := sinh x) in *. set (c := cosh x) in *. clearbody s c. simpl pow in *.
  assert (0 < 1 + s * (s * 1)) by nra. replace (Q2R 1) with 1 by (unfold Q2R; simpl; lra). unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ _)) by (left; now apply Rinv_0_lt_compat).
  apply (proj2 (Rle_div_l _ _ _ H)). apply Rabs_le. split; nra.
Qed.
