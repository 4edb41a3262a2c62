"""PD control with gravity compensation, τ = K_p q̃ − K_v q̇ + g(q), for every arm and all positive gains.

The energy V = ½q̇ᵀMq̇ + ½q̃ᵀK_p q̃ falls where the arm moves, and LaSalle's theorem does the rest. This is where
shaping of energy begins; the paper of the hyperbolic family builds on it.
"""

from lyapcheck.claims import (
    Proof,
    along,
    at_arm,
    constant_goal,
    lasalle,
    norm,
    rate_at_most,
    strict,
)
from lyapcheck.robots import load

proof = Proof("takegaki_arimoto", "PD control with gravity compensation", reference="takegaki1981feedback")

goal = constant_goal()
e, w, M, B = goal.e, goal.w, goal.M, goal.B
K_p, K_v = goal.gains("Kp Kv")
r, b = norm(e), norm(w)

loop = goal.under(K_p @ e - K_v @ w + goal.gravity)
V = w @ M @ w / 2 + e @ K_p @ e / 2
above = goal.mu / 2 * b**2 + K_p.min / 2 * r**2
theorem = lasalle(loop, V, above=above, rate=K_v.min * b**2, rest=(e, K_p.min * r**2))

proof.add("rate", "dV/dt = −q̇ᵀ(K_v + B)q̇: friction only helps", along(loop, V, -w @ K_v @ w - w @ B @ w))
proof.add_theorem("P", "q̃ = 0, q̇ = 0 is globally asymptotically stable for all positive gains", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", Kv="7 3"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add(
    "strict",
    "dV/dt ≤ −λmin(K_v)‖q̇‖² − λmin(K_p)‖q̃‖²: it is 0 wherever the arm rests",
    rate_at_most(strict(loop, V, above=above, rate=K_v.min * b**2 + K_p.min * r**2)),
)
proof.add(
    "weightless",
    "the same without g(q) in the torque: then the goal is no equilibrium",
    lasalle(goal.under(K_p @ e - K_v @ w), V, above=above, rate=K_v.min * b**2, rest=(e, K_p.min * r**2)),
)
