"""ODEs of a few variables whose motions are known, polynomial facts with equations and sines, and steps.

Gradient-like systems are ẋ = (J − R)∇V with J skew and R = SᵀS, so that dV/dt = −‖S∇V‖². Pendulums have a
rest at the top, which no statement about all motions may forget.
"""

from fractions import Fraction

from lyapcheck.check.expressions.expression import derivative
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.claims import (
    Implies,
    converges_to,
    cos,
    enters,
    expr,
    global_,
    implies,
    local,
    reals,
    sin,
    system,
    var,
)
from lyapcheck.claims.expressions import Expr
from tests.helpers.polynomial_facts import added, fact, plus, polynomial, squares, times, value, written
from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.loops import changed_theorem, theorems

SMALL = tuple(map(Fraction, ("1/4", "1/2", "1", "3/2", "2", "3")))
TINY = tuple(map(Fraction, ("1/1000", "1/100", "1/10")))
T, W = var("t"), var("w")


@generates("Flow", 0.6)
def flow(random):
    """A statement about all motions of a small system."""
    return random.choice((gradient, gradient, pendulum, pendulum, downwards, driven))(random)


def gradient(random):
    """ẋ = (J − R)∇V, or with a sign, a drift or the damping off."""
    names = "xyz"[: random.choice((2, 2, 3))]
    x = [var(name) for name in names]
    n = len(x)
    forms = [sum((random.randint(-2, 2) * one for one in x), expr(0)) for _ in range(n)]
    bowl = sum((one**2 for one in x), expr(0)) * random.choice(SMALL)
    V = bowl + sum((f**2 for f in forms), expr(0)) * random.choice((0, *SMALL))
    V += x[0] ** 4 * random.choice((0, 0, *SMALL))
    slope = [_slope(V, one) for one in names]
    turned = [[random.randint(-2, 2) for _ in x] for _ in x]
    J = [[turned[i][j] - turned[j][i] for j in range(n)] for i in range(n)]
    kind = random.choice(("damped", "damped", "parts", "driven", "drift", "no damping", "slow"))
    weights = [random.choice(SMALL) for _ in x]
    if kind in ("parts", "no damping"):
        weights[random.randrange(n)] = Fraction(0)
    if kind == "no damping":
        weights = [Fraction(0)] * n
    sign = -1 if kind == "driven" else 1
    rates = {
        name: sum((J[i][j] * slope[j] for j in range(n)), expr(0)) - sign * weights[i] * slope[i]
        for i, name in enumerate(names)
    }
    if kind == "drift":
        rates[names[0]] += random.choice(TINY)
    s = system(rates)
    grows = random.choice(TINY)
    if kind == "parts":
        parts = [p for p, weight in zip(slope, weights, strict=True) if weight]
        return Made(converges_to(s, V, parts, grows=grows), "slopes along which V falls", TRUE)
    if kind == "slow":
        rates = {name: rate * random.choice(SMALL) for name, rate in rates.items()}
        return Made(global_(system(rates), V, grows=grows), "a gradient with other weights")
    truth = TRUE if kind == "damped" else FALSE
    if random.random() < 0.3:
        return Made(global_(s, V, grows=grows, rest=slope), f"a gradient in steps, {kind}", truth)
    return Made(global_(s, V, grows=grows), f"a gradient, {kind}", truth)


def _slope(V, name):
    """∂V/∂name, which is tested elsewhere."""
    return Expr(derivative(V.tree, name))


def pendulum(random):
    """θ″ = −a sin θ − bθ′: what tends to 0 of all its motions."""
    a, b = random.choice(SMALL), random.choice((*SMALL, *SMALL, 0, *(-one for one in TINY)))
    s = system({"t": W, "w": -a * sin(T) - b * W})
    E = W**2 / 2 + a * (1 - cos(T))
    D = E - random.choice(SMALL)
    parts, fits = random.choice(
        (
            ([W, sin(T)], True),
            ([W], True),
            ([W, a * sin(T) + W], True),
            ([W, W * cos(T), sin(T) * cos(T)], True),
            ([W, 1 - cos(T)], False),
            ([W, 1 + cos(T)], False),
            ([W, sin(T), cos(T)], False),
            ([W, sin(T) * (1 - cos(T)), D], False),
            ([W + random.choice(TINY)], False),
        )
    )
    truth = TRUE if fits and b > 0 else FALSE
    if random.random() < 0.4:
        cross = Fraction(min(a, b, 1)) / 4 if b > 0 else Fraction(1, 8)
        E += cross * W * sin(T)
        truth = None if truth == TRUE else truth
    return Made(converges_to(s, E, parts, grows=Fraction(1, 8), less=8), "a pendulum", truth)


def downwards(random):
    """The lower rest of a pendulum with a region, which may have the upper one in it."""
    a, b = random.choice((1, Fraction(3, 2), 2, 3)), random.choice((*SMALL, *(-one for one in TINY)))
    R = random.choice((1, 2, 3, Fraction(7, 2), 4, 5, 6))
    c = random.choice((Fraction(1, 4), Fraction(1, 2), 1, Fraction(3, 2), 2, 3, 4))
    s = system({"t": W, "w": -a * sin(T) - b * W})
    E = W**2 / 2 + a * (1 - cos(T))
    truth = TRUE if b > 0 and 2 * c < R and c < 2 * a else None
    if b < 0 or (c >= 2 * a and R >= 4):
        truth = FALSE
    steps = {"rest": [W, sin(T)]} if random.random() < 0.7 else {}
    return Made(local(s, E, region=c >= E, within=R, **steps), "the lower rest of a pendulum", truth)


def driven(random):
    """A wheel with a torque that depends on its angle: its speed comes below a level, or stays above it."""
    a, u, b = random.choice(SMALL), random.choice((0, *SMALL)), random.choice(SMALL)
    level = random.choice((Fraction(1, 4), 1, 3, 9, 25, 100))
    s = system({"t": W, "w": u - b * W - a * sin(T)})
    truth = TRUE if level * b**2 > (a + u) ** 2 else None
    if u > a and level < ((u - a) / b) ** 2:
        truth = FALSE
    V = W**2
    return Made(enters(s, V, region=level >= V, less=4), "a wheel that is driven", truth)


@generates("Squares", 0.6)
def facts(random):
    """A fact about polynomials, true or false by construction; with an equation, or of sines."""
    kind = random.random()
    if kind < 0.4:
        true = random.random() < 0.5
        return Made(fact(random, true), "squares", TRUE if true else FALSE)
    if kind < 0.7:
        return _with_equation(random)
    return _of_sines(random)


def _with_equation(random):
    """Squares plus any multiple of an equation; or of one half of it, at a point at which the other fails."""
    names = "xyz"[: random.randint(2, 3)]
    n = len(names)
    z = [Fraction(random.randint(-3, 3)) for _ in names]
    equation = polynomial(random, n, 2)
    equation = plus(equation, -value(equation, z))
    true = random.random() < 0.5
    goal = squares(random, n, 1, z if not true else None)
    away = 0 if true else -random.choice(TINY)
    factor = polynomial(random, n, 1)
    goal = plus(added(goal, times(factor, equation)), away)
    left, p = written(goal, names), written(equation, names)
    statement = implies(reals(*names), [p <= 0, p >= 0], left >= 0)
    return Made(statement, "squares with an equation", TRUE if true else FALSE)


def _of_sines(random):
    """A fact about polynomials for sines and cosines in place of variables, and for one that must fail."""
    true = random.random() < 0.5
    base = fact(random, true)
    names = [one.name for one in base.variables]
    waves = [sin(T).tree, cos(T).tree, var("w").tree, sin(var("w")).tree]
    put = dict(zip(names, waves, strict=False))

    def at(tree):
        if tree[0] == "var":
            return put[tree[1]]
        return tuple(at(part) if isinstance(part, tuple) else part for part in tree)

    given = tuple(type(one)(at(one.left), one.operator, at(one.right)) for one in base.hypotheses)
    end = base.conclusion
    used = reals("t", "w") if len(names) > 2 else reals("t")
    statement = Implies(tuple(used), given, type(end)(at(end.left), end.operator, at(end.right)))
    return Made(statement, "squares of sines", TRUE if true else None)


@generates("Steps", 0.3)
def in_steps(random):
    """A theorem by steps to rest, changed."""
    chosen = [one.argument for one in theorems() if one.argument.steps]
    return Made(Stable(changed_theorem(random.choice(chosen), random)), "steps to rest, changed")


@generates("OfAPart", 0.3)
def of_a_part(random):
    """Convergence of a part, changed."""
    chosen = [one.argument for one in theorems() if one.argument.theorem == "convergence"]
    return Made(Stable(changed_theorem(random.choice(chosen), random)), "convergence of a part, changed")
