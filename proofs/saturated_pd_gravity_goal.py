"""Saturated PD control with gravity compensated at the goal, τ = L f(A q̃) − K k(q̇) + g(q_d), no friction.

The torque is bounded by L, K and g(q_d). V is the energy, with Σ l_i ∫ f(a_i x) dx.
The goal is the only state of rest if l_i f(a_i x) is above min(k_g x, 2k'_i) for every joint i, where 2k'_i
is the most that its torque of gravity changes: stiffer than gravity near the goal, stronger far away. Here
f_load is the largest share min(k_g x, 2k'_i)/(l_i f(a_i x)) that gravity has. It must be below 1.
Saturated versions of ``tomei.py`` are published. Those texts were not at hand; the proof is written anew.
"""

from lyapcheck.claims import (
    Proof,
    along,
    at_arm,
    constant_goal,
    cosh,
    lasalle,
    log,
    norm,
    rate_at_most,
    tanh,
    var,
)
from lyapcheck.robots import load

proof = Proof(
    "saturated_pd_gravity_goal",
    "Saturated PD control with gravity at the goal",
    reference="tomei1991adaptive",
)
x = var("x")


def any_function(goal, A, L):
    """The class: odd, C¹, positive right of 0, of bounded slope, with an endless integral."""
    return goal.entrywise("f", A @ goal.e, level=L), goal.entrywise("k", goal.w)


def tanh_of(goal, A, L):
    """tanh for both: tanh x ≥ x/4 as far as 3, and 0.99 from there on."""
    own = {"value": tanh(x), "potential": log(cosh(x)), "gamma": 1, "rho": 1, "secant": 1}
    f = goal.function("f", A @ goal.e, **own, low="0.99", start=3, steep="1/4", level=L)
    return f, goal.function("k", goal.w, **own, low="1/2")


def regulator(functions, friction="none", firm=True, damping=1):
    """The loop, V and the theorem."""
    goal = constant_goal(friction)
    w, M = goal.w, goal.M
    L, A, K = goal.gains("L A K")
    f, k = functions(goal, A, L)
    loop = goal.under(L @ f - damping * K @ k + goal.gravity_at_goal)
    V = w @ M @ w / 2 + L.entries @ f.U
    theorem = lasalle(
        loop,
        V,
        gravity=True,
        where=[f.load < 1] if firm else [],
        above=goal.mu / 2 * norm(w) ** 2 + (1 - f.load) * f.sum_LU,
        rate=K.min * k.sector * norm(k) ** 2,
        rest=(f.probe, (1 - f.load) * f.sum_T),
    )
    return loop, V, theorem, -damping * w @ K @ k


loop, V, theorem, power = regulator(any_function)
proof.add("rate", "dV/dt = −q̇ᵀK k(q̇)", along(loop, V, power, gravity=True))
proof.add_theorem("P", "f_load < 1 makes the goal globally asymptotically stable, without friction", theorem)
proof.add("P.tanh", "so with tanh for both", regulator(tanh_of)[2])
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains, whose friction only helps",
    at_arm(regulator(tanh_of, "any")[2], load("pelican2"), L="60 6", A="2 12", K="7 3"),
)

proof.section("What would be too much")
proof.add("firm", "the same for all positive gains: a soft arm falls", regulator(any_function, firm=False)[2])
proof.add(
    "weak",
    "the Pelican arm with a saturation below its gravity: the condition fails",
    at_arm(regulator(tanh_of, "any")[2], load("pelican2"), L="3 6", A="40 12", K="7 3"),
)
proof.add(
    "turned",
    "the same with the damping turned: then energy grows",
    rate_at_most(regulator(any_function, damping=-1)[2]),
)
