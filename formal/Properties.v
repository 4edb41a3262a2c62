(** Properties 2.1 to 2.6 of one arm, with numbers or with parameters between numbers. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia Reals.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Require Loop.
Require Import Arm Boxes Bridge Certified.
Import ListNotations.
Open Scope R_scope.

Theorem M_below_by_rows A high : (0 < joints A)%nat -> symmetric A = true ->
  forall_to (joints A) (fun i => Qle_bool (row A i) high) = true -> M_below A high.
Proof. intros Hn Sym H q x. now apply M_at_most. Qed.
Theorem C_below_by_squares A high : symmetric A = true -> Qle_bool (squares A) (high * high) = true -> Qle_bool 0 high = true -> C_below A high.
Proof. intros Sym H P q x y. now apply C_at_most. Qed.
Theorem M_above_by_boxes A low angles ks alpha turn fuel : (0 < joints A)%nat -> symmetric A = true -> all_known A angles ks = true ->
  List.length turn = List.length angles -> forallb (fun s => covers s (I.pi prec) (I.pi prec)) turn = true ->
  mass_shown A angles ks alpha turn (lift IA (problem_of A angles ks [] [] 0 0 0 0 0)) fuel turn = true ->
  Qle_bool alpha low = false -> M_above A low.
Proof.
  intros Hn Sym Known Ht Hc Hs Ha q. split; [intros; now apply symmetric_true|]. intros x (i & Hi & Hx).
  eapply Rlt_le_trans; [|exact (mass_low A angles ks Hn Sym Known alpha turn Ht Hc fuel Hs q x)]. apply Rmult_lt_compat_r.
  - unfold Definitions.dot. pose proof (Loop.term_le_sum (joints A) (fun j => x j * x j) i ltac:(intros; nra) Hi). simpl in *. nra.
  - destruct (Rlt_dec (Q2R low) (Q2R alpha)) as [|N]; auto. exfalso.
    assert (K : (alpha <= low)%Q) by (apply Rle_Qle; lra). apply Qle_bool_iff in K. congruence.
Qed.

(** *** With parameters *)
Section Mixed.
Variable A : arm.
Notation n := (joints A).
Variable p : vec.
(** The numbers that multiply the harmonics of a monomial, and their sum. *)
Definition factor_of (t : monomial) : R := product (length (fst t) - 2 * n) (fun k => p k ^ nth (2 * n + k) (fst t) 0%nat).
Definition mixed (f : list harmonic -> list harmonic) (q : vec) (ts : list monomial) : R :=
  fold_right (fun t s => factor_of t * Arm.total n q (f (of_monomial n t)) + s) 0 ts.
Notation entry := (fun i j => nth j (nth i (mass A) []) []).
Lemma M_mixed q i j : M_with A p q i j = mixed (fun ts => ts) q (entry i j).
Proof.
  unfold M_with, mixed, factor_of. cbv zeta. induction (entry i j) as [|t ts IH]; [reflexivity|]. cbn [fold_right]. rewrite IH. f_equal. f_equal.
  symmetry. apply total_of_monomial.
Qed.
Lemma mixed_rate (q : R -> vec) t v ts : (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
  is_derive (fun s => mixed (fun ts => ts) (q s) ts) t (sum n (fun l => mixed (map (slope l)) (q t) ts * v l)).
Proof.
  intros D. induction ts as [|m ts IH]; unfold mixed in *; cbn [fold_right].
  - rewrite (Loop.sum_ext n _ (fun _ => 0)) by (intros; ring). rewrite Loop.sum_const, Rmult_0_r. apply (is_derive_const (V := R_NormedModule) 0).
  - evar_last.
    + apply (is_derive_plus (fun s => factor_of m * Arm.total n (q s) (of_monomial n m)) (fun s => mixed (fun ts => ts) (q s) ts)); [|exact IH].
      apply (is_derive_scal (fun s => Arm.total n (q s) (of_monomial n m))). exact (total_rate A q t v (of_monomial n m) D).
    + unfold plus; simpl. rewrite <- Loop.sum_scal, <- Loop.sum_plus. apply Loop.sum_ext; intros; ring.
Qed.
Lemma partial_mixed q i j l : (l < n)%nat -> partial (fun q => M_with A p q i j) l q = mixed (map (slope l)) q (entry i j).
Proof.
  intros Hl. apply (partial_along A _ (fun l => mixed (map (slope l)) q (entry i j)) l q Hl). intros c t v E D.
  apply (is_derive_ext (fun s => mixed (fun ts => ts) (c s) (entry i j))); [intros; symmetry; apply M_mixed|].
  evar_last; [apply (mixed_rate c t v _ D)|]. apply Loop.sum_ext; intros k _. f_equal. unfold mixed. induction (entry i j) as [|m ts IH]; [reflexivity|].
  cbn [fold_right]. rewrite IH. do 2 f_equal. now apply total_same.
Qed.

(** M has the same monomials on both sides of the diagonal. *)
Definition entry_eq (x y : list monomial) : {x = y} + {x <> y}.
Proof. repeat decide equality. Defined.
Definition alike : bool := forall_to n (fun i => forall_to n (fun j => if entry_eq (entry i j) (entry j i) then true else false)).
Hypothesis Alike : alike = true.
Lemma with_symmetric q i j : (i < n)%nat -> (j < n)%nat -> M_with A p q i j = M_with A p q j i.
Proof.
  intros Hi Hj. pose proof (forall_to_true _ _ (forall_to_true _ _ Alike i Hi) j Hj) as K. cbv beta in K.
  unfold M_with. destruct (entry_eq (entry i j) (entry j i)) as [E|]; [|discriminate]. now rewrite E.
Qed.
Lemma with_rate (q : R -> vec) t w : let C := christoffel n (M_with A p) (q t) w in is_rate A p q w t (fun i j => C i j + C j i).
Proof.
  intros C D i j Hi Hj. apply (is_derive_ext (fun s => mixed (fun ts => ts) (q s) (entry i j))); [intros; symmetry; apply M_mixed|].
  evar_last; [apply (mixed_rate q t w _ D)|]. unfold C, christoffel. rewrite <- Loop.sum_plus. apply Loop.sum_ext; intros k Hk.
  rewrite <- partial_mixed by auto.
  assert (Sy : forall a b l, (a < n)%nat -> (b < n)%nat -> partial (fun q => M_with A p q a b) l (q t) = partial (fun q => M_with A p q b a) l (q t)).
  { intros a b l Ha Hb. apply Derive_ext. intros x. now apply with_symmetric. }
  rewrite (Sy j i k), (Sy j k i), (Sy i k j) by auto. field.
Qed.
End Mixed.

Theorem M_symmetric_by_entries A ranges : alike A = true -> M_symmetric A ranges.
Proof. intros H p q _ i j Hi Hj. now apply with_symmetric. Qed.
Theorem C_is_0_at_rest A ranges : C_at_rest A ranges.
Proof.
  intros p q _ i j _ _. unfold christoffel. rewrite (Loop.sum_ext _ _ (fun _ => 0)) by (intros; ring). rewrite Loop.sum_const. ring.
Qed.
Theorem M_rate_by_entries A ranges : alike A = true -> M_rate_by_C A ranges.
Proof. intros H p q w t _. now apply with_rate. Qed.
Theorem M_rate_less_2C_by_entries A ranges : alike A = true -> M_rate_less_2C A ranges.
Proof.
  intros H p q w t _. cbv zeta. set (C := christoffel _ _ _ _). exists (fun i j => C i j + C j i). split; [now apply with_rate|].
  split; [intros; ring|]. set (n := joints A).
  assert (E : Definitions.dot n w (apply_ n (fun i j => C i j + C j i - 2 * C i j) w) = sum n (fun i => sum n (fun j => w i * C j i * w j)) - sum n (fun i => sum n (fun j => w i * C i j * w j))).
  { rewrite <- Loop.sum_minus. apply Loop.sum_ext; intros i _. unfold apply_, Definitions.dot. rewrite <- Loop.sum_minus, <- Loop.sum_scal. apply Loop.sum_ext; intros; ring. }
  rewrite E, Loop.sum_swap. rewrite <- Loop.sum_minus. rewrite (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|].
  intros i _. rewrite <- Loop.sum_minus. rewrite (Loop.sum_ext n _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros; ring.
Qed.
