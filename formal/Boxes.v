(** A checker of trees of boxes, for any n: that a symmetric matrix is positive definite over a box of angles and errors.

    The matrix is evaluated by code that is written once, over an arbitrary arithmetic. Over R it is the statement;
    over the outward-rounded intervals of CoqInterval it is the checker. Soundness is that every operation keeps
    "this interval contains that real". *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia String Ascii Reals.
From Interval Require Import Interval.Interval Interval.Float_full Float.Basic Float.Primitive_ops Real.Xreal.
From Lyapcheck Require Import Arm.
Import ListNotations.
Open Scope R_scope.

Module F := PrimitiveFloat.
Module I := FloatIntervalFull PrimitiveFloat.
Definition prec := F.PtoP 53.

(** ** Arithmetics *)
Record arith := Arith {
  num : Type; zer : num;
  add : num -> num -> num; sub : num -> num -> num; mul : num -> num -> num; div : num -> num -> num;
  sqr : num -> num; root : num -> num; cosine : num -> num; sine : num -> num; expo : num -> num;
  cst : Z -> num }.

Definition RA : arith :=
  Arith R 0 Rplus Rminus Rmult Rdiv (fun x => x * x) sqrt cos sin exp IZR.

(** cos and sin after taking away 2 pi k, so that ranges stay tight away from the first period. *)
Definition turns (x : I.type) : Z :=
  match F.toF (PrimFloat.add (PrimFloat.mul (I.midpoint x) 0x1.45f306dc9c883p-3%float) 0.5%float) with
  | Basic.Float s m e => Z.shiftl (if s then Z.neg m else Z.pos m) e
  | _ => 0%Z
  end.                                            (* untrusted: the nearest multiple *)
Definition reduced (x : I.type) : I.type :=
  match turns x with
  | Z0 => x
  | k => I.sub prec x (I.mul prec (I.fromZ prec (2 * k)) (I.pi prec))
  end.
Definition IA : arith :=
  Arith I.type I.zero (I.add prec) (I.sub prec) (I.mul prec) (I.div prec) (I.sqr prec) (I.sqrt prec)
        (fun x => I.cos prec (reduced x)) (fun x => I.sin prec (reduced x)) (I.exp prec) (I.fromZ prec).

Definition rel (i : I.type) (x : R) : Prop := contains (I.convert i) (Xreal x).

Lemma nan_all i x : contains i Xnan -> contains i (Xreal x).
Proof. destruct i; simpl; tauto. Qed.
Lemma rel_zer : rel I.zero 0.
Proof. unfold rel. rewrite I.zero_correct. simpl. lra. Qed.
Lemma rel_add i j x y : rel i x -> rel j y -> rel (I.add prec i j) (x + y).
Proof. intros; exact (I.add_correct prec i j (Xreal x) (Xreal y) H H0). Qed.
Lemma rel_sub i j x y : rel i x -> rel j y -> rel (I.sub prec i j) (x - y).
Proof. intros; exact (I.sub_correct prec i j (Xreal x) (Xreal y) H H0). Qed.
Lemma rel_mul i j x y : rel i x -> rel j y -> rel (I.mul prec i j) (x * y).
Proof. intros; exact (I.mul_correct prec i j (Xreal x) (Xreal y) H H0). Qed.
Lemma rel_div i j x y : rel i x -> rel j y -> rel (I.div prec i j) (x / y).
Proof.
  intros H H0. pose proof (I.div_correct prec i j (Xreal x) (Xreal y) H H0) as K.
  simpl in K. unfold Xdiv' in K. destruct (is_zero y); [apply nan_all|]; exact K.
Qed.
Lemma rel_sqr i x : rel i x -> rel (I.sqr prec i) (x * x).
Proof. intros H; exact (I.sqr_correct prec i (Xreal x) H). Qed.
Lemma rel_root i x : rel i x -> rel (I.sqrt prec i) (sqrt x).
Proof.
  intros H. pose proof (I.sqrt_correct prec i (Xreal x) H) as K. simpl in K.
  unfold Xsqrt' in K. try (destruct (is_negative x); [apply nan_all; exact K|]). exact K.
Qed.
Lemma rel_expo i x : rel i x -> rel (I.exp prec i) (exp x).
Proof. intros H; exact (I.exp_correct prec i (Xreal x) H). Qed.
Lemma rel_cst z : rel (I.fromZ prec z) (IZR z).
Proof. apply I.fromZ_correct. Qed.
Lemma rel_reduced i x : rel i x -> exists k : Z, rel (reduced i) (x - IZR (2 * k) * PI).
Proof.
  intros H. unfold reduced. exists (turns i). destruct (turns i).
  - simpl. replace (x - 0 * PI) with x by ring. exact H.
  - apply rel_sub; [exact H|]. apply rel_mul; [apply rel_cst|exact (I.pi_correct prec)].
  - apply rel_sub; [exact H|]. apply rel_mul; [apply rel_cst|exact (I.pi_correct prec)].
Qed.
Lemma cos_turn x k : cos (x - IZR (2 * k) * PI) = cos x.
Proof.
  destruct (Z_le_gt_dec 0 k) as [h|h].
  - rewrite <- (cos_period _ (Z.to_nat k)). f_equal. rewrite INR_IZR_INZ, Z2Nat.id, mult_IZR; [ring|lia].
  - rewrite <- (cos_period x (Z.to_nat (- k))). f_equal.
    rewrite INR_IZR_INZ, Z2Nat.id, opp_IZR, mult_IZR; [ring|lia].
Qed.
Lemma sin_turn x k : sin (x - IZR (2 * k) * PI) = sin x.
Proof.
  destruct (Z_le_gt_dec 0 k) as [h|h].
  - rewrite <- (sin_period _ (Z.to_nat k)). f_equal. rewrite INR_IZR_INZ, Z2Nat.id, mult_IZR; [ring|lia].
  - rewrite <- (sin_period x (Z.to_nat (- k))). f_equal.
    rewrite INR_IZR_INZ, Z2Nat.id, opp_IZR, mult_IZR; [ring|lia].
Qed.
Lemma rel_cos i x : rel i x -> rel (cosine IA i) (cos x).
Proof.
  intros H. destruct (rel_reduced i x H) as [k K]. rewrite <- (cos_turn x k).
  exact (I.cos_correct prec _ (Xreal _) K).
Qed.
Lemma rel_sin i x : rel i x -> rel (sine IA i) (sin x).
Proof.
  intros H. destruct (rel_reduced i x H) as [k K]. rewrite <- (sin_turn x k).
  exact (I.sin_correct prec _ (Xreal _) K).
Qed.
Ltac through :=
  repeat first [assumption | exact rel_zer | apply rel_cst | apply rel_add | apply rel_sub | apply rel_mul
    | apply rel_div | apply rel_sqr | apply rel_root | apply rel_expo | apply rel_cos | apply rel_sin].


(** ** What is evaluated *)
Record problem := Problem {
  pn : nat; pk : list (list Z);                   (* joints; each wave as multiples of the angles of a box *)
  pM : list (list (list (nat * Q)));              (* M_ij: coefficients of the values [cos k1; sin k1; cos k2; ...] *)
  pC : list (list (list (list (nat * Q))));       (* c_ijk likewise *)
  pb : list Q; pd : list Q; pw : list Q;          (* b_i; b_i less a little; 1/(4 k~_i) *)
  peps : Q; pr2 : Q }.                            (* eps0; the square of the radius beyond which nothing is asked *)

Section Evaluate.
Variable A : arith.
Notation T := (num A).
Definition rat (r : Q) : T := div A (cst A (Qnum r)) (cst A (Z.pos (Qden r))).
Fixpoint map2 {X Y Z : Type} (f : X -> Y -> Z) (x : list X) (y : list Y) : list Z :=
  match x, y with a :: x', b :: y' => f a b :: map2 f x' y' | _, _ => [] end.
Fixpoint dot (x y : list T) : T :=
  match x, y with a :: x', b :: y' => add A (mul A a b) (dot x' y') | _, _ => zer A end.
Fixpoint sumsq (x : list T) : T :=
  match x with a :: x' => add A (sqr A a) (sumsq x') | _ => zer A end.


Fixpoint waves (ks : list (list Z)) (q : list T) : list T :=
  match ks with
  | k :: ks' => let t := dot (map (cst A) k) q in cosine A t :: sine A t :: waves ks' q | [] => [] end.
Definition val (wv : list T) (ts : list (nat * T)) : T := fold_right (fun t s => add A (mul A (snd t) (nth (fst t) wv (zer A))) s) (zer A) ts.
Definition sumn (n : nat) (f : nat -> T) : T := fold_right (fun i s => add A (f i) s) (zer A) (seq 0 n).
Definition at1 (l : list T) (i : nat) : T := nth i l (zer A).
Definition at2 (l : list (list T)) (i j : nat) : T := nth j (nth i l []) (zer A).

Record lifted := Lifted { lM : list (list (list (nat * T))); lC : list (list (list (list (nat * T)))); lb : list T; ld : list T; lw : list T; leps : T; lr2 : T }.
Definition lift1 (t : nat * Q) : nat * T := (fst t, rat (snd t)).
Definition lift (p : problem) : lifted :=
  Lifted (map (map (map lift1)) (pM p)) (map (map (map (map lift1))) (pC p)) (map rat (pb p)) (map rat (pd p)) (map rat (pw p)) (rat (peps p)) (rat (pr2 p)).

(** S = C(q, h) + (M h) pull' - M H',  X = B + eps S,  G = B + eps (S + S')/2 - eps X' diag(w) X *)
Definition mass_of (n : nat) (l : lifted) (wv : list T) := tab n (fun i => tab n (fun j => val wv (nth j (nth i (lM l) []) []))).
Definition coupling (n : nat) (l : lifted) (M : list (list T)) (wv h dh pull : list T) : list (list T) :=
  tab n (fun i => let Mh := sumn n (fun k => mul A (at2 M i k) (at1 h k)) in
    tab n (fun j => add A (sub A (mul A Mh (at1 pull j)) (mul A (at2 M i j) (at1 dh j)))
      (sumn n (fun k => mul A (val wv (nth k (nth j (nth i (lC l) []) []) [])) (at1 h k))))).
Definition crossed (n : nat) (l : lifted) (S : list (list T)) (eps : T) : list (list T) :=
  tab n (fun i => tab n (fun j => let x := mul A eps (at2 S i j) in if Nat.eqb i j then add A x (at1 (lb l) i) else x)).
Definition G_of (n : nat) (l : lifted) (S X : list (list T)) (eps half_eps : T) (i j : nat) : T :=
  sub A (if Nat.eqb i j then add A (at1 (ld l) i) (mul A eps (at2 S i i)) else mul A half_eps (add A (at2 S i j) (at2 S j i)))
    (mul A eps (sumn n (fun k => mul A (at1 (lw l) k) (if Nat.eqb i j then sqr A (at2 X k i) else mul A (at2 X k i) (at2 X k j))))).
Definition upper_rows := list (T * list T).
Definition rows_of (n : nat) (G : nat -> nat -> T) : upper_rows := map (fun i => (G i i, map (G i) (seq (S i) (n - S i)))) (seq 0 n).
Definition P_of (n : nat) (l : lifted) (wv h dh pull : list T) (shrink : T) : upper_rows :=
  let M := mass_of n l wv in let S := coupling n l M wv h dh pull in let eps := mul A (leps l) shrink in
  let X := crossed n l S eps in rows_of n (G_of n l S X eps (div A eps (cst A 2))).

Definition two : T := cst A 2.
(** One step of elimination, and the quadratic form of upper rows. *)
Fixpoint eliminate (a : T) (v : list T) (rows : upper_rows) : upper_rows :=
  match v, rows with
  | vk :: v', (b, u) :: rows' =>
      let f := div A vk a in
      (sub A b (div A (sqr A vk) a), map2 (fun uj vj => sub A uj (mul A f vj)) u v') :: eliminate a v' rows'
  | _, _ => [] end.
Fixpoint form (rows : upper_rows) (x : list T) : T :=
  match rows, x with
  | (a, v) :: rows', x0 :: xs =>
     add A (add A (mul A a (sqr A x0)) (mul A (mul A two x0) (dot v xs))) (form rows' xs)
  | _, _ => zer A end.
End Evaluate.
Definition nonzero (x : list R) : Prop := exists y, In y x /\ y <> 0.

(** ** Containment goes through everything *)
Definition rels := Forall2 rel.
Definition relm := Forall2 rels.
Definition relu : list (I.type * list I.type) -> list (R * list R) -> Prop :=
  Forall2 (fun i x => rel (fst i) (fst x) /\ rels (snd i) (snd x)).
Lemma rel_rat r : rel (rat IA r) (rat RA r).
Proof. unfold rat. through. Qed.
Lemma Forall2_map {X Y X' Y'} (R1 : X -> Y -> Prop) (R2 : X' -> Y' -> Prop) f g x y :
  (forall a b, R1 a b -> R2 (f a) (g b)) -> Forall2 R1 x y -> Forall2 R2 (map f x) (map g y).
Proof. intros H; induction 1; simpl; constructor; auto. Qed.
Lemma Forall2_lift {X X' Y'} (R2 : X' -> Y' -> Prop) (f : X -> X') g x :
  (forall a, R2 (f a) (g a)) -> Forall2 R2 (map f x) (map g x).
Proof. intros H; induction x; simpl; constructor; auto. Qed.
Lemma Forall2_map2 {X Y X' Y' X'' Y''} (R1 : X -> Y -> Prop) (R2 : X' -> Y' -> Prop) (R3 : X'' -> Y'' -> Prop)
  f g : (forall a b c d, R1 a b -> R2 c d -> R3 (f a c) (g b d)) ->
  forall x y, Forall2 R1 x y -> forall x' y', Forall2 R2 x' y' -> Forall2 R3 (map2 f x x') (map2 g y y').
Proof.
  intros H x y; induction 1; intros x' y' K; simpl; [constructor|].
  inversion K; subst; constructor; auto.
Qed.
Lemma rels_dot x y : rels x y -> forall x' y', rels x' y' -> rel (dot IA x x') (dot RA y y').
Proof.
  induction 1; intros x' y' K; [exact rel_zer|].
  inversion K; subst; [exact rel_zer|]. simpl. apply rel_add; [through|apply IHForall2; auto].
Qed.
Lemma rels_sumsq x y : rels x y -> rel (sumsq IA x) (sumsq RA y).
Proof. induction 1; [exact rel_zer|]. simpl. apply rel_add; through. Qed.

Lemma rels_nth x y : rels x y -> forall i, rel (nth i x I.zero) (nth i y 0).
Proof. induction 1; destruct i; simpl; auto using rel_zer. Qed.
Lemma relm_nth x y : relm x y -> forall i, rels (nth i x []) (nth i y []).
Proof. induction 1; destruct i; simpl; auto; constructor. Qed.
Lemma rel_at1 x y i : rels x y -> rel (at1 IA x i) (at1 RA y i).
Proof. intros; now apply rels_nth. Qed.
Lemma rel_at2 x y i j : relm x y -> rel (at2 IA x i j) (at2 RA y i j).
Proof. intros; now apply rels_nth, relm_nth. Qed.
Lemma rel_tab {X Y} (Q : X -> Y -> Prop) n f g : (forall i, Q (f i) (g i)) -> Forall2 Q (tab n f) (tab n g).
Proof. intros K. unfold tab. induction (seq 0 n); simpl; constructor; auto. Qed.
Lemma rel_sumn n f g : (forall i, rel (f i) (g i)) -> rel (sumn IA n f) (sumn RA n g).
Proof. intros K. unfold sumn. induction (seq 0 n); simpl; [exact rel_zer|]. apply rel_add; auto. Qed.
Lemma rel_val wv wv' ts : rels wv wv' -> rel (val IA wv (map (lift1 IA) ts)) (val RA wv' (map (lift1 RA) ts)).
Proof.
  intros K. induction ts as [|t ts IH]; [exact rel_zer|].
  change (val IA wv (map (lift1 IA) (t :: ts))) with (I.add prec (I.mul prec (rat IA (snd t)) (nth (fst t) wv I.zero)) (val IA wv (map (lift1 IA) ts))).
  change (val RA wv' (map (lift1 RA) (t :: ts))) with (rat RA (snd t) * nth (fst t) wv' 0 + val RA wv' (map (lift1 RA) ts)).
  apply rel_add; [|exact IH]. apply rel_mul; [apply rel_rat|now apply rels_nth].
Qed.
Lemma rels_waves ks q y : rels q y -> rels (waves IA ks q) (waves RA ks y).
Proof.
  intros K; induction ks; simpl; [constructor|].
  assert (rel (dot IA (map (I.fromZ prec) a) q) (dot RA (map IZR a) y)).
  { apply rels_dot; auto. apply Forall2_lift. apply rel_cst. }
  constructor; [now apply rel_cos|]. constructor; [now apply rel_sin|]. exact IHks.
Qed.
Lemma relu_eliminate a a' : rel a a' -> forall v v', rels v v' -> forall r r', relu r r' ->
  relu (eliminate IA a v r) (eliminate RA a' v' r').
Proof.
  intros Ha v v'; induction 1; intros r r' K; [constructor|].
  inversion K; subst; [constructor|]. destruct x0 as [b u], y0 as [b' u'].
  match goal with H : _ /\ _ |- _ => destruct H as [Hb Hu] end. simpl in Hb, Hu.
  constructor; [split|]; simpl.
  - apply rel_sub; auto. apply rel_div; auto. now apply rel_sqr.
  - eapply Forall2_map2; [|exact Hu|exact H0]. intros. apply rel_sub; auto. apply rel_mul; auto. now apply rel_div.
  - now apply IHForall2.
Qed.

Lemma nth_map_nil {X Y} (f : list X -> list Y) l i : f [] = [] -> nth i (map f l) [] = f (nth i l []).
Proof. intros E. rewrite <- E at 1. apply map_nth. Qed.
Section Contained.
Variable p : problem.
Notation n := (pn p).
Variables (wv h dh pull : list I.type) (wv' h' dh' pull' : list R) (s : I.type) (s' : R).
Hypotheses (Kw : rels wv wv') (Kh : rels h h') (Kd : rels dh dh') (Kp : rels pull pull') (Ks : rel s s').
Lemma relm_mass : relm (mass_of IA n (lift IA p) wv) (mass_of RA n (lift RA p) wv').
Proof.
  apply (rel_tab rels). intros i. apply (rel_tab rel). intros j. simpl lM.
  rewrite !(nth_map_nil (map (map (lift1 IA)))), !(nth_map_nil (map (map (lift1 RA)))), !(nth_map_nil (map (lift1 IA))), !(nth_map_nil (map (lift1 RA))) by reflexivity.
  now apply rel_val.
Qed.
Lemma relm_coupling M M' : relm M M' -> relm (coupling IA n (lift IA p) M wv h dh pull) (coupling RA n (lift RA p) M' wv' h' dh' pull').
Proof.
  intros KM. apply (rel_tab rels). intros i. apply (rel_tab rel). intros j. simpl lC.
  apply rel_add; [apply rel_sub; apply rel_mul|].
  - apply rel_sumn. intros k. apply rel_mul; [now apply rel_at2|now apply rel_at1].
  - now apply rel_at1.
  - now apply rel_at2.
  - now apply rel_at1.
  - apply rel_sumn. intros k. apply rel_mul; [|now apply rel_at1].
    rewrite !(nth_map_nil (map (map (map (lift1 IA))))), !(nth_map_nil (map (map (map (lift1 RA))))), !(nth_map_nil (map (map (lift1 IA)))),
      !(nth_map_nil (map (map (lift1 RA)))), !(nth_map_nil (map (lift1 IA))), !(nth_map_nil (map (lift1 RA))) by reflexivity.
    now apply rel_val.
Qed.
Lemma relm_crossed S S' e e' : relm S S' -> rel e e' -> relm (crossed IA n (lift IA p) S e) (crossed RA n (lift RA p) S' e').
Proof.
  intros KS Ke. apply (rel_tab rels). intros i. apply (rel_tab rel). intros j. destruct (Nat.eqb i j).
  - apply rel_add; [apply rel_mul; auto; now apply rel_at2|]. apply rel_at1. apply Forall2_lift, rel_rat.
  - apply rel_mul; auto. now apply rel_at2.
Qed.
Lemma relu_P : relu (P_of IA n (lift IA p) wv h dh pull s) (P_of RA n (lift RA p) wv' h' dh' pull' s').
Proof.
  unfold P_of. pose proof relm_mass as KM. pose proof (relm_coupling _ _ KM) as KS.
  set (S := coupling IA n _ _ _ _ _ _) in *. set (S' := coupling RA n _ _ _ _ _ _) in *. clearbody S S'.
  assert (Ke : rel (mul IA (leps IA (lift IA p)) s) (mul RA (leps RA (lift RA p)) s')) by (apply rel_mul; auto; apply rel_rat).
  set (e := mul IA _ s) in *. set (e' := mul RA _ s') in *. clearbody e e'.
  pose proof (relm_crossed _ _ _ _ KS Ke) as KX. set (X := crossed IA n _ _ _) in *. set (X' := crossed RA n _ _ _) in *. clearbody X X'.
  assert (KG : forall i j, rel (G_of IA n (lift IA p) S X e (div IA e (cst IA 2)) i j) (G_of RA n (lift RA p) S' X' e' (div RA e' (cst RA 2)) i j)).
  { intros i j. unfold G_of. apply rel_sub.
    - destruct (Nat.eqb i j).
      + apply rel_add; [apply rel_at1, Forall2_lift, rel_rat|]. apply rel_mul; auto. now apply rel_at2.
      + apply rel_mul; [apply rel_div; auto; apply rel_cst|]. apply rel_add; now apply rel_at2.
    - apply rel_mul; auto. apply rel_sumn. intros k. apply rel_mul; [apply rel_at1, Forall2_lift, rel_rat|].
      destruct (Nat.eqb i j); [apply rel_sqr|apply rel_mul]; now apply rel_at2. }
  unfold rows_of, relu. apply Forall2_lift. intros i. split; [apply KG|]. apply Forall2_lift. intros j. apply KG.
Qed.
End Contained.

(** ** Elimination shows positive definiteness *)
Definition positive (i : I.type) : bool := match I.sign_strict i with Xgt => true | _ => false end.
Lemma positive_correct i x : positive i = true -> rel i x -> 0 < x.
Proof.
  unfold positive. intros H K. pose proof (I.sign_strict_correct i) as L.
  destruct (I.sign_strict i); try discriminate. apply (L (Xreal x) K).
Qed.
Fixpoint definite (fuel : nat) (rows : list (I.type * list I.type)) : bool :=
  match rows, fuel with
  | [], _ => true
  | _, O => false
  | (a, v) :: rows', S f => if positive a then definite f (eliminate IA a v rows') else false
  end.
Fixpoint shaped (n : nat) (rows : list (R * list R)) : Prop :=
  match n, rows with
  | O, [] => True
  | S n', (_, v) :: rows' => List.length v = n' /\ shaped n' rows'
  | _, _ => False
  end.
Lemma length_map2 {X Y Z} (f : X -> Y -> Z) : forall x y n,
  List.length x = n -> List.length y = n -> List.length (map2 f x y) = n.
Proof.
  induction x; intros y n Hx Hy; destruct y, n; simpl in *; auto; try discriminate.
  all: try (injection Hx; injection Hy; intros; f_equal; auto).
Qed.
Lemma shaped_eliminate a : forall n v rows, List.length v = n -> shaped n rows -> shaped n (eliminate RA a v rows).
Proof.
  induction n; intros v rows Hv Hr; destruct v, rows as [|[b u] rows]; simpl in *; auto; try discriminate.
  destruct Hr. injection Hv; intros. split; auto using length_map2.
Qed.
Lemma dot_sub f : forall u v x, List.length u = List.length v ->
  dot RA (map2 (fun uj vj => sub RA uj (mul RA f vj)) u v) x = dot RA u x - f * dot RA v x.
Proof.
  induction u; intros [|b v] x Hl; simpl in *; try discriminate; try ring.
  destruct x; simpl; [ring|]. rewrite IHu by lia. simpl. ring.
Qed.
Lemma form_eliminate a : a <> 0 -> forall n v rows x, List.length v = n -> shaped n rows -> List.length x = n ->
  form RA (eliminate RA a v rows) x = form RA rows x - dot RA v x * dot RA v x / a.
Proof.
  intros Ha. induction n; intros v rows x Hv Hr Hx; destruct v, x, rows as [|[b u] rows]; simpl in *;
    try discriminate; try tauto; try (field; auto).
  destruct Hr as [Hu Hr]. injection Hv as Hv. injection Hx as Hx.
  rewrite (IHn v rows x Hv Hr Hx). rewrite dot_sub by (transitivity n; [exact Hu|symmetry; exact Hv]).
  simpl. field; auto.
Qed.
Lemma dot_zero : forall x, (forall y, In y x -> y = 0) -> forall v, dot RA v x = 0.
Proof.
  induction x as [|a x IH]; intros H [|b v]; simpl; auto.
  rewrite (IH (fun y h => H y (or_intror h))), (H a (or_introl eq_refl)). ring.
Qed.
Lemma form_zero : forall x, (forall y, In y x -> y = 0) -> forall r, form RA r x = 0.
Proof.
  induction x as [|a x IH]; intros H [|[b u] r]; simpl; auto.
  rewrite (IH (fun y h => H y (or_intror h))), (dot_zero x (fun y h => H y (or_intror h))),
    (H a (or_introl eq_refl)). ring.
Qed.
Lemma definite_correct : forall n fuel rows rs x, definite fuel rows = true -> relu rows rs -> shaped n rs ->
  List.length x = n -> nonzero x -> 0 < form RA rs x.
Proof.
  induction n; intros fuel rows rs x Hd Hrel Hs Hl [y [Hy H0]].
  - destruct x; [destruct Hy|discriminate].
  - destruct rs as [|[a v] rs]; [destruct Hs|]. destruct Hs as [Hv Hs]. destruct x as [|x0 xs]; [discriminate|].
    inversion Hrel as [|[ia iv] ? irows ? [Ha Hiv] Hrows]; subst. simpl in Ha, Hiv.
    destruct fuel; [discriminate|]. simpl in Hd. destruct (positive ia) eqn:Hp; [|discriminate].
    pose proof (positive_correct _ _ Hp Ha) as Hpos.
    assert (Hne : a <> 0) by lra. simpl in Hl. injection Hl; intros Hl'.
    pose proof (form_eliminate a Hne _ v rs xs eq_refl Hs Hl') as E.
    assert (D : (x0 <> 0 /\ forall y, In y xs -> y = 0) \/ nonzero xs).
    { destruct (Exists_dec (fun y => y <> 0) xs) as [K|K].
      - intros z; destruct (Req_EM_T z 0); [right|left]; tauto.
      - right. apply Exists_exists in K. exact K.
      - left. assert (Z : forall y, In y xs -> y = 0).
        { intros z Hz. destruct (Req_EM_T z 0); auto. exfalso. apply K. apply Exists_exists. eauto. }
        split; auto. destruct Hy as [->|Hy]; [exact H0|]. exfalso. apply H0. auto. }
    set (s := dot RA v xs) in *.
    assert (Hform : form RA ((a, v) :: rs) (x0 :: xs) =
                    a * (x0 + s / a) * (x0 + s / a) + form RA (eliminate RA a v rs) xs).
    { rewrite E. simpl. fold s. unfold s. field. auto. }
    rewrite Hform. destruct D as [[Hx0 Hz]|Hn].
    + pose proof (dot_zero xs Hz) as Z0. pose proof (form_zero xs Hz) as F0.
      rewrite F0. unfold s. rewrite Z0. replace (x0 + 0 / a) with x0 by (field; auto).
      assert (0 < x0 * x0) by (destruct (Rtotal_order x0 0) as [h|[h|h]]; [nra|tauto|nra]). nra.
    + assert (0 < form RA (eliminate RA a v rs) xs).
      { eapply (IHn fuel (eliminate IA ia iv irows)); eauto.
        - now apply relu_eliminate.
        - now apply shaped_eliminate. }
      assert (0 <= a * (x0 + s / a) * (x0 + s / a)).
      { rewrite Rmult_assoc. apply Rmult_le_pos; [lra|apply Rle_0_sqr]. }
      lra.
Qed.


Lemma shaped_rows n (G : nat -> nat -> R) : shaped n (rows_of RA n G).
Proof.
  unfold rows_of. assert (K : forall m k, (k + m = n)%nat -> shaped m (map (fun i => (G i i, map (G i) (seq (S i) (n - S i)))) (seq k m))).
  { induction m; intros k E; simpl; auto. split; [rewrite map_length, seq_length; lia|]. apply IHm. lia. }
  apply K. reflexivity.
Qed.

(** ** Boxes *)
Definition side := (PrimFloat.float * PrimFloat.float)%type.
Definition box := list side.
Definition value (f : PrimFloat.float) : R := proj_val (F.toX f).
Definition is_real (f : PrimFloat.float) : bool := F.real f.
Definition inside (b : side) (x : R) : Prop := value (fst b) <= x <= value (snd b).
Definition span (b : side) : I.type := I.bnd (fst b) (snd b).
Definition proper (b : box) : bool := forallb (fun s => is_real (fst s) && is_real (snd s)) b.

Lemma real_val f : is_real f = true -> F.toX f = Xreal (value f).
Proof. unfold is_real, value. rewrite F.real_correct. destruct (F.toX f); [discriminate|reflexivity]. Qed.
Lemma span_correct b x : is_real (fst b) && is_real (snd b) = true -> inside b x -> rel (span b) x.
Proof.
  intros H [Hl Hu]. apply andb_prop in H. destruct H as [Rl Ru].
  apply real_val in Rl. apply real_val in Ru. unfold rel, span.
  rewrite I.bnd_correct.
  - change I.F.toX with F.toX. rewrite Rl, Ru. simpl. lra.
  - apply I.valid_lb_real. change I.F.toX with F.toX. rewrite Rl. reflexivity.
  - apply I.valid_ub_real. change I.F.toX with F.toX. rewrite Ru. reflexivity.
Qed.
Lemma spans_correct b x : proper b = true -> Forall2 inside b x -> rels (map span b) x.
Proof.
  intros Hp H; induction H; simpl in *; [constructor|].
  apply andb_prop in Hp. destruct Hp. constructor; auto using span_correct. now apply IHForall2.
Qed.

(** The direction of the error: e_i/r = 1/sqrt(1 + (r^2 - e_i^2)/e_i^2) for e_i > 0, which rises with e_i. *)
Definition share (x rest : I.type) : I.type :=
  I.div prec (I.fromZ prec 1) (I.sqrt prec (I.add prec (I.fromZ prec 1) (I.div prec rest (I.sqr prec x)))).
Definition point (f : PrimFloat.float) : I.type := I.bnd f f.
(** An interval from 0 to what [share] says at the end of a side. *)
Definition reach (f : PrimFloat.float) (rest : I.type) : I.type :=
  match I.sign_strict (point f) with
  | Xeq => I.zero
  | _ => I.join I.zero (share (point f) rest)
  end.
Definition direction (b : side) (rest : I.type) : I.type :=
  match I.sign_strict (span b) with
  | Xgt => share (span b) rest
  | Xlt => I.neg (share (span b) rest)
  | _ => I.join (reach (snd b) rest) (I.neg (reach (fst b) rest))
  end.

Definition direction_value (x rest : R) : R := x / sqrt (x * x + rest).
Lemma share_correct i j x s : rel i x -> rel j s -> 0 < x -> 0 <= s -> rel (share i j) (direction_value x s).
Proof.
  intros Hi Hj Hx Hs. unfold direction_value.
  replace (x / sqrt (x * x + s)) with (1 / sqrt (1 + s / (x * x))).
  - unfold share. apply rel_div; [apply (rel_cst 1)|]. apply rel_root. apply rel_add; [apply (rel_cst 1)|].
    apply rel_div; auto. now apply rel_sqr.
  - assert (0 < x * x) by nra.
    replace (x * x + s) with ((x * x) * (1 + s / (x * x))) by (field; lra).
    assert (0 <= s / (x * x)) by (apply Rmult_le_pos; [lra|]; left; apply Rinv_0_lt_compat; lra).
    rewrite sqrt_mult by lra. rewrite sqrt_square by lra.
    assert (0 < sqrt (1 + s / (x * x))) by (apply sqrt_lt_R0; lra). field. lra.
Qed.
Lemma direction_neg x s : direction_value (- x) s = - direction_value x s.
Proof. unfold direction_value, Rdiv. replace (- x * - x) with (x * x) by ring. ring. Qed.
Lemma rel_neg i x : rel i x -> rel (I.neg i) (- x).
Proof. intros H; exact (I.neg_correct i (Xreal x) H). Qed.
Lemma share_neg i j x s : rel i x -> rel j s -> x < 0 -> 0 <= s -> rel (share i j) (- direction_value x s).
Proof.
  intros Hi Hj Hx Hs. rewrite <- direction_neg.
  unfold share, direction_value.
  replace (- x / sqrt (- x * - x + s)) with (1 / sqrt (1 + s / (x * x))).
  - apply rel_div; [apply (rel_cst 1)|]. apply rel_root. apply rel_add; [apply (rel_cst 1)|].
    apply rel_div; auto. now apply rel_sqr.
  - assert (0 < x * x) by nra.
    replace (- x * - x + s) with ((x * x) * (1 + s / (x * x))) by (field; lra).
    assert (0 <= s / (x * x)) by (apply Rmult_le_pos; [lra|]; left; apply Rinv_0_lt_compat; lra).
    rewrite sqrt_mult by lra. replace (x * x) with (- x * - x) at 2 by ring. rewrite sqrt_square by lra.
    assert (0 < sqrt (1 + s / (x * x))) by (apply sqrt_lt_R0; lra). field. lra.
Qed.
Lemma direction_mono x y s : 0 <= s -> 0 < x <= y -> direction_value x s <= direction_value y s.
Proof.
  intros Hs [Hx Hy]. unfold direction_value.
  assert (0 < sqrt (x * x + s)) by (apply sqrt_lt_R0; nra).
  assert (0 < sqrt (y * y + s)) by (apply sqrt_lt_R0; nra).
  apply Rmult_le_reg_r with (sqrt (x * x + s) * sqrt (y * y + s)); [nra|].
  replace (x / sqrt (x * x + s) * (sqrt (x * x + s) * sqrt (y * y + s))) with (x * sqrt (y * y + s)) by (field; lra).
  replace (y / sqrt (y * y + s) * (sqrt (x * x + s) * sqrt (y * y + s))) with (y * sqrt (x * x + s)) by (field; lra).
  apply Rsqr_incr_0_var; [|nra]. unfold Rsqr.
  replace (x * sqrt (y * y + s) * (x * sqrt (y * y + s))) with (x * x * (sqrt (y * y + s) * sqrt (y * y + s))) by ring.
  replace (y * sqrt (x * x + s) * (y * sqrt (x * x + s))) with (y * y * (sqrt (x * x + s) * sqrt (x * x + s))) by ring.
  rewrite !sqrt_sqrt by nra. assert (x * x <= y * y) by nra. assert (0 <= (y * y - x * x) * s) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma direction_pos x s : 0 <= s -> 0 < x -> 0 < direction_value x s.
Proof.
  intros. unfold direction_value. apply Rdiv_lt_0_compat; auto. apply sqrt_lt_R0. nra.
Qed.
(** Intervals are convex. *)
Lemma between i a b x : rel i a -> rel i b -> a <= x <= b -> rel i x.
Proof.
  unfold rel. destruct (I.convert i) as [|l u]; simpl; auto.
  destruct l, u; simpl; intros; lra.
Qed.
Lemma point_correct f : is_real f = true -> rel (point f) (value f).
Proof.
  intros H. apply (span_correct (f, f)); simpl; [rewrite H; reflexivity|]. unfold inside; simpl; lra.
Qed.
(** 0 and the direction at x are in the interval that reaches to f >= x. *)
Lemma reach_zero f rest : rel (reach f rest) 0.
Proof.
  unfold reach. destruct (I.sign_strict _); try exact rel_zer; apply I.join_correct; left; exact rel_zer.
Qed.
Lemma reach_right f j x s : is_real f = true -> rel j s -> 0 <= s -> 0 < x <= value f ->
  rel (reach f j) (direction_value x s).
Proof.
  intros Hr Hj Hs Hx. pose proof (point_correct f Hr) as Hp.
  assert (K : rel (I.join I.zero (share (point f) j)) (direction_value x s)).
  { apply between with 0 (direction_value (value f) s).
    - apply I.join_correct; left; exact rel_zer.
    - apply I.join_correct; right. apply share_correct; auto; lra.
    - split; [left; apply direction_pos; lra|apply direction_mono; lra]. }
  unfold reach. pose proof (I.sign_strict_correct (point f)) as L.
  destruct (I.sign_strict (point f)); auto.
  specialize (L _ Hp). injection L. lra.
Qed.
Lemma reach_left f j x s : is_real f = true -> rel j s -> 0 <= s -> value f <= x < 0 ->
  rel (reach f j) (- direction_value x s).
Proof.
  intros Hr Hj Hs Hx. pose proof (point_correct f Hr) as Hp.
  assert (K : rel (I.join I.zero (share (point f) j)) (- direction_value x s)).
  { apply between with 0 (direction_value (- value f) s).
    - apply I.join_correct; left; exact rel_zer.
    - apply I.join_correct; right. rewrite direction_neg. apply share_neg; auto; lra.
    - rewrite <- direction_neg.
      split; [left; apply direction_pos; lra|apply direction_mono; lra]. }
  unfold reach. pose proof (I.sign_strict_correct (point f)) as L.
  destruct (I.sign_strict (point f)); auto.
  specialize (L _ Hp). injection L. lra.
Qed.
Lemma direction_correct b j x s : is_real (fst b) && is_real (snd b) = true -> inside b x -> rel j s -> 0 <= s ->
  rel (direction b j) (direction_value x s).
Proof.
  intros Hr Hx Hj Hs. pose proof (span_correct b x Hr Hx) as Hsp.
  apply andb_prop in Hr. destruct Hr as [R1 R2]. destruct Hx as [X1 X2].
  assert (K : rel (I.join (reach (snd b) j) (I.neg (reach (fst b) j))) (direction_value x s)).
  { apply I.join_correct. destruct (Rtotal_order x 0) as [h|[h|h]].
    - right. rewrite <- (Ropp_involutive (direction_value x s)). apply rel_neg. apply reach_left; auto; lra.
    - left. subst x. unfold direction_value. replace (0 / sqrt (0 * 0 + s)) with 0 by (unfold Rdiv; ring).
      apply reach_zero.
    - left. apply reach_right; auto; lra. }
  unfold direction. pose proof (I.sign_strict_correct (span b)) as L.
  destruct (I.sign_strict (span b)); auto.
  - specialize (L _ Hsp). rewrite <- (Ropp_involutive (direction_value x s)). apply rel_neg.
    apply share_neg; auto. apply L.
  - specialize (L _ Hsp). apply share_correct; auto. apply L.
Qed.

(** All directions: [before] is the sum of the squares of the errors before, [squares] are theirs. *)
Fixpoint total (x : list I.type) : I.type := match x with a :: x' => I.add prec a (total x') | [] => I.zero end.
Fixpoint directions (before : I.type) (b : box) (squares : list I.type) : list I.type :=
  match b, squares with
  | s :: b', q :: sq' =>
      direction s (I.add prec before (total sq')) :: directions (I.add prec before q) b' sq'
  | _, _ => [] end.
Lemma total_correct b e : proper b = true -> Forall2 inside b e ->
  rel (total (map (fun s => I.sqr prec (span s)) b)) (sumsq RA e).
Proof.
  intros Hp H; induction H as [|s x b e Hx H IH]; [exact rel_zer|].
  cbn [proper forallb] in Hp. apply andb_prop in Hp. destruct Hp. cbn [map total].
  apply rel_add; [apply rel_sqr; now apply span_correct|now apply IH].
Qed.
Lemma sumsq_pos e : 0 <= sumsq RA e.
Proof. induction e; simpl; nra. Qed.
Lemma directions_correct b e : Forall2 inside b e -> forall before s0, proper b = true -> rel before s0 -> 0 <= s0 ->
  rels (directions before b (map (fun s => I.sqr prec (span s)) b))
       (map (fun x => x / sqrt (s0 + sumsq RA e)) e).
Proof.
  induction 1 as [|s x b e Hx H IH]; intros before s0 Hp Hb Hs; [constructor|].
  cbn [proper forallb] in Hp. cbn [map directions]. change (sumsq RA (x :: e)) with (x * x + sumsq RA e).
  apply andb_prop in Hp. destruct Hp as [Hp1 Hp]. pose proof (sumsq_pos e). constructor.
  - replace (s0 + (x * x + sumsq RA e)) with (x * x + (s0 + sumsq RA e)) by ring.
    apply (direction_correct s _ x (s0 + sumsq RA e)); auto; [|lra]. apply rel_add; auto. now apply total_correct.
  - replace (s0 + (x * x + sumsq RA e)) with ((s0 + x * x) + sumsq RA e) by ring.
    apply IH; auto; [|nra]. apply rel_add; auto. apply rel_sqr. now apply span_correct.
Qed.


(** ** A leaf, and a tree *)
Section Tree.
Variable p : problem.
Variable na : nat.                                (* how many angles a box begins with *)
Variables (hI dhI : I.type -> I.type) (h dh : R -> R).
Hypothesis hI_correct : forall i x, rel i x -> rel (hI i) (h x).
Hypothesis dhI_correct : forall i x, rel i x -> rel (dhI i) (dh x).

Definition norm (e : list R) : R := sqrt (sumsq RA e).
Definition P (q e : list R) : list (R * list R) :=
  let shrink := 1 / (1 + norm e) in
  P_of RA (pn p) (lift RA p) (waves RA (pk p) q) (map h e) (map dh e) (map (fun x => x / norm e * shrink) e) shrink.
Definition good (q e : list R) : Prop := sumsq RA e < rat RA (pr2 p) ->
  forall x, List.length x = pn p -> nonzero x -> 0 < form RA (P q e) x.

Definition far (r2 rad2 : I.type) : bool := match I.sign_large (I.sub prec r2 rad2) with Xgt | Xeq => true | _ => false end.
Definition leaf (l : lifted IA) (b : box) : bool :=
  if proper b then
    let errors := skipn na b in
    let spans := map span errors in
    let squares := map (fun s => I.sqr prec (span s)) errors in
    let r2 := total squares in
    if far r2 (lr2 IA l) then true else
    let shrink := I.div prec (I.fromZ prec 1) (I.add prec (I.fromZ prec 1) (I.sqrt prec r2)) in
    definite (pn p)
      (P_of IA (pn p) l (waves IA (pk p) (map span (firstn na b))) (map hI spans) (map dhI spans)
            (map (fun u => I.mul prec u shrink) (directions I.zero errors squares)) shrink)
  else false.
Definition proved (x : list R) : Prop := good (firstn na x) (skipn na x).

Lemma Forall2_firstn {X Y} (Q : X -> Y -> Prop) x y : Forall2 Q x y -> forall n, Forall2 Q (firstn n x) (firstn n y).
Proof. induction 1; destruct n; simpl; constructor; auto. Qed.
Lemma Forall2_skipn {X Y} (Q : X -> Y -> Prop) x y : Forall2 Q x y -> forall n, Forall2 Q (skipn n x) (skipn n y).
Proof. induction 1; destruct n; simpl; auto; constructor; auto. Qed.
Lemma Forall2_same {X Y} (Q : X -> Y -> Prop) x y : Forall2 Q x y -> List.length x = List.length y.
Proof. induction 1; simpl; auto. Qed.
Lemma proper_firstn b n : proper b = true -> proper (firstn n b) = true.
Proof. unfold proper. rewrite !forallb_forall. intros H x Hx. apply H. rewrite <- (firstn_skipn n b). apply in_or_app; auto. Qed.
Lemma proper_skipn b n : proper b = true -> proper (skipn n b) = true.
Proof. unfold proper. rewrite !forallb_forall. intros H x Hx. apply H. rewrite <- (firstn_skipn n b). apply in_or_app; auto. Qed.


Lemma leaf_correct b x : leaf (lift IA p) b = true -> Forall2 inside b x -> proved x.
Proof.
  intros H Hin. unfold leaf in H. destruct (proper b) eqn:Hp; [|discriminate].
  pose proof (proper_firstn b na Hp) as Hpa. pose proof (proper_skipn b na Hp) as Hpe.
  pose proof (Forall2_firstn _ _ _ Hin na) as Ha. pose proof (Forall2_skipn _ _ _ Hin na) as He.
  set (q := firstn na x) in *. set (e := skipn na x) in *.
  unfold proved, good. fold q e. intros Hnear y Hy Hnz.
  pose proof (total_correct _ _ Hpe He) as Hr2.
  set (r2 := total _) in *. destruct (far r2 _) eqn:Hfar.
  - exfalso. unfold far in Hfar. pose proof (I.sign_large_correct (I.sub prec r2 (lr2 IA (lift IA p)))) as L.
    assert (K : rel (I.sub prec r2 (lr2 IA (lift IA p))) (sumsq RA e - rat RA (pr2 p))).
    { apply rel_sub; auto. apply rel_rat. }
    destruct (I.sign_large _); try discriminate.
    + specialize (L _ K). apply (f_equal proj_val) in L. cbn [proj_val] in L. change (num RA) with R in *. lra.
    + specialize (L _ K). destruct L as [_ L]. cbn [proj_val] in L. change (num RA) with R in *. lra.
  - eapply definite_correct; [exact H| |apply shaped_rows|exact Hy|exact Hnz].
    assert (Hshrink : rel (I.div prec (I.fromZ prec 1) (I.add prec (I.fromZ prec 1) (I.sqrt prec r2)))
                          (1 / (1 + sqrt (sumsq RA e)))).
    { apply rel_div; [apply rel_cst|]. apply rel_add; [apply rel_cst|]. now apply rel_root. }
    unfold P. cbv zeta. fold (norm e) in Hshrink. set (sR := 1 / (1 + norm e)) in *. set (sI := I.div prec _ _) in *. clearbody sI.
    refine (relu_P p _ _ _ _ _ _ _ _ sI sR _ _ _ _ _).
    + apply rels_waves. now apply spans_correct.
    + eapply Forall2_map; [|apply spans_correct; eauto]. apply hI_correct.
    + eapply Forall2_map; [|apply spans_correct; eauto]. apply dhI_correct.
    + rewrite <- (map_map (fun x => x / norm e) (fun u => u * sR)).
      eapply Forall2_map with (R1 := rel); [intros; apply rel_mul; [eassumption|exact Hshrink]|].
      pose proof (directions_correct _ _ He I.zero 0 Hpe rel_zer (Rle_refl 0)) as D. rewrite Rplus_0_l in D. exact D.
    + exact Hshrink.
Qed.

Fixpoint cut (i : nat) (b : box) : option (box * box) :=
  match b, i with
  | [], _ => None
  | (l, u) :: b', O =>
      let m := PrimFloat.mul 0.5 (PrimFloat.add l u) in
      if is_real m then Some ((l, m) :: b', (m, u) :: b') else None
  | s :: b', S i' => match cut i' b' with Some (x, y) => Some (s :: x, s :: y) | None => None end
  end.
Lemma cut_correct : forall i b l r x, cut i b = Some (l, r) -> Forall2 inside b x -> Forall2 inside l x \/ Forall2 inside r x.
Proof.
  induction i; intros [|[a c] b] l r x H K; simpl in H; try discriminate; inversion K; subst.
  - destruct (is_real _); [|discriminate]. injection H; intros <- <-.
    match goal with H : inside _ ?y |- _ => destruct H as [H1 H2]; simpl in H1, H2;
      destruct (Rle_dec y (value (PrimFloat.mul 0.5 (PrimFloat.add a c)))) as [k|k] end.
    + left; constructor; auto. split; simpl; lra.
    + right; constructor; auto. split; simpl; lra.
  - destruct (cut i b) as [[bl br]|] eqn:E; [|discriminate]. injection H; intros <- <-.
    match goal with J : Forall2 inside b _ |- _ => destruct (IHi _ _ _ _ E J) end; [left|right]; constructor; auto.
Qed.
Lemma cut_length : forall i b l r, cut i b = Some (l, r) -> List.length l = List.length b /\ List.length r = List.length b.
Proof.
  induction i; intros [|[a c] b] l r H; simpl in H; try discriminate.
  - destruct (is_real _); [|discriminate]. injection H; intros <- <-; auto.
  - destruct (cut i b) as [[l' r']|] eqn:E; [|discriminate]. injection H; intros <- <-; simpl.
    destruct (IHi _ _ _ E). lia.
Qed.

(** The side that is widest beside what it was at the start. *)
Fixpoint widest_from (k best : nat) (width : PrimFloat.float) (start b : box) : nat :=
  match start, b with
  | (l0, u0) :: start', (l, u) :: b' =>
      let w := PrimFloat.div (PrimFloat.sub u l) (PrimFloat.sub u0 l0) in
      if PrimFloat.ltb width w then widest_from (S k) k w start' b' else widest_from (S k) best width start' b'
  | _, _ => best end.


Fixpoint shown (start : box) (l : lifted IA) (fuel : nat) (b : box) : bool :=
  if leaf l b then true else
  match fuel with
  | O => false
  | S f => match cut (widest_from 0 0 (-1)%float start b) b with
           | Some (x, y) => if shown start l f x then shown start l f y else false
           | None => false end
  end.
Lemma shown_correct start : forall fuel b x, shown start (lift IA p) fuel b = true -> Forall2 inside b x -> proved x.
Proof.
  induction fuel; intros b x H K; simpl in H; destruct (leaf _ b) eqn:E;
    try (eapply leaf_correct; eassumption); try discriminate.
  destruct (cut _ b) as [[y z]|] eqn:C; [|discriminate].
  destruct (shown _ _ fuel y) eqn:D; [|discriminate].
  destruct (cut_correct _ _ _ _ _ C K); [eapply (IHfuel y)|eapply (IHfuel z)]; eauto.
Qed.

(** The tree as certificates have it: preorder, a digit for the side that is cut, a dot for a leaf. *)
Definition digit (c : ascii) : nat := nat_of_ascii c - 48.
Fixpoint walk (start : box) (l : lifted IA) (fuel : nat) (tree : string) (stack : list box) : bool :=
  match tree, stack with
  | EmptyString, [] => true
  | String c tree', b :: stack' =>
      if Ascii.eqb c "."%char
      then if shown start l fuel b then walk start l fuel tree' stack' else false
      else match cut (digit c) b with
           | Some (x, y) => walk start l fuel tree' (x :: y :: stack')
           | None => false end
  | _, _ => false
  end.
Lemma walk_correct start fuel : forall tree stack, walk start (lift IA p) fuel tree stack = true ->
  forall b x, In b stack -> Forall2 inside b x -> proved x.
Proof.
  induction tree as [|c tree IH]; intros [|b0 stack] H b x Hb Hx; simpl in H; try discriminate; try tauto.
  destruct (Ascii.eqb c _).
  - destruct (shown _ _ fuel b0) eqn:E; [|discriminate]. destruct Hb as [<-|Hb].
    + eapply shown_correct; eauto.
    + eapply IH; eauto.
  - destruct (cut _ b0) as [[y z]|] eqn:C; [|discriminate]. destruct Hb as [<-|Hb].
    + destruct (cut_correct _ _ _ _ _ C Hx); [apply (IH _ H y)|apply (IH _ H z)]; simpl; auto.
    + apply (IH _ H b); simpl; auto.
Qed.
Definition check (start : box) (fuel : nat) (tree : string) : bool := walk start (lift IA p) fuel tree [start].
Theorem check_correct start fuel tree : check start fuel tree = true -> forall x, Forall2 inside start x -> proved x.
Proof. intros H x Hx. eapply walk_correct; eauto. now left. Qed.
End Tree.
