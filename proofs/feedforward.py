"""PD control with feedforward, τ = K_p q̃ + K_v dq̃/dt + M(q_d)q̈_d + C(q_d, q̇_d)q̇_d + g(q_d) + B q̇_d.

Nothing of the model is evaluated at q, so M(q) − M(q_d) and its like stay in the loop, at most in proportion
to ‖q̃‖, with k_h = k_m ‖q̈_d‖ + k_c2 ‖q̇_d‖² + k_g. Gains above it make the origin exponentially stable, with a
region: as α q̃ᵀCᵀw is cubic, dV/dt is bounded only where ‖q̃‖ ≤ R.
"""

from lyapcheck.claims import Proof, along, at_arm, exponential, moving_goal, norm
from lyapcheck.robots import load

proof = Proof("feedforward", "PD control with feedforward", reference="kelly2005control")

goal = moving_goal()
e, w, M, B = goal.e, goal.w, goal.M, goal.B
K_p, K_v = goal.gains("Kp Kv")
(α,) = goal.constants("alpha")
r, b, β, k_c, v_d, R = norm(e), norm(w), goal.beta, goal.kc, goal.vd, goal.R

feedforward = goal.M_at_goal @ goal.acceleration + goal.C_at_goal @ goal.velocity + goal.gravity_at_goal
loop = goal.under(K_p @ e - K_v @ w + feedforward + B @ goal.velocity)
energy = w @ M @ w / 2 + e @ K_p @ e / 2
V = energy - α * e @ M @ w

k_h = goal.km * goal.ad + goal.kc2 * v_d**2 + goal.kg
k, d = K_p.min - k_h, K_v.min - k_c * v_d - α * (β + k_c * R)
cross = k_h + α * (K_v.max + B.max + 2 * k_c * v_d)
WHERE = (
    α**2 * β**2 < goal.mu * K_p.min,
    k_h < K_p.min,
    k_c * v_d + α * (β + k_c * R) < K_v.min,
    cross**2 / 4 < α * k * d,
)
"""φ is positive definite by the first, ψ by the others."""


def theorem(where=WHERE, local=True):
    """By quadratic bounds of V and its rate in ‖q̃‖ and ‖w‖."""
    return exponential(
        loop,
        V,
        where=where,
        local=local,
        above=goal.mu / 2 * b**2 + K_p.min / 2 * r**2 - α * β * r * b,
        below=β / 2 * b**2 + K_p.max / 2 * r**2 + α * β * r * b,
        rate=α * k * r**2 - cross * r * b + d * b**2,
    )


difference = M @ goal.acceleration - goal.M_at_goal @ goal.acceleration
difference = difference + goal.C @ goal.velocity - goal.C_at_goal @ goal.velocity
difference = difference + goal.gravity - goal.gravity_at_goal
proof.add(
    "rate",
    "the energy has dV/dt = −wᵀ(K_v + B)w less wᵀ of what the model differs by between q and q_d",
    along(loop, energy, -w @ K_v @ w - w @ B @ w - w @ difference),
)
proof.add_theorem("P", "q̃ = 0, dq̃/dt = 0 is exponentially stable, with a region", theorem())
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains, ‖q̇_d‖ ≤ 1/10, ‖q̈_d‖ ≤ 1/10 and R = 1/4",
    at_arm(theorem(), load("pelican2"), Kp="90 90", Kv="30 30", alpha="1", R="1/4", vd="0.1", ad="0.1"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add("global", "the same argument without R: ‖q̃‖ has no bound", theorem(local=False))
proof.add(
    "soft.pelican",
    "the Pelican arm with K_p below its k_h: a condition fails",
    at_arm(theorem(), load("pelican2"), Kp="10 10", Kv="30 30", alpha="0.1", R="1/4", vd="0.1", ad="0.1"),
)
