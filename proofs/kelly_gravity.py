"""A strict Lyapunov function for PD control with gravity compensated at the goal, τ = K_p q̃ − K_v q̇ + g(q_d).

The energy of ``tomei.py`` less a cross term ε q̃ᵀMq̇ with ε = ε₀/(1 + ‖q̃‖), the multiplier of (12) in the paper
of the hyperbolic family: dV/dt < 0 at every state but the goal, and no invariance is needed.
"""

from lyapcheck.claims import Proof, along, at_arm, constant_goal, norm, strict, transpose
from lyapcheck.robots import load

proof = Proof(
    "kelly_gravity",
    "PD control with gravity compensated at the goal, by a strict V",
    reference="santibanez1997strict",
)

goal = constant_goal()
e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
K_p, K_v = goal.gains("Kp Kv")
r, b, k_g, ε0, s = norm(e), norm(w), goal.kg, goal.eps0, goal.s
ε = ε0 * s

loop = goal.under(K_p @ e - K_v @ w + goal.gravity_at_goal)
energy = w @ M @ w / 2 + e @ K_p @ e / 2
V = energy - ε * e @ M @ w
form = {
    "above": goal.mu / 2 * b**2 + (K_p.min - k_g) / 2 * r**2 - ε0 * goal.beta * r * b,
    "rate": ε * (K_p.min - k_g) * r**2
    - ε * (K_v.max + B.max) * r * b
    + (K_v.min - ε0 * (2 * goal.beta + goal.kc)) * b**2,
}
theorem = strict(loop, V, gravity=True, where=[k_g < K_p.min], small=True, **form)

proof.add(
    "energy",
    "without the cross term, dV/dt = −q̇ᵀ(K_v + B)q̇",
    along(loop, energy, -w @ K_v @ w - w @ B @ w, gravity=True),
)
proof.add(
    "constant",
    "for a constant multiplier, the cross term adds ε₀ [q̇ᵀMq̇ − q̃ᵀK_p q̃ + q̃ᵀ(K_v + B)q̇ + q̃ᵀ(g − g_d) − q̃ᵀCᵀq̇]",
    along(
        loop,
        energy - ε0 * e @ M @ w,
        -w @ K_v @ w
        - w @ B @ w
        + ε0 * w @ M @ w
        - ε0 * e @ K_p @ e
        + ε0 * e @ K_v @ w
        + ε0 * e @ B @ w
        + ε0 * e @ (goal.gravity - goal.gravity_at_goal)
        - ε0 * e @ transpose(C) @ w,
        gravity=True,
    ),
)
proof.add_theorem("P", "λmin(K_p) > k_g makes the goal globally asymptotically stable", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", Kv="7 3"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add(
    "corner",
    "the multiplier before the kinetic energy as well: V has a corner at q̃ = 0",
    strict(loop, V + ε * w @ M @ w, gravity=True, where=[k_g < K_p.min], small=True, **form),
)
proof.add(
    "soft",
    "the same argument for all positive gains: a soft arm falls",
    strict(loop, V, gravity=True, small=True, **form),
)
