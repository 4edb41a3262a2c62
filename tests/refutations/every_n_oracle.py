"""The oracle for identities between vectors and matrices: mpmath at random entries for n = 3, by definitions.

Derivatives are difference quotients along the letters' own rates, in numbers of 100 digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from mpmath import mp, mpf

from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.letters.grammar import letters

SIZE, SEED = 3, 20190301
STEP = mpf(10) ** -30
CLEAR = mpf(10) ** -20
Tree = tuple[Any, ...]
Values = Mapping[Tree, Any]


def every_n_is_false(statement: EveryN) -> bool:
    """Whether the sides clearly differ at random entries that meet what is given."""
    with mp.workdps(100):
        try:
            return any(_differ(statement, _drawn(statement, seed)) for seed in (SEED, SEED + 1))
        except (ZeroDivisionError, KeyError, TypeError, ValueError):
            return False


def _differ(statement: EveryN, at: Values) -> bool:
    left, right = (_value(side, at, statement) for side in (statement.left, statement.right))
    return bool(abs(left - right) > CLEAR * (abs(left) + abs(right) + CLEAR))


def _drawn(statement: EveryN, seed: int) -> Values:
    """Random values of the letters; vectors that something is given for are solved for."""
    generator = np.random.default_rng(seed)
    trees = [statement.left, statement.right, *(tree for pair in statement.rates for tree in pair)]
    trees += [known.equals for known in statement.given]
    trees += [("vec", known.vector) for known in statement.given] + [
        ("mat", k.matrix) for k in statement.given
    ]
    at: dict[Tree, Any] = {}
    for letter in sorted(set().union(*map(letters, trees))):
        shape = {"var": (), "vec": (SIZE, 1), "mat": (SIZE, SIZE)}[letter[0]]
        drawn = generator.uniform(0.2, 1.8, shape)
        if letter[1] in statement.symmetric:
            drawn = drawn + drawn.T
        at[letter] = mpmath.matrix(drawn.tolist()) if shape else mpf(float(drawn))
    for known in statement.given:
        right = _value(known.equals, at, statement)
        at[("vec", known.vector)] = mpmath.lu_solve(at[("mat", known.matrix)], right)
    return at


def _value(tree: Tree, at: Values, statement: EveryN) -> Any:
    kind, *rest = tree
    if kind in ("var", "vec", "mat"):
        return at[tree]
    if kind == "num":
        exact = Fraction(rest[0])
        return mpf(exact.numerator) / exact.denominator
    if kind == "diag":
        return mpmath.diag(list(at[("vec", rest[0])]))
    if kind == "rate":
        return _slope(rest[0], at, statement)
    parts = [_value(part, at, statement) if isinstance(part, tuple) else part for part in rest]
    return BY_DEFINITION[kind](*parts)


def _slope(tree: Tree, at: Values, statement: EveryN) -> Any:
    """The symmetric difference quotient of an expression, every letter moved by its rate."""
    speeds = {letter: _value(value, at, statement) for letter, value in statement.rates}
    ends = [
        _value(tree, {**at, **{x: at[x] + s * STEP * v for x, v in speeds.items()}}, statement)
        for s in (1, -1)
    ]
    return (ends[0] - ends[1]) / (2 * STEP)


def _sum(*parts: Any) -> Any:
    return sum(parts[1:], parts[0]) if parts else mpmath.zeros(SIZE, 1)


BY_DEFINITION = {
    "dot": lambda x, y: (x.T * y)[0],
    "apply": lambda a, x: a * x,
    "scale": lambda s, x: s * x,
    "mul": lambda *parts: mpmath.fprod(parts),
    "add": _sum,
    "sum": _sum,
    "neg": lambda a: -a,
    "div": lambda a, b: a / b,
    "pow": lambda a, k: a**k,
    "transpose": lambda a: a.T,
}
