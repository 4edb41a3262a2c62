"""Computed torque, τ = M(q)(q̈_d + K_v dq̃/dt + K_p q̃) + C(q, q̇)q̇ + g(q) + Bq̇: the errors are linear.

The loop is M ẇ = M(K_p q̃ − K_v w) with w = −dq̃/dt. M is invertible, so ẇ = K_p q̃ − K_v w, and for a <
λmin(K_v) V = ½wᵀw + ½q̃ᵀ(K_p + aK_v)q̃ − a q̃ᵀw has dV/dt = −wᵀ(K_v − a)w − a q̃ᵀK_p q̃: exponential
stability. V and its rate are those of the book of Kelly, Santibáñez and Loría, as far as they are
remembered here.
"""

from lyapcheck.claims import Proof, along, at_arm, exponential, moving_goal, norm, rate_at_most
from lyapcheck.robots import load

proof = Proof("computed_torque", "Computed torque", reference="kelly2005control")


def tracker(share=1, sign=1, where=True):
    """The loop, V and the theorem; ``share`` of M(q) is in the torque."""
    goal = moving_goal()
    e, w = goal.e, goal.w
    K_p, K_v = goal.gains("Kp Kv")
    (a,) = goal.constants("a")
    r, b, velocity = norm(e), norm(w), goal.velocity + w
    wanted = goal.acceleration + sign * K_p @ e - K_v @ w
    loop = goal.under(share * goal.M @ wanted + goal.C @ velocity + goal.gravity + goal.B @ velocity)
    V = w @ w / 2 + e @ K_p @ e / 2 + a * e @ K_v @ e / 2 - a * e @ w
    theorem = exponential(
        loop,
        V,
        where=[a < K_v.min] if where else [],
        above=b**2 / 2 + (K_p.min + a * K_v.min) / 2 * r**2 - a * r * b,
        below=b**2 / 2 + (K_p.max + a * K_v.max) / 2 * r**2 + a * r * b,
        rate=(K_v.min - a) * b**2 + a * K_p.min * r**2,
    )
    return loop, V, theorem, a * w @ w - w @ K_v @ w - a * e @ K_p @ e


loop, V, theorem, power = tracker()
proof.add("rate", "dV/dt = −wᵀ(K_v − a)w − a q̃ᵀK_p q̃: M is gone", along(loop, V, power))
proof.add_theorem("P", "q̃ = 0, dq̃/dt = 0 is globally exponentially stable for all positive gains", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", Kv="7 3", a="1"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add("any a", "the same V for every a", tracker(where=False)[2])
proof.add("turned", "the same with −K_p", rate_at_most(tracker(sign=-1)[2]))
proof.add("twice", "the same with 2M in the torque: q̈_d is then asked for twice", tracker(share=2)[2])
