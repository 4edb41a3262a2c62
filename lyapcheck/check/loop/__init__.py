"""dV/dt < 0 at every state of an arm but the origin, for one ε₀: checked over a tree of boxes.

For fixed q, e and D = diag(h(w_i)/w_i), 0 ≤ D ⪯ L, dV/dt is minus a quadratic form in (√ε h, w). Its damping
terms are eliminated by Σ k_vi d_i (w_i² − ε h_i w_i) ≥ −¼ ε² L Σ k_vi h_i², and the block of h by its Schur
complement. What remains is

    P = B + ½ ε (S + Sᵀ) − ¼ ε (B + ε S)ᵀ K̃⁻¹ (B + ε S),   K̃ = K_p − ¼ ε₀ L K_v ≻ 0,
    S = C(q,h) + (M h) êᵀ/(1+r) − M H',   ε = ε₀/(1 + r),   r = ‖e‖,   ê = e/r,

and P ≻ 0 for all q and e is enough, whatever w is. Where r ≥ R the scalar form at ε₀/(1+R) is enough as well.

With weights, y = w − εΛh, each h and h' becomes Λh and Λh', and K_p becomes K_p Λ⁻¹; the damping ratios stay
those of h.

References: ``reyes2019family`` (11), (12), (15).
"""
