"""PID control, τ = K_p q̃ − K_v q̇ + K_i ∫ α q̃ dt: the goal is asymptotically stable, with a region.

Let z be the integral less K_i⁻¹ g(q_d), so that τ = K_p q̃ − K_v q̇ + K_i z + g(q_d) and z = 0 at rest: three
vectors, q̃, q̇ and z. As α q̃ᵀCᵀq̇ is cubic, dV/dt is bounded only where ‖q̃‖ ≤ R, and the K_v that is needed
grows with R. No proof for all motions and fixed gains is known here.
"""

from lyapcheck.claims import Proof, along, any_vector, at_arm, constant_goal, lasalle, norm, transpose
from lyapcheck.robots import load

proof = Proof("pid", "PID control, locally", reference="arimoto1984stability")

goal = constant_goal()
e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
K_p, K_v, K_i = goal.gains("Kp Kv Ki")
(α,) = goal.constants("alpha")
z, y = goal.state("z", α * e), any_vector("y_z")
r, b, β, k_c, k_g, R = norm(e), norm(w), goal.beta, goal.kc, goal.kg, goal.R

loop = goal.under(K_p @ e - K_v @ w + K_i @ z + goal.gravity_at_goal)
V = w @ M @ w / 2 + e @ K_p @ e / 2 - e @ K_i @ e / 2 + (z + e) @ K_i @ (z + e) / 2 - α * e @ M @ w
k, d = K_p.min - K_i.max - k_g, K_v.min - α * (β + k_c * R)
WHERE = (
    α**2 * β**2 < goal.mu * k,
    α * (β + k_c * R) < K_v.min,
    α * (K_v.max + B.max) ** 2 / 4 < k * d,
)
"""φ is positive definite by the first, and so k > 0; ψ by the other two."""


def theorem(where=WHERE, local=True):
    """By LaSalle's theorem: dV/dt sees q̃ and q̇, and z where they stay 0; z = y − q̃ in φ."""
    return lasalle(
        loop,
        V,
        gravity=True,
        local=local,
        changes={"z": y - e},
        where=where,
        above=goal.mu / 2 * b**2 + k / 2 * r**2 - α * β * r * b + K_i.min / 2 * norm(y) ** 2,
        rate=α * k * r**2 - α * (K_v.max + B.max) * r * b + d * b**2,
        rest=(z, K_i.min * norm(z) ** 2),
    )


proof.add(
    "rate",
    "dV/dt = −q̇ᵀ(K_v + B)q̇ + α [q̇ᵀMq̇ − q̃ᵀ(K_p − K_i)q̃ + q̃ᵀ(K_v + B)q̇ + q̃ᵀ(g − g_d) − q̃ᵀCᵀq̇]: z is gone",
    along(
        loop,
        V,
        -w @ K_v @ w
        - w @ B @ w
        + α * w @ M @ w
        - α * e @ K_p @ e
        + α * e @ K_i @ e
        + α * e @ K_v @ w
        + α * e @ B @ w
        + α * e @ (goal.gravity - goal.gravity_at_goal)
        - α * e @ transpose(C) @ w,
        gravity=True,
    ),
)
proof.add_theorem("P", "q̃ = 0, q̇ = 0, z = 0 is asymptotically stable, with a region", theorem())
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains and R = 1/2",
    at_arm(theorem(), load("pelican2"), Kp="30 30", Kv="7 7", Ki="5 5", alpha="0.1", R="1/2"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add("global", "the same argument without R: ‖q̃‖ has no bound", theorem(local=False))
proof.add("damping", "the same argument for any K_v and α", theorem(WHERE[:1]))
