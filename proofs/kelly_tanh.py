"""PD control with gravity compensation by a strict Lyapunov function with a tanh in it.

τ = K_p q̃ − K_v q̇ + g(q),  V = ½q̇ᵀMq̇ + ½q̃ᵀK_p q̃ − γ tanh(q̃)ᵀMq̇ for a small γ > 0 (ε₀ below): the bounded
vector tanh(q̃) keeps the Coriolis term within bounds, as ε₀/(1 + ‖q̃‖) does elsewhere.
"""

from lyapcheck.claims import (
    Proof,
    along,
    at_arm,
    constant_goal,
    cosh,
    exponential,
    log,
    norm,
    rate_at_most,
    strict,
    tanh,
    transpose,
    var,
)
from lyapcheck.robots import load

proof = Proof("kelly_tanh", "PD control with gravity compensation, strictly", reference="kelly2005control")

x = var("x")
goal = constant_goal()
e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
K_p, K_v = goal.gains("Kp Kv")
h = goal.function("h", e, tanh(x), log(cosh(x)), gamma=1, rho=1, secant=1, low="1/2")
r, b, a, γ = norm(e), norm(w), norm(h), goal.eps0

loop = goal.under(K_p @ e - K_v @ w + goal.gravity)
energy = w @ M @ w / 2 + e @ K_p @ e / 2
V = energy - γ * h @ M @ w
above = goal.mu / 2 * b**2 + K_p.min / 2 * r**2 - γ * goal.beta * h.secant * r * b
rate = (
    γ * K_p.min * h.sector * a**2
    - γ * (K_v.max + B.max) * a * b
    + (K_v.min - γ * (h.slope * goal.beta + h.reach * goal.kc)) * b**2
)
theorem = strict(loop, V, above=above, rate=rate, small=True)

proof.add(
    "energy", "without the cross term, dV/dt = −q̇ᵀ(K_v + B)q̇", along(loop, energy, -w @ K_v @ w - w @ B @ w)
)
proof.add(
    "linear",
    "with q̃ for tanh(q̃) in V: γ [q̇ᵀMq̇ − q̃ᵀK_p q̃ + q̃ᵀ(K_v + B)q̇ − q̃ᵀCᵀq̇] comes to it",
    along(
        loop,
        energy - γ * e @ M @ w,
        -w @ K_v @ w
        - w @ B @ w
        + γ * w @ M @ w
        - γ * e @ K_p @ e
        + γ * e @ K_v @ w
        + γ * e @ B @ w
        - γ * e @ transpose(C) @ w,
    ),
)
proof.add_theorem("P", "q̃ = 0, q̇ = 0 is globally asymptotically stable for all positive gains", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", Kv="7 3"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add(
    "turned",
    "the same with the cross term turned: then q̃ is driven away",
    rate_at_most(strict(loop, energy + γ * h @ M @ w, above=above, rate=rate, small=True)),
)
proof.add(
    "exponential",
    "globally exponentially stable by the same V: ‖tanh(q̃)‖ is no norm of q̃",
    exponential(
        loop,
        V,
        above=above,
        below=goal.beta / 2 * (b + γ * r) ** 2 + K_p.max / 2 * r**2,
        rate=rate,
        small=True,
    ),
)
