"""PD+ control for every bounded q̇_d, τ = K_p q̃ + K_v dq̃/dt + M q̈_d + C q̇_d + g(q) + B q̇_d.

The energy ½wᵀMw + ½q̃ᵀK_p q̃, w = −dq̃/dt, falls as for regulation, and one is tempted to conclude by LaSalle's
theorem. But the error system depends on time through q_d(t), and the theorem is for systems that do not. With
a cross term ε q̃ᵀMw, ε = ε₀/(1 + ‖q̃‖), the rate is strict, and stability uniform, for all positive gains.
"""

from lyapcheck.claims import Proof, along, at_arm, lasalle, moving_goal, norm, rate_at_most, uniform
from lyapcheck.robots import load

proof = Proof("pd_plus", "PD+ control along a trajectory", reference="paden1988globally")

goal = moving_goal()
e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
K_p, K_v = goal.gains("Kp Kv")
r, b, ε0, β, k_c, v_d = norm(e), norm(w), goal.eps0, goal.beta, goal.kc, goal.vd
ε = ε0 * goal.s

feedforward = M @ goal.acceleration + C @ goal.velocity + goal.gravity + B @ goal.velocity
loop = goal.under(K_p @ e - K_v @ w + feedforward)
energy = w @ M @ w / 2 + e @ K_p @ e / 2
V = energy - ε * e @ M @ w
above = goal.mu / 2 * b**2 + K_p.min / 2 * r**2
form = {
    "above": above - ε0 * β * r * b,
    "below": β / 2 * b**2 + K_p.max / 2 * r**2 + ε0 * β * r * b,
    "rate": ε * K_p.min * r**2
    - ε * (K_v.max + B.max + k_c * v_d) * r * b
    + (K_v.min - ε0 * (2 * β + k_c)) * b**2,
}
theorem = uniform(loop, V, small=True, **form)

proof.add("rate", "the energy has dV/dt = −wᵀ(K_v + B)w", along(loop, energy, -w @ K_v @ w - w @ B @ w))
proof.add(
    "LaSalle",
    "so q̃ = 0, dq̃/dt = 0 is globally asymptotically stable by LaSalle's theorem",
    lasalle(loop, energy, above=above, rate=K_v.min * b**2, rest=(e, K_p.min * r**2)),
    "the argument that is often printed",
)
proof.add_theorem("P", "it is globally uniformly asymptotically stable, by a strict V", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", Kv="7 3"),
    uses=["P"],
)

proof.section("What would be too much")
still = K_p @ e - K_v @ w + M @ goal.acceleration + goal.gravity + B @ goal.velocity
proof.add(
    "feedforward",
    "the same without C q̇_d in the torque: then the error system has no equilibrium at 0",
    uniform(goal.under(still), V, small=True, **form),
)
proof.add(
    "rest",
    "the energy alone has a strict rate: it is 0 wherever w = 0",
    rate_at_most(
        uniform(loop, energy, above=above, below=form["below"], rate=K_v.min * b**2 + K_p.min * r**2)
    ),
)
