"""The theorems of ``scalar.py`` and ``tracking.py`` for every n and every function of a class, at once.

A function of the class is odd, C¹, bounded, positive right of 0, of bounded slope, its integral without end.
τ = K_p h(q̃) − K_v k(q̇) + g(q) makes the goal globally asymptotically stable for every arm with friction, all
positive gains and any two functions of the class, with V of (13), strictly; (21) likewise, for every bounded
q̇_d. The bounds γ, ρ and L are letters here, not numbers: one certificate serves all n and all functions.

Then members: tanh, arctan, x/√(1 + x²), h_m for the m at hand, and what makes h_m one for all real m ≥ 1.
"""

from lyapcheck.claims import (
    Proof,
    Reals,
    all_of,
    any_vector,
    atan,
    constant_goal,
    cosh,
    expr,
    gamma,
    h,
    identity,
    log,
    moving_goal,
    norm,
    potential,
    rho,
    secant_bound,
    sinh,
    sqrt,
    strict,
    tanh,
    uniform,
    var,
)
from lyapcheck.claims.bounds import above as at_least

proof = Proof(
    "every_function", "Every function of a class, every number of joints", reference="reyes2019family"
)

x = var("x")


def any_function(goal):
    """Two functions of the class."""
    return goal.entrywise("h", goal.e), goal.entrywise("k", goal.w)


def member(value, U, gamma=1, rho=1, secant=1):
    """One function for both."""
    numbers = {"gamma": gamma, "rho": rho, "secant": secant, "low": "1/2"}
    return lambda goal: [
        goal.function(n, of, value, U, **numbers) for n, of in (("h", goal.e), ("k", goal.w))
    ]


def h_of(m):
    """h_m."""
    return member(h(m, x), potential(m, x), *(at_least(bound(m)) for bound in (gamma, rho, secant_bound)))


def closed_loop(goal, functions):
    """The loop that (6) closes, or (21) where q_d moves; V of (13), its bound from below, h, k and gains."""
    (h, k), (K_p, K_v) = functions(goal), goal.gains("Kp Kv")
    w, M, B, y, ε = goal.w, goal.M, goal.B, any_vector("y_w"), goal.eps0 * goal.s
    torque = K_p @ h - K_v @ k + goal.gravity
    if goal.desired:
        torque = torque + M @ goal.acceleration + goal.C @ goal.velocity + B @ goal.velocity
    shifted = w - ε * h
    V = shifted @ M @ shifted / 2 + K_p.entries @ h.U
    above = {"above": goal.mu / 2 * norm(y) ** 2 + K_p.min * h.sum_U, "changes": {"w": y + ε * h}}
    return goal.under(torque), V, above, (h, k, K_p, K_v)


def argument(goal, functions, eps0):
    """dV/dt in a = ‖h(q̃)‖ and b = ‖w‖, for ``some`` ε₀ > 0, each ``given`` by a condition, or ``any``."""
    loop, V, above, (h, k, K_p, K_v) = closed_loop(goal, functions)
    ε0, β, a, b, B = goal.eps0, goal.beta, norm(h), norm(goal.w), goal.B
    ε, D = ε0 * goal.s, goal.kc * goal.vd
    c, d = β * (h.slope + h.share) + h.reach * goal.kc, B.max + k.secant * K_v.max
    corner, low, where = K_p.min, B.min - ε0 * c, []
    rate = ε * K_p.min * a**2 - ε * (d + ε * c) * a * b + (B.min - ε * c) * b**2
    if goal.desired:
        rate, d, corner = rate - ε**2 * D * a**2 - ε * D * a * b, d + D, corner - ε0 * D
        # the second follows from the others, and spares the search a product of two of them
        where = [ε0 * D < K_p.min, ε0**2 * D * c < K_p.min * B.min]
    where += [ε0 / 4 * (d + ε0 * c) ** 2 < corner * low]
    form = {**above, "rate": rate, **{"some": {"small": True}, "given": {"where": where}, "any": {}}[eps0]}
    if goal.desired:
        return uniform(loop, V, below=β / 2 * (b + ε * a) ** 2 + K_p.norm * h.sum_U, **form)
    return strict(loop, V, **form)


def regulator(functions, eps0="some"):
    """(6)."""
    return argument(constant_goal("positive"), functions, eps0)


def tracking(functions, eps0="some"):
    """(21)."""
    return argument(moving_goal("positive"), functions, eps0)


proof.section("Every function of the class")
proof.add_theorem(
    "F.arms",
    "(6): the goal is globally asymptotically stable for all positive gains",
    regulator(any_function),
)
proof.add_theorem(
    "F.tracking",
    "(21): globally uniformly asymptotically stable for every bounded q̇_d",
    tracking(any_function),
)

proof.section("Members of it")
root = sqrt(1 + x**2)
MEMBERS = {
    "tanh": member(tanh(x), log(cosh(x))),
    "arctan": member(atan(x), x * atan(x) - log(root**2) / 2, gamma="1.58"),
    "algebraic": member(x / root, root - 1),
}
for name, functions in MEMBERS.items():
    proof.add(f"F.{name}", f"(6) with {name}, for every n", regulator(functions), uses=["F.arms"])


@proof.claim("F.family", "(6) with h_m, for every n", "(6)", uses=["F.arms"])
def _(m):
    return regulator(h_of(m))


@proof.claim("F.family.tracking", "(21) with h_m, for every n", "(21)", uses=["F.tracking"])
def _(m):
    return tracking(h_of(m))


proof.section("h_m for all m: u = sinh²x, p = u^m")
R = Reals()
m_, u, p = R.positive("m u p")
SQUARE = (1 + u) / u * (p / (1 + p)) ** 2
SLOPE = p * (2 * m_ + (2 * m_ - 1 - p) / u) / (1 + p) ** 2


@proof.claim("F.h.square", "h_m² = (1 + 1/u)(p/(1 + p))²", "(6)")
def _(m):
    return identity(
        h(m, x) ** 2 * sinh(x) ** 2 * (1 + sinh(x) ** (2 * m)) ** 2, cosh(x) ** 2 * sinh(x) ** (4 * m)
    )


proof.add(
    "F.h.bounded",
    "|h_m| ≤ √2: for u ≥ 1, and for u ≤ 1, where p ≤ u",
    all_of(
        right=R.implies((u >= 1,), SQUARE <= 2),
        left=R.implies((u <= 1, p <= u), SQUARE <= 2),
    ),
)
proof.add(
    "F.h.slope",
    "|h_m'| ≤ 4m, and so |h_m(x)| ≤ 4m|x|, for every real m ≥ 1",
    all_of(
        right=R.implies((u >= 1, m_ >= 1), 4 * m_ >= SLOPE),
        right_falling=R.implies((u >= 1, m_ >= 1), 4 * m_ >= -SLOPE),
        left=R.implies((u <= 1, p <= u, m_ >= 1), 4 * m_ >= SLOPE),
        left_falling=R.implies((u <= 1, p <= u, m_ >= 1), 4 * m_ >= -SLOPE),
    ),
)
proof.add(
    "F.h.endless",
    "h_m ≥ 1/2 where u ≥ 1, so that p ≥ 1: its integral has no end",
    R.implies((p >= 1,), expr("1/4") <= SQUARE),
)
