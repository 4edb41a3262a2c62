(** gamma_m, rho_m and L_m for m = 1 to 12, to four digits after the point, and h_m with these bounds.  The numbers and the
    places where they are nearly attained are those of `lyapcheck table`; Coq proves them here. *)
From Coq Require Import Reals QArith Qreals Lra Lia ZArith.
From Coquelicot Require Import Coquelicot.
From Interval Require Import Tactic.
Require Import Definitions Bounds Members.
Open Scope R_scope.

Ltac open_Q := unfold Q2R; cbn [Qnum Qden].
Ltac prove_near_zero := let x := fresh "x" in let H := fresh "H" in intros x H; cbv [Nat.mul Nat.sub Nat.add];
  unfold sinh, cosh; spell 0%nat; interval with (i_bisect x, i_autodiff x, i_prec 60).
Ltac open_h := unfold h, dh, U, bottom, sinh, cosh; cbv [Nat.mul Nat.sub Nat.add]; spell 0%nat.
Ltac prove_between := let x := fresh "x" in let H := fresh "H" in intros x H; apply Rminus_le; open_h;
  interval with (i_bisect x, i_autodiff x, i_prec 60, i_depth 40).
(** |h_m(x)| <= c |x|, with the middle part up to [far]. *)
Ltac prove_secant_at_most m c far := apply (secant_at_most m ltac:(lia) c (1 / 2) far (3 / 2));
  [lra|lra|prove_h_at_most|lra|prove_near_zero|prove_between].
Ltac reached lemma := eapply Rle_trans; [|exact lemma]; open_h; interval with (i_prec 120).

(** m = 1: h = tanh, and each bound is 1. *)
Lemma h_1_bound x : Rabs (h 1 x) <= Q2R 1. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_1_bound x : Rabs (dh 1 x) <= Q2R 1. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_1_bound x : Rabs (h 1 x) <= Q2R 1 * Rabs x. Proof. pose proof (secant_1 x). pose proof (Rabs_pos x). open_Q. lra. Qed.
Definition member_1 : Loop.member := member_of 1 (le_n 1) 1 1 1 h_1_bound dh_1_bound secant_1_bound.

(** m = 2 *)
Lemma h_2_bound x : Rabs (h 2 x) <= Q2R (1317 # 1250)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_2_bound x : Rabs (dh 2 x) <= Q2R (16747 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_2_bound x : Rabs (h 2 x) <= Q2R (4337 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 2%nat (4337 * / 5000) ((7 / 4)). Qed.
Definition member_2 : Loop.member := member_of 2 ltac:(lia) (1317 # 1250)%Q (16747 # 10000)%Q (4337 # 5000)%Q h_2_bound dh_2_bound secant_2_bound.
Theorem gamma_2 : (2107 / 2000) <= gamma 2 <= Q2R (1317 # 1250)%Q.
Proof. split; [reached (h_le_gamma 2 ltac:(lia) (6337797 / 4194304))|apply gamma_le; exact h_2_bound]. Qed.
Theorem rho_2 : (3349 / 2000) <= rho 2 <= Q2R (16747 # 10000)%Q.
Proof. split; [reached (dh_le_rho 2 ltac:(lia) (3213245 / 4194304))|apply rho_le; exact dh_2_bound]. Qed.
Theorem L_2 : (8673 / 10000) <= L 2 <= Q2R (4337 # 5000)%Q.
Proof. split; [reached (secant_le_L 2 ltac:(lia) (1081 / 1024) ltac:(lra))|apply L_le; exact secant_2_bound]. Qed.

(** m = 3 *)
Lemma h_3_bound x : Rabs (h 3 x) <= Q2R (11143 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_3_bound x : Rabs (dh 3 x) <= Q2R (26317 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_3_bound x : Rabs (h 3 x) <= Q2R (4849 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 3%nat (4849 * / 5000) ((25 / 16)). Qed.
Definition member_3 : Loop.member := member_of 3 ltac:(lia) (11143 # 10000)%Q (26317 # 10000)%Q (4849 # 5000)%Q h_3_bound dh_3_bound secant_3_bound.
Theorem gamma_3 : (11141 / 10000) <= gamma 3 <= Q2R (11143 # 10000)%Q.
Proof. split; [reached (h_le_gamma 3 ltac:(lia) (5393357 / 4194304))|apply gamma_le; exact h_3_bound]. Qed.
Theorem rho_3 : (5263 / 2000) <= rho 3 <= Q2R (26317 # 10000)%Q.
Proof. split; [reached (dh_le_rho 3 ltac:(lia) (3480173 / 4194304))|apply rho_le; exact dh_3_bound]. Qed.
Theorem L_3 : (606 / 625) <= L 3 <= Q2R (4849 # 5000)%Q.
Proof. split; [reached (secant_le_L 3 ltac:(lia) (2181 / 2048) ltac:(lra))|apply L_le; exact secant_3_bound]. Qed.

(** m = 4 *)
Lemma h_4_bound x : Rabs (h 4 x) <= Q2R (723 # 625)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_4_bound x : Rabs (dh 4 x) <= Q2R (2254 # 625)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_4_bound x : Rabs (h 4 x) <= Q2R (10469 # 10000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 4%nat (10469 * / 10000) ((93 / 64)). Qed.
Definition member_4 : Loop.member := member_of 4 ltac:(lia) (723 # 625)%Q (2254 # 625)%Q (10469 # 10000)%Q h_4_bound dh_4_bound secant_4_bound.
Theorem gamma_4 : (11567 / 10000) <= gamma 4 <= Q2R (723 # 625)%Q.
Proof. split; [reached (h_le_gamma 4 ltac:(lia) (2498997 / 2097152))|apply gamma_le; exact h_4_bound]. Qed.
Theorem rho_4 : (18031 / 5000) <= rho 4 <= Q2R (2254 # 625)%Q.
Proof. split; [reached (dh_le_rho 4 ltac:(lia) (223293 / 262144))|apply rho_le; exact dh_4_bound]. Qed.
Theorem L_4 : (2617 / 2500) <= L 4 <= Q2R (10469 # 10000)%Q.
Proof. split; [reached (secant_le_L 4 ltac:(lia) (2149 / 2048) ltac:(lra))|apply L_le; exact secant_4_bound]. Qed.

(** m = 5 *)
Lemma h_5_bound x : Rabs (h 5 x) <= Q2R (11879 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_5_bound x : Rabs (dh 5 x) <= Q2R (45893 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_5_bound x : Rabs (h 5 x) <= Q2R (5529 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 5%nat (5529 * / 5000) ((11 / 8)). Qed.
Definition member_5 : Loop.member := member_of 5 ltac:(lia) (11879 # 10000)%Q (45893 # 10000)%Q (5529 # 5000)%Q h_5_bound dh_5_bound secant_5_bound.
Theorem gamma_5 : (5939 / 5000) <= gamma 5 <= Q2R (11879 # 10000)%Q.
Proof. split; [reached (h_le_gamma 5 ltac:(lia) (596071 / 524288))|apply gamma_le; exact h_5_bound]. Qed.
Theorem rho_5 : (11473 / 2500) <= rho 5 <= Q2R (45893 # 10000)%Q.
Proof. split; [reached (dh_le_rho 5 ltac:(lia) (3616123 / 4194304))|apply rho_le; exact dh_5_bound]. Qed.
Theorem L_5 : (691 / 625) <= L 5 <= Q2R (5529 # 5000)%Q.
Proof. split; [reached (secant_le_L 5 ltac:(lia) (2115 / 2048) ltac:(lra))|apply L_le; exact secant_5_bound]. Qed.

(** m = 6 *)
Lemma h_6_bound x : Rabs (h 6 x) <= Q2R (12117 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_6_bound x : Rabs (dh 6 x) <= Q2R (55771 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_6_bound x : Rabs (h 6 x) <= Q2R (5761 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 6%nat (5761 * / 5000) ((21 / 16)). Qed.
Definition member_6 : Loop.member := member_of 6 ltac:(lia) (12117 # 10000)%Q (55771 # 10000)%Q (5761 # 5000)%Q h_6_bound dh_6_bound secant_6_bound.
Theorem gamma_6 : (3029 / 2500) <= gamma 6 <= Q2R (12117 # 10000)%Q.
Proof. split; [reached (h_le_gamma 6 ltac:(lia) (4615431 / 4194304))|apply gamma_le; exact h_6_bound]. Qed.
Theorem rho_6 : (55769 / 10000) <= rho 6 <= Q2R (55771 # 10000)%Q.
Proof. split; [reached (dh_le_rho 6 ltac:(lia) (3640075 / 4194304))|apply rho_le; exact dh_6_bound]. Qed.
Theorem L_6 : (11521 / 10000) <= L 6 <= Q2R (5761 # 5000)%Q.
Proof. split; [reached (secant_le_L 6 ltac:(lia) (1043 / 1024) ltac:(lra))|apply L_le; exact secant_6_bound]. Qed.

(** m = 7 *)
Lemma h_7_bound x : Rabs (h 7 x) <= Q2R (2461 # 2000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_7_bound x : Rabs (dh 7 x) <= Q2R (32839 # 5000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_7_bound x : Rabs (h 7 x) <= Q2R (5949 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 7%nat (5949 * / 5000) ((41 / 32)). Qed.
Definition member_7 : Loop.member := member_of 7 ltac:(lia) (2461 # 2000)%Q (32839 # 5000)%Q (5949 # 5000)%Q h_7_bound dh_7_bound secant_7_bound.
Theorem gamma_7 : (769 / 625) <= gamma 7 <= Q2R (2461 # 2000)%Q.
Proof. split; [reached (h_le_gamma 7 ltac:(lia) (2252347 / 2097152))|apply gamma_le; exact h_7_bound]. Qed.
Theorem rho_7 : (16419 / 2500) <= rho 7 <= Q2R (32839 # 5000)%Q.
Proof. split; [reached (dh_le_rho 7 ltac:(lia) (913677 / 1048576))|apply rho_le; exact dh_7_bound]. Qed.
Theorem L_7 : (11897 / 10000) <= L 7 <= Q2R (5949 # 5000)%Q.
Proof. split; [reached (secant_le_L 7 ltac:(lia) (2063 / 2048) ltac:(lra))|apply L_le; exact secant_7_bound]. Qed.

(** m = 8 *)
Lemma h_8_bound x : Rabs (h 8 x) <= Q2R (12459 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_8_bound x : Rabs (dh 8 x) <= Q2R (15121 # 2000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_8_bound x : Rabs (h 8 x) <= Q2R (1221 # 1000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 8%nat (1221 * / 1000) ((5 / 4)). Qed.
Definition member_8 : Loop.member := member_of 8 ltac:(lia) (12459 # 10000)%Q (15121 # 2000)%Q (1221 # 1000)%Q h_8_bound dh_8_bound secant_8_bound.
Theorem gamma_8 : (12457 / 10000) <= gamma 8 <= Q2R (12459 # 10000)%Q.
Proof. split; [reached (h_le_gamma 8 ltac:(lia) (4420303 / 4194304))|apply gamma_le; exact h_8_bound]. Qed.
Theorem rho_8 : (75603 / 10000) <= rho 8 <= Q2R (15121 # 2000)%Q.
Proof. split; [reached (dh_le_rho 8 ltac:(lia) (1832155 / 2097152))|apply rho_le; exact dh_8_bound]. Qed.
Theorem L_8 : (12209 / 10000) <= L 8 <= Q2R (1221 # 1000)%Q.
Proof. split; [reached (secant_le_L 8 ltac:(lia) (2043 / 2048) ltac:(lra))|apply L_le; exact secant_8_bound]. Qed.

(** m = 9 *)
Lemma h_9_bound x : Rabs (h 9 x) <= Q2R (6293 # 5000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_9_bound x : Rabs (dh 9 x) <= Q2R (42773 # 5000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_9_bound x : Rabs (h 9 x) <= Q2R (12473 # 10000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 9%nat (12473 * / 10000) ((39 / 32)). Qed.
Definition member_9 : Loop.member := member_of 9 ltac:(lia) (6293 # 5000)%Q (42773 # 5000)%Q (12473 # 10000)%Q h_9_bound dh_9_bound secant_9_bound.
Theorem gamma_9 : (2517 / 2000) <= gamma 9 <= Q2R (6293 # 5000)%Q.
Proof. split; [reached (h_le_gamma 9 ltac:(lia) (4353539 / 4194304))|apply gamma_le; exact h_9_bound]. Qed.
Theorem rho_9 : (17109 / 2000) <= rho 9 <= Q2R (42773 # 5000)%Q.
Proof. split; [reached (dh_le_rho 9 ltac:(lia) (3670955 / 4194304))|apply rho_le; exact dh_9_bound]. Qed.
Theorem L_9 : (1559 / 1250) <= L 9 <= Q2R (12473 # 10000)%Q.
Proof. split; [reached (secant_le_L 9 ltac:(lia) (1013 / 1024) ltac:(lra))|apply L_le; exact secant_9_bound]. Qed.

(** m = 10 *)
Lemma h_10_bound x : Rabs (h 10 x) <= Q2R (6347 # 5000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_10_bound x : Rabs (dh 10 x) <= Q2R (47749 # 5000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_10_bound x : Rabs (h 10 x) <= Q2R (12699 # 10000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 10%nat (12699 * / 10000) ((77 / 64)). Qed.
Definition member_10 : Loop.member := member_of 10 ltac:(lia) (6347 # 5000)%Q (47749 # 5000)%Q (12699 # 10000)%Q h_10_bound dh_10_bound secant_10_bound.
Theorem gamma_10 : (3173 / 2500) <= gamma 10 <= Q2R (6347 # 5000)%Q.
Proof. split; [reached (h_le_gamma 10 ltac:(lia) (1074805 / 1048576))|apply gamma_le; exact h_10_bound]. Qed.
Theorem rho_10 : (11937 / 1250) <= rho 10 <= Q2R (47749 # 5000)%Q.
Proof. split; [reached (dh_le_rho 10 ltac:(lia) (114867 / 131072))|apply rho_le; exact dh_10_bound]. Qed.
Theorem L_10 : (12697 / 10000) <= L 10 <= Q2R (12699 # 10000)%Q.
Proof. split; [reached (secant_le_L 10 ltac:(lia) (2011 / 2048) ltac:(lra))|apply L_le; exact secant_10_bound]. Qed.

(** m = 11 *)
Lemma h_11_bound x : Rabs (h 11 x) <= Q2R (12787 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_11_bound x : Rabs (dh 11 x) <= Q2R (105457 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_11_bound x : Rabs (h 11 x) <= Q2R (2579 # 2000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 11%nat (2579 * / 2000) ((75 / 64)). Qed.
Definition member_11 : Loop.member := member_of 11 ltac:(lia) (12787 # 10000)%Q (105457 # 10000)%Q (2579 # 2000)%Q h_11_bound dh_11_bound secant_11_bound.
Theorem gamma_11 : (2557 / 2000) <= gamma 11 <= Q2R (12787 # 10000)%Q.
Proof. split; [reached (h_le_gamma 11 ltac:(lia) (4254047 / 4194304))|apply gamma_le; exact h_11_bound]. Qed.
Theorem rho_11 : (6591 / 625) <= rho 11 <= Q2R (105457 # 10000)%Q.
Proof. split; [reached (dh_le_rho 11 ltac:(lia) (3679311 / 4194304))|apply rho_le; exact dh_11_bound]. Qed.
Theorem L_11 : (12893 / 10000) <= L 11 <= Q2R (2579 # 2000)%Q.
Proof. split; [reached (secant_le_L 11 ltac:(lia) (999 / 1024) ltac:(lra))|apply L_le; exact secant_11_bound]. Qed.

(** m = 12 *)
Lemma h_12_bound x : Rabs (h 12 x) <= Q2R (12867 # 10000)%Q. Proof. open_Q. revert x. prove_h_at_most. Qed.
Lemma dh_12_bound x : Rabs (dh 12 x) <= Q2R (115423 # 10000)%Q. Proof. open_Q. revert x. prove_dh_at_most. Qed.
Lemma secant_12_bound x : Rabs (h 12 x) <= Q2R (6533 # 5000)%Q * Rabs x. Proof. open_Q. revert x. prove_secant_at_most 12%nat (6533 * / 5000) ((37 / 32)). Qed.
Definition member_12 : Loop.member := member_of 12 ltac:(lia) (12867 # 10000)%Q (115423 # 10000)%Q (6533 # 5000)%Q h_12_bound dh_12_bound secant_12_bound.
Theorem gamma_12 : (2573 / 2000) <= gamma 12 <= Q2R (12867 # 10000)%Q.
Proof. split; [reached (h_le_gamma 12 ltac:(lia) (4215813 / 4194304))|apply gamma_le; exact h_12_bound]. Qed.
Theorem rho_12 : (57711 / 5000) <= rho 12 <= Q2R (115423 # 10000)%Q.
Proof. split; [reached (dh_le_rho 12 ltac:(lia) (460255 / 524288))|apply rho_le; exact dh_12_bound]. Qed.
Theorem L_12 : (2613 / 2000) <= L 12 <= Q2R (6533 # 5000)%Q.
Proof. split; [reached (secant_le_L 12 ltac:(lia) (1987 / 2048) ltac:(lra))|apply L_le; exact secant_12_bound]. Qed.
