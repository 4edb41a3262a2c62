(** Gravity of an arm as data, with parameters between numbers: a bound of each torque by the sizes of its harmonics, that torques
    are the gradient of a potential, and their values at quarters of a turn. *)
From Coq Require Import Reals QArith Qreals Qabs List Lra Lia Psatz Bool ZArith.
From Coquelicot Require Import Coquelicot.
Require Import Definitions GateDefinitions.
Require Loop.
Require Import Arm.
Import ListNotations.
Open Scope R_scope.
Local Arguments Qred : simpl never. Local Arguments Q2R : simpl never. Local Arguments Qplus : simpl never.
Local Arguments Qminus : simpl never. Local Arguments Qmult : simpl never. Local Arguments Qopp : simpl never.

Section Gravity.
Variable n : nat.
Variable rs : list (Q * Q).
(** ** Harmonics with the powers of the parameters that multiply them *)
Definition item := (list nat * list harmonic)%type.
Definition factor (p : vec) (l : list nat) : R := product (length l) (fun k => p k ^ nth k l 0%nat).
Definition worth (p q : vec) (its : list item) : R := fold_right (fun it s => factor p (fst it) * total n q (snd it) + s) 0 its.
Lemma worth_cons p q it its : worth p q (it :: its) = factor p (fst it) * total n q (snd it) + worth p q its. Proof. reflexivity. Qed.
Definition items (f : list harmonic -> list harmonic) (ts : list monomial) : list item := map (fun t => (skipn (2 * n) (fst t), f (of_monomial n t))) ts.
Lemma product_ext m f g : (forall k, (k < m)%nat -> f k = g k) -> product m f = product m g.
Proof. intros E. induction m as [|m IH]; [reflexivity|]. simpl. rewrite IH, E by (intros; try apply E; lia). reflexivity. Qed.
Lemma nth_skip (l : list nat) j k : nth (j + k) l 0%nat = nth k (skipn j l) 0%nat.
Proof. revert l. induction j as [|j IH]; intros l; [reflexivity|]. destruct l; [destruct k; reflexivity|apply IH]. Qed.
Lemma poly_items p q ts : poly_with n ts p q = worth p q (items (fun us => us) ts).
Proof.
  unfold poly_with. induction ts as [|t ts IH]; [reflexivity|]. cbn [fold_right items map]. rewrite worth_cons.
  change (map _ ts) with (items (fun us => us) ts). rewrite IH. f_equal. cbn [fst snd]. rewrite total_of_monomial. f_equal.
  unfold factor. rewrite skipn_length. apply product_ext. intros k _. now rewrite nth_skip.
Qed.
Lemma worth_app p q a b : worth p q (a ++ b) = worth p q a + worth p q b.
Proof. induction a; simpl in *; [ring|]. rewrite IHa. ring. Qed.
(** Those with equal powers together. *)
Fixpoint put (it : item) (gs : list item) : list item := match gs with
  | [] => [it]
  | (l, us) :: gs' => if list_eq_dec PeanoNat.Nat.eq_dec l (fst it) then (l, snd it ++ us) :: gs' else (l, us) :: put it gs' end.
Definition groups (its : list item) : list item := map (fun it => (fst it, normal (snd it))) (fold_right put [] its).
Lemma worth_groups p q its : worth p q (groups its) = worth p q its.
Proof.
  unfold groups. transitivity (worth p q (fold_right put [] its)).
  - induction (fold_right put [] its) as [|it gs IH]; [reflexivity|]. cbn [map]. rewrite !worth_cons, IH. cbn [fst snd]. now rewrite total_normal.
  - induction its as [|it its IH]; [reflexivity|]. cbn [fold_right]. rewrite worth_cons, <- IH. generalize (fold_right put [] its).
    intros gs. induction gs as [|[l us] gs IHg]; [reflexivity|]. cbn [put]. destruct (list_eq_dec _ l (fst it)) as [->|].
    + rewrite !worth_cons. cbn [fst snd]. rewrite total_app. ring.
    + rewrite !worth_cons, IHg. ring.
Qed.

(** ** The sizes of the harmonics *)
Fixpoint Qpow (x : Q) (k : nat) : Q := match k with O => 1%Q | S k' => Qred (x * Qpow x k') end.
Lemma Q2R_pow x k : Q2R (Qpow x k) = Q2R x ^ k.
Proof. induction k as [|k IH]; [unfold Q2R; simpl; lra|]. simpl. now rewrite Q2R_red, Q2R_mult, IH. Qed.
Definition far (k : nat) : Q := let r := nth k rs (0, 0)%Q in if Qle_bool (Qabs (fst r)) (Qabs (snd r)) then Qabs (snd r) else Qabs (fst r).
Fixpoint far_powers (m : nat) (l : list nat) : Q := match m with O => 1%Q | S m' => Qred (far_powers m' l * Qpow (far m') (nth m' l 0%nat)) end.
Lemma far_up p k : in_ranges rs p -> (k < length rs)%nat -> Rabs (p k) <= Q2R (far k).
Proof.
  intros H Hk. specialize (H k Hk). unfold far. cbv zeta. destruct (nth k rs (0, 0)%Q) as [lo hi]. cbn [fst snd] in *.
  assert (A : forall x y : Q, Qle_bool x y = false -> Q2R y <= Q2R x).
  { intros x y F. destruct (Qlt_le_dec x y) as [L|L]; [apply Qlt_le_weak, Qle_bool_iff in L; congruence|now apply Qle_Rle]. }
  destruct (Qle_bool (Qabs lo) (Qabs hi)) eqn:F.
  - apply le_Q in F. rewrite !Q2R_abs in *. revert F. unfold Rabs. destruct (Rcase_abs (p k)), (Rcase_abs (Q2R lo)), (Rcase_abs (Q2R hi)); lra.
  - apply A in F. rewrite !Q2R_abs in *. revert F. unfold Rabs. destruct (Rcase_abs (p k)), (Rcase_abs (Q2R lo)), (Rcase_abs (Q2R hi)); lra.
Qed.
Lemma far_powers_up p l m : in_ranges rs p -> (m <= length rs)%nat -> Rabs (product m (fun k => p k ^ nth k l 0%nat)) <= Q2R (far_powers m l).
Proof.
  intros H Hm. induction m as [|m IH]; [simpl; rewrite Rabs_R1; unfold Q2R; simpl; lra|]. cbn [product far_powers]. rewrite Q2R_red, Q2R_mult, Q2R_pow, Rabs_mult.
  apply Rmult_le_compat; try apply Rabs_pos; [apply IH; lia|]. rewrite <- RPow_abs. apply pow_incr. split; [apply Rabs_pos|apply far_up; auto; lia].
Qed.
Definition size_with (its : list item) : Q := fold_right (fun it s => Qred (far_powers (length (fst it)) (fst it) * size (snd it) + s)) 0%Q its.
Definition short (its : list item) : bool := forallb (fun it : item => Nat.leb (length (fst it)) (length rs)) its.
Lemma size_with_up its p q : in_ranges rs p -> short its = true -> Rabs (worth p q its) <= Q2R (size_with its).
Proof.
  intros Hp. induction its as [|[l us] its IH]; intros S; [simpl; rewrite Rabs_R0, Q2R_0; lra|].
  cbn [short forallb fst] in S. apply andb_prop in S. destruct S as [S1 S2]. apply PeanoNat.Nat.leb_le in S1.
  rewrite worth_cons. cbn [size_with fold_right fst snd]. rewrite Q2R_red, Q2R_plus, Q2R_mult. eapply Rle_trans; [apply Rabs_triang|].
  apply Rplus_le_compat; [|now apply IH]. rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; [now apply far_powers_up|apply total_bound].
Qed.
Definition torque_kept (ts : list monomial) (k : Q) : bool := let gs := groups (items (fun us => us) ts) in short gs && Qle_bool (size_with gs) k.
Lemma torque_kept_true ts k p q : in_ranges rs p -> torque_kept ts k = true -> Rabs (poly_with n ts p q) <= Q2R k.
Proof.
  intros Hp H. apply andb_prop in H. destruct H as [S H]. rewrite poly_items, <- worth_groups. eapply Rle_trans; [now apply size_with_up|now apply le_Q].
Qed.

(** ** The gradient of a potential *)
Lemma worth_rate p (q : R -> vec) t v ts : (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
  is_derive (fun s => worth p (q s) (items (fun us => us) ts)) t (sum n (fun l => worth p (q t) (items (map (slope l)) ts) * v l)).
Proof.
  intros D. induction ts as [|m ts IH].
  - rewrite (Loop.sum_ext n _ (fun _ => 0)) by (intros; simpl; ring). rewrite Loop.sum_const, Rmult_0_r. apply (is_derive_const (V := R_NormedModule) 0).
  - change (is_derive (fun s => factor p (skipn (2 * n) (fst m)) * total n (q s) (of_monomial n m) + worth p (q s) (items (fun us => us) ts)) t
      (sum n (fun l => (factor p (skipn (2 * n) (fst m)) * total n (q t) (map (slope l) (of_monomial n m)) + worth p (q t) (items (map (slope l)) ts)) * v l))).
    set (c := factor p (skipn (2 * n) (fst m))). evar_last.
    + apply (is_derive_plus (fun s => c * total n (q s) (of_monomial n m)) (fun s => worth p (q s) (items (fun us => us) ts))); [|exact IH].
      apply (is_derive_scal (fun s => total n (q s) (of_monomial n m))). exact (total_rate (Arm n [] []) q t v (of_monomial n m) D).
    + unfold plus; simpl. rewrite <- Loop.sum_scal, <- Loop.sum_plus. apply Loop.sum_ext; intros l Hl. ring.
Qed.
Lemma worth_same p q q' f ts : (forall l, q l = q' l) -> worth p q (items f ts) = worth p q' (items f ts).
Proof.
  intros E. induction ts as [|m ts IH]; [reflexivity|]. cbn [items map]. rewrite !worth_cons. change (map _ ts) with (items f ts).
  rewrite IH. do 2 f_equal. now apply (total_same (Arm n [] [])).
Qed.
Lemma partial_items p q ts i : (i < n)%nat -> partial (poly_with n ts p) i q = worth p q (items (map (slope i)) ts).
Proof.
  intros Hi. apply (partial_along (Arm n [] []) _ (fun l => worth p q (items (map (slope l)) ts)) i q Hi). intros c t v E D.
  apply (is_derive_ext (fun s => worth p (c s) (items (fun us => us) ts))); [intros; symmetry; apply poly_items|].
  evar_last; [exact (worth_rate p c t v ts D)|]. apply Loop.sum_ext. intros l Hl. f_equal. now apply worth_same.
Qed.
Definition torque_known (pot ts : list monomial) (i : nat) : bool :=
  forallb (fun it : item => match snd it with [] => true | _ => false end) (groups (items (map (slope i)) pot ++ items (map (times (-1))) ts)).
Lemma torque_known_true pot ts i p q : (i < n)%nat -> torque_known pot ts i = true -> poly_with n ts p q = partial (poly_with n pot p) i q.
Proof.
  intros Hi H. rewrite partial_items by auto.
  assert (Z : worth p q (groups (items (map (slope i)) pot ++ items (map (times (-1))) ts)) = 0).
  { unfold torque_known in H. induction (groups _) as [|[l us] gs IH]; [reflexivity|]. cbn [forallb snd] in H. apply andb_prop in H. destruct H as [H1 H2].
    destruct us; [|discriminate]. rewrite worth_cons, IH by exact H2. simpl. ring. }
  rewrite worth_groups, worth_app in Z.
  assert (M : worth p q (items (map (times (-1))) ts) = - worth p q (items (fun us => us) ts)).
  { clear Z H. induction ts as [|t ts IH]; [simpl; ring|]. cbn [items map]. rewrite !worth_cons. cbn [fst snd].
    change (map (fun t => (skipn (2 * n) (fst t), map (times (-1)) (of_monomial n t))) ts) with (items (map (times (-1))) ts).
    change (map (fun t => (skipn (2 * n) (fst t), of_monomial n t)) ts) with (items (fun us => us) ts).
    rewrite IH, total_times. replace (Q2R (-1)) with (-1) by (unfold Q2R; simpl; lra). ring. }
  rewrite M in Z. rewrite poly_items. lra.
Qed.

(** ** Quarters of a turn *)
Fixpoint turn (k : nat) : Z * Z := match k with O => (1, 0)%Z | S k' => let '(c, s) := turn k' in (- s, c)%Z end.
Definition turn_Z (z : Z) : Z * Z := match z with Z0 => (1, 0)%Z | Zpos p => turn (Pos.to_nat p) | Zneg p => let '(c, s) := turn (Pos.to_nat p) in (c, - s)%Z end.
Lemma turn_up k : cos (INR k * (PI / 2)) = IZR (fst (turn k)) /\ sin (INR k * (PI / 2)) = IZR (snd (turn k)).
Proof.
  induction k as [|k [C S]]; [simpl; rewrite Rmult_0_l, cos_0, sin_0; auto|]. rewrite S_INR. replace ((INR k + 1) * (PI / 2)) with (INR k * (PI / 2) + PI / 2) by ring.
  rewrite cos_plus, sin_plus, cos_PI2, sin_PI2, C, S. cbn [turn]. destruct (turn k) as [c s]. cbn [fst snd]. rewrite opp_IZR. split; ring.
Qed.
Lemma turn_Z_up z : cos (IZR z * (PI / 2)) = IZR (fst (turn_Z z)) /\ sin (IZR z * (PI / 2)) = IZR (snd (turn_Z z)).
Proof.
  destruct z as [|p|p]; [simpl; rewrite Rmult_0_l, cos_0, sin_0; auto| |].
  - cbn [turn_Z]. pose proof (turn_up (Pos.to_nat p)) as K. rewrite INR_IZR_INZ, positive_nat_Z in K. exact K.
  - cbn [turn_Z]. pose proof (turn_up (Pos.to_nat p)) as [C S]. rewrite INR_IZR_INZ, positive_nat_Z in C, S. change (IZR (Z.neg p)) with (IZR (- Z.pos p)). rewrite opp_IZR, Ropp_mult_distr_l_reverse, cos_neg, sin_neg, C, S.
    destruct (turn (Pos.to_nat p)) as [c s]. cbn [fst snd]. now rewrite opp_IZR.
Qed.
Definition quarters (z : list Z) : vec := fun i => IZR (nth i z 0%Z) * (PI / 2).
Fixpoint count (m : nat) (k z : list Z) : Z := match m with O => 0%Z | S m' => (count m' k z + nth m' k 0 * nth m' z 0)%Z end.
Lemma phase_quarters k z : phase n k (quarters z) = IZR (count n k z) * (PI / 2).
Proof.
  unfold phase, quarters. induction n as [|m IH]; [simpl; ring|]. cbn [sum count]. rewrite IH, plus_IZR, mult_IZR. ring.
Qed.
Definition at_quarters (z : list Z) (ts : list harmonic) : Q := fold_right (fun (t : harmonic) s => let '(k, a, b) := t in
  let '(c, d) := turn_Z (count n k z) in Qred (a * inject_Z c + b * inject_Z d + s)) 0%Q ts.
Lemma at_quarters_up z ts : total n (quarters z) ts = Q2R (at_quarters z ts).
Proof.
  induction ts as [|[[k a] b] ts IH]; [simpl; now rewrite Q2R_0|]. cbn [total fold_right at_quarters wave]. change (fold_right _ 0 ts) with (total n (quarters z) ts). rewrite IH, phase_quarters.
  destruct (turn_Z_up (count n k z)) as [C S]. rewrite C, S. destruct (turn_Z (count n k z)) as [c d]. cbn [fst snd]. now rewrite Q2R_red, !Q2R_plus, !Q2R_mult, !Arm.Q2R_inject.
Qed.
Fixpoint powers_of (ps : list Q) (m : nat) (l : list nat) : Q := match m with O => 1%Q | S m' => Qred (powers_of ps m' l * Qpow (nth m' ps 0%Q) (nth m' l 0%nat)) end.
Lemma powers_of_up ps m l : product m (fun k => entries ps k ^ nth k l 0%nat) = Q2R (powers_of ps m l).
Proof. induction m as [|m IH]; [unfold Q2R; simpl; lra|]. cbn [product powers_of]. rewrite Q2R_red, Q2R_mult, Q2R_pow, <- IH. reflexivity. Qed.
Definition value_at (ps : list Q) (z : list Z) (ts : list monomial) : Q := fold_right (fun (it : item) s =>
  Qred (powers_of ps (length (fst it)) (fst it) * at_quarters z (snd it) + s)) 0%Q (items (fun us => us) ts).
Lemma value_at_up ps z ts : poly_with n ts (entries ps) (quarters z) = Q2R (value_at ps z ts).
Proof.
  rewrite poly_items. unfold value_at. induction (items (fun us => us) ts) as [|it its IH]; [simpl; now rewrite Q2R_0|]. rewrite worth_cons. cbn [fold_right].
  rewrite IH, Q2R_red, Q2R_plus, Q2R_mult, at_quarters_up. unfold factor. now rewrite powers_of_up.
Qed.
End Gravity.
