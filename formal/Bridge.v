(** From a tree of boxes to the closed loop: for every state there is a point of the boxes with the same quadratic form. *)
From Coq Require Import Floats.
From Coq Require Import ZArith QArith Qreals List Bool Lra Lia String Reals Psatz.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Float.Primitive_ops Real.Xreal.
Require Import Definitions.
Require Loop Converge.
Require Import Arm Boxes Rate.
Import ListNotations.
Open Scope R_scope.

Ltac rring := change (num RA) with R in *; ring.
Ltac rfield := change (num RA) with R in *; field.
Definition dot := Definitions.dot.
Definition norm := Definitions.norm.
Definition lsum (f : nat -> R) (l : list nat) : R := fold_right (fun i s => f i + s) 0 l.
Lemma lsum_ext f g l : (forall i, In i l -> f i = g i) -> lsum f l = lsum g l.
Proof. induction l; simpl; intros K; auto. rewrite K, IHl; auto. Qed.
Lemma lsum_plus f g l : lsum (fun i => f i + g i) l = lsum f l + lsum g l.
Proof. induction l; simpl; [ring|]. rewrite IHl. ring. Qed.
Lemma lsum_scal c f l : lsum (fun i => c * f i) l = c * lsum f l.
Proof. induction l; simpl; [ring|]. rewrite IHl. ring. Qed.
Lemma lsum_sum n f : lsum f (seq 0 n) = sum n f.
Proof.
  assert (K : forall m k, lsum f (seq k m) = sum m (fun j => f (k + j)%nat)).
  { induction m; intros k; [reflexivity|]. cbn [seq]. change (lsum f (k :: seq (S k) m)) with (f k + lsum f (seq (S k) m)). rewrite IHm.
    assert (E : forall g : nat -> R, g 0%nat + sum m (fun j => g (S j)) = sum (S m) g).
    { clear. intros g. induction m; simpl in *; [ring|]. rewrite <- Rplus_assoc, IHm. ring. }
    rewrite <- (E (fun j => f (k + j)%nat)). rewrite PeanoNat.Nat.add_0_r. f_equal. apply Loop.sum_ext; intros. f_equal. lia. }
  rewrite K. reflexivity.
Qed.
Lemma sumn_sum n f : sumn RA n f = sum n f.
Proof. apply lsum_sum. Qed.
Lemma dot_lists (u v : nat -> R) l : Boxes.dot RA (map u l) (map v l) = lsum (fun i => u i * v i) l.
Proof. induction l; simpl in *; [reflexivity|]. now rewrite IHl. Qed.
Lemma form_rows n (G : nat -> nat -> R) w : (forall i j, (i < n)%nat -> (j < n)%nat -> G i j = G j i) ->
  form RA (rows_of RA n G) (tab n w) = sum n (fun i => sum n (fun j => G i j * (w i * w j))).
Proof.
  intros Sy. unfold rows_of, tab.
  assert (K : forall m k, (k + m = n)%nat -> form RA (map (fun i => (G i i, map (G i) (seq (S i) (n - S i)))) (seq k m)) (map w (seq k m))
    = lsum (fun i => lsum (fun j => G i j * (w i * w j)) (seq k m)) (seq k m)).
  { induction m; intros k E; [reflexivity|]. cbn [seq map form]. replace (n - S k)%nat with m by lia.
    change (Boxes.dot RA (map (G k) (seq (S k) m)) (map w (seq (S k) m))) with (Boxes.dot RA (map (G k) (seq (S k) m)) (map w (seq (S k) m))).
    rewrite dot_lists, (IHm (S k)) by lia. set (l := seq (S k) m).
    assert (Hl : forall i, In i l -> (i < n)%nat) by (intros i Hi; apply in_seq in Hi; lia).
    change (lsum (fun i => lsum (fun j => G i j * (w i * w j)) (k :: l)) (k :: l)) with
      ((G k k * (w k * w k) + lsum (fun j => G k j * (w k * w j)) l) + lsum (fun i => G i k * (w i * w k) + lsum (fun j => G i j * (w i * w j)) l) l).
    rewrite lsum_plus. rewrite (lsum_ext (fun i => G i k * (w i * w k)) (fun i => w k * (G k i * w i))).
    - rewrite (lsum_ext (fun j => G k j * (w k * w j)) (fun i => w k * (G k i * w i))) by (intros; ring). rewrite lsum_scal.
      cbv [add mul sqr two cst RA num]. ring.
    - intros i Hi. rewrite (Sy i k) by (auto; lia). ring. }
  etransitivity; [exact (K n 0%nat eq_refl)|]. rewrite lsum_sum. apply Loop.sum_ext; intros i Hi. apply lsum_sum.
Qed.

Lemma at1_tab n f i : (i < n)%nat -> at1 RA (tab n f) i = f i.
Proof. intros; now apply nth_tab. Qed.
Lemma at2_tab n (f : nat -> nat -> R) i j : (i < n)%nat -> (j < n)%nat -> at2 RA (tab n (fun i => tab n (f i))) i j = f i j.
Proof. intros. unfold at2. rewrite !nth_tab; auto. Qed.
Lemma map_tab {X Y} n (f : nat -> X) (g : X -> Y) : map g (tab n f) = tab n (fun i => g (f i)).
Proof. unfold tab. apply map_map. Qed.
Lemma sumsq_tab n e : sumsq RA (tab n e) = dot n e e.
Proof.
  unfold dot, Definitions.dot. rewrite <- lsum_sum. unfold tab. induction (seq 0 n) as [|i l IH]; simpl in *; [reflexivity|]. now rewrite IH.
Qed.
Lemma rat_Q r : rat RA r = Q2R r. Proof. destruct r as [a b]. reflexivity. Qed.

(** ** The problem of an arm *)
Section Problem.
Variable A : arm.
Notation n := (joints A).
Variables (angles : list nat) (ks : list (list Z)).
Variables (kp kv : list Q) (eps0 c1 c2 L rad : Q).

Fixpoint index (k : list Z) (l : list (list Z)) : nat := match l with [] => O | x :: l' => if same k x then O else S (index k l') end.
Definition terms (ts : list harmonic) : list (nat * Q) :=
  flat_map (fun (t : harmonic) => let '(k, a, b) := t in let p := index k ks in
    (if Qeq_bool a 0 then [] else [(2 * p, a)%nat]) ++ (if Qeq_bool b 0 then [] else [(2 * p + 1, b)%nat])) ts.
Definition known (ts : list harmonic) : bool := forallb (fun (t : harmonic) => let '(k, _, _) := t in same (nth (index k ks) ks []) k && Nat.ltb (index k ks) (List.length ks)) ts.
(** K~ less a little: k_i = kp_i - eps0 L kv_i / 4 - c1 *)
Definition stiff (i : nat) : Q := Qred (nth i kp 0 - eps0 * L * nth i kv 0 * (1 # 4) - c1)%Q.
Definition problem_of : problem := Problem n (map (fun k => map (fun l => nth l k 0%Z) angles) ks)
  (tab n (fun i => tab n (fun j => terms (H A i j)))) (tab n (fun i => tab n (fun j => tab n (fun k => terms (c_of A i j k)))))
  (tab n (fun i => nth i (viscous A) 0%Q)) (tab n (fun i => Qred (nth i (viscous A) 0 - c2)%Q))
  (tab n (fun i => Qred (/ (4 * stiff i))%Q)) eps0 (rad * rad)%Q.

(** Each wave is one of the angles of a box alone. *)
Definition restricted (k : list Z) : bool := forall_to n (fun i =>
  Z.eqb (nth i k 0%Z) (fold_right (fun l s => if Nat.eqb l i then nth l k 0 + s else s)%Z 0%Z angles)) && forallb (fun l => Nat.ltb l n) angles.
Definition all_known : bool := forall_to n (fun i => forall_to n (fun j => known (H A i j) && forall_to n (fun k => known (c_of A i j k)))) && forallb restricted ks.
Hypothesis K : all_known = true.
Lemma known_H i j : (i < n)%nat -> (j < n)%nat -> known (H A i j) = true.
Proof. intros Hi Hj. apply andb_prop in K. destruct K as [K1 _]. pose proof (forall_to_true _ _ (forall_to_true _ _ K1 i Hi) j Hj) as E. now apply andb_prop in E. Qed.
Lemma known_c i j k : (i < n)%nat -> (j < n)%nat -> (k < n)%nat -> known (c_of A i j k) = true.
Proof.
  intros Hi Hj Hk. apply andb_prop in K. destruct K as [K1 _]. pose proof (forall_to_true _ _ (forall_to_true _ _ K1 i Hi) j Hj) as E.
  apply andb_prop in E. destruct E as [_ E]. exact (forall_to_true _ _ E k Hk).
Qed.

(** The angles of a box that stand for a posture: less multiples of 2 pi. *)
Definition stands_for (qb : list R) (q : vec) : Prop := exists zs : nat -> Z, qb = map (fun l => q l - IZR (2 * zs l) * PI) angles.
Lemma phase_of_box k q zs : restricted k = true -> exists z : Z,
  Boxes.dot RA (map IZR (map (fun l => nth l k 0%Z) angles)) (map (fun l => q l - IZR (2 * zs l) * PI) angles) = phase n k q - IZR (2 * z) * PI.
Proof.
  intros R. unfold restricted in R. apply andb_prop in R. destruct R as [R1 R2]. rewrite forallb_forall in R2.
  assert (P : phase n k q = fold_right (fun l s => IZR (nth l k 0%Z) * q l + s) 0 angles).
  { assert (P1 : phase n k q = sum n (fun i => IZR (fold_right (fun l s => if Nat.eqb l i then nth l k 0 + s else s)%Z 0%Z angles) * q i)).
    { apply Loop.sum_ext; intros i Hi. pose proof (forall_to_true _ _ R1 i Hi) as E. apply Z.eqb_eq in E. now rewrite E. }
    rewrite P1. clear P1 R1. induction angles as [|l ls IH]; simpl.
    - rewrite (Loop.sum_ext n _ (fun _ => 0)) by (intros; ring). rewrite Loop.sum_const. ring.
    - rewrite <- IH by (intros; apply R2; now right). pose proof (R2 l (or_introl eq_refl)) as Hl. apply PeanoNat.Nat.ltb_lt in Hl.
      rewrite (Loop.sum_ext n _ (fun i => (if Nat.eqb i l then IZR (nth l k 0%Z) * q l else 0) + IZR (fold_right (fun l0 s => if Nat.eqb l0 i then nth l0 k 0 + s else s)%Z 0%Z ls) * q i)).
      + rewrite Loop.sum_plus. f_equal. clear - Hl. revert Hl. generalize n. intros m Hl. generalize (IZR (nth l k 0%Z) * q l). intros x.
        induction m as [|m IH]; [lia|]. simpl. destruct (PeanoNat.Nat.eqb_spec m l) as [->|N].
        * rewrite (Loop.sum_ext l _ (fun _ => 0)); [rewrite Loop.sum_const; ring|]. intros j Hj. destruct (PeanoNat.Nat.eqb_spec j l); [lia|auto].
        * rewrite IH by lia. ring.
      + intros i Hi. rewrite (PeanoNat.Nat.eqb_sym i l). destruct (PeanoNat.Nat.eqb_spec l i) as [->|N]; [rewrite plus_IZR|]; ring. }
  rewrite P. clear P R1 R2.
  exists (fold_right (fun l s => nth l k 0 * zs l + s)%Z 0%Z angles).
  induction angles as [|l ls IH]; [simpl; ring|].
  change (IZR (nth l k 0%Z) * (q l - IZR (2 * zs l) * PI) + Boxes.dot RA (map IZR (map (fun l => nth l k 0%Z) ls)) (map (fun l => q l - IZR (2 * zs l) * PI) ls)
    = IZR (nth l k 0%Z) * q l + fold_right (fun l s => IZR (nth l k 0%Z) * q l + s) 0 ls
      - IZR (2 * (nth l k 0 * zs l + fold_right (fun l s => nth l k 0 * zs l + s) 0 ls)%Z) * PI).
  rewrite IH, !mult_IZR, plus_IZR, mult_IZR. ring.
Qed.
Lemma waves_of_box qb q p : stands_for qb q -> (p < List.length ks)%nat -> (forall k, In k ks -> restricted k = true) ->
  nth (2 * p) (waves RA (pk problem_of) qb) 0 = cos (phase n (nth p ks []) q) /\
  nth (2 * p + 1) (waves RA (pk problem_of) qb) 0 = sin (phase n (nth p ks []) q).
Proof.
  intros [zs ->]. unfold problem_of, pk. revert p. induction ks as [|k l IH]; intros p Hp R; [simpl in Hp; lia|].
  destruct (phase_of_box k q zs (R k (or_introl eq_refl))) as [z E].
  cbn [map waves]. cbv zeta. change (map (cst RA)) with (map IZR). rewrite E. destruct p as [|p].
  - split; [exact (cos_turn (phase n k q) z)|exact (sin_turn (phase n k q) z)].
  - replace (2 * S p)%nat with (S (S (2 * p))) by lia. replace (S (S (2 * p)) + 1)%nat with (S (S (2 * p + 1))) by lia. cbn [nth].
    apply IH; [simpl in Hp; lia|]. intros; apply R; now right.
Qed.
Lemma val_terms qb q ts : stands_for qb q -> known ts = true ->
  val RA (waves RA (pk problem_of) qb) (map (lift1 RA) (terms ts)) = Arm.total n q ts.
Proof.
  intros Sf. assert (R : forall k, In k ks -> restricted k = true) by (apply forallb_forall; now apply andb_prop in K).
  unfold val, terms, known. induction ts as [|[[k a] b] ts IH]; intros Kn; [reflexivity|]. cbn [flat_map forallb] in *.
  apply andb_prop in Kn. destruct Kn as [K1 K2]. apply andb_prop in K1. destruct K1 as [Ks Kl]. apply PeanoNat.Nat.ltb_lt in Kl.
  unfold same in Ks. destruct (list_eq_dec Z.eq_dec (nth (index k ks) ks []) k) as [Ek|]; [|discriminate].
  destruct (waves_of_box qb q _ Sf Kl R) as [W1 W2]. rewrite Ek in W1, W2.
  rewrite map_app, fold_right_app, (IH K2). cbv zeta.
  set (i1 := (2 * index k ks)%nat) in *. set (i2 := (i1 + 1)%nat) in *. clearbody i2. clearbody i1. cbn [Arm.total fold_right]. fold (Arm.total n q ts). unfold wave.
  assert (Za : forall x : Q, Qeq_bool x 0 = true -> Q2R x = 0) by (intros x Hx; rewrite (Qeq_eqR _ _ (Qeq_bool_eq _ _ Hx)); apply Q2R_0).
  destruct (Qeq_bool a 0) eqn:Ea, (Qeq_bool b 0) eqn:Eb; cbn [app map fold_right lift1 fst snd add mul RA zer num] in *;
    rewrite ?(rat_Q a), ?(rat_Q b), ?W1, ?W2, ?(Za _ Ea), ?(Za _ Eb); ring.
Qed.

(** *** The entries of the matrix that is evaluated *)
Variables (hf dhf : R -> R) (qb : list R) (q e : vec).
Hypothesis Sf : stands_for qb q.
Notation p := problem_of.
Notation wv := (waves RA (pk p) qb).
Notation hl := (map hf (tab n e)).
Notation dl := (map dhf (tab n e)).
Notation shrink := (1 / (1 + norm n e)).
Notation pl := (map (fun x => x / norm n e * shrink) (tab n e)).
Definition hv : vec := fun i => hf (e i).
Definition dv : vec := fun i => dhf (e i).
Definition Sm : mat := S_of n (M_of A q) (C_of A q hv) hv dv (pull n e).
Lemma mass_at i j : (i < n)%nat -> (j < n)%nat -> at2 RA (mass_of RA n (lift RA p) wv) i j = M_of A q i j.
Proof.
  intros Hi Hj. unfold mass_of. rewrite at2_tab by auto. cbn [lM lift]. unfold problem_of at 2. cbn [pM].
  rewrite !(nth_map_nil (map (map (lift1 RA)))), !(nth_map_nil (map (lift1 RA))), !nth_tab by auto.
  rewrite (val_terms qb q) by (auto using known_H). symmetry. apply M_total.
Qed.
Lemma coupling_at i j : (i < n)%nat -> (j < n)%nat -> at2 RA (coupling RA n (lift RA p) (mass_of RA n (lift RA p) wv) wv hl dl pl) i j = Sm i j.
Proof.
  intros Hi Hj. unfold coupling. rewrite at2_tab by auto. rewrite !map_tab, !sumn_sum. unfold Sm, S_of. cbn [add sub mul RA].
  rewrite !at1_tab, mass_at by auto.
  rewrite (Loop.sum_ext n (fun k => at2 RA (mass_of RA n (lift RA p) wv) i k * at1 RA (tab n (fun i0 => hf (e i0))) k) (fun k => M_of A q i k * hv k)).
  2: { intros k Hk. rewrite mass_at, at1_tab by auto. reflexivity. }
  rewrite (Loop.sum_ext n (fun k => val RA wv (nth k (nth j (nth i (lC RA (lift RA p)) []) []) []) * at1 RA (tab n (fun i0 => hf (e i0))) k) (fun k => Arm.total n q (c_of A i j k) * hv k)).
  2: { intros k Hk. rewrite at1_tab by auto. f_equal. cbn [lC lift]. unfold problem_of at 2. cbn [pC].
       rewrite !(nth_map_nil (map (map (map (lift1 RA))))), !(nth_map_nil (map (map (lift1 RA)))), !(nth_map_nil (map (lift1 RA))), !nth_tab by auto.
       apply val_terms; auto using known_c. }
  rewrite (C_total A q hv i j Hi Hj). unfold apply_, Definitions.dot, pull, dv, hv. fold (norm n e). change (num RA) with R in *. ring.
Qed.
Definition ep : R := Q2R eps0 * shrink.
Definition cw : vec := fun i => / (4 * Q2R (stiff i)).
Hypothesis stiff_pos : forall i, (i < n)%nat -> 0 < Q2R (stiff i).
Theorem form_is w : form RA (Boxes.P p hf dhf qb (tab n e)) (tab n w) = F_of n (b_of A) cw ep Sm w - Q2R c2 * dot n w w.
Proof.
  unfold Boxes.P. cbv zeta.
  assert (N : Boxes.norm (tab n e) = norm n e) by (unfold Boxes.norm, norm, Definitions.norm; now rewrite sumsq_tab). rewrite N.
  change (pn p) with n. unfold P_of. cbv zeta.
  set (S := coupling RA n _ _ wv hl dl pl).
  assert (HS : forall i j, (i < n)%nat -> (j < n)%nat -> at2 RA S i j = Sm i j) by (intros; now apply coupling_at). clearbody S.
  assert (HE : mul RA (leps RA (lift RA p)) shrink = ep).
  { change (rat RA eps0 * shrink = Q2R eps0 * shrink). rewrite (rat_Q eps0). reflexivity. }
  rewrite HE. clear HE.
  set (X := crossed RA n (lift RA p) S ep).
  assert (HX : forall i j, (i < n)%nat -> (j < n)%nat -> at2 RA X i j = ep * Sm i j + (if Nat.eqb i j then b_of A i else 0)).
  { intros i j Hi Hj. unfold X, crossed. rewrite at2_tab by auto. cbv zeta. rewrite HS by auto. destruct (Nat.eqb i j); cbn [add mul RA]; [|rring].
    cbn [lb lift pb problem_of]. rewrite map_tab, at1_tab, rat_Q by auto. reflexivity. }
  clearbody X.
  set (G := G_of RA n (lift RA p) S X ep (div RA ep (cst RA 2))).
  assert (HG : forall i j, (i < n)%nat -> (j < n)%nat -> G i j = (if Nat.eqb i j then b_of A i - Q2R c2 else 0) + ep / 2 * (Sm i j + Sm j i)
     - ep * sum n (fun k => cw k * (at2 RA X k i * at2 RA X k j))).
  { intros i j Hi Hj. unfold G, G_of. rewrite sumn_sum. cbn [add sub mul div sqr cst RA].
    rewrite (Loop.sum_ext n _ (fun k => cw k * (at2 RA X k i * at2 RA X k j))).
    - f_equal. destruct (PeanoNat.Nat.eqb_spec i j) as [->|Nij].
      + rewrite HS by auto. cbn [ld lift pd problem_of]. rewrite map_tab, at1_tab, rat_Q, Q2R_red, Q2R_minus by auto. unfold b_of, entries. rfield.
      + rewrite !HS by auto. rfield.
    - intros k Hk. cbn [lw lift pw problem_of]. rewrite map_tab, at1_tab, rat_Q, Q2R_red by auto. pose proof (stiff_pos k Hk) as Ps.
      unfold cw. rewrite Q2R_inv, Q2R_mult.
      + replace (Q2R 4) with 4 by (unfold Q2R; simpl; lra). destruct (Nat.eqb i j) eqn:Ei; [apply PeanoNat.Nat.eqb_eq in Ei; subst j|]; rring.
      + intros Z. apply Qeq_eqR in Z. rewrite Q2R_mult, Q2R_0 in Z. replace (Q2R 4) with 4 in Z by (unfold Q2R; simpl; lra). lra. }
  rewrite form_rows.
  2: { intros i j Hi Hj. rewrite !HG by auto. rewrite (PeanoNat.Nat.eqb_sym j i). destruct (PeanoNat.Nat.eqb_spec i j) as [->|Nij].
       - reflexivity.
       - f_equal; [f_equal; rring|]. f_equal. apply Loop.sum_ext; intros; rring. }
  set (x := fun l => b_of A l * w l + ep * dot n (Sm l) w).
  (* sum over i of X_li w_i is x_l *)
  assert (D : forall l, (l < n)%nat -> sum n (fun i => at2 RA X l i * w i) = x l).
  { intros l Hl. rewrite (Loop.sum_ext n _ (fun i => ep * (Sm l i * w i) + (if Nat.eqb i l then b_of A l * w l else 0))).
    - rewrite Loop.sum_plus, Loop.sum_scal. unfold x, dot, Definitions.dot. rewrite Rplus_comm. f_equal.
      clear - Hl. revert Hl. generalize n. intros m Hl. generalize (b_of A l * w l). intros y. induction m as [|m IH]; [lia|]. simpl.
      destruct (PeanoNat.Nat.eqb_spec m l) as [->|Nm].
      + rewrite (Loop.sum_ext l _ (fun _ => 0)); [rewrite Loop.sum_const; rring|]. intros j Hj. destruct (PeanoNat.Nat.eqb_spec j l); [lia|auto].
      + rewrite IH by lia. rring.
    - intros i Hi. rewrite HX by auto. rewrite (PeanoNat.Nat.eqb_sym i l). destruct (PeanoNat.Nat.eqb_spec l i) as [->|Nli]; rring. }
  assert (T1 : sum n (fun i => sum n (fun j => (if Nat.eqb i j then b_of A i - Q2R c2 else 0) * (w i * w j))) = sum n (fun i => (b_of A i - Q2R c2) * (w i * w i))).
  { apply Loop.sum_ext; intros i Hi. rewrite (Loop.sum_ext n _ (fun j => if Nat.eqb j i then (b_of A i - Q2R c2) * (w i * w i) else 0)).
    - revert Hi. generalize n. intros m Hi. generalize ((b_of A i - Q2R c2) * (w i * w i)). intros y. induction m as [|m IH]; [lia|]. simpl.
      destruct (PeanoNat.Nat.eqb_spec m i) as [->|Nm].
      + rewrite (Loop.sum_ext i _ (fun _ => 0)); [rewrite Loop.sum_const; rring|]. intros j Hj. destruct (PeanoNat.Nat.eqb_spec j i); [lia|auto].
      + rewrite IH by lia. rring.
    - intros j Hj. rewrite (PeanoNat.Nat.eqb_sym j i). destruct (PeanoNat.Nat.eqb_spec i j) as [->|Nij]; rring. }
  assert (T2 : sum n (fun i => sum n (fun j => ep / 2 * (Sm i j + Sm j i) * (w i * w j))) = ep * sum n (fun i => w i * dot n (Sm i) w)).
  { assert (E1 : sum n (fun i => sum n (fun j => Sm i j * (w i * w j))) = sum n (fun i => w i * dot n (Sm i) w)).
    { apply Loop.sum_ext; intros i Hi. unfold dot, Definitions.dot. rewrite <- Loop.sum_scal. apply Loop.sum_ext; intros; rring. }
    assert (E2 : sum n (fun i => sum n (fun j => Sm j i * (w i * w j))) = sum n (fun i => w i * dot n (Sm i) w)).
    { rewrite Loop.sum_swap. rewrite <- E1. apply Loop.sum_ext; intros i Hi. apply Loop.sum_ext; intros; rring. }
    replace (ep * sum n (fun i => w i * dot n (Sm i) w)) with (ep / 2 * (sum n (fun i => w i * dot n (Sm i) w) + sum n (fun i => w i * dot n (Sm i) w))) by rfield.
    rewrite <- E1 at 1. rewrite <- E2. rewrite <- Loop.sum_plus, <- Loop.sum_scal. apply Loop.sum_ext; intros i Hi.
    rewrite <- Loop.sum_plus, <- Loop.sum_scal. apply Loop.sum_ext; intros; rring. }
  assert (T3 : sum n (fun i => sum n (fun j => sum n (fun k => cw k * (at2 RA X k i * at2 RA X k j)) * (w i * w j))) = sum n (fun k => cw k * (x k * x k))).
  { transitivity (sum n (fun k => sum n (fun i => sum n (fun j => cw k * ((at2 RA X k i * w i) * (at2 RA X k j * w j)))))).
    - rewrite (Loop.sum_swap n n (fun k i => sum n (fun j => cw k * (at2 RA X k i * w i * (at2 RA X k j * w j))))).
      apply Loop.sum_ext; intros i Hi. rewrite Loop.sum_swap. apply Loop.sum_ext; intros j Hj. rewrite Rmult_comm, <- Loop.sum_scal. apply Loop.sum_ext; intros; rring.
    - apply Loop.sum_ext; intros k Hk. rewrite <- (D k Hk).
      rewrite (Loop.sum_ext n _ (fun i => cw k * sum n (fun j => at2 RA X k j * w j) * (at2 RA X k i * w i))).
      + rewrite Loop.sum_scal. rring.
      + intros i Hi. transitivity (cw k * (at2 RA X k i * w i) * sum n (fun j => at2 RA X k j * w j)); [|rring].
        rewrite <- Loop.sum_scal. apply Loop.sum_ext; intros; rring. }
  transitivity (sum n (fun i => sum n (fun j => (if Nat.eqb i j then b_of A i - Q2R c2 else 0) * (w i * w j)))
    + sum n (fun i => sum n (fun j => ep / 2 * (Sm i j + Sm j i) * (w i * w j)))
    - ep * sum n (fun i => sum n (fun j => sum n (fun k => cw k * (at2 RA X k i * at2 RA X k j)) * (w i * w j)))).
  { rewrite <- Loop.sum_scal, <- Loop.sum_plus, <- Loop.sum_minus. apply Loop.sum_ext; intros i Hi.
    rewrite <- Loop.sum_scal, <- Loop.sum_plus, <- Loop.sum_minus. apply Loop.sum_ext; intros j Hj. rewrite HG by auto. rring. }
  rewrite T1, T2, T3. unfold F_of, dot at 2. unfold Definitions.dot at 1. rewrite <- !Loop.sum_scal, <- Loop.sum_plus, <- !Loop.sum_minus.
  apply Loop.sum_ext; intros i Hi. unfold X_of. fold (dot n (Sm i) w). change (b_of A i * w i + ep * dot n (Sm i) w) with (x i). unfold x. rring.
Qed.
End Problem.
