"""PD control with gravity compensated at the goal alone, τ = K_p q̃ − K_v q̇ + g(q_d).

With stiffness above that of gravity, λmin(K_p) > k_g ≥ ‖∂g/∂q‖, the arm rests at the goal alone.
V = ½q̇ᵀMq̇ + ½q̃ᵀK_p q̃ + U_g(q) − U_g(q_d) + g(q_d)ᵀq̃, by LaSalle's theorem.
"""

from lyapcheck.claims import Proof, along, at_arm, constant_goal, lasalle, norm
from lyapcheck.robots import load

proof = Proof("tomei", "PD control with gravity compensated at the goal", reference="tomei1991adaptive")

goal = constant_goal()
e, w, M, B = goal.e, goal.w, goal.M, goal.B
K_p, K_v = goal.gains("Kp Kv")
r, b, k_g = norm(e), norm(w), goal.kg

loop = goal.under(K_p @ e - K_v @ w + goal.gravity_at_goal)
V = w @ M @ w / 2 + e @ K_p @ e / 2


def theorem(*where):
    """By LaSalle's theorem, under conditions on the constants."""
    return lasalle(
        loop,
        V,
        gravity=True,
        where=where,
        above=goal.mu / 2 * b**2 + (K_p.min - k_g) / 2 * r**2,
        rate=K_v.min * b**2,
        rest=(e, (K_p.min - k_g) * r**2),
    )


proof.add(
    "rate",
    "dV/dt = −q̇ᵀ(K_v + B)q̇: the energy of gravity leaves no trace",
    along(loop, V, -w @ K_v @ w - w @ B @ w, gravity=True),
)
proof.add_theorem(
    "P", "λmin(K_p) > k_g makes the goal globally asymptotically stable", theorem(k_g < K_p.min)
)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem(k_g < K_p.min), load("pelican2"), Kp="30 30", Kv="7 3"),
    uses=["P"],
)

proof.section("What the condition is for")
proof.add("soft", "the same argument for all positive gains: a soft arm falls", theorem())
proof.add(
    "soft.pelican",
    "the Pelican arm with K_p below its k_g: the condition fails",
    at_arm(theorem(k_g < K_p.min), load("pelican2"), Kp="10 10", Kv="7 3"),
)
