(** h_m and h_m' over intervals by monotone pieces: between the places where it turns, a function lies between its values
    at the ends.  Each turn is known to lie in a bracket, over which the function is evaluated as a whole. *)
From Coq Require Import Floats.
From Coq Require Import ZArith List Bool Lra Lia Reals.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Interval.Interval Interval.Float_full Float.Basic Float.Primitive_ops Real.Xreal.
Require Import Definitions.
Require Family Bounds.
Require Import Boxes Certified Members.
Import ListNotations.
Open Scope R_scope.
Local Arguments Nat.mul : simpl never.
Local Arguments Nat.sub : simpl never.
Local Arguments INR : simpl never.
Local Arguments pow : simpl never.

(** ** Monotone pieces *)
Definition monotone (f : R -> R) (P : R -> Prop) : Prop :=
  (forall x y, P x -> P y -> x <= y -> f x <= f y) \/ (forall x y, P x -> P y -> x <= y -> f y <= f x).
(** f is monotone from p to the first bracket, from each bracket to the next, and beyond the last. *)
Fixpoint pieces (f : R -> R) (p : R) (bs : list (R * R)) : Prop := match bs with
  | [] => monotone f (fun x => p <= x)
  | (a, b) :: bs' => p <= a <= b /\ monotone f (fun x => p <= x <= a) /\ pieces f b bs' end.

(** ** The range over an interval *)
Definition turn := (side * I.type)%type.            (* a bracket, and the range of the function over it *)
Definition ends (t : turn) : R * R := (value (fst (fst t)), value (snd (fst t))).
Definition meets (l u : I.type) (s : side) : bool := negb (far (point (fst s)) u) && negb (far l (point (snd s))).
Fixpoint hull (l u : I.type) (ts : list turn) (j : I.type) : I.type :=
  match ts with [] => j | (s, c) :: ts' => hull l u ts' (if meets l u s then I.join c j else j) end.
Definition known (f : R -> R) (t : turn) : Prop :=
  is_real (fst (fst t)) = true /\ is_real (snd (fst t)) = true /\ forall z, inside (fst t) z -> rel (snd t) (f z).

Lemma rel_between i x y z : rel i x -> rel i y -> x <= z <= y -> rel i z.
Proof. unfold rel. destruct (I.convert i) as [|[|a] [|b]]; simpl; auto; lra. Qed.
Lemma monotone_between f P i x y z : monotone f P -> P x -> P y -> P z -> x <= z <= y -> rel i (f x) -> rel i (f y) -> rel i (f z).
Proof.
  intros [M|M] Px Py Pz H Kx Ky.
  - apply (rel_between i (f x) (f y)); auto. split; apply M; auto; lra.
  - apply (rel_between i (f y) (f x)); auto. split; apply M; auto; lra.
Qed.
Lemma hull_wider li ui y : forall ts j, rel j y -> rel (hull li ui ts j) y.
Proof.
  induction ts as [|[s c] ts IH]; intros j K; cbn [hull]; auto. apply IH. destruct (meets _ _ _); auto. apply I.join_correct. now right.
Qed.
Lemma hull_correct f l u li ui x : rel li l -> rel ui u -> l <= x <= u -> forall ts p j, List.Forall (known f) ts -> pieces f p (map ends ts) -> p <= x ->
  rel j (f (Rmax l p)) -> rel j (f u) -> rel (hull li ui ts j) (f x).
Proof.
  intros Kl Ku Hx. induction ts as [|[s c] ts IH]; intros p j Kn Ps Hp Jl Ju; cbn [hull map pieces] in *;
    pose proof (Rmax_lub _ _ _ (proj1 Hx) Hp) as Mx; pose proof (Rmax_r l p) as Mr.
  - apply (monotone_between f _ j (Rmax l p) u x Ps); auto; lra.
  - inversion Kn as [|? ? [R1 [R2 Kc]] Kn']; subst. cbn [ends fst snd] in R1, R2, Kc, Ps.
    set (a := value (fst s)) in *. set (b := value (snd s)) in *. destruct Ps as (Ab & Mo & Ps).
    assert (Ka : rel (point (fst s)) a) by now apply point_correct.
    assert (Kb : rel (point (snd s)) b) by now apply point_correct.
    set (j' := if meets li ui s then I.join c j else j).
    assert (Up : forall y, rel j y -> rel j' y) by (intros y Ky; unfold j'; destruct (meets _ _ _); auto; apply I.join_correct; now right).
    assert (In : forall z, a < u -> l < b -> a <= z <= b -> rel j' (f z)).
    { intros z H1 H2 Hz. unfold j'. replace (meets li ui s) with true; [apply I.join_correct; left; now apply Kc|].
      symmetry. unfold meets. apply andb_true_intro. split; apply negb_true_iff, not_true_is_false; intros E.
      - pose proof (far_correct _ _ _ _ Ka Ku E). lra.
      - pose proof (far_correct _ _ _ _ Kl Kb E). lra. }
    assert (At : l = x -> rel j' (f x)) by (intros E; apply Up; rewrite E in Jl at 1; now rewrite Rmax_left in Jl).
    destruct (Rle_dec x a) as [Xa|Xa]; [|destruct (Rle_dec x b) as [Xb|Xb]].
    + apply hull_wider. destruct (Rle_dec u a) as [Ua|Ua].
      * apply (monotone_between f _ j' (Rmax l p) u x Mo); auto; lra.
      * destruct (Rle_dec b l) as [Bl|Bl]; [apply At; lra|].
        apply (monotone_between f _ j' (Rmax l p) a x Mo); auto; try lra. apply In; lra.
    + apply hull_wider. destruct (Rle_dec b l) as [Bl|Bl]; [apply At; lra|]. apply In; lra.
    + apply (IH b); auto; [lra|]. destruct (Rle_dec b l) as [Bl|Bl].
      * rewrite Rmax_left by auto. apply Up. rewrite Rmax_left in Jl; auto. lra.
      * rewrite Rmax_right by lra. apply In; lra.
Qed.

(** Of an evaluation of points and another one, of brackets. *)
Definition turns (f : I.type -> I.type) : list side -> list turn := map (fun s => (s, f (span s))).
Definition over_pieces (f : I.type -> I.type) (ts : list turn) (i : I.type) : I.type :=
  let l := I.lower i in let u := I.upper i in
  if is_real l && is_real u then hull (point l) (point u) ts (I.join (f (point l)) (f (point u))) else f i.
Lemma over_pieces_correct F f g ss : (forall i x, rel i x -> rel (f i) (F x)) -> (forall i x, rel i x -> rel (g i) (F x)) ->
  forallb (fun s => is_real (fst s) && is_real (snd s)) ss = true -> (exists p0, forall p, p <= p0 -> pieces F p (map (fun s => (value (fst s), value (snd s))) ss)) ->
  forall i x, rel i x -> rel (over_pieces f (turns g ss) i) (F x).
Proof.
  intros Hf Hg Hr [p0 Hp] i x K. unfold over_pieces. cbv zeta. destruct (is_real (I.lower i) && is_real (I.upper i))%bool eqn:E; [|now apply Hf].
  apply andb_prop in E. destruct E as [El Eu]. set (l := I.lower i) in *. set (u := I.upper i) in *.
  assert (Hx : value l <= x <= value u).
  { pose proof (real_val _ El) as Vl. pose proof (real_val _ Eu) as Vu. subst l u. destruct i as [|l u]; cbn [I.lower I.upper] in *; [discriminate El|].
    unfold rel in K. cbn [I.convert] in K. destruct (I.F.valid_lb l && I.F.valid_ub u)%bool; cbn [I.convert contains] in K; [|lra].
    change I.F.toX with F.toX in K. rewrite Vl, Vu in K. exact K. }
  apply (hull_correct F (value l) (value u) _ _ x) with (p := Rmin (value l) p0); try (now apply point_correct); try lra.
  - unfold turns. rewrite forallb_forall in Hr. apply Forall_forall. intros t Ht. apply in_map_iff in Ht. destruct Ht as (s & <- & Hs).
    specialize (Hr s Hs). apply andb_prop in Hr. destruct Hr as [R1 R2]. repeat split; auto. cbn [fst snd]. intros z Hz. apply Hg.
    apply span_correct; auto. now rewrite R1, R2.
  - unfold turns. rewrite map_map. apply Hp, Rmin_r.
  - eapply Rle_trans; [apply Rmin_l|apply Hx].
  - rewrite Rmax_left by apply Rmin_l. apply I.join_correct. left. apply Hf. now apply point_correct.
  - apply I.join_correct. right. apply Hf. now apply point_correct.
Qed.

(** ** Where h_m and h_m' are monotone *)
Lemma monotone_by (f df : R -> R) (P : R -> Prop) : (forall x, is_derive f x (df x)) -> (forall x y z, P x -> P y -> x <= z <= y -> P z) ->
  (forall x, P x -> 0 <= df x) \/ (forall x, P x -> df x <= 0) -> monotone f P.
Proof.
  intros D Cv S.
  assert (E : forall x y, P x -> P y -> x <= y -> exists z, P z /\ f y - f x = df z * (y - x)).
  { intros x y Px Py Hxy. destruct (MVT_gen f x y df) as (z & Hz & E).
    - intros; apply D.
    - intros t _. apply derivable_continuous_pt. exists (df t). apply is_derive_Reals, D.
    - rewrite Rmin_left, Rmax_right in Hz by lra. exists z. split; auto. now apply (Cv x y). }
  destruct S as [S|S]; [left|right]; intros x y Px Py Hxy; destruct (E x y Px Py Hxy) as (z & Pz & Ez); specialize (S z Pz); nra.
Qed.
Lemma monotone_less f (P Q : R -> Prop) : (forall x, Q x -> P x) -> monotone f P -> monotone f Q.
Proof. intros H [M|M]; [left|right]; intros; apply M; auto. Qed.
Lemma monotone_even f (P : R -> Prop) : (forall x, f (- x) = f x) -> monotone f P -> monotone f (fun x => P (- x)).
Proof. intros E [M|M]; [right|left]; intros x y Px Py H; rewrite <- (E x), <- (E y); apply M; auto; lra. Qed.
Lemma monotone_odd f (P : R -> Prop) : (forall x, f (- x) = - f x) -> monotone f P -> monotone f (fun x => P (- x)).
Proof.
  intros E [M|M]; [left|right]; intros x y Px Py H; apply Ropp_le_cancel; rewrite <- !E; apply M; auto; lra.
Qed.
Lemma sinh_le x y : x <= y -> sinh x <= sinh y.
Proof.
  intros [H| ->]; [|lra]. unfold sinh. pose proof (exp_increasing x y H). pose proof (exp_increasing (- y) (- x) ltac:(lra)). lra.
Qed.
Lemma sinh2_le x y : 0 <= x <= y -> sinh x ^ 2 <= sinh y ^ 2.
Proof.
  intros H. apply pow_incr. split; [|now apply sinh_le]. rewrite <- sinh_0. apply sinh_le. lra.
Qed.

Section Turns.
Variable m : nat.
Hypothesis Hm : (2 <= m)%nat.
(** h_m' has the sign of g, and dh_m'/du that of P, in u = sinh^2 x: with t = 1 / u beyond 1 *)
Definition g (u : R) : R := INR (2 * m - 1) + INR (2 * m) * u - u ^ m.
Definition P (u : R) : R := INR ((2 * m - 1) * (m - 1)) + INR (2 * m * m) * u - INR ((2 * m - 1) * (m + 2)) * u ^ m
  - INR (2 * m * m) * u ^ (m + 1) + u ^ (2 * m).
Definition P_far (t : R) : R := INR ((2 * m - 1) * (m - 1)) * t ^ (2 * m) + INR (2 * m * m) * t ^ (2 * m - 1)
  - INR ((2 * m - 1) * (m + 2)) * t ^ m - INR (2 * m * m) * t ^ (m - 1) + 1.
Definition slope (u : R) : R := (INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1)) / (1 + u ^ m) ^ 2.

Lemma dh_slope x : dh m x = slope (sinh x ^ 2).
Proof. apply Bounds.dh_square. lia. Qed.
Lemma slope_g u : 0 <= u -> slope u = u ^ (m - 1) * g u / (1 + u ^ m) ^ 2.
Proof.
  intros H. unfold slope, g. assert (0 <= u ^ m) by now apply pow_le.
  assert (E : u ^ (2 * m - 1) = u ^ (m - 1) * u ^ m) by (rewrite <- pow_add; f_equal; lia).
  assert (E2 : u ^ m = u ^ (m - 1) * u) by (rewrite Rmult_comm, tech_pow_Rmult; f_equal; lia).
  rewrite E. rewrite E2 at 1. field. lra.
Qed.
Lemma sign_of_dh x : (0 <= g (sinh x ^ 2) -> 0 <= dh m x) /\ (g (sinh x ^ 2) <= 0 -> dh m x <= 0).
Proof.
  rewrite dh_slope. set (u := sinh x ^ 2). assert (Hu : 0 <= u) by apply pow2_ge_0. rewrite slope_g by auto.
  assert (A : 0 <= u ^ (m - 1)) by now apply pow_le. assert (B : 0 <= u ^ m) by now apply pow_le.
  assert (D : 0 < / (1 + u ^ m) ^ 2) by (apply Rinv_0_lt_compat, pow_lt; lra).
  unfold Rdiv. split; intros G.
  - apply Rmult_le_pos; [now apply Rmult_le_pos|lra].
  - assert (0 <= u ^ (m - 1) * - g u * / (1 + u ^ m) ^ 2) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra). lra.
Qed.
(** g falls once it has begun to: its sign at one place is that on one side of it. *)
Lemma g_before a u : 0 <= g a -> 0 < a -> 0 <= u <= a -> 0 <= g u.
Proof.
  intros Ga Pa [U0 Ua]. unfold g in *. pose proof (pos_INR (2 * m - 1)) as C. set (k := INR (2 * m)) in *. set (c := INR (2 * m - 1)) in *.
  assert (E : forall v, v ^ m = v * v ^ (m - 1)) by (intros; rewrite tech_pow_Rmult; f_equal; lia). rewrite (E u). rewrite (E a) in Ga.
  assert (I1 : u ^ (m - 1) <= a ^ (m - 1)) by (apply pow_incr; lra). set (r := a ^ (m - 1)) in *. set (s := u ^ (m - 1)) in *.
  assert (u * s <= u * r) by (apply Rmult_le_compat_l; lra).
  destruct (Rle_dec r k) as [K|K]; [assert (u * r <= u * k) by (apply Rmult_le_compat_l; lra); lra|].
  assert (u * (r - k) <= a * (r - k)) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma g_beyond b u : g b <= 0 -> 0 < b -> b <= u -> g u <= 0.
Proof.
  intros Gb Pb Hu. unfold g in *. pose proof (pos_INR (2 * m - 1)) as C. set (k := INR (2 * m)) in *. set (c := INR (2 * m - 1)) in *.
  assert (S1 : 1 <= u / b) by (apply Rle_div_r; lra). set (s := u / b) in *. assert (E : u = s * b) by (unfold s; field; lra).
  rewrite E, Rpow_mult_distr.
  assert (I1 : s <= s ^ m).
  { replace m with (S (m - 1)) by lia. rewrite <- tech_pow_Rmult. pose proof (pow_R1_Rle s (m - 1) S1). nra. }
  assert (0 <= b ^ m) by (apply pow_le; lra). assert (s * b ^ m <= s ^ m * b ^ m) by (apply Rmult_le_compat_r; lra). nra.
Qed.

Lemma slope_rate u : 0 <= u -> is_derive slope u (u ^ (m - 2) * P u / (1 + u ^ m) ^ 3).
Proof.
  intros H. assert (B : 0 <= u ^ m) by now apply pow_le. unfold slope. evar_last.
  - apply (is_derive_div (fun u => INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m - u ^ (2 * m - 1)) (fun u => (1 + u ^ m) ^ 2) u
      (INR (2 * m - 1) * (INR (m - 1) * 1 * u ^ pred (m - 1)) + INR (2 * m) * (INR m * 1 * u ^ pred m) - INR (2 * m - 1) * 1 * u ^ pred (2 * m - 1))
      (INR 2 * (INR m * 1 * u ^ pred m) * (1 + u ^ m) ^ pred 2)).
    + apply (is_derive_minus (fun u => INR (2 * m - 1) * u ^ (m - 1) + INR (2 * m) * u ^ m) (fun u => u ^ (2 * m - 1))).
      * apply (is_derive_plus (fun u => INR (2 * m - 1) * u ^ (m - 1)) (fun u => INR (2 * m) * u ^ m));
          apply (is_derive_scal (fun u => u ^ _)); apply is_derive_pow; apply (is_derive_id (K := R_AbsRing)).
      * apply is_derive_pow; apply (is_derive_id (K := R_AbsRing)).
    + apply (is_derive_pow (fun u => 1 + u ^ m)). evar_last.
      * apply (is_derive_plus (fun _ => 1) (fun u => u ^ m)); [apply (is_derive_const (V := R_NormedModule))|].
        apply is_derive_pow; apply (is_derive_id (K := R_AbsRing)).
      * unfold plus, zero, one; simpl. ring.
    + apply pow_nonzero. lra.
  - set (v := u ^ (m - 2)).
    assert (E1 : u ^ (m - 1) = u * v) by (unfold v; rewrite tech_pow_Rmult; f_equal; lia).
    assert (E2 : u ^ m = u * u * v) by (unfold v; rewrite Rmult_assoc, !tech_pow_Rmult; f_equal; lia).
    assert (E3 : u ^ (2 * m - 1) = u * u * u * v * v).
    { replace (2 * m - 1)%nat with (3 + ((m - 2) + (m - 2)))%nat by lia. rewrite !pow_add. fold v. ring. }
    assert (E4 : u ^ (m + 1) = u * u * u * v) by (replace (m + 1)%nat with (3 + (m - 2))%nat by lia; rewrite pow_add; fold v; ring).
    assert (E5 : u ^ (2 * m) = u * u * u * u * v * v).
    { replace (2 * m)%nat with (4 + ((m - 2) + (m - 2)))%nat by lia. rewrite !pow_add. fold v. ring. }
    replace (pred (m - 1)) with (m - 2)%nat by lia. replace (pred m) with (m - 1)%nat by lia. replace (pred (2 * m - 1)) with (2 * m - 2)%nat by lia.
    assert (E6 : u ^ (2 * m - 2) = u * u * v * v).
    { replace (2 * m - 2)%nat with (2 + ((m - 2) + (m - 2)))%nat by lia. rewrite !pow_add. fold v. ring. }
    unfold P. fold v. rewrite E1, E2, E3, E4, E5, E6 in *. clearbody v.
    rewrite !mult_INR, !(minus_INR _ 1), plus_INR, !mult_INR by lia. change (INR 2) with 2. change (INR 1) with 1. cbn [pred].
    set (k := INR m). clearbody k. unfold minus, plus, opp; simpl. field. lra.
Qed.
Lemma P_beyond d u : (forall t, 0 <= t <= / d -> 0 <= P_far t) -> 0 < d -> d <= u -> 0 <= P u.
Proof.
  intros H Pd Hu. set (t := / u). assert (Tr : 0 <= t <= / d) by (split; [left; apply Rinv_0_lt_compat; lra|apply Rinv_le_contravar; lra]).
  specialize (H t Tr). assert (E : u * t = 1) by (apply Rinv_r; lra).
  replace (P u) with (u ^ (2 * m) * P_far t); [apply Rmult_le_pos; auto; apply pow_le; lra|]. unfold P_far, P.
  assert (T : forall j, (j <= 2 * m)%nat -> u ^ (2 * m) * t ^ j = u ^ (2 * m - j)).
  { intros j Hj. replace (2 * m)%nat with ((2 * m - j) + j)%nat at 1 by lia. rewrite pow_add, Rmult_assoc, <- Rpow_mult_distr, E, pow1. ring. }
  pose proof (T (2 * m)%nat ltac:(lia)) as T1. pose proof (T (2 * m - 1)%nat ltac:(lia)) as T2. pose proof (T m ltac:(lia)) as T3. pose proof (T (m - 1)%nat ltac:(lia)) as T4.
  replace (2 * m - 2 * m)%nat with 0%nat in T1 by lia. replace (2 * m - (2 * m - 1))%nat with 1%nat in T2 by lia.
  replace (2 * m - m)%nat with m in T3 by lia. replace (2 * m - (m - 1))%nat with (m + 1)%nat in T4 by lia. rewrite pow_O in T1. rewrite pow_1 in T2.
  set (c0 := INR ((2 * m - 1) * (m - 1))). set (k := INR (2 * m * m)). set (c1 := INR ((2 * m - 1) * (m + 2))). set (N := u ^ (2 * m)) in *.
  transitivity (c0 * (N * t ^ (2 * m)) + k * (N * t ^ (2 * m - 1)) - c1 * (N * t ^ m) - k * (N * t ^ (m - 1)) + N).
  { generalize (t ^ (2 * m)), (t ^ (2 * m - 1)), (t ^ m), (t ^ (m - 1)). intros. ring. }
  now rewrite T1, T2, T3, T4, Rmult_1_r.
Qed.

Lemma monotone_slope (Q : R -> Prop) : (forall u, Q u -> 0 <= u) -> (forall x y z, Q x -> Q y -> x <= z <= y -> Q z) ->
  (forall u, Q u -> 0 <= P u) \/ (forall u, Q u -> P u <= 0) -> monotone slope Q.
Proof.
  intros Pos Cv S.
  assert (E : forall x y, Q x -> Q y -> x <= y -> exists z, Q z /\ slope y - slope x = z ^ (m - 2) * P z / (1 + z ^ m) ^ 3 * (y - x)).
  { intros x y Hx Hy Hxy. pose proof (Pos x Hx) as X0. destruct (MVT_gen slope x y (fun z => z ^ (m - 2) * P z / (1 + z ^ m) ^ 3)) as (z & Hz & E).
    - intros z Hz. rewrite Rmin_left, Rmax_right in Hz by lra. apply slope_rate. lra.
    - intros z Hz. rewrite Rmin_left, Rmax_right in Hz by lra. apply derivable_continuous_pt. eexists. apply is_derive_Reals, slope_rate. lra.
    - rewrite Rmin_left, Rmax_right in Hz by lra. exists z. split; [now apply (Cv x y)|exact E]. }
  assert (D : forall z, 0 <= z -> 0 <= z ^ (m - 2) /\ 0 < / (1 + z ^ m) ^ 3).
  { intros z Hz. split; [now apply pow_le|]. apply Rinv_0_lt_compat, pow_lt. pose proof (pow_le z m Hz). lra. }
  destruct S as [S|S]; [left|right]; intros x y Hx Hy Hxy; destruct (E x y Hx Hy Hxy) as (z & Hz & Ez);
    destruct (D z (Pos z Hz)) as [D1 D2]; specialize (S z Hz); unfold Rdiv in Ez.
  - assert (0 <= z ^ (m - 2) * P z * / (1 + z ^ m) ^ 3 * (y - x)) by (repeat apply Rmult_le_pos; lra). lra.
  - assert (0 <= z ^ (m - 2) * - P z * / (1 + z ^ m) ^ 3 * (y - x)) by (repeat apply Rmult_le_pos; lra). lra.
Qed.
(** What is monotone in u is so in x. *)
Lemma monotone_in_x (X Q : R -> Prop) : (forall x, X x -> 0 <= x /\ Q (sinh x ^ 2)) -> monotone slope Q -> monotone (dh m) X.
Proof.
  intros H [S|S]; [left|right]; intros x y Hx Hy Hxy; destruct (H x Hx), (H y Hy); rewrite !dh_slope; apply S; auto; apply sinh2_le; lra.
Qed.

(** *** Brackets, in x as floats and in u as numbers between *)
Lemma abs_in_u x y : Rabs x <= y -> sinh x ^ 2 <= sinh y ^ 2.
Proof.
  intros H. replace (sinh x ^ 2) with (sinh (Rabs x) ^ 2); [apply sinh2_le; split; [apply Rabs_pos|exact H]|].
  unfold Rabs. destruct (Rcase_abs x); [rewrite Family.sinh_odd; ring|reflexivity].
Qed.
Section H.
Variables (a b A B : R).
Hypothesis Hab : 0 <= a <= b.
Hypothesis GA : 0 <= g A /\ 0 < A /\ sinh a ^ 2 <= A.
Hypothesis GB : g B <= 0 /\ 0 < B /\ B <= sinh b ^ 2.
Lemma h_pieces : exists p0, forall p, p <= p0 -> pieces (h m) p [(- b, - a); (a, b)].
Proof.
  assert (Mid : monotone (h m) (fun x => - a <= x <= a)).
  { apply (monotone_by (h m) (dh m)); [apply Family.h_derive; lia|intros; lra|]. left. intros x Hx. apply (sign_of_dh x), (g_before A); try tauto.
    split; [apply pow2_ge_0|]. eapply Rle_trans; [apply (abs_in_u x a); apply Rabs_le; lra|tauto]. }
  assert (Far : monotone (h m) (fun x => b <= x)).
  { apply (monotone_by (h m) (dh m)); [apply Family.h_derive; lia|intros; lra|]. right. intros x Hx. apply (sign_of_dh x), (g_beyond B); try tauto.
    eapply Rle_trans; [apply GB|]. apply sinh2_le. lra. }
  exists (- b). intros p Hp. cbn [pieces]. repeat split; try lra; auto.
  apply (monotone_less _ (fun x => b <= - x)); [intros; lra|]. apply (monotone_odd (h m) (fun x => b <= x)); auto. apply Family.h_odd; lia.
Qed.
End H.
Section Dh.
Variables (a b c d A B C D : R).
Hypothesis Habcd : 0 <= a <= b /\ b <= c <= d.
Hypothesis PA : forall u, 0 <= u <= A -> 0 <= P u.
Hypothesis PB : forall u, B <= u <= C -> P u <= 0.
Hypothesis PD : 0 < D /\ forall t, 0 <= t <= / D -> 0 <= P_far t.
Hypothesis HA : sinh a ^ 2 <= A.
Hypothesis HB : B <= sinh b ^ 2.
Hypothesis HC : sinh c ^ 2 <= C.
Hypothesis HD : D <= sinh d ^ 2.
Lemma dh_pieces : exists p0, forall p, p <= p0 -> pieces (dh m) p [(- d, - c); (- b, - a); (0, 0); (a, b); (c, d)].
Proof.
  assert (Near : monotone (dh m) (fun x => 0 <= x <= a)).
  { apply (monotone_in_x _ (fun u => 0 <= u <= A)); [|apply monotone_slope; auto; intros; lra]. intros x Hx.
    pose proof (sinh2_le x a ltac:(lra)). pose proof (pow2_ge_0 (sinh x)). lra. }
  assert (Mid : monotone (dh m) (fun x => b <= x <= c)).
  { apply (monotone_in_x _ (fun u => 0 <= u /\ B <= u <= C)); [|apply monotone_slope; try (intros; lra); right; intros; apply PB; lra].
    intros x Hx. pose proof (sinh2_le x c ltac:(lra)). pose proof (sinh2_le b x ltac:(lra)). pose proof (pow2_ge_0 (sinh x)). lra. }
  assert (Far : monotone (dh m) (fun x => d <= x)).
  { apply (monotone_in_x _ (fun u => D <= u)); [|apply monotone_slope; try (intros; lra); left; intros; now apply (P_beyond D)].
    intros x Hx. pose proof (sinh2_le d x ltac:(lra)). lra. }
  assert (Mirror : forall X Y : R -> Prop, (forall x, Y x -> X (- x)) -> monotone (dh m) X -> monotone (dh m) Y).
  { intros X Y H Mo. apply (monotone_less _ (fun x => X (- x))); auto. apply monotone_even; auto. apply Family.dh_even; lia. }
  exists (- d). intros p Hp. cbn [pieces]. repeat split; try lra; auto.
  - apply (Mirror (fun x => d <= x)); auto; intros; lra.
  - apply (Mirror (fun x => b <= x <= c)); auto; intros; lra.
  - apply (Mirror (fun x => 0 <= x <= a)); auto; intros; lra.
Qed.
End Dh.
End Turns.
