"""Statements judged anew by mpmath at many points: no checker, no balls, no normal forms.

``contradicts`` finds fault with a verdict; it misses some faults, but what it finds is one.
"""

import random
from fractions import Fraction
from functools import cache

import mpmath

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.claims import statements
from tests.refutations.every_n_oracle import every_n_is_false

POINTS = 40
SLACK = mpmath.mpf(10) ** -25
UNDEFINED = (ValueError, ZeroDivisionError, OverflowError, TypeError, mpmath.libmp.NoConvergence)
FUNCTIONS = {
    "abs": abs,
    **{name: getattr(mpmath, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh")},
    **{name: getattr(mpmath, name) for name in ("asin", "acos", "atan", "tanh")},
}


def number(value):
    value = Fraction(value)
    return mpmath.mpf(value.numerator) / value.denominator


def hyperbolic(m, x):
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    return s ** (2 * m - 1) * c / (1 + s ** (2 * m))


def slope(m, x):
    u = mpmath.sinh(x) ** 2
    lead = mpmath.mpf(1) if m == 1 else u ** (m - 1)
    return lead * (2 * m - 1 + 2 * m * u - u**m) / (1 + u**m) ** 2


def potential(m, x):
    return mpmath.log(1 + mpmath.sinh(x) ** (2 * m)) / (2 * m)


@cache
def constant(name, m):
    """γ, ρ, L by a fine search; m = 1 is tanh, for which all are 1."""
    if m == 1:
        return mpmath.mpf(1)
    f = {
        "gamma": lambda x: hyperbolic(m, x),
        "rho": lambda x: abs(slope(m, x)),
        "L": lambda x: hyperbolic(m, x) / x,
    }[name]
    best = max((mpmath.mpf(k) / 50 for k in range(1, 150)), key=f)
    width = mpmath.mpf(1) / 50
    for _ in range(90):
        left, right = best - width / 3, best + width / 3
        best = max((left, best, right), key=f)
        width *= mpmath.mpf(3) / 4
    return f(best)


COMBINE = {
    "add": lambda *parts: mpmath.fsum(parts),
    "mul": lambda *parts: mpmath.fprod(parts),
    "neg": lambda a: -a,
    "div": lambda a, b: a / b,
    **FUNCTIONS,
}
WITH_MEMBER = {"h": hyperbolic, "dh": slope, "potential": potential}


def value(tree, at):
    kind, *rest = tree
    if kind in ("num", "var", "pi", "gamma", "rho", "L"):
        return leaf(kind, rest, at)
    if kind in WITH_MEMBER:
        return WITH_MEMBER[kind](rest[0], value(rest[1], at))
    if kind == "pow":
        return value(rest[0], at) ** rest[1]
    return COMBINE[kind](*(value(part, at) for part in rest))


def leaf(kind, rest, at):
    if kind == "num":
        return number(rest[0])
    if kind == "var":
        return at[rest[0]]
    return +mpmath.pi if kind == "pi" else constant(kind, rest[0])


def gap_at(left, right, at):
    """right − left relative to their sizes; None where it is not real."""
    try:
        a, b = value(left, at), value(right, at)
    except UNDEFINED:
        return None
    if not all(isinstance(v, mpmath.mpf) and mpmath.isfinite(v) for v in (a, b)):
        return None
    return (b - a) / (abs(a) + abs(b) + 1)


def fails(relation, at):
    gap = gap_at(relation.left, relation.right, at)
    return gap is not None and (gap < -SLACK or (relation.strict and gap <= 0 and gap < -SLACK))


def holds(relation, at):
    gap = gap_at(relation.left, relation.right, at)
    return gap is not None and gap > SLACK


def draws(names, seed, low=None):
    """Points of sizes from e^-4 to e^3, above the lower bounds where there are some."""
    chance = random.Random(seed)
    for _ in range(POINTS):
        point = {}
        for name in names:
            size = number(Fraction(mpmath.exp(chance.uniform(-4, 3)).__float__()).limit_denominator(10**6))
            bound = (low or {}).get(name)
            point[name] = size * chance.choice((-1, 1)) if bound is None else number(bound) + size
        yield point


def contradicts(statement, verdict, proof):
    """Whether mpmath finds a reason against a verdict."""
    with mpmath.workdps(40):
        judge = {"proved": _against_truth, "refuted": _against_falsehood}[verdict]
        return judge(statement, proof)


def _against_truth(statement, proof):
    if isinstance(statement, statements.AllOf):
        pairs = zip(statement.parts, proof.parts, strict=True)
        return any(_against_truth(part, own) for (_, part), own in pairs)
    judge = AGAINST_TRUTH.get(type(statement))
    return judge is not None and judge(statement)


def _against_falsehood(statement, proof):
    if isinstance(statement, statements.AllOf):
        return _against_falsehood(statement.parts[proof.part][1], proof.proof)
    at = {name: number(x) for name, x in getattr(proof, "point", ())}
    judge = AGAINST_FALSEHOOD.get(type(statement))
    return judge is not None and judge(statement, at)


def _identity_fails(statement):
    names = sorted(variables(statement.left) | variables(statement.right))
    gaps = (gap_at(statement.left, statement.right, at) for at in draws(names, 1))
    return any(gap is not None and abs(gap) > SLACK for gap in gaps)


def _implication_fails(statement):
    lows = {v.name: v.low for v in statement.variables}
    return any(
        all(holds(h, at) for h in statement.hypotheses) and fails(statement.conclusion, at)
        for at in draws(list(lows), 2, lows)
    )


def _bound_fails(statement):
    return any(
        bound is not None and abs(value(tree, at)) > number(bound) + SLACK
        for tree, bound in statement.entries
        for at in draws(sorted(variables(tree)), 3)
    )


def _positivity_fails(statement):
    return any(
        value(tree, at) < -SLACK for tree in statement.entries for at in draws(sorted(variables(tree)), 4)
    )


def _identity_holds(statement, at):
    gap = gap_at(statement.left, statement.right, at)
    return gap is not None and abs(gap) < SLACK


def _implication_holds(statement, at):
    return any(fails(h, at) for h in statement.hypotheses) or holds(statement.conclusion, at)


def _agrees_exactly(statement, at):
    exact = value(statement.formula, {name: number(text) for name, text in statement.inputs})
    return abs(exact - number(statement.printed)) < SLACK


def _domain(statement):
    low = number(statement.low) if statement.low is not None else mpmath.mpf(-30)
    high = number(statement.high) if statement.high is not None else mpmath.mpf(max(30, low + 30))
    low = min(low, high - 30) if statement.low is None else low
    inside = [low + (high - low) * k / 200 for k in range(1, 200)]
    return [x for x in (*inside, mpmath.mpf("0.001"), mpmath.mpf("-0.001")) if low < x < high]


def _norm_fails(statement, at, strict=True):
    norm = mpmath.sqrt(mpmath.fsum(value(statement.component, {"x": x}) ** 2 for x in at.values()))
    size = mpmath.sqrt(mpmath.fsum(x**2 for x in at.values())) ** statement.power
    limit = value(statement.bound, {}) * size
    return norm > limit + SLACK if strict else norm > limit


def _vectors(statement):
    names = [f"x{i + 1}" for i in range(statement.n)]
    for k in range(1, 120):
        x = mpmath.mpf(k) / 20
        yield dict.fromkeys(names, x)
        yield {**dict.fromkeys(names, mpmath.mpf(0)), "x1": x}


def _rounds_alike(statement):
    """Whether some inputs within their rounding reach the printed result within its own."""
    chance = random.Random(5)
    results = []
    for _ in range(300):
        at = {
            name: number(text) + half_unit(text) * chance.choice((-1, 0, 1))
            for name, text in statement.inputs
        }
        results.append(value(statement.formula, at))
    middle, half = number(statement.printed), half_unit(statement.printed)
    return min(results) <= middle + half + SLACK and max(results) >= middle - half - SLACK


def half_unit(text):
    mantissa, _, exponent = text.lower().partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0)
    return mpmath.mpf(10) ** -places / 2


AGAINST_TRUTH = {
    statements.Identity: _identity_fails,
    Constant: lambda s: fails(s.relation, {}),
    statements.ForAll: lambda s: any(fails(s.relation, {s.variable: x}) for x in _domain(s)),
    statements.Implies: _implication_fails,
    statements.NormBound: lambda s: any(_norm_fails(s, at) for at in _vectors(s)),
    statements.TrigonometricBound: _bound_fails,
    statements.TrigonometricPositive: _positivity_fails,
    statements.Agrees: lambda s: not _rounds_alike(s),
    EveryN: every_n_is_false,
}
AGAINST_FALSEHOOD = {
    statements.Identity: _identity_holds,
    Constant: lambda s, at: holds(s.relation, at),
    statements.ForAll: lambda s, at: holds(s.relation, at),
    statements.Implies: _implication_holds,
    statements.NormBound: lambda s, at: not _norm_fails(s, at, strict=False),
    statements.Agrees: _agrees_exactly,
    EveryN: lambda s, at: not every_n_is_false(s),
}
