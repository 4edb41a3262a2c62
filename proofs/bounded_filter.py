"""Bounded torques from positions alone, τ = K_p f(q̃) − N L k(z) + g(q), dz/dt = N q̇ − A k(z).

No friction is needed. z = x + N q with dx/dt = −A k(x + N q) is computed from q. V falls only where z
moves, so LaSalle's theorem needs two steps: z stays 0, so q̇ does, so K_p f(q̃) does. f and k are any
bounded functions of the class. Loría, Kelly, Ortega and Santibáñez published such regulators in 1997.
Their paper was not at hand here: the law and the proof are written anew, with gravity compensated at the
present posture.
"""

from lyapcheck.claims import (
    Proof,
    along,
    any_vector,
    at_arm,
    constant_goal,
    cosh,
    lasalle,
    log,
    norm,
    step,
    tanh,
    var,
)
from lyapcheck.robots import load

proof = Proof("bounded_filter", "Bounded torques from positions alone", reference="kelly2005control")

x = var("x")


def regulator(functions, leak=1, steps=None):
    """The loop, V and the theorem, with functions of q̃ and of z."""
    goal = constant_goal()
    w, M = goal.w, goal.M
    K_p, L, N, A = goal.gains("Kp L N A")
    z = goal.state("z", N @ w - leak * A @ any_vector("k"))
    f, k = functions(goal, z)
    loop = goal.under(K_p @ f - N @ (L @ k) + goal.gravity)
    V = w @ M @ w / 2 + K_p.entries @ f.U + L.entries @ k.U
    moving = step(N.min * norm(w) ** 2, z=w)
    resting = step(K_p.min * norm(f) ** 2, w=f)
    theorem = lasalle(
        loop,
        V,
        above=goal.mu / 2 * norm(w) ** 2 + K_p.min * f.sum_U + L.min * k.sum_U,
        rate=L.min * A.min * norm(k) ** 2,
        rest=steps(moving, resting) if steps else [moving, resting],
    )
    return loop, V, theorem, -k @ L @ A @ k - w @ goal.B @ w


def any_function(goal, z):
    """The class: bounded, odd, C¹, positive right of 0, with an endless integral."""
    return goal.entrywise("f", goal.e), goal.entrywise("k", z)


def tanh_of(goal, z):
    """tanh for both."""
    numbers = {"gamma": 1, "rho": 1, "secant": 1, "low": "1/2"}
    return [
        goal.function(name, of, tanh(x), log(cosh(x)), **numbers) for name, of in (("f", goal.e), ("k", z))
    ]


loop, V, theorem, power = regulator(any_function)
proof.add("rate", "dV/dt = −k(z)ᵀL A k(z) − q̇ᵀBq̇: it sees z, and q̇ by friction alone", along(loop, V, power))
proof.add_theorem(
    "P",
    "q̃ = 0, q̇ = 0, z = 0 is globally asymptotically stable for all positive gains, with or without friction",
    theorem,
)
proof.add("P.tanh", "so with tanh for both", regulator(tanh_of)[2])
proof.add(
    "P.pelican",
    "so it is, with tanh, for the Pelican arm with these gains",
    at_arm(regulator(tanh_of)[2], load("pelican2"), Kp="30 30", L="2 2", N="5 5", A="10 10"),
)

proof.section("What would be too much")
proof.add(
    "leak", "the same with a filter that forgets nothing: nothing damps", regulator(any_function, leak=0)[2]
)
proof.add(
    "order",
    "the same steps the other way round: K_p f(q̃) = 0 needs q̇ = 0 first",
    regulator(any_function, steps=lambda moving, resting: [resting, moving])[2],
)
proof.add(
    "at once",
    "the same without the first step: V may stand still while the arm moves",
    regulator(any_function, steps=lambda moving, resting: [resting])[2],
)
