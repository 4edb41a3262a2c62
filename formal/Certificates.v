(** What the proofs of printed certificates use. Nothing of a statement is defined here. *)
From Coq Require Export Reals QArith Qreals List Lra Lia Psatz.
From Coquelicot Require Export Coquelicot.
From Interval Require Export Tactic.
Require Export Definitions.
Require Export Family Bounds Words Stability.
Require Export Arm Boxes Bridge Certified Members Ranges Turns Sharp Falsified Damping Properties.
Require Export GateDefinitions.
Require SampledDefinitions.
Require Gate Period Witness.
Require Export String.
Export ListNotations.
Open Scope R_scope.

(** *** Norms of vectors of values *)
Lemma norm_of_bounded n f (c B : R) : (forall x, Rabs (f x) <= c) -> sqrt (INR n) * c <= B -> forall x : vec, norm n (fun i => f (x i)) <= B.
Proof.
  intros H HB x. eapply Rle_trans; [|exact HB]. apply Loop.bounded_norm; [|intros i; apply H].
  eapply Rle_trans; [apply Rabs_pos|apply (H 0)].
Qed.
Lemma norm_of_linear n f (c B : R) : (forall x, Rabs (f x) <= c * Rabs x) -> 0 <= c -> c <= B -> forall x : vec, norm n (fun i => f (x i)) <= B * norm n x.
Proof.
  intros H Hc HB x. apply Rle_trans with (c * norm n x); [|apply Rmult_le_compat_r; [apply Loop.norm_pos|exact HB]].
  rewrite <- Loop.norm_scal by exact Hc. rewrite <- (Loop.norm_abs n (fun i => c * x i)). apply Loop.norm_le. intros i.
  rewrite Rabs_Rabsolu, Rabs_mult, (Rabs_pos_eq c) by exact Hc. apply H.
Qed.

(** *** Tactics *)
Ltac open_numbers := unfold h, dh, U, bottom, sinh, cosh, norm, dot, entries, Q2R; cbn [sum nth Qnum Qden];
  cbv [Nat.mul Nat.sub Nat.add]; spell 0%nat.
Ltac open_rationals := unfold Q2R; cbn [Qnum Qden].
(** Two numbers by an enclosure of each. *)
Ltac apart := match goal with |- ?a <= ?b => interval_intro a upper with (i_prec 90); interval_intro b lower with (i_prec 90); lra
  | |- ?a < ?b => interval_intro a upper with (i_prec 90); interval_intro b lower with (i_prec 90); lra end.
(** A relation between numbers. *)
Ltac numbers := intros; first [lra | open_numbers; first [interval with (i_prec 120) | apart]].
(** A relation that a point refutes. *)
Ltac fails H := revert H; first [apply Rlt_not_le | apply Rle_not_lt | apply Rgt_not_eq | apply Rlt_not_eq]; numbers.
(** An identity in sinh and cosh of one variable. *)
Ltac identity := intros; first
  [ apply h_odd; lia | apply h_zero; lia | lra | ring
  | match goal with |- context [sinh ?x] => unfold h, dh, U, bottom; cbv [Nat.mul Nat.sub Nat.add]; spell 0%nat;
      let E := fresh in let s := fresh "s" in let c := fresh "c" in
      pose proof (cosh2 x) as E; set (s := sinh x) in *; set (c := cosh x) in *; clearbody s c;
      repeat match goal with |- context [1 + s ^ ?k] => let j := eval compute in (Nat.div2 k) in
        lazymatch goal with K : 0 <= s ^ k |- _ => fail | _ => assert (0 <= s ^ k) by exact (even_pow_pos s j) end end;
      field [E]; repeat split; lra
    end ].
(** Signs of h_m and of what else is plainly positive. *)
Ltac signs x := first
  [ lra
  | apply h_pos; lra
  | match goal with |- 0 <= x * h ?m x => destruct (Req_dec x 0) as [->|N]; [lra|left; apply h_sign; [lia|auto]] end
  | match goal with |- context [sinh x ^ ?k] => let j := eval compute in (Nat.div2 k) in
      let E := fresh in assert (E : 0 <= sinh x ^ k) by exact (even_pow_pos (sinh x) j); lra end
  | interval with (i_bisect x, i_autodiff x, i_prec 60)
  | first [apply Rminus_lt | apply Rminus_le]; interval with (i_bisect x, i_autodiff x, i_prec 90, i_depth 60) ].
(** *** Arms *)
(** The waves that M(q) and its derivatives are made of. *)
Definition waves_in (A : arm) : list (list Z) := nodup (list_eq_dec Z.eq_dec) (map (fun t : harmonic => fst (fst t))
  (flat_map (fun i => flat_map (fun j => (H A i j ++ flat_map (fun k => c_of A i j k) (seq 0 (joints A)))%list) (seq 0 (joints A))) (seq 0 (joints A)))).
(** What [certified_by_norms] and [certified_by_boxes] ask is computed, or a relation between numbers. *)
Ltac computed := lazymatch goal with
  | |- @eq bool _ ?r => vm_cast_no_check (eq_refl r)
  | |- @eq nat _ _ => reflexivity
  | |- (_ < _)%nat => apply PeanoNat.Nat.ltb_lt; reflexivity
  | |- (_ <= _)%nat => lia
  | |- @eq (R -> R) _ _ => reflexivity
  | |- (Loop.Lf _ <= _)%R => cbn [Loop.Lf member_of member_1 member_2 member_3 member_4 member_5 member_6 member_7 member_8 member_9 member_10 member_11 member_12]; apply Rle_refl
  | |- forall i x, rel i x -> _ => first [exact h1_correct | exact dh1_correct | exact h_R_2_correct | exact dh_R_2_correct | exact h_R_3_correct | exact dh_R_3_correct
      | exact h_R_4_correct | exact dh_R_4_correct | exact h_R_5_correct | exact dh_R_5_correct | exact h_R_6_correct | exact dh_R_6_correct
      | apply h_correct; lia | apply dh_correct; lia]
  | |- _ => unfold enough, enough_moving; repeat split; cbn [Loop.gammaf Loop.rhof Loop.Lf member_of member_1 member_2 member_3 member_4 member_5 member_6 member_7 member_8 member_9 member_10 member_11 member_12 joints];
      unfold Q2R; cbn [Qnum Qden]; simpl INR; interval with (i_prec 100)
  end.
