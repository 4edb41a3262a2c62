"""A proof of one's own, as an example: τ = K_p arctan(q̃) − K_v arctan(q̇) + g(q) for every arm and all gains.

Run it with ``lyapcheck check proofs/examples/arctan.py``; ``--help`` lists what can be chosen.

How a script is made:

- ``proof = Proof(...)`` once; then one function per claim, decorated with its id and what it says in words.
  It is handed what its arguments name (m, n, robot, gains), no more, and returns the statement as data.
- Numbers are exact: write "1.5708" or Fraction(11, 7), never the float 1.5708.
- ``uses`` names the claims that a step rests on. If one of them is not proved, neither is the step.
- Nothing says here what is true: each statement is decided, a wrong one is refuted with a witness.

The proof is that of ``proofs/scalar.py`` for another function: h = arctan has γ = π/2, ρ = 1 and L = 1.
"""

from fractions import Fraction

from lyapcheck.claims import (
    Constant,
    FamilyBounds,
    Proof,
    all_of,
    any_vector,
    atan,
    companion,
    constant_goal,
    decreasing,
    diff,
    dot,
    expr,
    for_all,
    identity,
    implies,
    log,
    loops,
    nonnegative,
    norm,
    norm_bound,
    pi,
    positive,
    property_of,
    rate,
    rate_at_most,
    rate_definite,
    strict,
    total,
    var,
)
from lyapcheck.control.gains import GainSet

proof = Proof("arctan", "arctan in place of h: global asymptotic stability for every arm and all gains")

x = var("x")
NAMES = ("a", "b", "eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc")
"""‖h(q̃)‖, ‖q̇‖, ε and the constants of the loop."""
U = x * atan(x) - log(1 + x**2) / 2


SLOPE = 1 / (1 + x**2)


ARCTAN = (atan(x), SLOPE, U)
"""h, h' and U."""


def known_of(n):
    """γ, √nγ, ρ, L and G; γ is above π/2 by enough to be shown without going far out."""
    return FamilyBounds(n, gamma="1.58", rho=1, L=1)


def theorem(small=True):
    """The loop under τ, V, and its bounds: from below in y = w − εh, for its rate in a = ‖h‖ and b = ‖w‖.

    For some ε₀ > 0; without ``small``, for each.
    """
    goal = constant_goal("positive")  # q_d is constant, and every joint has viscous friction
    of_arctan = {"gamma": "1.58", "rho": 1, "secant": 1, "low": "1/2"}
    h, k = (goal.function(name, of, atan(x), U, **of_arctan) for name, of in (("h", goal.e), ("k", goal.w)))
    K_p, K_v = goal.gains("Kp Kv")
    loop = goal.under(K_p @ h - K_v @ k + goal.gravity)
    w, B, β, a, b, y = goal.w, goal.B, goal.beta, norm(h), norm(goal.w), any_vector("y_w")
    ε = goal.eps0 * goal.s  # s = 1/(1 + ‖e‖)
    shifted = w - ε * h
    c = β * (h.slope + h.share) + h.reach * goal.kc
    return strict(
        loop,
        shifted @ goal.M @ shifted / 2 + K_p.entries @ h.U,
        above=goal.mu / 2 * norm(y) ** 2 + K_p.min * h.sum_U,
        changes={"w": y + ε * h},
        rate=ε * K_p.min * a**2 - ε * (B.max + k.secant * K_v.max + ε * c) * a * b + (B.min - ε * c) * b**2,
        small=small,
    )


def at_rest():
    """The same loop, and what moves it where w = 0."""
    arctan = companion("every_function.py").MEMBERS["arctan"]
    return companion("kelly_santibanez.py").regulator(arctan, friction="positive")[2]


# One variable: inequalities on the whole line or on a part of it --------------------------------------------

FUNCTION = "The function arctan"


@proof.claim("sign", "arctan has the sign of x", section=FUNCTION)
def _():
    return all_of(
        odd=identity(atan(-x), -atan(x)),
        right_of_0=for_all(expr(0) < atan(x), 0, open_low=True),
        left_of_0=for_all(atan(x) < 0, None, 0, open_high=True),
        product=for_all(expr(0) <= x * atan(x)),
    )


@proof.claim("bound", "|arctan x| ≤ π/2 ≤ γ", section=FUNCTION)
def _(n):
    return all_of(
        from_above=for_all(atan(x) <= pi / 2),
        from_below=for_all(-pi / 2 <= atan(x)),
        rounded_up=Constant(pi / 2 <= known_of(n).gamma),
    )


@proof.claim("slope", "‖arctan(x)‖ ≤ ‖x‖ for x in Rⁿ", section=FUNCTION)
def _(n):
    return norm_bound(atan(x), n, known_of(n).L, power=1)


@proof.claim("steep", "0 ≤ arctan' ≤ 1", section=FUNCTION)
def _(n):
    return all_of(
        derivative=identity(diff(atan(x), "x"), SLOPE),
        below=for_all(expr(0) <= SLOPE),
        above=for_all(known_of(n).rho >= SLOPE),
    )


@proof.claim(
    "potential",
    "U = x arctan x − ½ ln(1 + x²): U' = arctan, U > 0 unless x = 0, U ≥ ½|x| − 1",
    section=FUNCTION,
)
def _():
    return all_of(
        arctan_is_odd=identity(atan(-x), -atan(x)),
        arctan_is_positive=for_all(expr(0) < atan(x), 0, open_low=True),
        derivative=identity(diff(U, "x"), atan(x)),
        positive_right_of_0=for_all(expr(0) < U, 0, open_low=True),
        positive_left_of_0=for_all(expr(0) < U, None, 0, open_high=True),
        unbounded_right=for_all(x / 2 - 1 <= U, 0),
        unbounded_left=for_all(-x / 2 - 1 <= U, None, 0),
    )


# Many variables: identities and implications between inequalities -------------------------------------------

LYAPUNOV = "V = ½yᵀMy + Σ k_pi U(q̃_i), y = q̇ − ε arctan(q̃)"


@proof.claim("share", "a ≤ √nγ and a ≤ Lr give a/(1 + r) ≤ √nγL/(√nγ + L) = G", section=LYAPUNOV)
def _():
    a, r, reach, L = map(var, ("a", "r", "reach", "L"))
    variables = positive("reach", "L") + nonnegative("a", "r")
    return implies(variables, (a <= reach, a <= L * r), a / (1 + r) <= reach * L / (reach + L))


@proof.claim("positive", "V is positive definite", section=LYAPUNOV, uses=["potential"])
def _():
    return property_of("V is positive definite", theorem(small=False))


@proof.claim(
    "smooth", "V is continuously differentiable, also at q̃ = 0", section=LYAPUNOV, uses=["slope", "steep"]
)
def _():
    return property_of("V is continuously differentiable", theorem(small=False))


@proof.claim("unbounded", "V is radially unbounded", section=LYAPUNOV, uses=["bound", "potential"])
def _():
    return property_of("V is radially unbounded", theorem(small=False))


@proof.claim("equilibrium", "the origin is the only equilibrium", section=LYAPUNOV, uses=["sign"])
def _():
    """Where q̇ = 0, h(q̃)ᵀMq̈ ≥ λmin(K_p)‖h(q̃)‖²."""
    return property_of("the origin is the only equilibrium", at_rest())


@proof.claim("sizes", "γ, ρ and L bound arctan, its derivative and arctan(x)/x", section=LYAPUNOV)
def _(n):
    return known_of(n).of_h(ARCTAN)


@proof.claim("rate", "dV/dt is the sum of eleven terms", section=LYAPUNOV, uses=["potential", "smooth"])
def _():
    s = loops.letters()
    return all_of(
        terms=loops.along(s, loops.energy(s), total(loops.terms(s))),
        rate_of_the_norm=loops.along(s, s.r**2, rate(dot(s.e, s.e))),
    )


# Norms for every n: each term is at most a product of norms, by what is said of its letters -----------------


@proof.claim(
    "bounds",
    "each of the terms is at most its part of the form",
    section=LYAPUNOV,
    uses=["rate", "sign", "bound", "slope", "steep", "share"],
)
def _(n):
    known, s = known_of(n), loops.short_letters()
    norms, least = loops.known_norms(s, known), loops.known_least(s)
    a, b, eps, kp, b_min, b_max, kv_max, beta, kc = map(var, NAMES)

    def term(k, bound, names, forms=""):
        known_here = [norms[name] for name in names.split()], [least[name] for name in forms.split()]
        return loops.term_at_most(s, k, bound, *known_here)

    return all_of(
        term_1=term(1, expr(0), "", "damping"),
        term_2=term(2, -b_min * b**2, "w", "friction"),
        term_3=term(3, eps * known.rho * beta * b**2, "dh M w"),
        term_4=term(4, eps * known.G * beta * b**2, "u share M w"),
        term_5=term(5, eps * known.reach * kc * b**2, "reach C w"),
        term_6=term(6, -eps * kp * a**2, "h", "gain"),
        term_7=term(7, eps * b_max * a * b, "h B w"),
        term_8=term(8, eps * known.L * kv_max * a * b, "h K_v hw"),
        term_9=term(9, eps**2 * known.reach * kc * a * b, "h reach C"),
        term_10=term(10, eps**2 * known.G * beta * a * b, "u w share h M"),
        term_11=term(11, eps**2 * known.rho * beta * a * b, "dh w h M"),
    )


@proof.claim(
    "form", "dV/dt ≤ −[a b] Θ' [a b]ᵀ with a = ‖arctan(q̃)‖, b = ‖q̇‖", section=LYAPUNOV, uses=["bounds"]
)
def _():
    """What the terms add up to, from V and τ at once: the checker derives how the letters move."""
    return rate_at_most(theorem())


# A parameter that may be chosen small, and the theorem ------------------------------------------------------

CONCLUSION = "Conclusion"


@proof.claim("small", "some ε₀ > 0 makes Θ' positive definite for every ε in (0, ε₀]", section=CONCLUSION)
def _():
    return rate_definite(theorem())


@proof.claim(
    "stable",
    "the origin is globally asymptotically stable for every arm with friction and all positive gains",
    section=CONCLUSION,
    uses=["equilibrium", "smooth", "positive", "unbounded", "sizes", "form", "small"],
)
def _():
    """The steps above show where an argument breaks; the theorem asks for all that it needs once more."""
    return theorem()


# Every state of one arm with numbers ------------------------------------------------------------------------


@proof.claim(
    "arm",
    "dV/dt < 0 at every state but the origin of this arm with these gains, ε₀ = 0.02",
    section=CONCLUSION,
)
def _(robot):
    kp, kv = (28, 60, 5), ("0.3", "0.3", "0.3")
    gains = GainSet("arctan", None, tuple(map(Fraction, kp)), tuple(map(Fraction, kv)), family="arctan")
    return decreasing(robot, gains, "0.02")
