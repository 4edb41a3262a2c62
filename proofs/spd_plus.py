"""PD+ control with one saturation, τ = L f(A q̃ − K w) + M q̈_d + C(q,q̇_d) q̇_d + g(q) + B q̇_d, w = q̇ − q̇_d.

The torque is bounded, as C(q,q̇_d) and not C(q,q̇) is in it. That asks for friction: λmin(B) > k_c v_d. With
f(A q̃ − K w) = h − c, h = f(A q̃), each c_i has the sign of w_i. So the derivative term dissipates although it
shares its saturation with the proportional term. V = ½yᵀMy + Σ l_i ∫ f(a_i x) dx with y = w − ε₀h.
Bounded versions of PD+ are published. Those texts were not at hand; the proof is written here anew.
"""

from lyapcheck.claims import (
    Proof,
    any_vector,
    at_arm,
    constant_goal,
    cosh,
    lasalle,
    log,
    moving_goal,
    norm,
    rate_at_most,
    tanh,
    uniform,
    var,
)
from lyapcheck.robots import load

proof = Proof("spd_plus", "PD+ control with one saturation", reference="paden1988globally")
x = var("x")


def any_function(goal, of):
    """The class: odd, C¹ with a positive slope that has a bound, with an endless integral."""
    return goal.entrywise("h", of)


def tanh_of(goal, of):
    """tanh."""
    return goal.function("h", of, tanh(x), log(cosh(x)), gamma=1, rho=1, secant=1, low="1/2")


def tracking(function, friction="positive", conditions=True, sign=1):
    """The theorem."""
    goal = moving_goal(friction)
    e, w, M, B, ε0 = goal.e, goal.w, goal.M, goal.B, goal.eps0
    L, A, K = goal.gains("L A K")
    h = function(goal, A @ e)
    d = goal.increase("c", h, A @ e - sign * K @ w)
    model = M @ goal.acceleration + goal.C_desired @ goal.velocity + goal.gravity + B @ goal.velocity
    loop = goal.under(L @ d.value + model)
    z, y = w - ε0 * h, any_vector("y_w")
    V = z @ M @ z / 2 + L.entries @ h.U
    a, b, c, β, k_c, v_d = norm(h), norm(w), norm(y), goal.beta, goal.kc, goal.vd
    return uniform(
        loop,
        V,
        small=True,
        changes={"w": y + ε0 * h},
        where=[k_c * v_d < B.min] if conditions else [],
        above=goal.mu / 2 * c**2 + L.min * h.sum_U,
        below=β / 2 * (b + ε0 * a) ** 2 + L.norm * h.sum_U,
        rate=ε0 * (L.min - ε0 * k_c * v_d) * a**2
        - ε0 * (L.max * d.secant + B.max + 2 * k_c * v_d + ε0 * (β * h.slope + k_c * h.reach)) * a * b
        + (B.min - k_c * v_d - ε0 * (β * h.slope + k_c * h.reach)) * b**2,
    )


def regulator(function, back=1):
    """The theorem for a goal at rest, τ = L f(A q̃ − K w) + g(q), without friction."""
    goal = constant_goal("none")
    e, w, M = goal.e, goal.w, goal.M
    L, A, K = goal.gains("L A K")
    h = function(goal, A @ e)
    c = goal.increase("c", h, A @ e - back * K @ w)
    return lasalle(
        goal.under(L @ c.value + goal.gravity),
        w @ M @ w / 2 + L.entries @ h.U,
        above=goal.mu / 2 * norm(w) ** 2 + L.min * h.sum_U,
        rate=L.min * c.sector * norm(c) ** 2,
        rest=(h, L.min * norm(h) ** 2),
    )


says = "with λmin(B) > k_c v_d the error is globally uniformly asymptotically stable"
proof.add_theorem("P", says, tracking(any_function))
proof.add_theorem("R", "at rest it is for all positive gains, without friction", regulator(any_function))
proof.add("P.tanh", "so with tanh", tracking(tanh_of))
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains, if ‖q̇_d‖ ≤ 1/4",
    at_arm(tracking(tanh_of), load("pelican2"), L="20 5", A="5 5", K="1 1", vd="1/4"),
)

proof.section("What would be too much")
proof.add("turned", "the same with the velocity turned", rate_at_most(tracking(any_function, sign=-1)))
proof.add("R.turned", "at rest with the velocity turned", rate_at_most(regulator(any_function, back=-1)))
proof.add("friction", "the same for every friction", tracking(any_function, friction="any", conditions=False))
proof.add("fast", "the same for every v_d", tracking(any_function, conditions=False))
