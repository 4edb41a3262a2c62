"""How fast V falls, how long an arm takes to come near its goal, and what disturbances can do: certified.

dV/dt along (11) is affine in B and in K_p,

    −dV/dt = ε hᵀK_p h + yᵀ(B + K_v D + ε S) w,     y = w − εh,

so a proof of dV/dt < 0 for the smaller friction (1 − η)B and the smaller stiffness (1 − κ)K_p, with the same
ε₀, leaves for the arm itself, at every state,

    −dV/dt ≥ κ ε hᵀK_p h + η yᵀB w = Σ [κ k_pi ε h_i² + η b_i (y_i² + ε h_i y_i)].

That is a sum over joints. Where B is anywhere from b to b + Δ the proof is for (1 − η)b and
(1 − κ)K_p − ¼ ε₀ Δ, as δ_i y_i w_i ≥ −¼ ε² δ_i h_i² for 0 ≤ δ_i ≤ Δ_i, and b_i is the lower end throughout;
ranges of parameters in M are those of the proof.

A torque d = d' − φ, |d'_i| ≤ d̄_i, |φ_i| ≤ f_i and φ_i w_i ≥ 0 (dry friction), adds yᵀd to dV/dt, and
yᵀd ≤ Σ |y_i| d̄_i + ε Σ f_i |h_i| because −wᵀφ ≤ 0. With shares t, s > 0 of the damping,

    −dV/dt ≥ (1 − t − s) η Σ b_i y_i² + ε Σ (c_i h_i² − f_i |h_i|) − K,
    c_i = κ k_pi − η b_i ε₀/(4t),     K = Σ d̄_i²/(4 s η b_i).

For certified u_i with M(q) ≼ diag(u) the kinetic part T = ½ yᵀMy of V has (1 − t − s) η Σ b_i y_i² ≥ a T,
a = 2 (1 − t − s) η min b_i/u_i. For every 0 ≤ λ ≤ a/ε₀ and wherever v ≤ V ≤ v',

    −dV/dt ≥ ε [λ v + Σ min (c_i h² − f_i |h| − λ k_pi U)] − K,     |e_i| ≤ U⁻¹(v'/k_pi),

minima of one variable each, and ε ≥ ε₀/(1 + r') with r' = ‖(U⁻¹(v'/k_pi))‖. Where this is positive at all
levels between v and v', the set {V ≤ v} is reached from {V ≤ v'} in the time that the sum over levels gives,
and it is kept.

For m ≥ 2, h ~ x^(2m−1) at 0 and h²/U → 0: V does not fall exponentially there, but every level above 0 is
still reached in finite time.

References: ``reyes2019family`` (11), (12), (15).
"""
