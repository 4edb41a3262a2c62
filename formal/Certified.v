(** A certified epsilon_0: what has to be computed, and that it is enough. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia String Reals Psatz.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Float.Primitive_ops Real.Xreal.
Require Import Definitions.
Require Loop Converge Family.
Require Import Arm Boxes Rate Bridge.
Import ListNotations.
Open Scope R_scope.

(** ** A turn of each angle *)
Lemma turned x : exists z : Z, - PI <= x - IZR (2 * z) * PI <= PI.
Proof.
  pose proof PI_RGT_0 as P. exists (up (x / (2 * PI) - / 2)). destruct (archimed (x / (2 * PI) - / 2)) as [A1 A2].
  set (z := IZR (up _)) in *. rewrite mult_IZR. fold z.
  assert (E : x = x / (2 * PI) * (2 * PI)) by (field; lra). set (y := x / (2 * PI)) in *. rewrite E. split; nra.
Qed.
Lemma far_correct i j x y : rel i x -> rel j y -> far i j = true -> y <= x.
Proof.
  intros Hi Hj H. unfold far in H. pose proof (I.sign_large_correct (I.sub prec i j)) as L. pose proof (rel_sub _ _ _ _ Hi Hj) as K.
  destruct (I.sign_large _); try discriminate; specialize (L _ K).
  - apply (f_equal proj_val) in L. cbn [proj_val] in L. lra.
  - destruct L as [_ L]. cbn [proj_val] in L. lra.
Qed.
(** A side that reaches from - lo to hi. *)
Definition covers (s : side) (lo hi : I.type) : bool :=
  is_real (fst s) && is_real (snd s) && far (point (snd s)) hi && far (I.neg (point (fst s))) lo.
Lemma covers_correct s lo hi x l u : covers s lo hi = true -> rel lo l -> rel hi u -> - l <= x <= u -> inside s x.
Proof.
  unfold covers. rewrite !andb_true_iff. intros (((R1 & R2) & F1) & F2) Hl Hu Hx. unfold inside.
  pose proof (far_correct _ _ _ _ (point_correct _ R2) Hu F1).
  pose proof (far_correct _ _ _ _ (rel_neg _ _ (point_correct _ R1)) Hl F2). lra.
Qed.

Section Certified.
Variable A : arm.
Notation n := (joints A).
Variables (angles : list nat) (ks : list (list Z)).
Hypothesis Hn : (0 < n)%nat.
Hypothesis Sym : symmetric A = true.
Hypothesis Known : all_known A angles ks = true.

Lemma posture q (sides : list side) : List.length sides = List.length angles -> forallb (fun s => covers s (I.pi prec) (I.pi prec)) sides = true ->
  exists qb, stands_for angles qb q /\ Forall2 inside sides qb.
Proof.
  intros Hl Hs. assert (Z : exists zs : nat -> Z, forall l, - PI <= q l - IZR (2 * zs l) * PI <= PI).
  { exists (fun l => up (q l / (2 * PI) - / 2)). intros l. pose proof PI_RGT_0 as P. destruct (archimed (q l / (2 * PI) - / 2)) as [A1 A2].
    set (z := IZR (up _)) in *. rewrite mult_IZR. fold z.
    assert (E : q l = q l / (2 * PI) * (2 * PI)) by (field; lra). set (y := q l / (2 * PI)) in *. rewrite E. split; nra. }
  destruct Z as [zs Z]. exists (map (fun l => q l - IZR (2 * zs l) * PI) angles). split; [now exists zs|].
  revert Hl Hs. generalize sides. clear - Z. induction angles as [|l ls IH]; intros [|s ss] Hl Hs; try discriminate; [constructor|].
  cbn [forallb map] in *. apply andb_prop in Hs. destruct Hs as [H1 H2]. constructor.
  - apply (covers_correct s _ _ _ PI PI H1 (I.pi_correct prec) (I.pi_correct prec)). apply Z.
  - apply IH; auto.
Qed.

(** ** M(q) - alpha I is positive definite *)
Variable alpha : Q.
Definition mass_rows (B : arith) (l : lifted B) (a : num B) (wv : list (num B)) : upper_rows B :=
  let Mv := mass_of B n l wv in rows_of B n (fun i j => if Nat.eqb i j then sub B (at2 B Mv i j) a else at2 B Mv i j).
Notation p0 := (problem_of A angles ks [] [] 0 0 0 0 0).
Definition mass_leaf (l : lifted IA) (b : box) : bool :=
  if proper b then definite n (mass_rows IA l (rat IA alpha) (waves IA (pk p0) (map span b))) else false.
Fixpoint mass_shown (start : box) (l : lifted IA) (fuel : nat) (b : box) : bool :=
  if mass_leaf l b then true else
  match fuel with
  | O => false
  | S f => match cut (widest_from 0 0 (-1)%float start b) b with
           | Some (x, y) => if mass_shown start l f x then mass_shown start l f y else false
           | None => false end
  end.
Lemma mass_leaf_correct b qb : mass_leaf (lift IA p0) b = true -> Forall2 inside b qb ->
  forall y, List.length y = n -> nonzero y -> 0 < form RA (mass_rows RA (lift RA p0) (rat RA alpha) (waves RA (pk p0) qb)) y.
Proof.
  intros H Hin y Hy Hz. unfold mass_leaf in H. destruct (proper b) eqn:Hp; [|discriminate].
  eapply definite_correct; [exact H| |apply shaped_rows|exact Hy|exact Hz].
  assert (KM : relm (mass_of IA n (lift IA p0) (waves IA (pk p0) (map span b))) (mass_of RA n (lift RA p0) (waves RA (pk p0) qb))).
  { apply (relm_mass p0). apply rels_waves. now apply spans_correct. }
  unfold mass_rows. cbv zeta. set (MI := mass_of IA _ _ _) in *. set (MR := mass_of RA _ _ _) in *. clearbody MI MR.
  unfold rows_of, relu. apply Forall2_lift. intros i. split.
  - cbn [fst]. rewrite PeanoNat.Nat.eqb_refl. apply rel_sub; [now apply rel_at2|apply rel_rat].
  - apply Forall2_lift. intros j. destruct (Nat.eqb i j); [apply rel_sub; [now apply rel_at2|apply rel_rat]|now apply rel_at2].
Qed.
Lemma mass_shown_correct start : forall fuel b qb, mass_shown start (lift IA p0) fuel b = true -> Forall2 inside b qb ->
  forall y, List.length y = n -> nonzero y -> 0 < form RA (mass_rows RA (lift RA p0) (rat RA alpha) (waves RA (pk p0) qb)) y.
Proof.
  induction fuel; intros b qb H K; simpl in H; destruct (mass_leaf _ b) eqn:E; try (eapply mass_leaf_correct; eassumption); try discriminate.
  destruct (cut _ b) as [[y z]|] eqn:C; [|discriminate]. destruct (mass_shown _ _ fuel y) eqn:D; [|discriminate].
  destruct (cut_correct _ _ _ _ _ C K); [eapply (IHfuel y)|eapply (IHfuel z)]; eauto.
Qed.
Variable turn : list side.                          (* one side for each angle of a box *)
Hypothesis Hturn : List.length turn = List.length angles.
Hypothesis Hcovers : forallb (fun s => covers s (I.pi prec) (I.pi prec)) turn = true.
Variable fuel : nat.
Hypothesis Hmass : mass_shown turn (lift IA p0) fuel turn = true.
Lemma zero_or_not (x : vec) : nonzero (tab n x) \/ forall i, (i < n)%nat -> x i = 0.
Proof.
  destruct (Exists_dec (fun y => y <> 0) (tab n x)) as [E|E].
  - intros z; destruct (Req_EM_T z 0); [right|left]; tauto.
  - left. apply Exists_exists in E. exact E.
  - right. intros i Hi. destruct (Req_EM_T (x i) 0) as [|N]; auto. exfalso. apply E. apply Exists_exists. exists (x i). split; auto.
    unfold tab. apply in_map, in_seq. lia.
Qed.
Lemma mass_low q x : Q2R alpha * Definitions.dot n x x <= Definitions.dot n x (apply_ n (M_of A q) x).
Proof.
  destruct (zero_or_not x) as [Z|Z].
  2: { assert (Z0 : forall u, Definitions.dot n x u = 0).
       { intros u. unfold Definitions.dot. rewrite (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros i Hi. rewrite (Z i Hi). ring. }
       rewrite !Z0. lra. }
  destruct (posture q turn Hturn Hcovers) as (qb & Sf & Hin).
  pose proof (mass_shown_correct turn fuel turn qb Hmass Hin (tab n x) (length_tab n x) Z) as F.
  unfold mass_rows in F. cbv zeta in F. rewrite form_rows in F.
  - assert (E : sum n (fun i => sum n (fun j => (if Nat.eqb i j then sub RA (at2 RA (mass_of RA n (lift RA p0) (waves RA (pk p0) qb)) i j) (rat RA alpha)
       else at2 RA (mass_of RA n (lift RA p0) (waves RA (pk p0) qb)) i j) * (x i * x j)))
       = Definitions.dot n x (apply_ n (M_of A q) x) - Q2R alpha * Definitions.dot n x x); [|change (num RA) with R in *; lra].
    unfold Definitions.dot, apply_, Definitions.dot. rewrite <- Loop.sum_scal, <- Loop.sum_minus. apply Loop.sum_ext; intros i Hi.
    transitivity (sum n (fun j => M_of A q i j * (x i * x j)) - sum n (fun j => if Nat.eqb j i then Q2R alpha * (x i * x i) else 0)).
    + rewrite <- Loop.sum_minus. apply Loop.sum_ext; intros j Hj. rewrite (mass_at A angles ks [] [] 0 0 0 0 0 Known qb q Sf i j Hi Hj).
      rewrite (PeanoNat.Nat.eqb_sym j i). destruct (PeanoNat.Nat.eqb_spec i j) as [->|N]; [|rring]. cbn [sub RA]. rewrite (rat_Q alpha). rring.
    + f_equal; [rewrite <- Loop.sum_scal; apply Loop.sum_ext; intros; ring|].
      revert Hi. generalize n. intros k Hi. generalize (Q2R alpha * (x i * x i)). intros y. induction k as [|k IH]; [lia|]. simpl.
      destruct (PeanoNat.Nat.eqb_spec k i) as [->|Nk].
      * rewrite (Loop.sum_ext i _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros j Hj. destruct (PeanoNat.Nat.eqb_spec j i); [lia|auto].
      * rewrite IH by lia. ring.
  - intros i j Hi Hj. rewrite !(mass_at A angles ks [] [] 0 0 0 0 0 Known qb q Sf) by auto. rewrite (PeanoNat.Nat.eqb_sym j i).
    rewrite (symmetric_true A Sym q i j) by auto. destruct (PeanoNat.Nat.eqb_spec i j) as [->|]; reflexivity.
Qed.

(** ** The loop *)
Variables (beta kc lo hi : Q).
Hypothesis Halpha : Qle_bool alpha 0 = false.
Hypothesis Hbeta : forall_to n (fun i => Qle_bool (row A i) beta) = true.
Hypothesis Hkc : Qle_bool (squares A) (kc * kc) = true.
Hypothesis kc_pos : Qle_bool 0 kc = true.
Hypothesis Hlo : Qle_bool lo 0 = false.
Hypothesis Hb : forall_to n (fun i => Qle_bool lo (nth i (viscous A) 0%Q) && Qle_bool (nth i (viscous A) 0%Q) hi) = true.
Lemma positive_Q x : Qle_bool x 0 = false -> 0 < Q2R x.
Proof.
  intros E. destruct (Rlt_dec 0 (Q2R x)) as [|N]; auto. exfalso.
  assert (K : (x <= 0)%Q) by (apply Rle_Qle; rewrite Q2R_0; lra). apply Qle_bool_iff in K. congruence.
Qed.
Definition rb : robot n := robot_of A Sym beta kc Hbeta Hkc kc_pos alpha lo hi Hn (positive_Q _ Halpha) mass_low (positive_Q _ Hlo) Hb.

Theorem pd : positive_definite A.
Proof.
  intros q. split; [intros; now apply symmetric_true|]. intros x (i & Hi & Hx). eapply Rlt_le_trans; [|apply mass_low].
  apply Rmult_lt_0_compat; [now apply positive_Q|]. unfold Definitions.dot.
  pose proof (Loop.term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi). simpl in *. nra.
Qed.

Variables (m : nat) (f : Loop.member) (kp kv : list Q) (kmin vmax : Q).
Hypothesis f_h : Loop.hf f = h m.
Hypothesis f_dh : Loop.dhf f = dh m.
Hypothesis f_U : Loop.Uf f = U m.
Hypothesis Hm : (1 <= m)%nat.
Hypothesis Hkmin : Qle_bool kmin 0 = false.
Hypothesis Hkp : forall_to n (fun i => Qle_bool kmin (nth i kp 0%Q)) = true.
Hypothesis Hkv : forall_to n (fun i => Qle_bool 0 (nth i kv 0%Q) && Qle_bool (nth i kv 0%Q) vmax) = true.
Lemma kp_le i : (i < n)%nat -> Q2R kmin <= entries kp i.
Proof. intros Hi. apply le_Q, (forall_to_true _ _ Hkp i Hi). Qed.
Lemma kv_le i : (i < n)%nat -> 0 <= entries kv i <= Q2R vmax.
Proof.
  intros Hi. pose proof (forall_to_true _ _ Hkv i Hi) as E. apply andb_prop in E. destruct E as [E1 E2].
  apply le_Q in E1. apply le_Q in E2. rewrite Q2R_0 in E1. unfold entries. lra.
Qed.
Definition g : Loop.gains n := Loop.Gains n (entries kp) (entries kv) (Q2R kmin) (Q2R vmax) (positive_Q _ Hkmin)
  ltac:(pose proof (kv_le 0 Hn); lra) kp_le kv_le.
Lemma proper_f : forall K, exists r, forall x, Loop.Uf f x <= K -> Rabs x <= r.
Proof. intros K. exists (K + ln 4). intros x Hx. rewrite f_U in Hx. pose proof (Family.U_grows m Hm x). lra. Qed.

(** *** From norms alone *)
Variables eps0 c1 c2 : Q.
Hypothesis Heps0 : Qle_bool eps0 0 = false.
Hypothesis Hc1 : Qle_bool c1 0 = false.
Hypothesis Hc2 : Qle_bool c2 0 = false.
Hypothesis Hc1k : Qle_bool kmin c1 = false.
Lemma c1_small : Q2R c1 < Q2R kmin.
Proof.
  destruct (Rlt_dec (Q2R c1) (Q2R kmin)) as [|N]; auto. exfalso.
  assert (K : (kmin <= c1)%Q) by (apply Rle_Qle; lra). apply Qle_bool_iff in K. congruence.
Qed.
(** What is asked of a bar of eps: with reach = sqrt n gamma and G = reach L / (reach + L). *)
Definition enough (bar : R) : Prop := let reach := sqrt (INR n) * Loop.gammaf f in let G := reach * Loop.Lf f / (reach + Loop.Lf f) in
  let drift := Q2R kc * reach + Q2R beta * (Loop.rhof f + G) in let cross := Q2R vmax * Loop.Lf f + Q2R hi in
  bar * (cross + bar * drift) ^ 2 <= 4 * (Q2R kmin - Q2R c1) * (Q2R lo - Q2R c2 - bar * drift).
Theorem certified_by_norms : enough (Q2R eps0) -> certified A m kp kv eps0.
Proof.
  intros E. split; [exact pd|]. intros qd. rewrite <- f_h, <- f_U.
  exact (Converge.stable_by_norms n rb f g proper_f qd (Q2R eps0) (Q2R c1) (Q2R c2) (positive_Q _ Heps0) (positive_Q _ Hc1) (positive_Q _ Hc2) c1_small E).
Qed.
(** A goal that moves, by norms alone. *)
Definition enough_moving (vd : Q) : Prop := let reach := sqrt (INR n) * Loop.gammaf f in let G := reach * Loop.Lf f / (reach + Loop.Lf f) in
  let drift := Q2R kc * reach + Q2R beta * (Loop.rhof f + G) in let cross := Q2R vmax * Loop.Lf f + Q2R hi + Q2R kc * Q2R vd in
  let kp0 := Q2R kmin - Q2R eps0 * (Q2R kc * Q2R vd) in
  Q2R c1 < kp0 /\ Q2R eps0 * (cross + Q2R eps0 * drift) ^ 2 <= 4 * (kp0 - Q2R c1) * (Q2R lo - Q2R c2 - Q2R eps0 * drift).
Theorem certified_tracking_by_norms vd : enough_moving vd -> certified_tracking A m kp kv eps0 vd.
Proof.
  intros [E1 E2]. split; [exact pd|]. intros r v H. rewrite <- f_h, <- f_U.
  pose proof (positive_Q _ Heps0). pose proof (positive_Q _ Hc1). pose proof (positive_Q _ Hc2). split.
  - exact (Converge.tracking_falls n rb f g r v (Q2R vd) H (Q2R eps0) (Q2R c1) (Q2R c2) ltac:(auto) ltac:(auto) ltac:(auto) E1 E2).
  - exact (Converge.tracks_by_norms n rb f g proper_f r v (Q2R vd) H (Q2R eps0) (Q2R c1) (Q2R c2) ltac:(auto) ltac:(auto) ltac:(auto) E1 E2).
Qed.

(** *** By boxes *)
Variables (Lq rad : Q).
Hypothesis HL : Loop.Lf f <= Q2R Lq.
Hypothesis Hrad : Qle_bool 0 rad = true.
Notation p := (problem_of A angles ks kp kv eps0 c1 c2 Lq rad).
Notation stiff := (stiff kp kv eps0 c1 Lq).
Hypothesis Hstiff : forall_to n (fun i => negb (Qle_bool (stiff i) 0)) = true.
Lemma stiff_pos i : (i < n)%nat -> 0 < Q2R (stiff i).
Proof. intros Hi. apply positive_Q. apply negb_true_iff. exact (forall_to_true _ _ Hstiff i Hi). Qed.

(** Signs that leave the form as it is. *)
Definition mirror (s : list Z) (ts : list harmonic) : list harmonic := map (fun t : harmonic => let '(k, a, b) := t in (tab n (fun i => nth i s 1 * nth i k 0)%Z, a, b)) ts.
Definition sg (s : list Z) (i : nat) : Z := nth i s 1%Z.
Definition none (ts : list harmonic) : bool := match normal ts with [] => true | _ => false end.
Definition mirrors (s : list Z) : bool := forall_to n (fun i => (Z.eqb (sg s i) 1 || Z.eqb (sg s i) (-1)) && forall_to n (fun j =>
  none (mirror s (H A i j) ++ map (times (inject_Z (- (sg s i * sg s j)))) (H A i j)) && forall_to n (fun k =>
  none (mirror s (c_of A i j k) ++ map (times (inject_Z (- (sg s i * sg s j * sg s k)))) (c_of A i j k))))).
Definition flip (s : list Z) (x : vec) : vec := fun i => IZR (sg s i) * x i.
Lemma total_mirror s q ts : Arm.total n (flip s q) ts = Arm.total n q (mirror s ts).
Proof.
  induction ts as [|[[k a] b] ts IH]; [reflexivity|]. cbn [mirror map Arm.total fold_right]. fold (Arm.total n (flip s q) ts). fold (mirror s ts). fold (Arm.total n q (mirror s ts)).
  rewrite IH. unfold wave. assert (P : phase n k (flip s q) = phase n (tab n (fun i => nth i s 1 * nth i k 0)%Z) q); [|now rewrite P].
  apply Loop.sum_ext; intros i Hi. rewrite nth_tab by auto. unfold flip, sg. rewrite mult_IZR. ring.
Qed.
Lemma none_true q ts us c : none (ts ++ map (times (inject_Z (- c))) us) = true -> Arm.total n q ts = IZR c * Arm.total n q us.
Proof.
  unfold none. intros E. destruct (normal _) eqn:N in E; [|discriminate]. apply (f_equal (Arm.total n q)) in N.
  rewrite total_normal, total_app, total_times, Q2R_inject, opp_IZR in N. simpl in N. lra.
Qed.
Section Mirror.
Variable s : list Z.
Hypothesis Hs : mirrors s = true.
Variables (q e w : vec).
Lemma sg2 i : (i < n)%nat -> IZR (sg s i) * IZR (sg s i) = 1.
Proof.
  intros Hi. pose proof (forall_to_true _ _ Hs i Hi) as E. apply andb_prop in E. destruct E as [E _]. apply orb_prop in E.
  destruct E as [E|E]; apply Z.eqb_eq in E; rewrite E; lra.
Qed.
Lemma M_mirror i j : (i < n)%nat -> (j < n)%nat -> M_of A (flip s q) i j = IZR (sg s i) * IZR (sg s j) * M_of A q i j.
Proof.
  intros Hi Hj. pose proof (forall_to_true _ _ Hs i Hi) as E. apply andb_prop in E. destruct E as [_ E].
  pose proof (forall_to_true _ _ E j Hj) as F. apply andb_prop in F. destruct F as [F _].
  rewrite !M_total, total_mirror, (none_true q _ _ _ F), mult_IZR. ring.
Qed.
Lemma c_mirror i j k : (i < n)%nat -> (j < n)%nat -> (k < n)%nat ->
  Arm.total n (flip s q) (c_of A i j k) = IZR (sg s i) * IZR (sg s j) * IZR (sg s k) * Arm.total n q (c_of A i j k).
Proof.
  intros Hi Hj Hk. pose proof (forall_to_true _ _ Hs i Hi) as E. apply andb_prop in E. destruct E as [_ E].
  pose proof (forall_to_true _ _ E j Hj) as F. apply andb_prop in F. destruct F as [_ F].
  rewrite total_mirror, (none_true q _ _ _ (forall_to_true _ _ F k Hk)), !mult_IZR. ring.
Qed.
Lemma norm_mirror x : norm n (flip s x) = norm n x.
Proof.
  unfold norm, Definitions.norm. f_equal. apply Loop.sum_ext; intros i Hi. unfold flip.
  replace (IZR (sg s i) * x i * (IZR (sg s i) * x i)) with (IZR (sg s i) * IZR (sg s i) * (x i * x i)) by ring. rewrite sg2 by auto. ring.
Qed.
Lemma h_mirror i : (i < n)%nat -> h m (flip s e i) = IZR (sg s i) * h m (e i) /\ dh m (flip s e i) = dh m (e i).
Proof.
  intros Hi. pose proof (forall_to_true _ _ Hs i Hi) as E. apply andb_prop in E. destruct E as [E _]. apply orb_prop in E. unfold flip.
  destruct E as [E|E]; apply Z.eqb_eq in E; rewrite E.
  - rewrite !Rmult_1_l. auto.
  - replace (-1 * e i) with (- e i) by ring. rewrite (Family.h_odd m Hm). split; [ring|]. apply (Family.dh_even m Hm).
Qed.
Notation S1 := (Sm A (h m) (dh m) q e).
Notation S2 := (Sm A (h m) (dh m) (flip s q) (flip s e)).
Lemma S_mirror i j : (i < n)%nat -> (j < n)%nat -> S2 i j = IZR (sg s i) * IZR (sg s j) * S1 i j.
Proof.
  intros Hi Hj. unfold Sm, S_of. rewrite !C_total, M_mirror by auto. unfold apply_, Definitions.dot, dv, hv, pull.
  pose proof (norm_mirror e) as Ne. unfold norm in Ne. rewrite !Ne. rewrite (proj2 (h_mirror j Hj)).
  rewrite (Loop.sum_ext n (fun k => Arm.total n (flip s q) (c_of A i j k) * h m (flip s e k)) (fun k => IZR (sg s i) * IZR (sg s j) * (Arm.total n q (c_of A i j k) * h m (e k)))).
  2: { intros k Hk. rewrite c_mirror, (proj1 (h_mirror k Hk)) by auto.
       transitivity (IZR (sg s i) * IZR (sg s j) * (Arm.total n q (c_of A i j k) * h m (e k)) * (IZR (sg s k) * IZR (sg s k))); [ring|]. rewrite sg2 by auto. ring. }
  rewrite (Loop.sum_ext n (fun k => M_of A (flip s q) i k * h m (flip s e k)) (fun k => IZR (sg s i) * (M_of A q i k * h m (e k)))).
  2: { intros k Hk. rewrite M_mirror, (proj1 (h_mirror k Hk)) by auto.
       transitivity (IZR (sg s i) * (M_of A q i k * h m (e k)) * (IZR (sg s k) * IZR (sg s k))); [ring|]. rewrite sg2 by auto. ring. }
  rewrite !Loop.sum_scal. unfold flip, Rdiv. ring.
Qed.
Lemma F_mirror bb cc x : F_of n bb cc x S2 (flip s w) = F_of n bb cc x S1 w.
Proof.
  apply Loop.sum_ext; intros i Hi. assert (X : X_of n bb x S2 (flip s w) i = IZR (sg s i) * X_of n bb x S1 w i).
  { unfold X_of, Definitions.dot.
    rewrite (Loop.sum_ext n (fun j => S2 i j * flip s w j) (fun j => IZR (sg s i) * (S1 i j * w j))).
    - rewrite Loop.sum_scal. unfold flip. ring.
    - intros j Hj. rewrite S_mirror by auto. unfold flip.
      transitivity (IZR (sg s i) * (S1 i j * w j) * (IZR (sg s j) * IZR (sg s j))); [ring|]. rewrite sg2 by auto. ring. }
  rewrite X. unfold flip. set (y := X_of n bb x S1 w i). pose proof (sg2 i Hi) as Q.
  transitivity (IZR (sg s i) * IZR (sg s i) * (w i * y) - x * cc i * (IZR (sg s i) * IZR (sg s i) * (y * y))); [ring|]. rewrite Q. ring.
Qed.
End Mirror.

(** Errors that a box may take to be positive: (joint, signs). *)
Variable signs : list (nat * list Z).
Fixpoint signs_fit (l : list (nat * list Z)) : bool := match l with
  | [] => true
  | (j, s) :: l' => mirrors s && Z.eqb (sg s j) (-1) && Nat.ltb j n && forallb (fun t => Z.eqb (sg (snd t) j) 1) l' && signs_fit l' end.
Lemma one_sided l : signs_fit l = true -> forall q e w, exists q' e' w',
  (forall bb cc x, F_of n bb cc x (Sm A (h m) (dh m) q' e') w' = F_of n bb cc x (Sm A (h m) (dh m) q e) w) /\
  norm n e' = norm n e /\ norm n w' = norm n w /\ (forall t, In t l -> 0 <= e' (fst t)) /\
  (forall j, (forall t, In t l -> sg (snd t) j = 1%Z) -> e' j = e j).
Proof.
  induction l as [|[j s] l IH]; intros Fit q e w; [exists q, e, w; repeat split; auto; intros t []|].
  cbn [signs_fit] in Fit. rewrite !andb_true_iff in Fit. destruct Fit as ((((Ms & Mj) & _) & Ml) & Fl).
  apply Z.eqb_eq in Mj. rewrite forallb_forall in Ml.
  destruct (Rle_dec 0 (e j)) as [P|P].
  - destruct (IH Fl q e w) as (q' & e' & w' & F & N1 & N2 & T & O). exists q', e', w'. repeat split; auto.
    + intros t [<-|Ht]; auto. cbn [fst]. rewrite O; auto. intros t Ht. apply Z.eqb_eq, Ml, Ht.
    + intros i Hi. apply O. intros t Ht. apply Hi. now right.
  - destruct (IH Fl (flip s q) (flip s e) (flip s w)) as (q' & e' & w' & F & N1 & N2 & T & O). exists q', e', w'. repeat split.
    + intros. rewrite F. now apply F_mirror.
    + rewrite N1. now apply norm_mirror.
    + rewrite N2. now apply norm_mirror.
    + intros t [<-|Ht]; auto. cbn [fst]. rewrite O; [unfold flip; rewrite Mj; lra|]. intros t Ht. apply Z.eqb_eq, Ml, Ht.
    + intros i Hi. rewrite O; [pose proof (Hi (j, s) (or_introl eq_refl)) as K; cbn [snd] in K; unfold flip; rewrite K; ring|]. intros t Ht. apply Hi. now right.
Qed.

Variable errors : list side.
Definition errors_fit : bool := Nat.eqb (List.length errors) n && forall_to n (fun i =>
  covers (nth i errors (0, 0)%float) (if existsb (fun t => Nat.eqb (fst t) i) signs then I.zero else rat IA rad) (rat IA rad)).
Hypothesis Herrors : errors_fit = true.
Hypothesis Hsigns : signs_fit signs = true.
Variables (hI dhI : I.type -> I.type).
Hypothesis hI_correct : forall i x, rel i x -> rel (hI i) (h m x).
Hypothesis dhI_correct : forall i x, rel i x -> rel (dhI i) (dh m x).
Variables (more : nat) (tree : string).
Hypothesis Htree : check p (List.length angles) hI dhI (turn ++ errors) more tree = true.
Hypothesis Htail : enough (Q2R eps0 / (1 + Q2R rad)).

Lemma inside_errors e : norm n e < Q2R rad -> (forall t, In t signs -> 0 <= e (fst t)) -> Forall2 inside errors (tab n e).
Proof.
  intros Hr Ht. apply andb_prop in Herrors. destruct Herrors as [L F]. apply PeanoNat.Nat.eqb_eq in L.
  assert (K : forall i, (i < n)%nat -> inside (nth i errors (0, 0)%float) (e i)).
  { intros i Hi. pose proof (forall_to_true _ _ F i Hi) as Ci. cbv beta in Ci. pose proof (Converge.entry_le_norm n e i Hi) as B.
    fold (norm n e) in B. apply Rabs_le_between in B. pose proof (rel_rat rad) as Rr. rewrite (rat_Q rad) in Rr.
    destruct (existsb _ signs) eqn:Ex.
    - apply (covers_correct _ _ _ _ 0 (Q2R rad) Ci rel_zer Rr). apply existsb_exists in Ex. destruct Ex as (t & It & Et).
      apply PeanoNat.Nat.eqb_eq in Et. specialize (Ht t It). rewrite Et in Ht. lra.
    - apply (covers_correct _ _ _ _ (Q2R rad) (Q2R rad) Ci Rr Rr). lra. }
  clear - K L. unfold tab. revert K. rewrite <- L. clear L. generalize errors. intros l K.
  assert (G : forall k, (forall i, (i < List.length l)%nat -> inside (nth i l (0, 0)%float) (e (k + i)%nat)) -> Forall2 inside l (map e (seq k (List.length l)))).
  { clear K. induction l as [|s l IH]; intros k K; [constructor|]. cbn [List.length seq map]. constructor.
    - specialize (K 0%nat ltac:(simpl; lia)). rewrite PeanoNat.Nat.add_0_r in K. exact K.
    - apply IH. intros i Hi. specialize (K (S i) ltac:(simpl; lia)). replace (k + S i)%nat with (S k + i)%nat in K by lia. exact K. }
  apply G. exact K.
Qed.
Lemma form_is_positive q e w : norm n e < Q2R rad -> Q2R c2 * Definitions.dot n w w <=
  F_of n (b_of A) (cw kp kv eps0 c1 Lq) (ep A eps0 e) (Sm A (h m) (dh m) q e) w.
Proof.
  intros Hr. destruct (one_sided signs Hsigns q e w) as (q' & e' & w' & F & N1 & N2 & T & _).
  destruct (posture q' turn Hturn Hcovers) as (qb & Sf & Hin).
  rewrite <- (F (b_of A) (cw kp kv eps0 c1 Lq) (ep A eps0 e)).
  assert (D : Definitions.dot n w w = Definitions.dot n w' w') by (rewrite <- !Loop.norm2; fold (norm n w) (norm n w'); now rewrite N2).
  rewrite D. assert (E : ep A eps0 e = ep A eps0 e') by (unfold ep; now rewrite N1). rewrite E. rewrite <- N1 in Hr.
  pose proof (form_is A angles ks kp kv eps0 c1 c2 Lq rad Known (h m) (dh m) qb q' e' Sf stiff_pos w') as Fi. fold dot in D.
  change (Definitions.dot n w' w') with (dot n w' w').
  destruct (zero_or_not w') as [Z|Z].
  - assert (X : Forall2 inside (turn ++ errors) (qb ++ tab n e')) by (apply Forall2_app; [exact Hin|now apply inside_errors]).
    pose proof (check_correct p (List.length angles) hI dhI (h m) (dh m) hI_correct dhI_correct (turn ++ errors) more tree Htree _ X) as G.
    assert (Lq' : List.length qb = List.length angles) by (destruct Sf as [zs ->]; apply map_length).
    unfold proved, good in G. rewrite <- Lq', firstn_app, skipn_app, PeanoNat.Nat.sub_diag, firstn_all, skipn_all, app_nil_r in G. cbn [app skipn] in G.
    assert (Near : sumsq RA (tab n e') < rat RA (pr2 p)).
    { rewrite sumsq_tab. change (pr2 p) with (rad * rad)%Q. rewrite (rat_Q (rad * rad)), Q2R_mult. unfold dot. rewrite <- Loop.norm2. fold (norm n e').
      pose proof (Loop.norm_pos n e') as Np. fold (norm n e') in Np. nra. }
    specialize (G Near (tab n w') (length_tab n w') Z).
    assert (G' : 0 < F_of n (b_of A) (cw kp kv eps0 c1 Lq) (ep A eps0 e') (Sm A (h m) (dh m) q' e') w' - Q2R c2 * dot n w' w') by (rewrite <- Fi; exact G).
    lra.
  - assert (Z0 : dot n w' w' = 0).
    { unfold dot, Definitions.dot. rewrite (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros i Hi. rewrite (Z i Hi). ring. }
    assert (Z1 : F_of n (b_of A) (cw kp kv eps0 c1 Lq) (ep A eps0 e') (Sm A (h m) (dh m) q' e') w' = 0).
    { unfold F_of. rewrite (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros i Hi.
      assert (X0 : X_of n (b_of A) (ep A eps0 e') (Sm A (h m) (dh m) q' e') w' i = 0).
      { unfold X_of, Definitions.dot. rewrite (Z i Hi), (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros j Hj. rewrite (Z j Hj). ring. }
      rewrite X0. ring. }
    rewrite Z0, Z1. lra.
Qed.
Lemma C_swap q x y i : (i < n)%nat -> apply_ n (C rb q x) y i = apply_ n (C rb q y) x i.
Proof.
  intros Hi. change (apply_ n (C_of A q x) y i = apply_ n (C_of A q y) x i). unfold apply_, Definitions.dot.
  rewrite (Loop.sum_ext n _ (fun j => sum n (fun k => Arm.total n q (c_of A i j k) * (x k * y j)))).
  2: { intros j Hj. rewrite C_total by auto. rewrite Rmult_comm, <- Loop.sum_scal. apply Loop.sum_ext; intros; ring. }
  rewrite (Loop.sum_ext n (fun j => C_of A q y i j * x j) (fun j => sum n (fun k => Arm.total n q (c_of A i j k) * (y k * x j)))).
  2: { intros j Hj. rewrite C_total by auto. rewrite Rmult_comm, <- Loop.sum_scal. apply Loop.sum_ext; intros; ring. }
  rewrite Loop.sum_swap. apply Loop.sum_ext; intros j Hj. apply Loop.sum_ext; intros k Hk. rewrite !total_c by auto.
  assert (Sy : partial (fun p => M_of A p j k) i q = partial (fun p => M_of A p k j) i q) by (apply Derive_ext; intros; now apply symmetric_true).
  rewrite Sy. field.
Qed.
Theorem decreases qd e w t : Loop.rate n rb f g qd e w (Q2R eps0) t
  <= - (Q2R c1 * eps n (Q2R eps0) (e t) * Definitions.norm n (Loop.hv f (e t)) ^ 2) - Q2R c2 * Definitions.norm n (w t) ^ 2.
Proof.
  pose proof (positive_Q _ Heps0) as P0. assert (R0 : 0 <= Q2R rad) by (pose proof (le_Q _ _ Hrad) as K; now rewrite Q2R_0 in K).
  destruct (Rlt_dec (norm n (e t)) (Q2R rad)) as [Near|Far].
  - apply (decreases_by_form n rb f g qd C_swap (Q2R eps0) (Q2R c1) P0 (fun i => Q2R (stiff i)) stiff_pos).
    + intros i Hi. change (Loop.kp n g i) with (entries kp i). change (Loop.kv n g i) with (entries kv i). unfold Bridge.stiff. rewrite Q2R_red, !Q2R_minus, !Q2R_mult.
      replace (Q2R (1 # 4)) with (/ 4) by (unfold Q2R; simpl; lra). fold (entries kp i) (entries kv i).
      pose proof (kv_le i Hi) as [V0 _]. assert (Q2R eps0 * Loop.Lf f * entries kv i <= Q2R eps0 * Q2R Lq * entries kv i).
      { apply Rmult_le_compat_r; auto. apply Rmult_le_compat_l; lra. }
      unfold entries in *. lra.
    + intros x. pose proof (form_is_positive (fun j => qd j - e t j) (e t) x Near) as K.
      replace (eps n (Q2R eps0) (e t)) with (ep A eps0 (e t)) by (unfold ep, eps; fold (norm n (e t)); pose proof (Loop.norm_pos n (e t)) as N; fold (norm n (e t)) in N; field; lra).
      unfold S_at, Sm in *. unfold Loop.hv. rewrite f_h, f_dh. exact K.
  - eapply Rle_trans; [apply (Loop.rate_bound n rb f g qd e w (Q2R eps0) P0 t)|]. cbv zeta.
    apply Loop.form_decreases with (bar := Q2R eps0 / (1 + Q2R rad)); auto using Loop.norm_pos, Loop.cross_pos, c1_small.
    split; [exact (proj1 (Loop.eps_range n e (Q2R eps0) P0 t))|]. unfold eps. fold (norm n (e t)).
    apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; lra.
Qed.
Theorem certified_by_boxes : certified A m kp kv eps0.
Proof.
  split; [exact pd|]. intros qd. rewrite <- f_h, <- f_U.
  pose proof (positive_Q _ Heps0) as P0. pose proof (positive_Q _ Hc1) as P1. pose proof (positive_Q _ Hc2) as P2. split.
  - exact (Converge.falls_everywhere n rb f g (Q2R eps0) P0 qd (Q2R c1) (Q2R c2) P1 P2 (decreases qd)).
  - exact (Converge.gas n rb f g proper_f (Q2R eps0) P0 qd (Q2R c1) (Q2R c2) P1 P2 (decreases qd)).
Qed.
End Certified.
