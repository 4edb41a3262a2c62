(** An arm from its data: M(q) as a sum of harmonics a cos(k.q) + b sin(k.q), its derivatives, the bounds beta and
    kc, and the record of a robot. *)
From Coq Require Import Reals QArith Qreals List Lra Lia Psatz Bool.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Require Loop Converge.
Import Loop(sum_ext, sum_plus, sum_minus, sum_scal, sum_swap, sum_le, sum_nonneg, norm_pos, dot_pos, norm2, is_derive_sum, cauchy_schwarz).
Import ListNotations.
Open Scope R_scope.

Local Arguments Qred : simpl never. Local Arguments Q2R : simpl never. Local Arguments Qplus : simpl never.
Local Arguments Qminus : simpl never. Local Arguments Qmult : simpl never. Local Arguments Qopp : simpl never.

(** ** Harmonics *)
Definition harmonic := (list Z * Q * Q)%type.
Definition phase (n : nat) (k : list Z) (q : vec) : R := sum n (fun i => IZR (nth i k 0%Z) * q i).
Definition wave (n : nat) (q : vec) (t : harmonic) : R :=
  let '(k, a, b) := t in Q2R a * cos (phase n k q) + Q2R b * sin (phase n k q).
Definition total (n : nat) (q : vec) (ts : list harmonic) : R := fold_right (fun t s => wave n q t + s) 0 ts.

Definition tab {X} (n : nat) (f : nat -> X) : list X := map f (seq 0 n).
Lemma nth_tab {X} n (f : nat -> X) d i : (i < n)%nat -> nth i (tab n f) d = f i.
Proof.
  intros H. unfold tab. rewrite (nth_indep _ d (f 0%nat)) by (rewrite map_length, seq_length; auto). rewrite map_nth, seq_nth by auto. reflexivity.
Qed.
Lemma length_tab {X} n (f : nat -> X) : length (tab n f) = n.
Proof. unfold tab. now rewrite map_length, seq_length. Qed.
Lemma Q2R_0 : Q2R 0 = 0. Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_half : Q2R (1 # 2) = / 2. Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_red x : Q2R (Qred x) = Q2R x. Proof. apply Qeq_eqR, Qred_correct. Qed.
Lemma le_Q x y : Qle_bool x y = true -> Q2R x <= Q2R y.
Proof. intros H. apply Qle_Rle, Qle_bool_iff, H. Qed.

(** Sums of harmonics with the same k, or with k and -k, become one. *)
Definition same (k l : list Z) : bool := if list_eq_dec Z.eq_dec k l then true else false.
Fixpoint add (t : harmonic) (ts : list harmonic) : list harmonic :=
  match ts with
  | [] => [t]
  | (l, c, d) :: ts' =>
      let '(k, a, b) := t in
      if same k l then (l, Qred (c + a), Qred (d + b)) :: ts'
      else if same (map Z.opp k) l then (l, Qred (c + a), Qred (d - b)) :: ts' else (l, c, d) :: add t ts'
  end.
Definition zero (t : harmonic) : bool := let '(_, a, b) := t in Qeq_bool a 0 && Qeq_bool b 0.
(** cos and sin of -k.q are those of k.q, up to a sign. *)
Fixpoint negative (k : list Z) : bool := match k with [] => false | z :: k' => if Z.eqb z 0 then negative k' else Z.ltb z 0 end.
Definition upright (t : harmonic) : harmonic := let '(k, a, b) := t in if negative k then (map Z.opp k, a, Qred (- b)) else t.
Definition normal (ts : list harmonic) : list harmonic := filter (fun t => negb (zero t)) (fold_right (fun t us => add (upright t) us) [] ts).

Section Angles.
Variable n : nat.
Variable q : vec.
Notation wave := (wave n q).
Notation total := (total n q).
Lemma phase_opp k : phase n (map Z.opp k) q = - phase n k q.
Proof.
  unfold phase. replace (- sum n (fun i => IZR (nth i k 0%Z) * q i)) with (-1 * sum n (fun i => IZR (nth i k 0%Z) * q i)) by ring.
  rewrite <- sum_scal. apply sum_ext; intros i Hi. replace (nth i (map Z.opp k) 0%Z) with (- nth i k 0%Z)%Z.
  - rewrite opp_IZR. ring.
  - change 0%Z with (Z.opp 0) at 2. now rewrite map_nth.
Qed.
Lemma total_app ts us : total (ts ++ us) = total ts + total us.
Proof. induction ts; simpl; [ring|]. rewrite IHts. ring. Qed.
Lemma total_add t ts : total (add t ts) = wave t + total ts.
Proof.
  induction ts as [|[[l c] d] ts IH]; [reflexivity|]. destruct t as [[k a] b]. simpl add. unfold same.
  destruct (list_eq_dec Z.eq_dec k l) as [->|]; [simpl; rewrite !Q2R_red, !Q2R_plus; ring|].
  destruct (list_eq_dec Z.eq_dec (map Z.opp k) l) as [<-|].
  - simpl. rewrite !Q2R_red, Q2R_plus, Q2R_minus, phase_opp, cos_neg, sin_neg. ring.
  - simpl in *. rewrite IH. ring.
Qed.
Lemma wave_zero t : zero t = true -> wave t = 0.
Proof.
  destruct t as [[k a] b]. simpl. intros H. apply andb_prop in H. destruct H as [A B].
  apply Qeq_bool_iff, Qeq_eqR in A. apply Qeq_bool_iff, Qeq_eqR in B. rewrite A, B, Q2R_0. ring.
Qed.
Lemma wave_upright t : wave (upright t) = wave t.
Proof.
  destruct t as [[k a] b]. unfold upright. destruct (negative k); [|reflexivity]. simpl. rewrite Q2R_red, Q2R_opp, phase_opp, cos_neg, sin_neg. ring.
Qed.
Lemma total_normal ts : total (normal ts) = total ts.
Proof.
  unfold normal. transitivity (total (fold_right (fun t us => add (upright t) us) [] ts)).
  - induction (fold_right (fun t us => add (upright t) us) [] ts) as [|t us IH]; [reflexivity|]. simpl. destruct (zero t) eqn:Z; simpl; rewrite IH; auto.
    rewrite (wave_zero t Z). ring.
  - induction ts as [|t ts IH]; [reflexivity|]. simpl. rewrite total_add, wave_upright, IH. reflexivity.
Qed.
Lemma total_flat f g ts : (forall t, total (f t) = g * wave t) -> total (flat_map f ts) = g * total ts.
Proof. intros H. induction ts; simpl; [ring|]. rewrite total_app, H, IHts. ring. Qed.

(** sin q_i and cos q_i times a harmonic *)
Definition shift (i : nat) (d : Z) (k : list Z) : list Z := tab n (fun j => if Nat.eqb j i then nth j k 0 + d else nth j k 0)%Z.
Lemma phase_shift i d k : (i < n)%nat -> phase n (shift i d k) q = phase n k q + IZR d * q i.
Proof.
  intros Hi. unfold phase. rewrite (sum_ext n _ (fun j => IZR (nth j k 0%Z) * q j + (if Nat.eqb j i then IZR d * q j else 0))).
  - rewrite sum_plus. f_equal. clear k. induction n as [|m IH]; [lia|]. simpl. destruct (Nat.eqb_spec m i) as [->|N].
    + rewrite (sum_ext i _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros j Hj. destruct (Nat.eqb_spec j i); [lia|auto].
    + rewrite IH by lia. ring.
  - intros j Hj. unfold shift. rewrite nth_tab by auto. destruct (Nat.eqb j i); [rewrite plus_IZR|]; ring.
Qed.
Definition half (x : Q) : Q := Qred (x * (1 # 2)).
Lemma Q2R_half_of x : Q2R (half x) = Q2R x / 2.
Proof. unfold half. rewrite Q2R_red, Q2R_mult, Q2R_half. field. Qed.
Definition times_sin (i : nat) (t : harmonic) : list harmonic :=
  let '(k, a, b) := t in [(shift i 1 k, half (- b), half a); (shift i (-1) k, half b, half (- a))].
Definition times_cos (i : nat) (t : harmonic) : list harmonic :=
  let '(k, a, b) := t in [(shift i 1 k, half a, half b); (shift i (-1) k, half a, half b)].
Lemma total_times_sin i t : (i < n)%nat -> total (times_sin i t) = sin (q i) * wave t.
Proof.
  intros Hi. destruct t as [[k a] b]. simpl. rewrite !phase_shift, !Q2R_half_of, !Q2R_opp by auto.
  replace (phase n k q + 1 * q i) with (phase n k q + q i) by ring. replace (phase n k q + -1 * q i) with (phase n k q - q i) by ring.
  rewrite cos_plus, cos_minus, sin_plus, sin_minus. field.
Qed.
Lemma total_times_cos i t : (i < n)%nat -> total (times_cos i t) = cos (q i) * wave t.
Proof.
  intros Hi. destruct t as [[k a] b]. simpl. rewrite !phase_shift, !Q2R_half_of by auto.
  replace (phase n k q + 1 * q i) with (phase n k q + q i) by ring. replace (phase n k q + -1 * q i) with (phase n k q - q i) by ring.
  rewrite cos_plus, cos_minus, sin_plus, sin_minus. field.
Qed.
Definition repeated (f : harmonic -> list harmonic) (p : nat) (ts : list harmonic) : list harmonic :=
  Nat.iter p (fun us => normal (flat_map f us)) ts.
Lemma total_repeated f g p ts : (forall t, total (f t) = g * wave t) -> total (repeated f p ts) = g ^ p * total ts.
Proof.
  intros H. induction p; simpl; [ring|]. unfold repeated in *. simpl. rewrite total_normal, (total_flat f g) by auto.
  rewrite IHp. ring.
Qed.
Fixpoint powers (f : nat -> harmonic -> list harmonic) (p : nat -> nat) (k : nat) (ts : list harmonic) : list harmonic :=
  match k with O => ts | S k' => repeated (f k') (p k') (powers f p k' ts) end.
Lemma total_powers f g p k ts : (k <= n)%nat -> (forall i t, (i < n)%nat -> total (f i t) = g i * wave t) ->
  total (powers f p k ts) = product k (fun i => g i ^ p i) * total ts.
Proof.
  intros Hk H. induction k; simpl; [ring|]. rewrite (total_repeated (f k) (g k)) by (intros; apply H; lia). rewrite IHk by lia. ring.
Qed.
Definition of_monomial (t : monomial) : list harmonic :=
  powers times_cos (fun i => nth (n + i) (fst t) 0%nat) n (powers times_sin (fun i => nth i (fst t) 0%nat) n [(tab n (fun _ => 0%Z), snd t, 0%Q)]).
Lemma total_of_monomial t : total (of_monomial t) = monomial_at n q t.
Proof.
  unfold of_monomial, monomial_at. rewrite (total_powers times_cos (fun i => cos (q i))) by (auto; intros; now apply total_times_cos).
  rewrite (total_powers times_sin (fun i => sin (q i))) by (auto; intros; now apply total_times_sin). simpl.
  assert (E : phase n (tab n (fun _ => 0%Z)) q = 0).
  { unfold phase. rewrite (sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros i Hi. rewrite nth_tab by auto. ring. }
  rewrite E, cos_0, sin_0, Q2R_0. ring.
Qed.
Definition of_monomials (ts : list monomial) : list harmonic := normal (flat_map of_monomial ts).
Lemma total_of_monomials ts : total (of_monomials ts) = fold_right (fun t s => monomial_at n q t + s) 0 ts.
Proof.
  unfold of_monomials. rewrite total_normal. induction ts; simpl; [reflexivity|]. now rewrite total_app, total_of_monomial, IHts.
Qed.

(** The derivative with respect to q_l; multiples; bounds *)
Definition times (c : Q) (t : harmonic) : harmonic := let '(k, a, b) := t in (k, Qred (c * a), Qred (c * b)).
Definition slope (l : nat) (t : harmonic) : harmonic :=
  let '(k, a, b) := t in (k, Qred (inject_Z (nth l k 0%Z) * b), Qred (inject_Z (- nth l k 0%Z) * a)).
Lemma Q2R_inject z : Q2R (inject_Z z) = IZR z. Proof. unfold Q2R; simpl. field. Qed.
Lemma wave_times c t : wave (times c t) = Q2R c * wave t.
Proof. destruct t as [[k a] b]. simpl. rewrite !Q2R_red, !Q2R_mult. ring. Qed.
Lemma total_times c ts : total (map (times c) ts) = Q2R c * total ts.
Proof. induction ts; simpl; [ring|]. rewrite wave_times, IHts. ring. Qed.
Lemma wave_slope l t : wave (slope l t) = let '(k, a, b) := t in IZR (nth l k 0%Z) * (Q2R b * cos (phase n k q) - Q2R a * sin (phase n k q)).
Proof. destruct t as [[k a] b]. simpl. rewrite !Q2R_red, !Q2R_mult, !Q2R_inject, opp_IZR. ring. Qed.
Definition size (ts : list harmonic) : Q := fold_right (fun (t : harmonic) s => let '(k, a, b) := t in Qred (Qabs.Qabs a + Qabs.Qabs b + s)) 0%Q ts.
Lemma Q2R_abs x : Q2R (Qabs.Qabs x) = Rabs (Q2R x).
Proof.
  destruct (Qlt_le_dec x 0) as [H|H].
  - rewrite (Qeq_eqR _ _ (Qabs.Qabs_neg x (Qlt_le_weak _ _ H))), Q2R_opp. apply Qlt_Rlt in H. rewrite Q2R_0 in H. now rewrite Rabs_left.
  - rewrite (Qeq_eqR _ _ (Qabs.Qabs_pos x H)). apply Qle_Rle in H. rewrite Q2R_0 in H. now rewrite Rabs_pos_eq.
Qed.
Lemma total_bound ts : Rabs (total ts) <= Q2R (size ts).
Proof.
  induction ts as [|[[k a] b] ts IH]; simpl; [rewrite Rabs_R0, Q2R_0; lra|]. rewrite Q2R_red, !Q2R_plus, !Q2R_abs.
  eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat; auto. eapply Rle_trans; [apply Rabs_triang|].
  rewrite !Rabs_mult. pose proof (COS_bound (phase n k q)). pose proof (SIN_bound (phase n k q)).
  pose proof (Rabs_pos (Q2R a)). pose proof (Rabs_pos (Q2R b)).
  assert (Rabs (cos (phase n k q)) <= 1) by (apply Rabs_le; lra). assert (Rabs (sin (phase n k q)) <= 1) by (apply Rabs_le; lra). nra.
Qed.
End Angles.

(** ** The arm *)
Section Arm.
Variable A : arm.
Notation n := (joints A).
Definition H (i j : nat) : list harmonic := of_monomials n (nth j (nth i (mass A) []) []).
Lemma M_total q i j : M_of A q i j = total n q (H i j).
Proof. symmetry. apply total_of_monomials. Qed.

Lemma wave_rate (q : R -> vec) t v (w : harmonic) : (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
  is_derive (fun s => wave n (q s) w) t (sum n (fun l => wave n (q t) (slope l w) * v l)).
Proof.
  intros D. destruct w as [[k a] b].
  assert (P : is_derive (fun s => phase n k (q s)) t (sum n (fun l => IZR (nth l k 0%Z) * v l))).
  { apply (is_derive_sum n (fun l s => IZR (nth l k 0%Z) * q s l)). intros i Hi. apply (is_derive_scal (fun s => q s i)). auto. }
  unfold wave at 1. evar_last.
  - apply (is_derive_plus (fun s => Q2R a * cos (phase n k (q s))) (fun s => Q2R b * sin (phase n k (q s)))).
    + apply (is_derive_scal (fun s => cos (phase n k (q s)))). apply (is_derive_comp cos (fun s => phase n k (q s))); [apply is_derive_cos|exact P].
    + apply (is_derive_scal (fun s => sin (phase n k (q s)))). apply (is_derive_comp sin (fun s => phase n k (q s))); [apply is_derive_sin|exact P].
  - set (c := cos (phase n k (q t))). set (s := sin (phase n k (q t))).
    rewrite (sum_ext n (fun l => wave n (q t) (slope l (k, a, b)) * v l) (fun l => (Q2R b * c - Q2R a * s) * (IZR (nth l k 0%Z) * v l))).
    + rewrite sum_scal. unfold scal, plus; simpl; unfold mult; simpl. fold c s. ring.
    + intros l Hl. rewrite wave_slope. fold c s. ring.
Qed.
Lemma total_rate (q : R -> vec) t v ts : (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
  is_derive (fun s => total n (q s) ts) t (sum n (fun l => total n (q t) (map (slope l) ts) * v l)).
Proof.
  intros D. induction ts as [|w ts IH]; simpl.
  - rewrite (sum_ext n _ (fun _ => 0)) by (intros; ring). rewrite Loop.sum_const, Rmult_0_r. apply (is_derive_const (V := R_NormedModule) 0).
  - evar_last; [apply (is_derive_plus (fun s => wave n (q s) w) (fun s => total n (q s) ts)); [apply (wave_rate q t v w D)|exact IH]|].
    unfold plus; simpl. rewrite <- sum_plus. apply sum_ext; intros; ring.
Qed.
Lemma total_same q p ts : (forall i, p i = q i) -> total n p ts = total n q ts.
Proof.
  intros E. induction ts as [|[[k a] b] ts IH]; simpl; [reflexivity|]. rewrite IH.
  assert (P : phase n k p = phase n k q); [|now rewrite P]. apply sum_ext; intros m _. now rewrite E.
Qed.
Lemma one_of m l (D : nat -> R) : (l < m)%nat -> sum m (fun k => D k * (if Nat.eqb k l then 1 else 0)) = D l.
Proof.
  intros Hl. induction m as [|m IH]; [lia|]. simpl. destruct (Nat.eqb_spec m l) as [->|N].
  - rewrite (sum_ext l _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros j Hj. destruct (Nat.eqb_spec j l); [lia|ring].
  - rewrite IH by lia. ring.
Qed.
(** A partial derivative, from the derivatives along curves. *)
Lemma partial_along (F : vec -> R) (D : nat -> R) l q : (l < n)%nat ->
  (forall p t v, (forall i, p t i = q i) -> (forall i, (i < n)%nat -> is_derive (fun s => p s i) t (v i)) ->
    is_derive (fun s => F (p s)) t (sum n (fun k => D k * v k))) -> partial F l q = D l.
Proof.
  intros Hl HF. apply is_derive_unique. evar_last; [|exact (one_of n l D Hl)].
  apply (HF (fun x i => if Nat.eqb i l then x else q i) (q l) (fun k => if Nat.eqb k l then 1 else 0)).
  - intros i. destruct (Nat.eqb_spec i l) as [->|]; reflexivity.
  - intros k Hk. destruct (Nat.eqb_spec k l); [apply (is_derive_id (K := R_AbsRing))|apply (is_derive_const (V := R_NormedModule))].
Qed.
Lemma partial_M i j l q : (l < n)%nat -> partial (fun p => M_of A p i j) l q = total n q (map (slope l) (H i j)).
Proof.
  intros Hl. apply (partial_along _ (fun l => total n q (map (slope l) (H i j))) l q Hl). intros p t v E D.
  apply (is_derive_ext (fun x => total n (p x) (H i j))); [intros; symmetry; apply M_total|].
  evar_last; [apply (total_rate p t v (H i j) D)|]. apply sum_ext; intros k _. now rewrite (total_same q).
Qed.

(** Christoffel's symbols as harmonics *)
Definition c_of (i j k : nat) : list harmonic := normal (map (times (1 # 2))
  (map (slope k) (H i j) ++ map (slope j) (H i k) ++ map (times (-1)) (map (slope i) (H j k)))).
Lemma total_c q i j k : (i < n)%nat -> (j < n)%nat -> (k < n)%nat -> total n q (c_of i j k) =
  (partial (fun p => M_of A p i j) k q + partial (fun p => M_of A p i k) j q - partial (fun p => M_of A p j k) i q) / 2.
Proof.
  intros. unfold c_of. rewrite total_normal, total_times, !total_app, total_times, Q2R_half, !partial_M by auto.
  replace (Q2R (-1)) with (-1) by (unfold Q2R; simpl; lra). field.
Qed.
Lemma C_total q x i j : (i < n)%nat -> (j < n)%nat -> C_of A q x i j = sum n (fun k => total n q (c_of i j k) * x k).
Proof. intros. apply sum_ext; intros k Hk. now rewrite total_c. Qed.

(** Symmetry, by comparing harmonics *)
Definition forall_to (m : nat) (f : nat -> bool) : bool := forallb f (seq 0 m).
Lemma forall_to_true m f : forall_to m f = true -> forall i, (i < m)%nat -> f i = true.
Proof. unfold forall_to. rewrite forallb_forall. intros K i Hi. apply K, in_seq. lia. Qed.
Definition symmetric : bool := forall_to n (fun i => forall_to i (fun j => match normal (H i j ++ map (times (-1)) (H j i)) with [] => true | _ => false end)).
Lemma symmetric_true : symmetric = true -> forall q i j, (i < n)%nat -> (j < n)%nat -> M_of A q i j = M_of A q j i.
Proof.
  intros S q. assert (K : forall i j, (i < n)%nat -> (j < i)%nat -> M_of A q i j = M_of A q j i).
  { intros i j Hi Hj. pose proof (forall_to_true _ _ (forall_to_true _ _ S i Hi) j Hj) as E. cbv beta in E.
    destruct (normal _) eqn:N in E; [|discriminate]. apply (f_equal (total n q)) in N. rewrite total_normal, total_app, total_times in N.
    replace (Q2R (-1)) with (-1) in N by (unfold Q2R; simpl; lra). rewrite !M_total. simpl in N. lra. }
  intros i j Hi Hj. destruct (PeanoNat.Nat.lt_trichotomy i j) as [L|[->|L]]; auto. symmetry. apply K; auto.
Qed.
Hypothesis Sym : symmetric = true.

Lemma rate_of_M (q : R -> vec) t v : (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
  forall i j, (i < n)%nat -> (j < n)%nat -> is_derive (fun s => M_of A (q s) i j) t (C_of A (q t) v i j + C_of A (q t) v j i).
Proof.
  intros D i j Hi Hj. apply (is_derive_ext (fun s => total n (q s) (H i j))); [intros; symmetry; apply M_total|].
  evar_last; [apply (total_rate q t v (H i j) D)|]. unfold C_of, christoffel. rewrite <- sum_plus. apply sum_ext; intros k Hk.
  assert (Sy : forall a b l, (a < n)%nat -> (b < n)%nat -> partial (fun p => M_of A p a b) l (q t) = partial (fun p => M_of A p b a) l (q t)).
  { intros a b l Ha Hb. apply Derive_ext. intros x. now apply symmetric_true. }
  rewrite (Sy j i k), <- (partial_M i j k) by auto. field.
Qed.

(** |x'My| <= beta |x| |y|, by the largest row sum: Schur's test. *)
Variable beta kc : Q.
Definition row (i : nat) : Q := fold_right (fun j s => Qred (size (H i j) + s)) 0%Q (seq 0 n).
Hypothesis Hbeta : forall_to n (fun i => Qle_bool (row i) beta) = true.
Lemma fold_sum (f : nat -> Q) : Q2R (fold_right (fun j s => Qred (f j + s)) 0%Q (seq 0 n)) = sum n (fun j => Q2R (f j)).
Proof.
  assert (K : forall m k, Q2R (fold_right (fun j s => Qred (f j + s)) 0%Q (seq k m)) = sum m (fun j => Q2R (f (k + j)%nat))).
  { induction m; intros k; [apply Q2R_0|]. cbn [seq fold_right]. rewrite Q2R_red, Q2R_plus, IHm.
    assert (E : forall g : nat -> R, g 0%nat + sum m (fun j => g (S j)) = sum (S m) g).
    { clear. intros g. induction m; simpl in *; [ring|]. rewrite <- Rplus_assoc, IHm. ring. }
    rewrite <- (E (fun j => Q2R (f (k + j)%nat))). rewrite PeanoNat.Nat.add_0_r. f_equal. apply sum_ext; intros. do 2 f_equal. lia. }
  rewrite K. reflexivity.
Qed.
Lemma beta_pos : (0 < n)%nat -> 0 <= Q2R beta.
Proof.
  intros Hn. eapply Rle_trans; [|apply le_Q, (forall_to_true _ _ Hbeta 0%nat Hn)]. unfold row. rewrite fold_sum.
  apply sum_nonneg. intros j. eapply Rle_trans; [apply Rabs_pos|apply (total_bound n (fun _ => 0))].
Qed.
Lemma M_at_most q x : (0 < n)%nat -> norm n (apply_ n (M_of A q) x) <= Q2R beta * norm n x.
Proof.
  intros Hn. pose proof (beta_pos Hn) as B0. set (B := Q2R beta) in *.
  set (a := fun i j => Rabs (M_of A q i j)).
  assert (R1 : forall i, (i < n)%nat -> sum n (a i) <= B).
  { intros i Hi. eapply Rle_trans; [|apply le_Q, (forall_to_true _ _ Hbeta i Hi)]. unfold row. rewrite fold_sum.
    apply Converge.sum_le_in. intros j Hj. unfold a. rewrite M_total. apply total_bound. }
  assert (C1 : forall j, (j < n)%nat -> sum n (fun i => a i j) <= B).
  { intros j Hj. rewrite (sum_ext n _ (a j)); [auto|]. intros i Hi. unfold a. now rewrite (symmetric_true Sym q i j). }
  assert (Q1 : forall i, (i < n)%nat -> apply_ n (M_of A q) x i * apply_ n (M_of A q) x i <= B * sum n (fun j => a i j * (x j * x j))).
  { intros i Hi. pose proof (cauchy_schwarz n (fun j => sqrt (a i j)) (fun j => sqrt (a i j) * Rabs (x j))) as K.
    assert (P : forall j, 0 <= a i j) by (intros; apply Rabs_pos).
    assert (E1 : dot n (fun j => sqrt (a i j)) (fun j => sqrt (a i j) * Rabs (x j)) = sum n (fun j => a i j * Rabs (x j))).
    { apply sum_ext; intros j _. rewrite <- Rmult_assoc, sqrt_sqrt; auto. }
    assert (E2 : norm n (fun j => sqrt (a i j)) = sqrt (sum n (a i))).
    { unfold norm, dot. f_equal. apply sum_ext; intros j _. apply sqrt_sqrt; auto. }
    assert (E3 : norm n (fun j => sqrt (a i j) * Rabs (x j)) = sqrt (sum n (fun j => a i j * (x j * x j)))).
    { unfold norm, dot. f_equal. apply sum_ext; intros j _.
      replace (sqrt (a i j) * Rabs (x j) * (sqrt (a i j) * Rabs (x j))) with (sqrt (a i j) * sqrt (a i j) * (Rabs (x j) * Rabs (x j))) by ring.
      rewrite sqrt_sqrt by auto. rewrite <- Rabs_mult, (Rabs_pos_eq (x j * x j)) by nra. reflexivity. }
    rewrite E1, E2, E3 in K. set (s := sum n (fun j => a i j * (x j * x j))) in *.
    assert (S0 : 0 <= s) by (apply sum_nonneg; intros j; apply Rmult_le_pos; [auto|nra]).
    assert (R0 : 0 <= sum n (a i)) by (apply sum_nonneg; auto).
    assert (U1 : Rabs (apply_ n (M_of A q) x i) <= sum n (fun j => a i j * Rabs (x j))).
    { unfold apply_, dot. clear. induction n as [|m IH]; simpl; [rewrite Rabs_R0; lra|]. eapply Rle_trans; [apply Rabs_triang|].
      apply Rplus_le_compat; auto. unfold a. rewrite Rabs_mult. lra. }
    assert (U2 : Rabs (apply_ n (M_of A q) x i) * Rabs (apply_ n (M_of A q) x i) <= (sqrt (sum n (a i)) * sqrt s) * (sqrt (sum n (a i)) * sqrt s)).
    { pose proof (Rabs_pos (apply_ n (M_of A q) x i)). apply Rmult_le_compat; lra. }
    replace ((sqrt (sum n (a i)) * sqrt s) * (sqrt (sum n (a i)) * sqrt s)) with (sqrt (sum n (a i)) * sqrt (sum n (a i)) * (sqrt s * sqrt s)) in U2 by ring.
    rewrite !sqrt_sqrt in U2 by auto. rewrite <- Rabs_mult in U2. pose proof (Rle_abs (apply_ n (M_of A q) x i * apply_ n (M_of A q) x i)).
    assert (sum n (a i) * s <= B * s) by (apply Rmult_le_compat_r; auto). lra. }
  apply Rsqr_incr_0_var; [|apply Rmult_le_pos; [auto|apply norm_pos]]. unfold Rsqr. rewrite norm2.
  replace (B * norm n x * (B * norm n x)) with (B * B * (norm n x * norm n x)) by ring. rewrite norm2. unfold dot.
  eapply Rle_trans; [apply Converge.sum_le_in, Q1|]. rewrite sum_scal, Rmult_assoc. apply Rmult_le_compat_l; auto.
  rewrite sum_swap, <- sum_scal. apply Converge.sum_le_in. intros j Hj.
  rewrite (sum_ext n _ (fun i => x j * x j * a i j)) by (intros; ring). rewrite sum_scal, Rmult_comm. apply Rmult_le_compat_r; [nra|auto].
Qed.

(** |C(q, x) y| <= kc |x| |y|, by the squares of the symbols. *)
Definition squares : Q := fold_right (fun i s => Qred (fold_right (fun j s => Qred (fold_right (fun k s =>
  Qred (size (c_of i j k) * size (c_of i j k) + s)) 0%Q (seq 0 n) + s)) 0%Q (seq 0 n) + s)) 0%Q (seq 0 n).
Hypothesis Hkc : Qle_bool squares (kc * kc) = true.
Hypothesis kc_pos : Qle_bool 0 kc = true.
Lemma C_at_most q x y : norm n (apply_ n (C_of A q x) y) <= Q2R kc * norm n x * norm n y.
Proof.
  assert (K0 : 0 <= Q2R kc) by (pose proof (le_Q _ _ kc_pos) as K; rewrite Q2R_0 in K; exact K).
  set (c := fun i j k => total n q (c_of i j k)).
  assert (Sq : sum n (fun i => sum n (fun j => sum n (fun k => c i j k * c i j k))) <= Q2R kc * Q2R kc).
  { eapply Rle_trans; [|rewrite <- Q2R_mult; apply le_Q, Hkc]. unfold squares. rewrite fold_sum.
    apply sum_le. intros i _. rewrite fold_sum. apply sum_le. intros j _. rewrite fold_sum. apply sum_le. intros k _.
    rewrite Q2R_mult. pose proof (total_bound n q (c_of i j k)) as T. fold (c i j k) in T. apply Rabs_le_between in T. nra. }
  apply Rsqr_incr_0_var; [|apply Rmult_le_pos; [apply Rmult_le_pos; [auto|]|]; apply norm_pos]. unfold Rsqr. rewrite norm2.
  replace (Q2R kc * norm n x * norm n y * (Q2R kc * norm n x * norm n y)) with (Q2R kc * Q2R kc * ((norm n x * norm n x) * (norm n y * norm n y))) by ring.
  rewrite !norm2. pose proof (dot_pos n x) as X. pose proof (dot_pos n y) as Y.
  assert (CS : forall u v : vec, dot n u v * dot n u v <= dot n u u * dot n v v).
  { intros u v. pose proof (cauchy_schwarz n u v) as K1. pose proof (Loop.dot_ge n u v) as K2. rewrite <- (norm2 n u), <- (norm2 n v).
    assert (Rabs (dot n u v) <= norm n u * norm n v) by (apply Rabs_le; lra). pose proof (Rabs_pos (dot n u v)).
    replace (dot n u v * dot n u v) with (Rabs (dot n u v) * Rabs (dot n u v)) by (rewrite <- Rabs_mult; apply Rabs_pos_eq; nra).
    replace (norm n u * norm n u * (norm n v * norm n v)) with ((norm n u * norm n v) * (norm n u * norm n v)) by ring.
    apply Rmult_le_compat; auto. }
  assert (E : forall i, (i < n)%nat -> apply_ n (C_of A q x) y i * apply_ n (C_of A q x) y i <= sum n (fun j => sum n (fun k => c i j k * c i j k)) * (dot n x x * dot n y y)).
  { intros i Hi.
    assert (E1 : apply_ n (C_of A q x) y i = dot n (fun j => dot n (c i j) x) y).
    { apply sum_ext; intros j Hj. rewrite C_total by auto. reflexivity. }
    rewrite E1. eapply Rle_trans; [apply CS|]. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; auto.
    rewrite Rmult_comm, <- sum_scal. apply sum_le. intros j _. cbv beta. rewrite (Rmult_comm (dot n x x)). apply CS. }
  unfold dot at 1. eapply Rle_trans; [apply Converge.sum_le_in, E|].
  rewrite (sum_ext n _ (fun i => dot n x x * dot n y y * sum n (fun j => sum n (fun k => c i j k * c i j k)))) by (intros; ring).
  rewrite sum_scal, Rmult_comm. apply Rmult_le_compat_r; [apply Rmult_le_pos; auto|exact Sq].
Qed.

(** The robot *)
Variables alpha lo hi : Q.
Hypothesis Hn : (0 < n)%nat.
Hypothesis Halpha : 0 < Q2R alpha.
Hypothesis Hlow : forall q x, Q2R alpha * dot n x x <= dot n x (apply_ n (M_of A q) x).
Hypothesis Hlo : 0 < Q2R lo.
Hypothesis Hb : forall_to n (fun i => Qle_bool lo (nth i (viscous A) 0%Q) && Qle_bool (nth i (viscous A) 0%Q) hi) = true.
Lemma b_between i : (i < n)%nat -> Q2R lo <= b_of A i <= Q2R hi.
Proof. intros Hi. pose proof (forall_to_true _ _ Hb i Hi) as K. apply andb_prop in K. destruct K. split; apply le_Q; auto. Qed.
Definition robot_of : robot n.
Proof.
  refine (Robot n (M_of A) (C_of A) (b_of A) (Q2R alpha) (Q2R beta) (Q2R kc) (Q2R lo) (Q2R hi) Halpha (beta_pos Hn) _ Hlo
    _ Hlow _ rate_of_M _ _ b_between).
  - pose proof (le_Q _ _ kc_pos) as K. rewrite Q2R_0 in K. exact K.
  - intros q. apply symmetric_true, Sym.
  - intros q x. now apply M_at_most.
  - apply C_at_most.
  - pose proof (b_between 0 Hn). lra.
Defined.
End Arm.
