(** dV/dt against a quadratic form in w alone, for every n: the squares in h(e) are completed. *)
From Coq Require Import Reals Lra Lia Psatz.
From Coquelicot Require Import Coquelicot.
Require Import Definitions.
Require Import Loop.
Require Converge.
Open Scope R_scope.

Section Rate.
Variable n : nat.

(** p = e / (|e| (1 + |e|)), and 0 at e = 0, where Coq's 0 / 0 is 0 *)
Definition pull (e : vec) : vec := fun j => e j / norm n e * (1 / (1 + norm n e)).
(** S = C(q, h) + (M h) p' - M H' *)
Definition S_of (Mq : mat) (Ch : mat) (h dh p : vec) (i j : nat) : R := Ch i j + apply_ n Mq h i * p j - Mq i j * dh j.
(** X w = B w + eps S w, and the form w'(X w) - eps sum of c_i (X w)_i^2 *)
Definition X_of (b : vec) (ep : R) (S : mat) (w : vec) (i : nat) : R := b i * w i + ep * dot n (S i) w.
Definition F_of (b c : vec) (ep : R) (S : mat) (w : vec) : R := sum n (fun i => w i * X_of b ep S w i - ep * c i * (X_of b ep S w i * X_of b ep S w i)).

Variable rb : robot n.
Variable f : member.
Variable g : gains n.
Variable qd : vec.
Hypothesis C_swap : forall q x y i, (i < n)%nat -> apply_ n (C rb q x) y i = apply_ n (C rb q y) x i.
Variables eps0 c1 : R.
Hypothesis eps0_pos : 0 < eps0.
Variable k : vec.
Hypothesis k_pos : forall i, (i < n)%nat -> 0 < k i.
Hypothesis k_le : forall i, (i < n)%nat -> k i + c1 <= kp n g i - eps0 * Lf f * kv n g i / 4.

Definition S_at (q e : vec) : mat := S_of (M rb q) (C rb q (hv f e)) (hv f e) (fun j => dhf f (e j)) (pull e).
Lemma term ep hi wi hw v kpi ki X : 0 < ep <= eps0 -> 0 <= wi * hw -> Rabs hw <= Lf f * Rabs wi -> 0 <= v -> 0 < ki ->
  ki + c1 <= kpi - eps0 * Lf f * v / 4 ->
  - (ep * kpi * (hi * hi)) - (wi - ep * hi) * (v * hw) - (wi - ep * hi) * X
  <= - (c1 * ep * (hi * hi)) - (wi * X - ep * (/ (4 * ki)) * (X * X)).
Proof.
  intros [E0 E1] Hs Hl Hv Hk Hle. pose proof (L_pos f) as HL.
  assert (T1 : - (wi - ep * hi) * hw <= ep * (eps0 * Lf f / 4) * (hi * hi)).
  { assert (T0 : - (wi - ep * hi) * hw <= Lf f * (ep * hi) * (ep * hi) / 4).
    { destruct (Req_dec wi 0) as [->|N].
      - rewrite Rabs_R0, Rmult_0_r in Hl. assert (hw = 0) by (pose proof (Rabs_pos hw); apply Rabs_eq_0; lra). subst.
        assert (0 <= Lf f * (ep * hi * (ep * hi))) by (apply Rmult_le_pos; [lra|apply (Rle_0_sqr (ep * hi))]). lra.
      - set (D := hw / wi). assert (E : hw = D * wi) by (unfold D; field; auto). clearbody D.
        assert (W2 : 0 < wi * wi) by nra.
        assert (D0 : 0 <= D). { apply Rmult_le_reg_r with (wi * wi); auto. rewrite Rmult_0_l. replace (D * (wi * wi)) with (wi * hw) by (rewrite E; ring). exact Hs. }
        assert (D1 : D <= Lf f).
        { rewrite E, Rabs_mult, (Rabs_pos_eq D) in Hl by auto. pose proof (Rabs_pos_lt wi N). apply Rmult_le_reg_r with (Rabs wi); auto. }
        rewrite E. assert (0 <= D * ((wi - ep * hi / 2) * (wi - ep * hi / 2))) by (apply Rmult_le_pos; [auto|apply (Rle_0_sqr (wi - ep * hi / 2))]).
        assert (0 <= (Lf f - D) * (ep * hi * (ep * hi))) by (apply Rmult_le_pos; [lra|apply (Rle_0_sqr (ep * hi))]). lra. }
    eapply Rle_trans; [exact T0|].
    replace (Lf f * (ep * hi) * (ep * hi) / 4) with (Lf f / 4 * ep * (hi * hi) * ep) by field.
    replace (ep * (eps0 * Lf f / 4) * (hi * hi)) with (Lf f / 4 * ep * (hi * hi) * eps0) by field.
    apply Rmult_le_compat_l; [|exact E1]. apply Rmult_le_pos; [apply Rmult_le_pos; lra|nra]. }
  apply Rmult_le_compat_l with (r := v) in T1; auto.
  assert (T2 : ep * (ki + c1) * (hi * hi) <= ep * (kpi - eps0 * Lf f * v / 4) * (hi * hi)).
  { apply Rmult_le_compat_r; [nra|]. apply Rmult_le_compat_l; lra. }
  assert (T3 : ep * hi * X <= ep * ki * (hi * hi) + ep * (/ (4 * ki)) * (X * X)).
  { assert (0 <= ep * (/ (4 * ki)) * ((2 * ki * hi - X) * (2 * ki * hi - X))).
    { apply Rmult_le_pos; [apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]|apply (Rle_0_sqr (2 * ki * hi - X))]. }
    replace (ep * / (4 * ki) * ((2 * ki * hi - X) * (2 * ki * hi - X))) with
      (ep * ki * (hi * hi) - ep * hi * X + ep * / (4 * ki) * (X * X)) in H by (field; lra). lra. }
  lra.
Qed.
Theorem rate_by_form e w t : let ep := eps n eps0 (e t) in let q := fun j => qd j - e t j in
  rate n rb f g qd e w eps0 t <= - (c1 * ep * norm n (hv f (e t)) ^ 2) - F_of (b rb) (fun i => / (4 * k i)) ep (S_at q (e t)) (w t).
Proof.
  intros ep q. pose proof (eps_range n e eps0 eps0_pos t) as [E0 E1]. fold ep in E0, E1.
  set (x := w t). set (h := hv f (e t)). set (S := S_at q (e t)).
  assert (G1 : forall i, (i < n)%nat ->
    ep * apply_ n (C rb q x) h i + apply_ n (M rb q) (gr n f e w eps0 t) i = ep * dot n (S i) x).
  { intros i Hi. rewrite (C_swap q x h i Hi).
    assert (Er : eps_rate n e w eps0 t = ep * dot n (pull (e t)) x).
    { unfold eps_rate, ep, eps, pull. fold x. pose proof (norm_pos n (e t)) as N.
      destruct (Req_EM_T (norm n (e t)) 0) as [Z|Z].
      - assert (Z2 : dot n (fun j => e t j / norm n (e t) * (1 / (1 + norm n (e t)))) x = 0).
        { unfold dot. rewrite (sum_ext n _ (fun _ => 0)); [rewrite sum_const; ring|]. intros j Hj. rewrite (norm_zero n (e t) Z j Hj). unfold Rdiv. ring. }
        unfold dot in *. rewrite Z2. ring.
      - assert (Z2 : dot n (fun j => e t j / norm n (e t) * (1 / (1 + norm n (e t)))) x = dot n (e t) x / norm n (e t) / (1 + norm n (e t))).
        { unfold dot. rewrite (sum_ext n _ (fun j => (/ norm n (e t) * / (1 + norm n (e t))) * (e t j * x j))).
          - rewrite sum_scal. field. split; lra.
          - intros j Hj. field. split; lra. }
        unfold dot in *. rewrite Z2. field. split; lra. }
    assert (A1 : apply_ n (M rb q) (gr n f e w eps0 t) i
      = ep * dot n (pull (e t)) x * dot n (M rb q i) h - ep * sum n (fun j => M rb q i j * dhf f (e t j) * x j)).
    { unfold apply_, gr. fold ep. rewrite Er. unfold dot at 1 4. rewrite <- !sum_scal, <- sum_minus. apply sum_ext; intros j Hj. unfold h, hv, x. ring. }
    assert (A2 : dot n (S i) x = dot n (C rb q h i) x + dot n (M rb q i) h * dot n (pull (e t)) x - sum n (fun j => M rb q i j * dhf f (e t j) * x j)).
    { unfold dot at 1 2 4. rewrite <- sum_scal, <- sum_plus, <- sum_minus. apply sum_ext; intros j Hj. unfold S, S_at, S_of. fold h. unfold apply_. ring. }
    rewrite A1, A2. unfold apply_. ring. }
  assert (G2 : ep * dot n (yt n f e w eps0 t) (apply_ n (C rb q x) h) + dot n (yt n f e w eps0 t) (apply_ n (M rb q) (gr n f e w eps0 t))
     = sum n (fun i => yt n f e w eps0 t i * (ep * dot n (S i) x))).
  { unfold dot at 1 2. rewrite <- sum_scal, <- sum_plus. apply sum_ext; intros i Hi. rewrite <- G1 by auto. ring. }
  replace (norm n h ^ 2) with (dot n h h) by (rewrite <- norm2; ring).
  unfold rate, rate_along. change (q_along (fun _ => qd) e t) with q. fold ep x h.
  assert (G3 : forall a b c d, b + c = d -> a - b - c = a - d) by (intros; lra).
  rewrite (G3 _ _ _ _ G2), <- sum_minus.
  assert (G4 : - (c1 * ep * dot n h h) - F_of (b rb) (fun i => / (4 * k i)) ep S x
    = sum n (fun i => - (c1 * ep * (h i * h i)) - (x i * X_of (b rb) ep S x i - ep * (/ (4 * k i)) * (X_of (b rb) ep S x i * X_of (b rb) ep S x i)))).
  { rewrite sum_minus. unfold F_of. f_equal. unfold dot. rewrite (sum_ext n (fun i => - (c1 * ep * (h i * h i))) (fun i => - (c1 * ep) * (h i * h i))) by (intros; ring).
    rewrite sum_scal. ring. }
  rewrite G4. apply Converge.sum_le_in. intros i Hi. pose proof (kv_range n g i Hi) as Kv.
  assert (Hw : 0 <= x i * hf f (x i)) by (destruct (Req_dec (x i) 0) as [->|Z]; [rewrite h_zero; lra|left; now apply h_sign]).
  pose proof (term ep (h i) (x i) (hf f (x i)) (kv n g i) (kp n g i) (k i) (X_of (b rb) ep S x i) (conj E0 E1) Hw (h_lip f (x i)) ltac:(lra) (k_pos i Hi) (k_le i Hi)) as T.
  eapply Rle_trans; [|exact T]. right. unfold yt, y_of, X_of. fold ep x. change (hf f (e t i)) with (h i). ring.
Qed.

(** So dV/dt is as negative as [Converge] asks, where the form is. *)
Theorem decreases_by_form c2 e w t : (forall x, c2 * dot n x x <= F_of (b rb) (fun i => / (4 * k i)) (eps n eps0 (e t)) (S_at (fun j => qd j - e t j) (e t)) x) ->
  rate n rb f g qd e w eps0 t <= - (c1 * eps n eps0 (e t) * norm n (hv f (e t)) ^ 2) - c2 * norm n (w t) ^ 2.
Proof.
  intros K. eapply Rle_trans; [apply rate_by_form|]. specialize (K (w t)). rewrite <- norm2 in K. simpl in *. lra.
Qed.
End Rate.
