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

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
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


# Upper bounds, at n = 1, where every letter is a number and norms are attained -----------------------------

DRAWS = 300


def bound_every_n_is_false(statement: BoundEveryN) -> bool:
    """Whether the left side clearly exceeds the right at random numbers that meet all bounds of norms."""
    with mp.workdps(100):
        return any(_exceeds(statement, np.random.default_rng(seed)) for seed in range(DRAWS))


def _exceeds(statement: BoundEveryN, generator: np.random.Generator) -> bool:
    try:
        at = _numbers(statement, generator)
        meets = all(
            mpmath.fprod(abs(_number(x, at, statement)) for x in known)
            <= _number(size, at, statement) + CLEAR
            for known, size in statement.norms
        )
        meets &= all(
            _number(number, at, statement) >= _number(size, at, statement) for number, size in statement.least
        )
        left, right = (_number(side, at, statement) for side in (statement.left, statement.right))
    except (ZeroDivisionError, KeyError, TypeError, ValueError):
        return False
    return bool(meets and left - right > CLEAR * (abs(left) + abs(right) + CLEAR))


def _numbers(statement: BoundEveryN, generator: np.random.Generator) -> Values:
    """Numbers for all letters, as large as their norms may be or, now and then, smaller."""
    trees = [statement.left, *(tree for pair in statement.rates for tree in pair)]
    trees += [number for number, _ in statement.least]
    trees += [tree for known in statement.given for tree in (known.equals, ("mat", known.matrix))]
    every = set().union(*map(letters, trees), *(letters(x) for known, _ in statement.norms for x in known))
    at: dict[Tree, Any] = {("var", n): _size(generator) for n in sorted(statement.numbers)}
    sizes = list(at.values())
    for letter in sorted(every - set(at)):
        at[letter] = (
            sizes[generator.integers(len(sizes))] if sizes and generator.random() < 0.5 else _size(generator)
        )
    seen: set[Tree] = set()
    for known, size in sorted(statement.norms, key=lambda pair: len(pair[0])):
        letter = known[0] if known[0][0] != "diag" else ("vec", known[0][1])
        most = _number(size, at, statement) / mpmath.fprod(_number(x, at, statement) for x in known[1:])
        at[letter] = min(at[letter], most) if letter in seen or letter[0] == "var" else most
        seen.add(letter)
    for letter in sorted(every):
        if letter[0] != "var" and letter[1] not in statement.symmetric and generator.random() < 0.5:
            at[letter] = -at[letter]
    for known_here in statement.given:
        right = _number(known_here.equals, at, statement)
        at[("vec", known_here.vector)] = right / at[("mat", known_here.matrix)]
    return at


def _size(generator: np.random.Generator) -> mpf:
    return mpf(float(10 ** generator.uniform(-1, 1)))


def _number(tree: Tree, at: Values, statement: BoundEveryN) -> Any:
    """The value at n = 1."""
    kind, *rest = tree
    if kind in ("var", "vec", "mat", "diag"):
        return at[("vec", rest[0])] if kind == "diag" else at[tree]
    if kind == "num":
        exact = Fraction(rest[0])
        return mpf(exact.numerator) / exact.denominator
    if kind in ("gamma", "rho", "L"):
        from tests.refutations.oracle import family_number

        return mpf(family_number(kind, rest[0]))
    if kind == "rate":
        speeds = {letter: _number(value, at, statement) for letter, value in statement.rates}
        ends = [
            _number(rest[0], {**at, **{x: at[x] + s * STEP * v for x, v in speeds.items()}}, statement)
            for s in (1, -1)
        ]
        return (ends[0] - ends[1]) / (2 * STEP)
    return AT_ONE[kind](*(_number(x, at, statement) if isinstance(x, tuple) else x for x in rest))


def _product(*parts: Any) -> Any:
    return mpmath.fprod(parts)


AT_ONE = {
    **dict.fromkeys(("dot", "apply", "scale", "mul"), _product),
    **dict.fromkeys(("add", "sum"), lambda *parts: mpmath.fsum(parts)),
    "neg": lambda a: -a,
    "div": lambda a, b: a / b,
    "pow": lambda a, k: a**k,
    "transpose": lambda a: a,
    "sqrt": mpmath.sqrt,
}
