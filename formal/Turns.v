(** Where h_m and h_m' turn, for m = 2 to 6: brackets of 1/1024 about the zeros of h_m' and h_m'', and ranges over any interval. *)
From Coq Require Import Floats.
From Coq Require Import ZArith List Bool Lra Lia Reals.
From Interval Require Import Interval.Float_full Float.Basic Float.Primitive_ops Real.Xreal Tactic.
Require Import Definitions Bounds.
Require Import Boxes Members Ranges.
Import ListNotations.
Open Scope R_scope.

Definition h_sides (a b : PrimFloat.float) : list side := [(-b, -a); (a, b)]%float.
Definition dh_sides (a b c d : PrimFloat.float) : list side := [(-d, -c); (-b, -a); (0, 0); (a, b); (c, d)]%float.

(** The values of floats as they stand. *)
Ltac floats := cbv [map h_sides dh_sides fst snd]; unfold value, F.toX;
  repeat match goal with |- context [F.toF ?f] => let v := eval vm_compute in (F.toF f) in
    change (F.toF f) with v end; cbv -[Rmult Rdiv Rplus Rminus Ropp IZR Rinv].
Ltac polynomial x := let H := fresh in intros x H; unfold P, P_far; cbv [Nat.mul Nat.sub Nat.add]; spell 0%nat;
  interval with (i_bisect x, i_autodiff x, i_prec 40, i_depth 30).
Ltac number := unfold g, sinh; cbv [Nat.mul Nat.sub Nat.add]; spell 0%nat; interval with (i_prec 60).
(** The places of the brackets in x and, with capital letters, numbers between them and the zeros in u. *)
Ltac prove_h_range m a b A B := apply over_pieces_correct;
  [intros; apply h_correct; [lia|assumption]|intros; apply h_correct; [lia|assumption]|vm_compute; reflexivity|];
  replace (map _ _) with [(- b, - a); (a, b)]; [apply (h_pieces m ltac:(lia) a b A B); [lra|repeat split; number|repeat split; number]|floats; repeat (f_equal; try lra)].
Ltac prove_dh_range m a b c d A B C D := apply over_pieces_correct;
  [intros; apply dh_correct; [lia|assumption]|intros; apply dh_correct; [lia|assumption]|vm_compute; reflexivity|];
  replace (map _ _) with [(- d, - c); (- b, - a); (0, 0); (a, b); (c, d)];
  [apply (dh_pieces m ltac:(lia) a b c d A B C D);
    [lra|let u := fresh "u" in polynomial u|let u := fresh "u" in polynomial u|split; [lra|let u := fresh "u" in polynomial u]|number|number|number|number]
  |floats; repeat (f_equal; try lra)].

(** m = 2 *)
Definition h_sides_2 := h_sides (0x1.82cp+0) (0x1.83p+0).
Definition dh_sides_2 := dh_sides (0x1.88p-1) (0x1.888p-1) (0x1.d42p+0) (0x1.d46p+0).
Definition h_R_2 := over_pieces (h_I 2 0) (turns (h_I 2 7) h_sides_2).
Definition dh_R_2 := over_pieces (dh_I 2 0) (turns (dh_I 2 7) dh_sides_2).
Theorem h_R_2_correct : forall i x, rel i x -> rel (h_R_2 i) (h 2 x).
Proof. prove_h_range 2%nat (1547 / 1024) (387 / 256) (4644183 / 1000000) (2324593 / 500000). Qed.
Theorem dh_R_2_correct : forall i x, rel i x -> rel (dh_R_2 i) (dh 2 x).
Proof. prove_dh_range 2%nat (49 / 64) (785 / 1024) (3745 / 2048) (3747 / 2048) (28423 / 40000) (711653 / 1000000) (2300027 / 250000) (9209573 / 1000000). Qed.

(** m = 3 *)
Definition h_sides_3 := h_sides (0x1.49p+0) (0x1.494p+0).
Definition dh_sides_3 := dh_sides (0x1.a88p-1) (0x1.a9p-1) (0x1.868p+0) (0x1.86cp+0).
Definition h_R_3 := over_pieces (h_I 3 0) (turns (h_I 3 7) h_sides_3).
Definition dh_R_3 := over_pieces (dh_I 3 0) (turns (dh_I 3 7) dh_sides_3).
Theorem h_R_3_correct : forall i x, rel i x -> rel (h_R_3 i) (h 3 x).
Proof. prove_h_range 3%nat (329 / 256) (1317 / 1024) (1394473 / 500000) (1396061 / 500000). Qed.
Theorem dh_R_3_correct : forall i x, rel i x -> rel (dh_R_3 i) (dh 3 x).
Proof. prove_dh_range 3%nat (849 / 1024) (425 / 512) (781 / 512) (1563 / 1024) (860893 / 1000000) (862129 / 1000000) (149899 / 31250) (4801921 / 1000000). Qed.

(** m = 4 *)
Definition h_sides_4 := h_sides (0x1.30ep+0) (0x1.312p+0).
Definition dh_sides_4 := dh_sides (0x1.b3cp-1) (0x1.b44p-1) (0x1.63p+0) (0x1.634p+0).
Definition h_R_4 := over_pieces (h_I 4 0) (turns (h_I 4 7) h_sides_4).
Definition dh_R_4 := over_pieces (dh_I 4 0) (turns (dh_I 4 7) dh_sides_4).
Theorem h_R_4_correct : forall i x, rel i x -> rel (h_R_4 i) (h 4 x).
Proof. prove_h_range 4%nat (2439 / 2048) (2441 / 2048) (446231 / 200000) (1116889 / 500000). Qed.
Theorem dh_R_4_correct : forall i x, rel i x -> rel (dh_R_4 i) (dh 4 x).
Proof. prove_dh_range 4%nat (1743 / 2048) (1745 / 2048) (355 / 256) (1421 / 1024) (22949 / 25000) (114907 / 125000) (3520377 / 1000000) (140971 / 40000). Qed.

(** m = 5 *)
Definition h_sides_5 := h_sides (0x1.22ep+0) (0x1.232p+0).
Definition dh_sides_5 := dh_sides (0x1.b94p-1) (0x1.b9cp-1) (0x1.4d8p+0) (0x1.4dcp+0).
Definition h_R_5 := over_pieces (h_I 5 0) (turns (h_I 5 7) h_sides_5).
Definition dh_R_5 := over_pieces (dh_I 5 0) (turns (dh_I 5 7) dh_sides_5).
Theorem h_R_5_correct : forall i x, rel i x -> rel (h_R_5 i) (h 5 x).
Proof. prove_h_range 5%nat (2327 / 2048) (2329 / 2048) (976611 / 500000) (122223 / 62500). Qed.
Theorem dh_R_5_correct : forall i x, rel i x -> rel (dh_R_5 i) (dh 5 x).
Proof. prove_dh_range 5%nat (1765 / 2048) (1767 / 2048) (667 / 512) (1335 / 1024) (946271 / 1000000) (473799 / 500000) (2904729 / 1000000) (145401 / 50000). Qed.

(** m = 6 *)
Definition h_sides_6 := h_sides (0x1.19ap+0) (0x1.19ep+0).
Definition dh_sides_6 := dh_sides (0x1.bcp-1) (0x1.bc8p-1) (0x1.3eep+0) (0x1.3f2p+0).
Definition h_R_6 := over_pieces (h_I 6 0) (turns (h_I 6 7) h_sides_6).
Definition dh_R_6 := over_pieces (dh_I 6 0) (turns (dh_I 6 7) dh_sides_6).
Theorem h_R_6_correct : forall i x, rel i x -> rel (h_R_6 i) (h 6 x).
Proof. prove_h_range 6%nat (2253 / 2048) (2255 / 2048) (1785073 / 1000000) (446813 / 250000). Qed.
Theorem dh_R_6_correct : forall i x, rel i x -> rel (dh_R_6 i) (dh 6 x).
Proof. prove_dh_range 6%nat (111 / 128) (889 / 1024) (2551 / 2048) (2553 / 2048) (4807 / 5000) (962741 / 1000000) (508227 / 200000) (508813 / 200000). Qed.
