"""Slotine and Li's passivity-based tracking, with s = dq̃/dt + Λq̃ (the model known).

τ = M(q̈_d + Λ dq̃/dt) + C(q, q̇)(q̇_d + Λq̃) + g(q) + B(q̇_d + Λq̃) + K s makes M ds/dt + C s + (K + B)s = 0.
V = ½sᵀMs falls, but it is no Lyapunov function of (q̃, dq̃/dt): it is 0 on the whole line s = 0. What it shows
is that s → 0, by Barbalat's lemma, and then q̃ → 0, as dq̃/dt = −Λq̃ + s: convergence, not stability. With
q̃ᵀΛ(K + B)q̃ added it is a Lyapunov function, and as all is quadratic, the origin is exponentially stable.
"""

from lyapcheck.claims import (
    Proof,
    along,
    any_vector,
    at_arm,
    cascade,
    every_n,
    exponential,
    input_to_state,
    moving_goal,
    norm,
    uniform,
)
from lyapcheck.robots import load

proof = Proof("slotine_li", "Passivity-based tracking", reference="slotine1987adaptive")

goal, shaken = moving_goal(), moving_goal(disturbed=True)
e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
K, Λ = [goal.gains("K Lambda") for goal in (shaken, goal)][-1]
r, b, β = norm(e), norm(w), goal.beta
s, y = Λ @ e - w, any_vector("y_w")
"""w = −dq̃/dt; y is s as a letter of its own, so that w = Λq̃ − y."""

reference = goal.velocity + Λ @ e
torque = M @ (goal.acceleration - Λ @ w) + C @ reference + B @ reference + goal.gravity + K @ s
loop = goal.under(torque)
kinetic = s @ M @ s / 2
V = kinetic + e @ Λ @ K @ e + e @ Λ @ B @ e
below = β / 2 * (Λ.max * r + b) ** 2
bounds = {
    "changes": {"w": Λ @ e - y},
    "above": goal.mu / 2 * norm(y) ** 2 + Λ.min * K.min * r**2,
    "below": below + Λ.max * (K.max + B.max) * r**2,
    "rate": K.min * b**2 + Λ.min**2 * K.min * r**2,
}
theorem = exponential(loop, V, **bounds)
convergence = cascade(
    loop,
    kinetic,
    changes={"w": Λ @ e - y},
    above=goal.mu / 2 * norm(y) ** 2,
    rate=K.min * norm(y) ** 2,
    motion=(goal.kc * (goal.vd + b) + K.max + B.max) * norm(y),
    contraction=Λ.min * r**2 - r * norm(y),
)

proof.add("s", "½sᵀMs has the rate −sᵀ(K + B)s", along(loop, kinetic, -s @ K @ s - s @ B @ s))
proof.add(
    "square",
    "sᵀKs + 2q̃ᵀΛKw = wᵀKw + q̃ᵀΛKΛq̃: what the second term of V is for",
    every_n(s @ K @ s + 2 * e @ Λ @ K @ w, w @ K @ w + e @ Λ @ K @ Λ @ e),
)
proof.add(
    "printed",
    "so the origin is stable by V = ½sᵀMs",
    uniform(
        loop,
        kinetic,
        changes={"w": Λ @ e - y},
        above=goal.mu / 2 * norm(y) ** 2,
        below=below,
        rate=K.min * b**2 + Λ.min**2 * K.min * r**2,
    ),
    "the argument that is often printed",
)
proof.add_theorem(
    "convergence",
    "what ½sᵀMs shows: s → 0, and then q̃ → 0 and dq̃/dt → 0, whatever they are at first",
    convergence,
    "what the printed argument comes to",
)
proof.add_theorem("P", "q̃ = 0, dq̃/dt = 0 is globally exponentially stable, by ½sᵀMs + q̃ᵀΛ(K + B)q̃", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), K="7 3", Lambda="5 5"),
    uses=["P"],
)

proof.add_theorem(
    "P.disturbed",
    "an unknown torque of at most δ beside τ keeps the errors within a multiple of it in the end",
    input_to_state(shaken.under(torque), V, **bounds, gain=Λ.max * r + b),
)

proof.section("What would be too much")
proof.add(
    "printed.form",
    "½sᵀMs + c‖q̃‖² is below V = ½sᵀMs: the line s = 0 refutes it",
    exponential(
        loop,
        kinetic,
        changes={"w": Λ @ e - y},
        above=goal.mu / 2 * norm(y) ** 2 + Λ.min * K.min * r**2,
        below=below,
        rate=K.min * b**2 + Λ.min**2 * K.min * r**2,
    ),
)
