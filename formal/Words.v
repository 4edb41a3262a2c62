(** Numbers made of vectors and matrices for every n, as sums of words x' F1 F2 ... y, and what bounds a word. *)
From Coq Require Import Reals List Lra Lia FunctionalExtensionality.
Require Import Definitions Family Bounds.
From Lyapcheck Require Loop.
Import ListNotations.
Open Scope R_scope.

(** *** Expressions in letters, by their places in two lists *)
Inductive matrix := Nothing | Letter (k : nat) | Turned (A : matrix) | Sum (A B : matrix) | Scaled (c : R) (A : matrix).
Inductive vector := Entry (k : nat) | Zero | Plus (x y : vector) | Times (c : R) (x : vector)
  | Diagonal (k : nat) (x : vector) | Applied (A : matrix) (x : vector).
(** What stands in a word: a diagonal matrix, a matrix, a matrix transposed. *)
Inductive factor := D (k : nat) | A (k : nat) | T (k : nat).
Definition turned (f : factor) : factor := match f with D k => D k | A k => T k | T k => A k end.

Section Words.
Variables (n : nat) (xs : list vec) (ms : list mat).
Definition x_ (k : nat) : vec := nth k xs (fun _ => 0).
Definition m_ (k : nat) : mat := nth k ms (fun _ _ => 0).
Fixpoint mat_of (B : matrix) : mat := match B with
  | Nothing => fun _ _ => 0 | Letter k => m_ k | Turned B => fun i j => mat_of B j i
  | Sum B C => fun i j => mat_of B i j + mat_of C i j | Scaled c B => fun i j => c * mat_of B i j end.
Fixpoint vec_of (x : vector) : vec := match x with
  | Entry k => x_ k | Zero => fun _ => 0 | Plus x y => fun i => vec_of x i + vec_of y i | Times c x => fun i => c * vec_of x i
  | Diagonal k x => fun i => x_ k i * vec_of x i | Applied B x => apply_ n (mat_of B) (vec_of x) end.
Definition act (f : factor) (v : vec) : vec := match f with
  | D k => fun i => x_ k i * v i | A k => apply_ n (m_ k) v | T k => apply_ n (fun i j => m_ k j i) v end.
Fixpoint acting (fs : list factor) (v : vec) : vec := match fs with [] => v | f :: fs => act f (acting fs v) end.
(** x' F1 F2 ... y *)
Definition word (x : nat) (fs : list factor) (y : nat) : R := dot n (x_ x) (acting fs (x_ y)).

Fixpoint factors (t : bool) (B : matrix) : list (R * factor) := match B with
  | Nothing => [] | Letter k => [(1, if t then T k else A k)] | Turned B => factors (negb t) B
  | Sum B C => factors t B ++ factors t C | Scaled c B => map (fun p => (c * fst p, snd p)) (factors t B) end.
Fixpoint expanded (x : vector) : list (R * (list factor * nat)) := match x with
  | Entry k => [(1, ([], k))] | Zero => [] | Plus x y => expanded x ++ expanded y
  | Times c x => map (fun p => (c * fst p, snd p)) (expanded x)
  | Diagonal k x => map (fun p => (fst p, (D k :: fst (snd p), snd (snd p)))) (expanded x)
  | Applied B x => flat_map (fun f => map (fun p => (fst f * fst p, (snd f :: fst (snd p), snd (snd p)))) (expanded x)) (factors false B) end.
Definition dotted (x y : vector) : list (R * (nat * list factor * nat)) := flat_map (fun p => map (fun r =>
  (fst p * fst r, (snd (snd p), rev (map turned (fst (snd p))) ++ fst (snd r), snd (snd r)))) (expanded y)) (expanded x).
Definition total (ws : list (R * (nat * list factor * nat))) : R :=
  fold_right (fun w s => fst w * (let '(x, fs, y) := snd w in word x fs y) + s) 0 ws.

Definition whole (l : list (R * (list factor * nat))) : vec :=
  fun i => fold_right (fun p s => fst p * acting (fst (snd p)) (x_ (snd (snd p))) i + s) 0 l.
Lemma dot_plus x y z : dot n x (fun i => y i + z i) = dot n x y + dot n x z.
Proof. unfold dot. rewrite <- Loop.sum_plus. apply Loop.sum_ext; intros; ring. Qed.
Lemma dot_nothing x : dot n x (fun _ => 0) = 0.
Proof. unfold dot. rewrite (Loop.sum_ext _ _ (fun _ => 0 * 0)), Loop.sum_scal by (intros; ring). ring. Qed.
Lemma act_plus f x y : act f (fun i => x i + y i) = fun i => act f x i + act f y i.
Proof. destruct f; extensionality i; cbn; [ring|apply dot_plus|apply dot_plus]. Qed.
Lemma act_scal f c x : act f (fun i => c * x i) = fun i => c * act f x i.
Proof. destruct f; extensionality i; cbn; [ring|apply Loop.dot_scal_r|apply Loop.dot_scal_r]. Qed.
Lemma act_nothing f : act f (fun _ => 0) = fun _ => 0.
Proof. destruct f; extensionality i; cbn; [ring|apply dot_nothing|apply dot_nothing]. Qed.
Lemma act_whole f l : act f (whole l) = whole (map (fun p => (fst p, (f :: fst (snd p), snd (snd p)))) l).
Proof.
  induction l as [|p l I]; [apply act_nothing|]. unfold whole in *. cbn. rewrite (act_plus f (fun i => fst p * _) _).
  rewrite act_scal. extensionality i. now rewrite I.
Qed.
Lemma whole_app l r : whole (l ++ r) = fun i => whole l i + whole r i.
Proof. extensionality i. unfold whole. induction l as [|p l I]; cbn; [ring|]. rewrite I. ring. Qed.
Lemma whole_scal c l : whole (map (fun p => (c * fst p, snd p)) l) = fun i => c * whole l i.
Proof. extensionality i. unfold whole. induction l as [|p l I]; cbn; [ring|]. rewrite I. ring. Qed.

(** A matrix as the sum of its factors. *)
Definition acted (l : list (R * factor)) (v : vec) : vec := fun i => fold_right (fun p s => fst p * act (snd p) v i + s) 0 l.
Lemma acted_app l r v : acted (l ++ r) v = fun i => acted l v i + acted r v i.
Proof. extensionality i. unfold acted. induction l as [|p l I]; cbn; [ring|]. rewrite I. ring. Qed.
Lemma acted_scal c l v : acted (map (fun p => (c * fst p, snd p)) l) v = fun i => c * acted l v i.
Proof. extensionality i. unfold acted. induction l as [|p l I]; cbn; [ring|]. rewrite I. ring. Qed.
Lemma apply_plus B C v : apply_ n (fun i j => B i j + C i j) v = fun i => apply_ n B v i + apply_ n C v i.
Proof. extensionality i. unfold apply_, dot. rewrite <- Loop.sum_plus. apply Loop.sum_ext; intros; ring. Qed.
Lemma apply_scal c B v : apply_ n (fun i j => c * B i j) v = fun i => c * apply_ n B v i.
Proof. extensionality i. unfold apply_, dot. rewrite <- Loop.sum_scal. apply Loop.sum_ext; intros; ring. Qed.
Lemma factors_correct B : forall t v, apply_ n (if t : bool then fun i j => mat_of B j i else mat_of B) v = acted (factors t B) v.
Proof.
  induction B as [|k|B I|B I C J|c B I]; intros t v.
  - destruct t; extensionality i; unfold acted, apply_; cbn; rewrite Loop.dot_sym; apply dot_nothing.
  - destruct t; extensionality i; unfold acted; cbn; ring.
  - cbn. destruct t; [exact (I false v)|exact (I true v)].
  - cbn. rewrite acted_app, <- I, <- J. destruct t; [apply (apply_plus (fun i j => mat_of B j i))|apply apply_plus].
  - cbn. rewrite acted_scal, <- I. destruct t; [apply (apply_scal c (fun i j => mat_of B j i))|apply apply_scal].
Qed.
Lemma acted_whole l fs : acted l (whole fs) = whole (flat_map (fun f => map (fun p => (fst f * fst p, (snd f :: fst (snd p), snd (snd p)))) fs) l).
Proof.
  induction l as [|f l I]; [reflexivity|]. cbn [flat_map]. rewrite whole_app, <- I. extensionality i. unfold acted at 1. cbn.
  rewrite act_whole. fold (acted l (whole fs) i). f_equal. symmetry.
  apply (f_equal (fun v => v i)) with (x := whole _) (y := fun i => fst f * whole _ i). rewrite <- whole_scal, map_map. reflexivity.
Qed.
Lemma expanded_correct x : vec_of x = whole (expanded x).
Proof.
  induction x as [k| |x I y J|c x I|k x I|B x I]; cbn.
  - extensionality i. unfold whole. cbn. ring.
  - reflexivity.
  - now rewrite whole_app, I, J.
  - now rewrite whole_scal, I.
  - rewrite I. apply (act_whole (D k)).
  - rewrite (factors_correct B false), I. apply acted_whole.
Qed.
(** x'F y = (F'x)'y *)
Lemma dot_act f x y : dot n (act f x) y = dot n x (act (turned f) y).
Proof.
  destruct f; cbn; unfold dot, apply_, dot.
  - apply Loop.sum_ext; intros; ring.
  - transitivity (sum n (fun i => sum n (fun j => m_ k i j * x j * y i))).
    + apply Loop.sum_ext; intros i _. rewrite (Rmult_comm _ (y i)), <- Loop.sum_scal. apply Loop.sum_ext; intros; ring.
    + rewrite Loop.sum_swap. apply Loop.sum_ext; intros i _. rewrite <- Loop.sum_scal. apply Loop.sum_ext; intros; ring.
  - transitivity (sum n (fun i => sum n (fun j => m_ k j i * x j * y i))).
    + apply Loop.sum_ext; intros i _. rewrite (Rmult_comm _ (y i)), <- Loop.sum_scal. apply Loop.sum_ext; intros; ring.
    + rewrite Loop.sum_swap. apply Loop.sum_ext; intros i _. rewrite <- Loop.sum_scal. apply Loop.sum_ext; intros; ring.
Qed.
Lemma dot_acting fs : forall x y, dot n (acting fs x) y = dot n x (acting (rev (map turned fs)) y).
Proof.
  induction fs as [|f fs I]; intros x y; [reflexivity|]. cbn. rewrite dot_act, I. f_equal. clear I.
  induction (rev (map turned fs)) as [|g gs I]; [reflexivity|]. cbn. now rewrite I.
Qed.
Lemma acting_app fs gs v : acting (fs ++ gs) v = acting fs (acting gs v).
Proof. induction fs as [|f fs I]; [reflexivity|]. cbn. now rewrite I. Qed.
Lemma dot_whole x l : dot n x (whole l) = fold_right (fun p s => fst p * dot n x (acting (fst (snd p)) (x_ (snd (snd p)))) + s) 0 l.
Proof.
  induction l as [|p l I]; [apply dot_nothing|]. cbn. rewrite <- I. unfold whole at 1. cbn. rewrite (dot_plus x (fun i => _ * _)), Loop.dot_scal_r. reflexivity.
Qed.
Lemma total_app a b : total (a ++ b) = total a + total b.
Proof. unfold total. induction a as [|w a I]; cbn; [ring|]. rewrite I. ring. Qed.
Theorem dot_words x y : dot n (vec_of x) (vec_of y) = total (dotted x y).
Proof.
  rewrite (expanded_correct x), (expanded_correct y), Loop.dot_sym, dot_whole. unfold dotted.
  induction (expanded x) as [|[c [fs k]] l I]; [reflexivity|]. cbn [flat_map fold_right fst snd]. rewrite total_app, I. f_equal. clear I.
  rewrite Loop.dot_sym, dot_whole. unfold total. induction (expanded y) as [|[d [gs j]] r I]; cbn in *; [ring|]. rewrite <- I.
  unfold word. rewrite acting_app, <- dot_acting. ring.
Qed.
(** Another way to write a word: its factors turned, in reverse order. *)
Lemma word_turned x fs y : word x fs y = word y (rev (map turned fs)) x.
Proof. unfold word. now rewrite Loop.dot_sym, dot_acting. Qed.

(** A symmetric matrix may be turned in a word, and neighbours that multiply entry by entry may change places. *)
Definition symmetric (k : nat) : Prop := forall i j, (i < n)%nat -> (j < n)%nat -> m_ k i j = m_ k j i.
Definition same (f g : factor) : Prop := f = g \/ exists k, symmetric k /\ (f = T k /\ g = A k \/ f = A k /\ g = T k).
Lemma act_same f g u v : same f g -> (forall i, (i < n)%nat -> u i = v i) -> forall i, (i < n)%nat -> act f u i = act g v i.
Proof.
  intros S E i Hi. destruct S as [<-|(k & Y & [[-> ->]|[-> ->]])]; [destruct f|..]; cbn; unfold apply_, dot; try rewrite E by auto; auto;
    apply Loop.sum_ext; intros j Hj; rewrite E by auto; auto; rewrite Y by auto; auto.
Qed.
Lemma word_same x fs gs y : Forall2 same fs gs -> word x fs y = word x gs y.
Proof.
  intros F. apply Loop.sum_ext. intros i Hi. f_equal. revert i Hi. induction F as [|f g fs gs S F I]; cbn; auto.
  intros i Hi. now apply act_same.
Qed.

(** *** What bounds a word *)
Definition sized (f : factor) (a : R) : Prop := 0 <= a /\ forall v, norm n (act f v) <= a * norm n v.
Lemma sized_turned k a : sized (A k) a -> sized (T k) a.
Proof.
  intros [P H]. split; [exact P|]. intros v. set (u := act (T k) v). pose proof (Loop.norm_pos n u) as U. pose proof (Loop.norm_pos n v) as V.
  assert (S : norm n u * norm n u <= norm n v * (a * norm n u)).
  { rewrite Loop.norm2. unfold u at 1. rewrite dot_act. cbn [turned]. eapply Rle_trans; [apply Loop.cauchy_schwarz|].
    apply Rmult_le_compat_l; [exact V|apply H]. }
  destruct (Req_dec (norm n u) 0) as [->|N]; [nra|]. apply Rmult_le_reg_r with (norm n u); lra.
Qed.
Theorem word_at_most x fs y sizes : Forall2 sized fs sizes ->
  Rabs (word x fs y) <= norm n (x_ x) * (fold_right Rmult 1 sizes * norm n (x_ y)).
Proof.
  intros F. assert (0 <= fold_right Rmult 1 sizes /\ norm n (acting fs (x_ y)) <= fold_right Rmult 1 sizes * norm n (x_ y)) as [P H].
  { induction F as [|f a fs l [Ha Hf] F [P I]]; cbn; [lra|]. split; [now apply Rmult_le_pos|].
    eapply Rle_trans; [apply Hf|]. rewrite Rmult_assoc. now apply Rmult_le_compat_l. }
  unfold word. apply Rle_trans with (norm n (x_ x) * norm n (acting fs (x_ y))).
  - apply Rabs_le. split; [apply Loop.dot_ge|apply Loop.cauchy_schwarz].
  - apply Rmult_le_compat_l; [apply Loop.norm_pos|exact H].
Qed.
End Words.
Lemma within_product a b c d : Rabs a <= c -> Rabs b <= d -> Rabs (a * b) <= c * d.
Proof. intros. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.
Lemma gamma_pos m : (1 <= m)%nat -> 0 <= gamma m.
Proof. intros Hm. eapply Rle_trans; [apply Rabs_pos|apply (abs_h_le_gamma m Hm 0)]. Qed.
Lemma rho_pos m : (1 <= m)%nat -> 0 <= rho m.
Proof. intros Hm. eapply Rle_trans; [apply Rabs_pos|apply (dh_le_rho m Hm 0)]. Qed.

(** *** Tactics *)
(** A product or sum of what is not negative. *)
Ltac nonneg := repeat first [assumption | apply Rlt_le; assumption | apply pow2_ge_0 | apply pow_le | apply Rmult_le_pos | apply Rplus_le_le_0_compat | apply sqrt_pos | apply Loop.norm_pos
  | apply gamma_pos; lia | apply rho_pos; lia | lra].
Ltac all_sized := repeat (apply Forall2_cons;
  [first [split; [nonneg|assumption] | apply sized_turned; split; [nonneg|assumption]]|]); apply Forall2_nil.
(** Numbers are not negative: their size is themselves. *)
Ltac plain_sizes := repeat match goal with H : context [Rabs ?x] |- _ => rewrite (Rabs_pos_eq x) in H by assumption end.
(** Two ways to write a word are equal: entry by entry, with factors turned, or in reverse order. *)
Ltac all_same := repeat (apply Forall2_cons; [first [left; reflexivity
  | right; refine (ex_intro _ _ (conj _ (or_introl (conj eq_refl eq_refl)))); assumption
  | right; refine (ex_intro _ _ (conj _ (or_intror (conj eq_refl eq_refl)))); assumption]|]);
  apply Forall2_nil.
(** A dot product in the goal as words. *)
Ltac in_words E := let K := fresh "E" in pose proof E as K;
  cbv [vec_of mat_of total dotted expanded factors word acting act x_ m_ nth fold_right flat_map map app rev fst snd turned negb] in K;
  match type of K with ?l = ?r => try rewrite K end; clear K.
(** A product of factors, each at most one of another. *)
Ltac products := repeat first [assumption | apply Rle_refl | apply Rmult_le_compat; [nonneg|nonneg| |]].
(** Equal as quotients of polynomials in words. *)
Ltac identical := first [ring | field; repeat split; nonzero]
with nonzero := first [lra | apply Rgt_not_eq; nonneg; lra].

(** *** Identities of signs: a gap g = t / b, of which a positive multiple is a sum of what is not negative *)
Lemma gap_nonnegative g b t l s : g * b = t -> 0 < b -> 0 < l -> l * t = s -> 0 <= s -> 0 <= g.
Proof. intros <- B P <- S. apply Rmult_le_reg_l with (l * b); [now apply Rmult_lt_0_compat|]. lra. Qed.
Lemma gap_positive g b t l s : g * b = t -> 0 < b -> 0 < l -> l * t = s -> 0 < s -> 0 < g.
Proof. intros <- B P <- S. apply Rmult_lt_reg_l with (l * b); [now apply Rmult_lt_0_compat|]. lra. Qed.
(** A leading term l outweighs what is multiplied with a small number. *)
Lemma small_enough l B : 0 < l -> 0 <= B -> exists small, 0 < small /\ forall x, 0 < x < small -> x <= 1 /\ 0 < l - x * B.
Proof.
  intros P B0. exists (Rmin 1 (l / (B + 1))). split; [apply Rmin_pos; [lra|apply Rdiv_lt_0_compat; lra]|]. intros x [X0 X1].
  pose proof (Rmin_l 1 (l / (B + 1))). pose proof (Rmin_r 1 (l / (B + 1))). split; [lra|].
  assert (x * (B + 1) < l); [|lra]. apply Rlt_le_trans with (l / (B + 1) * (B + 1)); [apply Rmult_lt_compat_r; lra|right; field; lra].
Qed.
Lemma pow_below_one x k : 0 <= x <= 1 -> 0 <= x ^ k <= 1.
Proof. intros [X0 X1]. split; [now apply pow_le|]. rewrite <- (pow1 k). apply pow_incr. lra. Qed.
Lemma product_below_one a b : 0 <= a <= 1 -> 0 <= b <= 1 -> 0 <= a * b <= 1.
Proof. intros. split; [apply Rmult_le_pos; lra|]. rewrite <- (Rmult_1_l 1). apply Rmult_le_compat; lra. Qed.
Ltac below_one := match goal with |- 0 <= 1 - ?a => enough (0 <= a <= 1) by lra end;
  repeat first [apply product_below_one | apply pow_below_one]; lra.
Ltac positive := lazymatch goal with
  | |- 0 < ?a + ?b => first [assumption | apply Rplus_lt_le_0_compat; [solve [positive]|solve [nonneg]] | apply Rplus_le_lt_0_compat; [solve [nonneg]|solve [positive]]]
  | |- 0 < ?a * ?b => first [assumption | apply Rmult_lt_0_compat; positive]
  | |- 0 < ?a ^ ?k => apply pow_lt; positive
  | |- 0 < ?a / ?b => apply Rdiv_lt_0_compat; positive
  | |- 0 < _ => first [assumption | lra] end.
Ltac quotients Q := first [field [Q] | field]; repeat split; apply not_eq_sym, Rlt_not_eq; positive.
