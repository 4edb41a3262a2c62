(** The loop on a computer: to be read after Definitions.v, as the rest of what a statement means. *)
From Coq Require Import Reals QArith Qreals List.
From Coquelicot Require Import Coquelicot.
Require Import Definitions GateDefinitions.
Import ListNotations.
Open Scope R_scope.

(** Gravity: a potential, and the torques that are its gradient. *)
Record gravity (n : nat) := Gravity { P : vec -> R; grav : vec -> vec;
  P_rate : forall (q : R -> vec) t v, (forall i, (i < n)%nat -> is_derive (fun s => q s i) t (v i)) ->
    is_derive (fun s => P (q s)) t (dot n (grav (q t)) v) }.
Arguments P {n}. Arguments grav {n}. Arguments P_rate {n}.
(** Of an arm whose joints are revolute and in series: bounded, and as one joint turns each mass goes round a circle. *)
Definition turned (j : nat) (t : R) (q : vec) : vec := fun i => if Nat.eqb i j then q i + t else q i.
Definition revolute (n : nat) (G : gravity n) : Prop := (exists top, forall q, Rabs (P G q) <= top) /\
  forall q j, (j < n)%nat -> exists x y z, forall t, P G (turned j t q) = x + y * cos t + z * sin t.

(** Joints, m, K_p, K_v, the least of each b_i, the taps of the filter from the newest difference on, samples of delay, the longest
    nominal period T, and how many times T an interval may last. *)
Record computed := Computed { joints_of : nat; its_m : nat; its_kp : list Q; its_kv : list Q; least_b : list Q; taps : list Q;
  late : nat; period : Q; stretch : Q }.
Section Computed.
Variable D : computed.
Notation n := (joints_of D).
Notation J := (length (taps D)).
Variables (rb : robot n) (Gt Gm : gravity n) (qd : vec) (T : R).   (* the gravity that acts, and that of the controller *)
(** The torque held from tk k to tk (k + 1): of the reading p (k + J), which is q (tk (k - late)), and of those before it. *)
Definition speed (p : nat -> vec) (k : nat) : vec := fun i =>
  sum J (fun l => entries (rev (taps D)) l * (p (S (k + l)) i - p (k + l)%nat i)) / T.
Definition held (p : nat -> vec) (k : nat) : vec := fun i => entries (its_kp D) i * h (its_m D) (qd i - p (k + J)%nat i)
  - entries (its_kv D) i * h (its_m D) (speed p k i) + grav Gm (p (k + J)%nat) i.
(** Newton's law under this torque, with further friction phi. *)
Definition obeys (tau phi : vec) (q w : R -> vec) (t : R) : Prop := forall i, (i < n)%nat -> ex_derive (fun s => w s i) t /\
  apply_ n (M rb (q t)) (fun j => Derive (fun s => w s j) t) i
    = tau i - grav Gt (q t) i - phi i - b rb i * w t i - apply_ n (C rb (q t) (w t)) (w t) i.
(** A motion from tk 0 on: readings at times tk without end, those before tk 0 are whatever they are. *)
Definition moves (tk : nat -> R) (p : nat -> vec) (phi q w : R -> vec) : Prop :=
  (forall k, tk k < tk (S k) <= tk k + Q2R (stretch D) * T) /\ (forall t, exists k, t <= tk k) /\
  (forall k, p (k + (J + late D))%nat = q (tk k)) /\
  (forall t i, tk 0%nat <= t -> (i < n)%nat -> is_derive (fun s => q s i) t (w t i) /\ continuous (fun s => w s i) t) /\
  (forall k t, tk k < t < tk (S k) -> obeys (held p k) (phi t) q w t).
Definition close (z : R) (q w : vec) : Prop := forall i, (i < n)%nat -> Rabs (qd i - q i) < z /\ Rabs (w i) < z.
(** The goal is stable, and every motion tends to it. *)
Definition goal_stable : Prop := forall eta, 0 < eta -> exists z, 0 < z /\ forall tk p q w, moves tk p (fun _ _ => 0) q w ->
  close z (q (tk 0%nat)) (w (tk 0%nat)) -> (forall l i, (l < J + late D)%nat -> (i < n)%nat -> Rabs (p (S l) i - p l i) < z) ->
  forall t, tk 0%nat <= t -> close eta (q t) (w t).
Definition goal_attractive : Prop := forall tk p q w, moves tk p (fun _ _ => 0) q w ->
  forall eta, 0 < eta -> exists t1, forall t, t1 <= t -> close eta (q t) (w t).
(** Every motion comes to rest, also under friction that only brakes. *)
Definition all_rest : Prop := forall tk p phi q w, moves tk p phi q w ->
  (forall t i, tk 0%nat <= t -> (i < n)%nat -> 0 <= phi t i * w t i) ->
  forall eta, 0 < eta -> exists t1, forall t, t1 <= t -> norm n (w t) < eta.
End Computed.
(** For every T up to the period, every robot with at least this friction, and every goal: with the controller's gravity the goal is
    globally asymptotically stable; under any other bounded one of a revolute arm it comes to rest. *)
Definition admitted (D : computed) (T : R) (rb : robot (joints_of D)) : Prop := 0 < T <= Q2R (period D) /\
  forall i, (i < joints_of D)%nat -> entries (least_b D) i <= b rb i.
Definition sampled_goal (D : computed) (G : gravity (joints_of D)) : Prop := forall T rb qd, admitted D T rb ->
  goal_stable D rb G G qd T /\ goal_attractive D rb G G qd T.
Definition sampled_rest (D : computed) (G : gravity (joints_of D)) : Prop := forall T rb qd Gt, admitted D T rb ->
  revolute (joints_of D) Gt -> (exists k, forall q i, (i < joints_of D)%nat -> Rabs (grav Gt q i) <= k) -> all_rest D rb Gt G qd T.
(** Of the controller's gravity bounds are known, or it is that of a potential with parameters. *)
Definition of_bounds (D : computed) (k : list Q) (says : forall D, gravity (joints_of D) -> Prop) : Prop := forall G,
  revolute (joints_of D) G -> (forall q i, (i < joints_of D)%nat -> Rabs (grav G q i) <= entries k i) -> says D G.
Definition of_potential (D : computed) (pot : list monomial) (ranges : list (Q * Q))
  (says : forall D, gravity (joints_of D) -> Prop) : Prop := forall p G, in_ranges ranges p ->
  (forall q, P G q = poly_with (joints_of D) pot p q) -> says D G.
