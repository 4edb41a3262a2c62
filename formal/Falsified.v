(** A state of an arm at which dV/dt > 0: (11) can be solved for dw/dt there, and the exact dV/dt is evaluated over intervals. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia Reals FunctionalExtensionality.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Float.Primitive_ops Real.Xreal.
Require Import Definitions.
Require Loop Stability.
Require Import Arm Boxes Bridge Certified.
Import ListNotations.
Open Scope R_scope.
Notation dot := Definitions.dot.
Notation norm := Definitions.norm.

(** ** A x = y can be solved where x'A x > 0 for x other than 0: by elimination, one row after the other *)
Lemma solvable (A : mat) : forall n, (forall x, (exists i, (i < n)%nat /\ x i <> 0) -> 0 < dot n x (apply_ n A x)) ->
  forall y, exists x, forall i, (i < n)%nat -> apply_ n A x i = y i.
Proof.
  induction n as [|n IH]; intros H y; [exists y; intros; lia|].
  set (with_last := fun (x : vec) (s : R) (i : nat) => if Nat.ltb i n then x i else s).
  assert (L1 : forall x s i, (i < n)%nat -> with_last x s i = x i).
  { intros x s i Hi. unfold with_last. now apply PeanoNat.Nat.ltb_lt in Hi as ->. }
  assert (L2 : forall x s, with_last x s n = s) by (intros; unfold with_last; now rewrite PeanoNat.Nat.ltb_irrefl).
  assert (L3 : forall x s i, apply_ (S n) A (with_last x s) i = apply_ n A x i + A i n * s).
  { intros x s i. unfold apply_, dot. cbn [sum]. rewrite L2. f_equal. apply Loop.sum_ext; intros j Hj. now rewrite L1. }
  assert (Pd : forall x, (exists i, (i < n)%nat /\ x i <> 0) -> 0 < dot n x (apply_ n A x)).
  { intros x (i & Hi & Hx). assert (K : 0 < dot (S n) (with_last x 0) (apply_ (S n) A (with_last x 0))).
    { apply H. exists i. rewrite L1 by auto. split; [lia|auto]. }
    unfold dot at 1 in K. cbn [sum] in K. rewrite L2, Rmult_0_l, Rplus_0_r in K. unfold dot at 1.
    rewrite (Loop.sum_ext n _ (fun j => x j * apply_ n A x j)) in K; [exact K|]. intros j Hj. rewrite L1, L3 by auto. ring. }
  destruct (IH Pd (fun i => A i n)) as [z Hz]. destruct (IH Pd y) as [x Hx]. set (d := A n n - dot n (A n) z).
  assert (Sc : forall u s i, apply_ n A (fun j => x j * u - s * z j) i = u * apply_ n A x i - s * apply_ n A z i).
  { intros u s i. unfold apply_, dot. rewrite <- !Loop.sum_scal, <- Loop.sum_minus. apply Loop.sum_ext; intros; ring. }
  assert (D : 0 < d).
  { assert (K : 0 < dot (S n) (with_last (fun j => x j * 0 - 1 * z j) 1) (apply_ (S n) A (with_last (fun j => x j * 0 - 1 * z j) 1))).
    { apply H. exists n. rewrite L2. split; [lia|lra]. }
    unfold dot at 1 in K. cbn [sum] in K. rewrite L2, L3, Sc, (Loop.sum_ext n _ (fun _ => 0)), Loop.sum_const in K.
    - unfold d. change (dot n (A n) z) with (apply_ n A z n). lra.
    - intros i Hi. rewrite L3, Sc, (Hz i Hi). ring. }
  set (s := (y n - dot n (A n) x) / d). exists (with_last (fun j => x j * 1 - s * z j) s). intros i Hi.
  rewrite L3, Sc. destruct (PeanoNat.Nat.eq_dec i n) as [->|N].
  - change (apply_ n A x n) with (dot n (A n) x). change (apply_ n A z n) with (dot n (A n) z).
    replace (1 * dot n (A n) x - s * dot n (A n) z + A n n * s) with (dot n (A n) x + s * d) by (unfold d; ring). unfold s. field. lra.
  - rewrite (Hx i), (Hz i) by lia. ring.
Qed.

(** ** dV/dt, over any arithmetic *)
Section Rate.
Variable B : arith.
Notation T := (num B).
Variable n : nat.
Definition phase_Q (k : list Z) (q : list Q) : Q := fold_right (fun i s => Qred (inject_Z (nth i k 0%Z) * nth i q 0%Q + s)) 0%Q (seq 0 n).
Definition wave_at (q : list Q) (t : harmonic) : T :=
  let '(k, a, b) := t in let p := rat B (phase_Q k q) in add B (mul B (rat B a) (cosine B p)) (mul B (rat B b) (sine B p)).
Definition total_at (q : list Q) (ts : list harmonic) : T := fold_right (fun t s => add B (wave_at q t) s) (zer B) ts.

Variable at_goal : bool.                            (* e = 0, where the paper's V has the derivative 0 of eps h(e) *)
Variables (M : nat -> nat -> T) (c : nat -> nat -> nat -> T) (h dh e w hw b kp kv : nat -> T) (eps0 : T).
Notation sum_of := (sumn B n).
Definition r2_at : T := sum_of (fun i => mul B (e i) (e i)).
Definition one_r : T := add B (cst B 1) (root B r2_at).
Definition eps_at : T := div B eps0 one_r.
Definition eps_rate_at : T := if at_goal then zer B else div B (mul B eps0 (div B (sum_of (fun i => mul B (e i) (w i))) (root B r2_at))) (mul B one_r one_r).
Definition y_at (i : nat) : T := sub B (w i) (mul B eps_at (h i)).
Definition gr_at (i : nat) : T := sub B (mul B eps_rate_at (h i)) (mul B eps_at (mul B (dh i) (w i))).
Definition rate_at : T :=
  sub B (sub B
    (sum_of (fun i => sub B (sub B (zer B) (mul B (mul B eps_at (kp i)) (mul B (h i) (h i))))
                            (mul B (y_at i) (add B (mul B (kv i) (hw i)) (mul B (b i) (w i))))))
    (mul B eps_at (sum_of (fun i => mul B (y_at i) (sum_of (fun j => mul B (sum_of (fun k => mul B (c i j k) (w k))) (h j)))))))
    (sum_of (fun i => mul B (y_at i) (sum_of (fun j => mul B (M i j) (gr_at j))))).
End Rate.
Ltac contained := repeat first [assumption | apply rel_zer | apply rel_cst | apply rel_add | apply rel_sub | apply rel_mul | apply rel_div | apply rel_root
  | apply rel_sumn; intros ? | match goal with K : forall _, _ |- _ => apply K end].
Lemma rel_rate n z M c h dh e w hw b kp kv ep M' c' h' dh' e' w' hw' b' kp' kv' ep' :
  (forall i j, rel (M i j) (M' i j)) -> (forall i j k, rel (c i j k) (c' i j k)) -> (forall i, rel (h i) (h' i)) -> (forall i, rel (dh i) (dh' i)) ->
  (forall i, rel (e i) (e' i)) -> (forall i, rel (w i) (w' i)) -> (forall i, rel (hw i) (hw' i)) -> (forall i, rel (b i) (b' i)) ->
  (forall i, rel (kp i) (kp' i)) -> (forall i, rel (kv i) (kv' i)) -> rel ep ep' ->
  rel (rate_at IA n z M c h dh e w hw b kp kv ep) (rate_at RA n z M' c' h' dh' e' w' hw' b' kp' kv' ep').
Proof.
  intros. assert (R2 : rel (r2_at IA n e) (r2_at RA n e')) by (unfold r2_at; contained).
  assert (O : rel (one_r IA n e) (one_r RA n e')) by (unfold one_r; contained).
  assert (Ep : rel (eps_at IA n e ep) (eps_at RA n e' ep')) by (unfold eps_at; contained).
  assert (Er : rel (eps_rate_at IA n z e w ep) (eps_rate_at RA n z e' w' ep')) by (unfold eps_rate_at; destruct z; contained).
  assert (Y : forall i, rel (y_at IA n h e w ep i) (y_at RA n h' e' w' ep' i)) by (intros; unfold y_at; contained).
  assert (G : forall i, rel (gr_at IA n z h dh e w ep i) (gr_at RA n z h' dh' e' w' ep' i)) by (intros; unfold gr_at; contained).
  unfold rate_at. contained.
Qed.
Lemma phase_value n k q : Q2R (phase_Q n k q) = phase n k (entries q).
Proof.
  unfold phase_Q, phase. rewrite <- lsum_sum. induction (seq 0 n) as [|i l IH]; [apply Q2R_0|].
  cbn [fold_right]. unfold lsum in *. cbn [fold_right]. rewrite Q2R_red, Q2R_plus, Q2R_mult, Q2R_inject, IH. reflexivity.
Qed.
Lemma total_value n q ts : total_at RA n q ts = Arm.total n (entries q) ts.
Proof.
  induction ts as [|[[k a] b] ts IH]; [reflexivity|]. unfold total_at in *. cbn [fold_right Arm.total]. rewrite IH. unfold wave_at, Arm.wave. cbv zeta.
  rewrite (rat_Q a), (rat_Q b), (rat_Q (phase_Q n k q)), phase_value. reflexivity.
Qed.
Lemma rel_total n q ts : rel (total_at IA n q ts) (total_at RA n q ts).
Proof.
  induction ts as [|[[k a] b] ts IH]; [apply rel_zer|]. unfold total_at in *. cbn [fold_right]. apply rel_add; [|exact IH]. unfold wave_at. cbv zeta.
  apply rel_add; apply rel_mul; try apply rel_rat; [apply rel_cos|apply rel_sin]; apply rel_rat.
Qed.

(** ** The state *)
Section State.
Variable A : arm.
Notation n := (joints A).
Variable rb : robot n.
Hypotheses (HM : M rb = M_of A) (HC : C rb = C_of A) (Hbv : b rb = b_of A).
Variables (f : Loop.member) (g : Loop.gains n) (kp kv : list Q).
Hypotheses (Hkp : Loop.kp n g = entries kp) (Hkv : Loop.kv n g = entries kv).
Variable eps0 : Q.
Variables (q e w : list Q).
Variables (hI dhI : I.type -> I.type).
Hypothesis hI_correct : forall i x, rel i x -> rel (hI i) (Loop.hf f x).
Hypothesis dhI_correct : forall i x, rel i x -> rel (dhI i) (Loop.dhf f x).
Definition of_list (l : list Q) (i : nat) : I.type := rat IA (nth i l 0%Q).
Lemma rel_list l i : rel (of_list l i) (entries l i).
Proof. unfold of_list, entries. rewrite <- (rat_Q (nth i l 0%Q)). apply rel_rat. Qed.
Definition at_goal : bool := forall_to n (fun i => Qeq_bool (nth i e 0%Q) 0).
Definition rate_I : I.type := rate_at IA n at_goal (fun i j => total_at IA n q (H A i j)) (fun i j k => total_at IA n q (c_of A i j k))
  (fun i => hI (of_list e i)) (fun i => dhI (of_list e i)) (of_list e) (of_list w) (fun i => hI (of_list w i)) (of_list (viscous A)) (of_list kp) (of_list kv) (rat IA eps0).
Definition elsewhere : bool := positive (r2_at IA n (of_list (if at_goal then w else e))).
Hypothesis Helse : elsewhere = true.
Hypothesis Hrate : positive rate_I = true.

Lemma nonzero_entry k (x : vec) : 0 < dot k x x -> exists i, (i < k)%nat /\ x i <> 0.
Proof.
  unfold dot. induction k as [|k IH]; cbn [sum]; intros H; [lra|]. destruct (Req_dec (x k) 0) as [Z|Z]; [|exists k; auto].
  rewrite Z in H. destruct IH as (i & Hi & Hx); [lra|]. exists i. split; [lia|auto].
Qed.
Lemma r2_pos l : positive (r2_at IA n (of_list l)) = true -> 0 < dot n (entries l) (entries l).
Proof.
  intros K. apply (positive_correct _ _ K). replace (dot n (entries l) (entries l)) with (r2_at RA n (entries l)) by apply sumn_sum.
  unfold r2_at. apply rel_sumn. intros i. apply rel_mul; apply rel_list.
Qed.
Lemma at_goal_zero : at_goal = true -> norm n (entries e) = 0.
Proof.
  intros Z. unfold norm, dot. rewrite (Loop.sum_ext n _ (fun _ => 0)), Loop.sum_const, Rmult_0_r; [apply sqrt_0|]. intros i Hi.
  pose proof (forall_to_true _ _ Z i Hi) as K. apply Qeq_bool_iff, Qeq_eqR in K. unfold entries. rewrite K, Q2R_0. ring.
Qed.
Lemma not_at_goal : at_goal = false -> norm n (entries e) <> 0.
Proof.
  intros Z N. unfold elsewhere in Helse. rewrite Z in Helse. pose proof (r2_pos e Helse) as R0. pose proof (Loop.norm2 n (entries e)) as N2.
  rewrite N in N2. lra.
Qed.
Let qd : vec := fun i => entries q i + entries e i.
Lemma rate_value (ec wc : R -> vec) t : ec t = entries e -> wc t = entries w -> 0 < Loop.rate n rb f g qd ec wc (Q2R eps0) t.
Proof.
  intros Ee Ew. apply (positive_correct _ _ Hrate). unfold rate_I.
  assert (Eq : Loop.q_along (fun _ => qd) ec t = entries q) by (apply functional_extensionality; intros i; unfold Loop.q_along, qd; rewrite Ee; ring).
  pose proof (Loop.norm_pos n (entries e)) as N0.
  replace (Loop.rate n rb f g qd ec wc (Q2R eps0) t) with (rate_at RA n at_goal (fun i j => total_at RA n q (H A i j)) (fun i j k => total_at RA n q (c_of A i j k))
    (fun i => Loop.hf f (entries e i)) (fun i => Loop.dhf f (entries e i)) (entries e) (entries w) (fun i => Loop.hf f (entries w i)) (entries (viscous A)) (entries kp) (entries kv) (rat RA eps0)).
  { apply rel_rate; intros; try apply rel_total; try apply rel_list; try apply hI_correct; try apply dhI_correct; try apply rel_list; apply rel_rat. }
  assert (E1 : one_r RA n (entries e) = 1 + norm n (entries e)) by (unfold one_r, r2_at; rewrite sumn_sum; reflexivity).
  assert (E2 : eps_at RA n (entries e) (rat RA eps0) = eps n (Q2R eps0) (entries e)).
  { unfold eps_at. rewrite E1, (rat_Q eps0). reflexivity. }
  assert (E3 : eps_rate_at RA n at_goal (entries e) (entries w) (rat RA eps0) = Loop.eps_rate n ec wc (Q2R eps0) t).
  { unfold eps_rate_at, Loop.eps_rate. rewrite Ee, Ew. destruct at_goal eqn:Z.
    { rewrite (at_goal_zero Z). destruct (Req_EM_T 0 0); [reflexivity|lra]. }
    pose proof (not_at_goal Z) as N. destruct (Req_EM_T _ _) as [|_]; [contradiction|]. rewrite E1, (rat_Q eps0). unfold r2_at. rewrite !sumn_sum.
    cbn [div mul root RA]. change (sqrt (sum n (fun i => entries e i * entries e i))) with (norm n (entries e)).
    change (sum n (fun i => entries e i * entries w i)) with (dot n (entries e) (entries w)). change (num RA) with R in *. field. split; lra. }
  assert (Ey : forall i, y_at RA n (fun i => Loop.hf f (entries e i)) (entries e) (entries w) (rat RA eps0) i = Loop.yt n f ec wc (Q2R eps0) t i).
  { intros i. unfold y_at, Loop.yt, y_of. rewrite E2, Ee, Ew. reflexivity. }
  assert (Eg : forall i, gr_at RA n at_goal (fun i => Loop.hf f (entries e i)) (fun i => Loop.dhf f (entries e i)) (entries e) (entries w) (rat RA eps0) i = Loop.gr n f ec wc (Q2R eps0) t i).
  { intros i. unfold gr_at, Loop.gr. rewrite E2, E3, Ee, Ew. cbn [sub mul RA]. rring. }
  unfold rate_at, Loop.rate, Loop.rate_along. rewrite !sumn_sum, E2, Ee, Ew, Hkp, Hkv, HM, HC, Hbv, Eq. cbn [sub mul add zer RA]. f_equal; [f_equal|].
  - apply Loop.sum_ext; intros i Hi. rewrite Ey. unfold b_of. rring.
  - f_equal. apply Loop.sum_ext; intros i Hi. rewrite Ey, sumn_sum. f_equal. apply Loop.sum_ext; intros j Hj. rewrite C_total, sumn_sum by auto.
    unfold Loop.hv. f_equal. apply Loop.sum_ext; intros k Hk. now rewrite total_value.
  - apply Loop.sum_ext; intros i Hi. rewrite Ey, sumn_sum. f_equal. apply Loop.sum_ext; intros j Hj. rewrite Eg, total_value, M_total. reflexivity.
Qed.
Theorem rises : exists qd e w t d, solves_at n (M_of A) (C_of A) (b_of A) (Loop.hf f) (entries kp) (entries kv) qd e w t /\ away n (e t) (w t) /\
  is_derive (fun s => V n (M_of A) (Loop.hf f) (Loop.Uf f) (entries kp) qd (Q2R eps0) (e s) (w s)) t d /\ 0 < d.
Proof.
  set (y := fun i => entries kp i * Loop.hf f (entries e i) - entries kv i * Loop.hf f (entries w i) - b_of A i * entries w i
    - apply_ n (C_of A (entries q) (entries w)) (entries w) i).
  destruct (solvable (M_of A (entries q)) n) with (y := y) as [a Ha].
  { intros x (i & Hi & Hx). rewrite <- HM. eapply Rlt_le_trans; [|apply M_low]. apply Rmult_lt_0_compat; [apply alpha_pos|].
    pose proof (Loop.term_le_sum n (fun j => x j * x j) i ltac:(intros; nra) Hi) as K. unfold dot. simpl in *. nra. }
  set (ec := fun (s : R) (i : nat) => entries e i - s * entries w i). set (wc := fun (s : R) (i : nat) => entries w i + s * a i).
  assert (Ee : ec 0 = entries e) by (apply functional_extensionality; intros i; unfold ec; ring).
  assert (Ew : wc 0 = entries w) by (apply functional_extensionality; intros i; unfold wc; ring).
  assert (Dw : forall i, is_derive (fun s => wc s i) 0 (a i)) by (intros i; unfold wc; auto_derive; auto; ring).
  assert (Sv : solves_at n (M_of A) (C_of A) (b_of A) (Loop.hf f) (entries kp) (entries kv) qd ec wc 0).
  { intros i Hi. split; [|split].
    - rewrite Ew. unfold ec. auto_derive; auto. ring.
    - eexists. apply Dw.
    - replace (fun j => Derive (fun s => wc s j) 0) with a by (apply functional_extensionality; intros j; symmetry; apply is_derive_unique, Dw).
      rewrite Ee, Ew. replace (fun j => qd j - entries e j) with (entries q) by (apply functional_extensionality; intros j; unfold qd; ring). now apply Ha. }
  exists qd, ec, wc, 0, (Loop.rate n rb f g qd ec wc (Q2R eps0) 0). split; [exact Sv|]. split; [|split].
  - rewrite Ee, Ew. unfold elsewhere in Helse. destruct at_goal; destruct (nonzero_entry n _ (r2_pos _ Helse)) as (i & Hi & Hx); exists i; auto.
  - pose proof (Loop.V_rate n rb f g qd ec wc (fun s => s = 0)) as VR. rewrite HM, HC, Hbv, Hkp, Hkv in VR. apply VR; auto. intros t ->. exact Sv.
  - now apply rate_value.
Qed.
End State.

Section Arm.
Variable A : arm.
Notation n := (joints A).
Variables (angles : list nat) (ks : list (list Z)) (alpha beta kc lo hi : Q) (turn : list side) (fuel m : nat) (kp kv : list Q) (kmin vmax eps0 : Q) (q e w : list Q).
Variables (hI dhI : I.type -> I.type).
Hypothesis Hn : (0 < n)%nat.
Hypothesis Sym : symmetric A = true.
Hypothesis Known : all_known A angles ks = true.
Hypothesis Hturn : List.length turn = List.length angles.
Hypothesis Hcovers : forallb (fun s => covers s (I.pi prec) (I.pi prec)) turn = true.
Hypothesis Hmass : mass_shown A angles ks alpha turn (lift IA (problem_of A angles ks [] [] 0 0 0 0 0)) fuel turn = true.
Hypothesis Halpha : Qle_bool alpha 0 = false.
Hypothesis Hbeta : forall_to n (fun i => Qle_bool (row A i) beta) = true.
Hypothesis Hkc : Qle_bool (squares A) (kc * kc) = true.
Hypothesis kc_pos : Qle_bool 0 kc = true.
Hypothesis Hlo : Qle_bool lo 0 = false.
Hypothesis Hb : forall_to n (fun i => Qle_bool lo (nth i (viscous A) 0%Q) && Qle_bool (nth i (viscous A) 0%Q) hi) = true.
Hypothesis Hm : (1 <= m)%nat.
Hypothesis Hkmin : Qle_bool kmin 0 = false.
Hypothesis Hkp : forall_to n (fun i => Qle_bool kmin (nth i kp 0%Q)) = true.
Hypothesis Hkv : forall_to n (fun i => Qle_bool 0 (nth i kv 0%Q) && Qle_bool (nth i kv 0%Q) vmax) = true.
Hypothesis hI_correct : forall i x, rel i x -> rel (hI i) (h m x).
Hypothesis dhI_correct : forall i x, rel i x -> rel (dhI i) (dh m x).
Hypothesis Helse : elsewhere A e w = true.
Hypothesis Hrate : positive (rate_I A kp kv eps0 q e w hI dhI) = true.
Theorem falsified_by_state : falsified A m kp kv eps0.
Proof.
  exact (rises A (rb A angles ks Hn Sym Known alpha turn Hturn Hcovers fuel Hmass beta kc lo hi Halpha Hbeta Hkc kc_pos Hlo Hb) eq_refl eq_refl eq_refl
    (Stability.hyperbolic m Hm) (Certified.g A Hn kp kv kmin vmax Hkmin Hkp Hkv) kp kv eq_refl eq_refl eps0 q e w hI dhI hI_correct dhI_correct Helse Hrate).
Qed.
End Arm.
