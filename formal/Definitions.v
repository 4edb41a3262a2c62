(** Everything that a statement here means.  A reader who trusts Coq's kernel has to check this page alone:
    no proof needs to be read, since Coq has checked them all.  (n) are formulas and properties of the paper,
    q~ is e, dq/dt is w, and eps0, kp, kv are epsilon_0 and the diagonals of K_p and K_v. *)
From Coq Require Import Reals QArith Qreals List.
From Coquelicot Require Import Coquelicot.
Import ListNotations.
Open Scope R_scope.

(** ** The family of functions, (6) to (8) *)

(** 1 + sinh^(2m) x *)
Definition bottom (m : nat) (x : R) : R := 1 + sinh x ^ (2 * m).
(** h_m(x) = sinh^(2m-1) x cosh x / (1 + sinh^(2m) x) *)
Definition h (m : nat) (x : R) : R := sinh x ^ (2 * m - 1) * cosh x / bottom m x.
(** h_m'(x) = ((2m-1) sinh^(2m-2) x + 2m sinh^(2m) x - sinh^(4m-2) x) / (1 + sinh^(2m) x)^2 *)
Definition dh (m : nat) (x : R) : R :=
  (INR (2 * m - 1) * sinh x ^ (2 * m - 2) + INR (2 * m) * sinh x ^ (2 * m) - sinh x ^ (4 * m - 2)) / bottom m x ^ 2.
(** U_m(x) = ln(1 + sinh^(2m) x) / (2m) *)
Definition U (m : nat) (x : R) : R := ln (bottom m x) / INR (2 * m).

(** The least upper bound of f where P holds. *)
Definition sup (P : R -> Prop) (f : R -> R) : R := real (Lub_Rbar (fun y => exists x, P x /\ y = f x)).
(** gamma_m = sup h_m,  rho_m = sup |h_m'|,  L_m = sup of h_m(x)/x over x > 0 *)
Definition gamma (m : nat) : R := sup (fun _ => True) (h m).
Definition rho (m : nat) : R := sup (fun _ => True) (fun x => Rabs (dh m x)).
Definition L (m : nat) : R := sup (fun x => 0 < x) (fun x => h m x / x).

(** ** Vectors and matrices: entries 0 to n - 1 count, the others are not looked at *)
Definition vec := nat -> R.
Definition mat := nat -> nat -> R.
(** f 0 + ... + f (k - 1) *)
Fixpoint sum (k : nat) (f : nat -> R) : R := match k with O => 0 | S k' => sum k' f + f k' end.
Definition dot (n : nat) (x y : vec) : R := sum n (fun i => x i * y i).
Definition norm (n : nat) (x : vec) : R := sqrt (dot n x x).
Definition apply_ (n : nat) (A : mat) (x : vec) : vec := fun i => dot n (A i) x.
(** The vector with these entries. *)
Definition entries (l : list Q) : vec := fun i => Q2R (nth i l 0%Q).
(** Not all of the first n entries of x and y are 0. *)
Definition away (n : nat) (x y : vec) : Prop := exists i, (i < n)%nat /\ (x i <> 0 \/ y i <> 0).

(** ** A robot with Properties 2.1 to 2.7: M(q), C(q, w), the diagonal b of B, and their bounds *)
Record robot (n : nat) := Robot {
  M : vec -> mat; C : vec -> vec -> mat; b : vec;
  alpha : R; beta : R; kc : R; b_min : R; b_max : R;
  alpha_pos : 0 < alpha; beta_pos : 0 <= beta; kc_pos : 0 <= kc; b_min_pos : 0 < b_min;
  M_sym : forall q i j, (i < n)%nat -> (j < n)%nat -> M q i j = M q j i;                          (* 2.1 *)
  M_low : forall q x, alpha * dot n x x <= dot n x (apply_ n (M q) x);                            (* 2.1 *)
  M_up : forall q x, norm n (apply_ n (M q) x) <= beta * norm n x;                                (* 2.2 *)
  M_rate : forall (q : R -> vec) t v, (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
    forall i j, (i < n)%nat -> (j < n)%nat ->                                                     (* 2.4, 2.5 *)
    is_derive (fun s => M (q s) i j) t (C (q t) v i j + C (q t) v j i);
  C_up : forall q x y, norm n (apply_ n (C q x) y) <= kc * norm n x * norm n y;                   (* 2.3, 2.6 *)
  b_order : b_min <= b_max; b_range : forall i, (i < n)%nat -> b_min <= b i <= b_max }.           (* 2.7 *)
Arguments M {n}. Arguments C {n}. Arguments b {n}. Arguments alpha {n}. Arguments beta {n}. Arguments kc {n}.
Arguments b_min {n}. Arguments b_max {n}.

(** ** The closed loop (11), V of (13), and what is said of them *)
Section Loop.
Variable n : nat.                                  (* joints *)
Variables (Mq : vec -> mat) (Cq : vec -> vec -> mat) (bv : vec).
Variables (hf Uf : R -> R) (kp kv qd : vec).       (* the function with its integral, the gains, the goal q_d *)

(** The loop at time t, with q and dq/dt there: e' = -w and M(q) w' = K_p h(e) - K_v h(w) - B w - C(q, dq/dt) w. *)
Definition closed_at (q dq : vec) (e w : R -> vec) (t : R) : Prop := forall i, (i < n)%nat ->
  is_derive (fun s => e s i) t (- w t i) /\ ex_derive (fun s => w s i) t /\
  apply_ n (Mq q) (fun j => Derive (fun s => w s j) t) i
    = kp i * hf (e t i) - kv i * hf (w t i) - bv i * w t i - apply_ n (Cq q dq) (w t) i.
(** (11) holds at time t: q = q_d - e, and as q_d is constant, dq/dt = w. *)
Definition solves_at (e w : R -> vec) (t : R) : Prop := closed_at (fun j => qd j - e t j) (w t) e w t.
(** A motion, from time 0 on. *)
Definition solution (e w : R -> vec) : Prop := forall t, 0 <= t -> solves_at e w t.

(** eps = eps0 / (1 + |e|), y = w - eps h(e), V = y'M(q)y / 2 + sum of k_pi U(e_i): (12), (13) *)
Definition eps (eps0 : R) (e : vec) : R := eps0 / (1 + norm n e).
Definition y_of (eps0 : R) (e w : vec) : vec := fun i => w i - eps eps0 e * hf (e i).
Definition V (eps0 : R) (e w : vec) : R :=
  / 2 * dot n (y_of eps0 e w) (apply_ n (Mq (fun j => qd j - e j)) (y_of eps0 e w)) + sum n (fun i => kp i * Uf (e i)).

(** dV/dt < 0 along (11) at every state but the origin.  Time plays no part in (11): t is when a curve is there. *)
Definition decreasing (eps0 : R) : Prop := forall e w t, solves_at e w t -> away n (e t) (w t) ->
  exists d, is_derive (fun s => V eps0 (e s) (w s)) t d /\ d < 0.

(** The origin is stable, and every motion tends to it, from wherever it starts. *)
Definition stable : Prop := forall eta, 0 < eta -> exists z, 0 < z /\
  forall e w, solution e w -> norm n (e 0) < z -> norm n (w 0) < z ->
  forall t, 0 <= t -> norm n (e t) < eta /\ norm n (w t) < eta.
Definition attractive : Prop := forall e w, solution e w ->
  forall eta, 0 < eta -> exists T, forall t, T <= t -> norm n (e t) < eta /\ norm n (w t) < eta.
Definition globally_asymptotically_stable : Prop := stable /\ attractive.

(** *** (21): a goal r(t) with the velocity v(t).  K_p h(e) - K_v h(w) + M r'' + C r' + B r' + g is the torque that
    closes the same loop, with q = r - e and dq/dt = v + w. *)
Variables r v : R -> vec.
(** A motion, from time t0 on. *)
Definition tracks (t0 : R) (e w : R -> vec) : Prop := forall t, t0 <= t ->
  closed_at (fun j => r t j - e t j) (fun j => v t j + w t j) e w t.
(** |e| and |w| are below c at time t. *)
Definition within (c : R) (e w : R -> vec) (t : R) : Prop := norm n (e t) < c /\ norm n (w t) < c.
(** How near a motion has to start to stay near, how far it goes, and how long it takes, whatever the time t0 >= 0. *)
Definition uniformly_stable : Prop := forall eta, 0 < eta -> exists z, 0 < z /\
  forall t0 e w, 0 <= t0 -> tracks t0 e w -> within z e w t0 -> forall t, t0 <= t -> within eta e w t.
Definition uniformly_bounded : Prop := forall z, exists eta,
  forall t0 e w, 0 <= t0 -> tracks t0 e w -> within z e w t0 -> forall t, t0 <= t -> within eta e w t.
Definition uniformly_attractive : Prop := forall z eta, 0 < eta -> exists T, 0 <= T /\
  forall t0 e w, 0 <= t0 -> tracks t0 e w -> within z e w t0 -> forall t, t0 + T <= t -> within eta e w t.
Definition globally_uniformly_asymptotically_stable : Prop := uniformly_stable /\ uniformly_bounded /\ uniformly_attractive.
End Loop.
(** dV/dt < 0 along (21) at every state but the origin, from time 0 on. *)
Definition decreasing_along n Mq Cq bv hf Uf kp kv (r v : R -> vec) (eps0 : R) : Prop := forall e w t, 0 <= t ->
  closed_at n Mq Cq bv hf kp kv (fun j => r t j - e t j) (fun j => v t j + w t j) e w t -> away n (e t) (w t) ->
  exists d, is_derive (fun s => V n Mq hf Uf kp (r s) eps0 (e s) (w s)) t d /\ d < 0.

(** ** What is said of every robot with Properties 2.1 to 2.7, all positive gains and every goal *)
Definition positive (n : nat) (k : vec) : Prop := forall i, (i < n)%nat -> 0 < k i.
Definition V_positive_definite (m : nat) : Prop := forall n (rb : robot n) kp qd eps0, positive n kp -> 0 < eps0 ->
  forall e w, (away n e w -> 0 < V n (M rb) (h m) (U m) kp qd eps0 e w) /\
              (~ away n e w -> V n (M rb) (h m) (U m) kp qd eps0 e w = 0).
Definition V_radially_unbounded (m : nat) : Prop := forall n (rb : robot n) kp qd eps0, positive n kp -> 0 < eps0 ->
  forall K, exists r, forall e w, V n (M rb) (h m) (U m) kp qd eps0 e w <= K -> norm n e <= r /\ norm n w <= r.
(** The loop can rest nowhere else. *)
Definition only_equilibrium (m : nat) : Prop := forall n (rb : robot n) kp kv qd, positive n kp -> positive n kv ->
  forall e w, solves_at n (M rb) (C rb) (b rb) (h m) kp kv qd (fun _ => e) (fun _ => w) 0 <-> ~ away n e w.
(** V lies between two functions of e and w alone, both positive definite: c |y|^2 / 2 + sum of k_pi U(e_i). *)
Definition V_like (n m : nat) (kp : vec) (eps0 c : R) (e w : vec) : R :=
  c / 2 * dot n (y_of n (h m) eps0 e w) (y_of n (h m) eps0 e w) + sum n (fun i => kp i * U m (e i)).
Definition definite (n : nat) (W : vec -> vec -> R) : Prop := forall e w, (away n e w -> 0 < W e w) /\ (~ away n e w -> W e w = 0).
Definition V_bounded_below (m : nat) : Prop := forall n (rb : robot n) kp eps0, positive n kp -> 0 < eps0 -> exists c,
  definite n (V_like n m kp eps0 c) /\ forall qd e w, V_like n m kp eps0 c e w <= V n (M rb) (h m) (U m) kp qd eps0 e w.
Definition V_bounded_above (m : nat) : Prop := forall n (rb : robot n) kp eps0, positive n kp -> 0 < eps0 -> exists c,
  definite n (V_like n m kp eps0 c) /\ forall qd e w, V n (M rb) (h m) (U m) kp qd eps0 e w <= V_like n m kp eps0 c e w.
(** Under (21) a motion that is at the origin rests there. *)
Definition equilibrium_of_tracking (m : nat) : Prop := forall n (rb : robot n) kp kv r v e w, ~ away n e w ->
  tracks n (M rb) (C rb) (b rb) (h m) kp kv r v 0 (fun _ => e) (fun _ => w).
(** The proposition of the paper, without (19). *)
Definition every_robot_is_stable (n m : nat) : Prop := forall (rb : robot n) kp kv qd, positive n kp -> positive n kv ->
  globally_asymptotically_stable n (M rb) (C rb) (b rb) (h m) kp kv qd.
(** From time 0 on the goal r has the velocity v, at most vd. *)
Definition goal_moves (n : nat) (r v : R -> vec) (vd : R) : Prop := forall t, 0 <= t ->
  (forall i, (i < n)%nat -> is_derive (fun s => r s i) t (v t i)) /\ norm n (v t) <= vd.
(** (21) on every robot, for every goal whose velocity is bounded. *)
Definition every_robot_tracks (n m : nat) : Prop := forall (rb : robot n) kp kv, positive n kp -> positive n kv ->
  forall r v vd, goal_moves n r v vd -> globally_uniformly_asymptotically_stable n (M rb) (C rb) (b rb) (h m) kp kv r v.

(** ** An arm of n joints as data: M_ij(q) is the sum of c sin^p1 q_1 ... sin^pn q_n cos^p(n+1) q_1 ... cos^p2n q_n *)
Definition monomial := (list nat * Q)%type.        (* ([p1; ...; p2n], c) *)
Record arm := Arm { joints : nat; mass : list (list (list monomial)); viscous : list Q }.

Fixpoint product (k : nat) (f : nat -> R) : R := match k with O => 1 | S k' => product k' f * f k' end.
Definition monomial_at (n : nat) (q : vec) (t : monomial) : R :=
  Q2R (snd t) * product n (fun i => sin (q i) ^ nth i (fst t) 0%nat) * product n (fun i => cos (q i) ^ nth (n + i) (fst t) 0%nat).
Definition M_of (A : arm) (q : vec) : mat := fun i j =>
  fold_right (fun t s => monomial_at (joints A) q t + s) 0 (nth j (nth i (mass A) []) []).
(** df/dq_l at q *)
Definition partial (f : vec -> R) (l : nat) (q : vec) : R :=
  Derive (fun x => f (fun i => if Nat.eqb i l then x else q i)) (q l).
(** C(q, x) by Christoffel's symbols: C_ij = sum over k of (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i)/2 x_k *)
Definition christoffel (n : nat) (Mq : vec -> mat) (q x : vec) : mat := fun i j => sum n (fun k =>
  (partial (fun p => Mq p i j) k q + partial (fun p => Mq p i k) j q - partial (fun p => Mq p j k) i q) / 2 * x k).
Definition C_of (A : arm) : vec -> vec -> mat := christoffel (joints A) (M_of A).
Definition b_of (A : arm) : vec := entries (viscous A).

(** M(q) is symmetric and positive definite, for every q. *)
Definition positive_definite (A : arm) : Prop := forall q,
  (forall i j, (i < joints A)%nat -> (j < joints A)%nat -> M_of A q i j = M_of A q j i) /\
  (forall x, (exists i, (i < joints A)%nat /\ x i <> 0) -> 0 < dot (joints A) x (apply_ (joints A) (M_of A q) x)).
(** Properties 2.1, 2.2 and 2.6 with numbers. *)
Definition M_above (A : arm) (low : Q) : Prop := forall q,
  (forall i j, (i < joints A)%nat -> (j < joints A)%nat -> M_of A q i j = M_of A q j i) /\
  (forall x, (exists i, (i < joints A)%nat /\ x i <> 0) ->
    Q2R low * dot (joints A) x x < dot (joints A) x (apply_ (joints A) (M_of A q) x)).
Definition M_below (A : arm) (high : Q) : Prop := forall q x, norm (joints A) (apply_ (joints A) (M_of A q) x) <= Q2R high * norm (joints A) x.
Definition C_below (A : arm) (high : Q) : Prop := forall q x y,
  norm (joints A) (apply_ (joints A) (C_of A q x) y) <= Q2R high * norm (joints A) x * norm (joints A) y.
(** Properties 2.1 and 2.3 to 2.5 of an arm with parameters p, each between two numbers: in [mass] their powers follow those of the
    cosines. *)
Definition M_with (A : arm) (p q : vec) : mat := fun i j => let n := joints A in fold_right (fun t s =>
  product (length (fst t) - 2 * n) (fun k => p k ^ nth (2 * n + k) (fst t) 0%nat) * monomial_at n q t + s) 0 (nth j (nth i (mass A) []) []).
Definition in_ranges (ranges : list (Q * Q)) (p : vec) : Prop := forall k, (k < length ranges)%nat ->
  Q2R (fst (nth k ranges (0, 0)%Q)) <= p k <= Q2R (snd (nth k ranges (0, 0)%Q)).
Definition M_symmetric (A : arm) ranges : Prop := forall p q, in_ranges ranges p ->
  forall i j, (i < joints A)%nat -> (j < joints A)%nat -> M_with A p q i j = M_with A p q j i.
Definition C_at_rest (A : arm) ranges : Prop := forall p q, in_ranges ranges p ->
  forall i j, (i < joints A)%nat -> (j < joints A)%nat -> christoffel (joints A) (M_with A p) q (fun _ => 0) i j = 0.
(** dM is the rate of M, along a curve that has the velocity w at time t. *)
Definition is_rate (A : arm) (p : vec) (q : R -> vec) (w : vec) (t : R) (dM : mat) : Prop :=
  (forall i, (i < joints A)%nat -> is_derive (fun s => q s i) t (w i)) ->
  forall i j, (i < joints A)%nat -> (j < joints A)%nat -> is_derive (fun s => M_with A p (q s) i j) t (dM i j).
Definition M_rate_by_C (A : arm) ranges : Prop := forall p q w t, in_ranges ranges p ->
  let C := christoffel (joints A) (M_with A p) (q t) w in is_rate A p q w t (fun i j => C i j + C j i).
Definition M_rate_less_2C (A : arm) ranges : Prop := forall p q w t, in_ranges ranges p ->
  let C := christoffel (joints A) (M_with A p) (q t) w in exists dM, is_rate A p q w t dM /\
  (forall i j, (i < joints A)%nat -> (j < joints A)%nat -> dM i j - 2 * C i j = - (dM j i - 2 * C j i)) /\
  dot (joints A) w (apply_ (joints A) (fun i j => dM i j - 2 * C i j) w) = 0.
(** The arm under (6) with h_m: what a certified epsilon_0 says, for every goal q_d. *)
Definition certified (A : arm) (m : nat) (kp kv : list Q) (eps0 : Q) : Prop := positive_definite A /\ forall qd,
  decreasing (joints A) (M_of A) (C_of A) (b_of A) (h m) (U m) (entries kp) (entries kv) qd (Q2R eps0) /\
  globally_asymptotically_stable (joints A) (M_of A) (C_of A) (b_of A) (h m) (entries kp) (entries kv) qd.
(** The arm under (21), for every goal whose velocity is at most vd. *)
Definition certified_tracking (A : arm) (m : nat) (kp kv : list Q) (eps0 vd : Q) : Prop := positive_definite A /\
  forall r v, goal_moves (joints A) r v (Q2R vd) ->
  decreasing_along (joints A) (M_of A) (C_of A) (b_of A) (h m) (U m) (entries kp) (entries kv) r v (Q2R eps0) /\
  globally_uniformly_asymptotically_stable (joints A) (M_of A) (C_of A) (b_of A) (h m) (entries kp) (entries kv) r v.
(** dV/dt > 0 along some curve through some state other than the origin: what a falsified epsilon_0 says. *)
Definition falsified (A : arm) (m : nat) (kp kv : list Q) (eps0 : Q) : Prop := exists qd e w t d,
  solves_at (joints A) (M_of A) (C_of A) (b_of A) (h m) (entries kp) (entries kv) qd e w t /\
  away (joints A) (e t) (w t) /\
  is_derive (fun s => V (joints A) (M_of A) (h m) (U m) (entries kp) qd (Q2R eps0) (e s) (w s)) t d /\ 0 < d.
(** (19) as a necessary condition: where dV/dt < 0 under kappa K_v for some eps0, kappa times the largest k_v is below the bound. *)
Definition damping_below (A : arm) (m : nat) (kp kv : list Q) (largest : Q) (bound : R) : Prop := forall kappa eps0, 0 < kappa -> 0 < eps0 ->
  positive_definite A ->
  (forall qd, decreasing (joints A) (M_of A) (C_of A) (b_of A) (h m) (U m) (entries kp) (fun i => kappa * entries kv i) qd eps0) ->
  kappa * Q2R largest < bound.
