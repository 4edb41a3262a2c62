"""Bounded proportional and derivative actions, τ = K_p f(q̃) − K_v k(q̇) + g(q), on an arm without friction.

For all positive gains, by LaSalle's theorem: what (19) asks of K_v in the paper of the hyperbolic family was
not needed before it either. f and k are any odd functions of the class; h_m is one of them.
"""

from lyapcheck.claims import (
    Proof,
    along,
    at_arm,
    constant_goal,
    cosh,
    gamma,
    h,
    lasalle,
    log,
    norm,
    potential,
    rate_at_most,
    rho,
    secant_bound,
    tanh,
    var,
)
from lyapcheck.claims.bounds import above as at_least
from lyapcheck.robots import load

proof = Proof(
    "kelly_santibanez",
    "Bounded actions without friction",
    reference="santibanez1997strict",
)

x = var("x")


def regulator(functions, damping=1, friction="none"):
    """The goal, the loop, V and the theorem, with functions for q̃ and q̇."""
    goal = constant_goal(friction)
    w, M = goal.w, goal.M
    K_p, K_v = goal.gains("Kp Kv")
    f, k = functions(goal)
    loop = goal.under(K_p @ f - damping * K_v @ k + goal.gravity)
    V = w @ M @ w / 2 + K_p.entries @ f.U
    theorem = lasalle(
        loop,
        V,
        above=goal.mu / 2 * norm(w) ** 2 + K_p.min * f.sum_U,
        rate=K_v.min * k.sector * norm(k) ** 2,
        rest=(f, K_p.min * norm(f) ** 2),
    )
    return loop, V, theorem, -w @ K_v @ k


def any_function(goal):
    """The class: odd, C¹, positive right of 0, of bounded slope, with an endless integral."""
    return goal.entrywise("f", goal.e), goal.entrywise("k", goal.w)


def tanh_of(goal):
    """tanh for both."""
    numbers = {"gamma": 1, "rho": 1, "secant": 1, "low": "1/2"}
    return [
        goal.function(n, of, tanh(x), log(cosh(x)), **numbers) for n, of in (("f", goal.e), ("k", goal.w))
    ]


def h_of(m):
    """h_m for both."""
    numbers = {"gamma": gamma(m), "rho": rho(m), "secant": secant_bound(m)}
    numbers = {name: at_least(value) for name, value in numbers.items()} | {"low": "1/2"}
    return lambda goal: [
        goal.function(n, of, h(m, x), potential(m, x), **numbers) for n, of in (("f", goal.e), ("k", goal.w))
    ]


loop, V, theorem, power = regulator(any_function)
proof.add("rate", "dV/dt = −q̇ᵀK_v k(q̇)", along(loop, V, power))
proof.add_theorem(
    "P", "for all positive gains the goal is globally asymptotically stable, without friction", theorem
)
proof.add("P.tanh", "so with tanh for both", regulator(tanh_of)[2])
proof.add(
    "P.pelican",
    "so it is, with tanh, for the Pelican arm with these gains, whose friction only helps",
    at_arm(regulator(tanh_of, friction="any")[2], load("pelican2"), Kp="30 30", Kv="7 3"),
)


@proof.claim(
    "P.family", "so with h_m for both: no friction and no bound of K_v", "the Proposition, without (19)"
)
def _(m):
    return regulator(h_of(m))[2]


proof.section("What would be too much")
proof.add(
    "turned",
    "the same with the damping turned: then energy grows",
    rate_at_most(regulator(any_function, damping=-1)[2]),
)
