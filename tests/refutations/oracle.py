"""Whether a statement is false, by numbers alone: an independent evaluator, many points, many digits.

Nothing of lyapcheck's arithmetic or searches is used. ``True`` means that a point has been found at which the
statement clearly fails; ``False`` means only that none was found.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import product
from typing import Any

import mpmath
import numpy as np
from mpmath import mp, mpf

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.claims import (
    Agrees,
    Constant,
    ForAll,
    ForSmall,
    Identity,
    Implies,
    NormBound,
    Relation,
    Statement,
    TrigonometricBound,
    TrigonometricPositive,
    Variable,
)
from tests.refutations.every_n_oracle import bound_every_n_is_false, every_n_is_false

Tree = tuple[Any, ...]
Point = dict[str, Any]

DIGITS = 120
SEED = 1871
SAMPLES = 6_000
CONFIRMED = 16
BORDER = 3
CLEAR = mpf(10) ** -20
EQUAL = mpf(10) ** -100
ALIAS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}


def is_false(statement: Statement) -> bool:
    """Whether a point shows that a statement fails."""
    with mp.workdps(DIGITS), np.errstate(all="ignore"):
        return ORACLES[type(statement)](statement)


# Values ---------------------------------------------------------------------------------------------------


def value(tree: Tree, point: Mapping[str, Any], lib: Any, memo: dict[int, Any] | None = None) -> Any:
    """An expression at a point, in NumPy (``lib = np``) or to ``DIGITS`` digits (``lib = mpmath``)."""
    memo = {} if memo is None else memo
    if id(tree) not in memo:
        memo[id(tree)] = _value(tree, point, lib, memo)
    return memo[id(tree)]


def _value(tree: Tree, point: Mapping[str, Any], lib: Any, memo: dict[int, Any]) -> Any:
    kind, *rest = tree
    if kind in ("num", "var", "pi", "gamma", "rho", "L"):
        return _leaf(kind, rest, point, lib)
    if kind in ("h", "dh", "potential"):
        return family_value(kind, rest[0], value(rest[1], point, lib, memo), lib)
    if kind == "pow":
        return value(rest[0], point, lib, memo) ** rest[1]
    return _operation(kind, [value(part, point, lib, memo) for part in rest], lib)


def _leaf(kind: str, rest: list[Any], point: Mapping[str, Any], lib: Any) -> Any:
    if kind == "num":
        top, _, bottom = rest[0].partition("/")
        return _number(top, lib) / _number(bottom or "1", lib)
    if kind == "var":
        return point[rest[0]]
    if kind == "pi":
        return lib.pi + _number("0", lib)
    return family_number(kind, rest[0]) if lib is mpmath else float(family_number(kind, rest[0]))


def _operation(kind: str, parts: list[Any], lib: Any) -> Any:
    if kind == "add":
        return sum(parts[1:], parts[0])
    if kind == "mul":
        result = parts[0]
        for part in parts[1:]:
            result = result * part
        return result
    if kind == "neg":
        return -parts[0]
    if kind == "div":
        return parts[0] / parts[1]
    if kind == "abs":
        return abs(parts[0])
    return getattr(lib, ALIAS.get(kind, kind) if lib is np else kind)(parts[0])


def _number(text: str, lib: Any) -> Any:
    return mpf(text) if lib is mpmath else float(text)


def family_value(kind: str, m: int, x: Any, lib: Any) -> Any:
    """h_m = s^(2m−1) c/(1 + s^(2m)), its derivative by the quotient rule, or U_m = ln(1 + s^(2m))/(2m)."""
    s, c = lib.sinh(x), lib.cosh(x)
    bottom = 1 + s ** (2 * m)
    if kind == "h":
        return s ** (2 * m - 1) * c / bottom
    if kind == "potential":
        return lib.log(bottom) / (2 * m)
    slope = s ** (2 * m) + (2 * m - 1) * s ** (2 * m - 2) * c**2
    return (slope * bottom - 2 * m * s ** (4 * m - 2) * c**2) / bottom**2


@lru_cache(maxsize=64)
def family_number(kind: str, m: int) -> mpf:
    """γ_m, ρ_m or L_m, by a grid and a ternary search."""
    if m == 1:
        return mpf(1)
    with mp.workdps(DIGITS):

        def size(x: Any, lib: Any) -> Any:
            if kind == "rho":
                return abs(family_value("dh", m, x, lib))
            return family_value("h", m, x, lib) / (x if kind == "L" else 1)

        grid = np.linspace(0.01, 8.0, 4001)
        best = float(grid[int(np.argmax(size(grid, np)))])
        low, high = mpf(best) - mpf("0.003"), mpf(best) + mpf("0.003")
        for _ in range(150):
            third = (high - low) / 3
            rises = size(low + third, mpmath) < size(high - third, mpmath)
            low, high = (low + third, high) if rises else (low, high - third)
        return size((low + high) / 2, mpmath)


# Points ---------------------------------------------------------------------------------------------------


def _gap(relation: Relation, point: Mapping[str, Any]) -> tuple[mpf, mpf]:
    """Right minus left, and the size against which it counts: that of the terms, not of their sum."""
    memo: dict[int, Any] = {}
    left, right = (
        mpmath.mpmathify(value(side, point, mpmath, memo)) for side in (relation.left, relation.right)
    )
    size = scale(relation.left, point, memo) + scale(relation.right, point, memo)
    return right - left, size + mpf(10) ** -30


def scale(tree: Tree, point: Mapping[str, Any], memo: dict[int, Any]) -> mpf:
    """The size of an expression with sums of sizes for sums: what rounding is relative to."""
    kind, *rest = tree
    if kind == "add":
        return sum(scale(part, point, memo) for part in rest)
    if kind == "neg":
        return scale(rest[0], point, memo)
    if kind == "mul":
        return mpmath.fprod(scale(part, point, memo) for part in rest)
    if kind == "div":
        return scale(rest[0], point, memo) / abs(value(rest[1], point, mpmath, memo))
    if kind == "pow":
        return scale(rest[0], point, memo) ** rest[1]
    return abs(value(tree, point, mpmath, memo))


def breaks(relation: Relation, point: Mapping[str, Any]) -> bool:
    """Whether a relation clearly fails at a point: by more than 10⁻²⁰, or by equality where it is strict."""
    try:
        gap, size = _gap(relation, point)
    except (ZeroDivisionError, ValueError, OverflowError, TypeError):
        return False
    if isinstance(gap, mpmath.mpc) or not mpmath.isfinite(gap):
        return False
    return gap < -CLEAR * size or (relation.strict and abs(gap) <= EQUAL * size)


def meets(relation: Relation, point: Mapping[str, Any]) -> bool:
    """Whether a relation holds at a point; equality to 100 digits is taken for equality."""
    try:
        gap, size = _gap(relation, point)
    except (ZeroDivisionError, ValueError, OverflowError, TypeError):
        return False
    if isinstance(gap, mpmath.mpc) or not mpmath.isfinite(gap):
        return False
    return gap > CLEAR * size if relation.strict else gap >= -EQUAL * size


def _lowest(relation: Relation, points: dict[str, Any]) -> np.ndarray[Any, Any]:
    """The relative gap at many points in floating point; what is undefined counts as infinite."""
    left, right = (
        np.asarray(value(side, points, np), dtype=float) for side in (relation.left, relation.right)
    )
    gap = (right - left) / (np.abs(left) + np.abs(right) + 1e-300)
    count = len(next(iter(points.values())))
    return np.where(np.isfinite(gap), gap, np.inf) + np.zeros(count)


def _exactly(points: dict[str, Any], index: int) -> Point:
    return {name: mpf(float(column[index])) for name, column in points.items()}


# One kind of statement after the other --------------------------------------------------------------------


def _identity(statement: Identity) -> bool:
    names = sorted(names_in(statement.left) | names_in(statement.right))
    generator = np.random.default_rng(SEED)
    for _ in range(3):
        point = {name: mpf(float(generator.uniform(0.2, 1.8))) for name in names}
        left, right = (value(side, point, mpmath) for side in (statement.left, statement.right))
        if abs(left - right) > CLEAR * (abs(left) + abs(right) + mpf(10) ** -12):
            return True
    return False


def _for_all(statement: ForAll) -> bool:
    low = -30.0 if statement.low is None else float(statement.low)
    high = max(30.0, low + 30) if statement.high is None else float(statement.high)
    fine = np.concatenate([s * np.geomspace(1e-5, 30, 2000) for s in (-1, 1)])
    grid = np.concatenate([np.linspace(low, high, 8001), fine[(fine > low) & (fine < high)]])
    order = np.argsort(_lowest(statement.relation, {statement.variable: grid}), kind="stable")[:CONFIRMED]
    ends = [mpf(e.numerator) / e.denominator for e in (statement.low, statement.high) if e is not None]
    points = [mpf(float(grid[k])) for k in order] + ends + [mpf(0)]
    inside = [p for p in points if _inside(p, statement)]
    return any(breaks(statement.relation, {statement.variable: p}) for p in inside)


def _inside(point: mpf, statement: ForAll) -> bool:
    low, high = (
        None if e is None else mpf(e.numerator) / e.denominator for e in (statement.low, statement.high)
    )
    above = low is None or point > low or (point == low and not statement.open_low)
    return above and (high is None or point < high or (point == high and not statement.open_high))


def _constant(statement: Constant) -> bool:
    return breaks(statement.relation, {})


def _norm_bound(statement: NormBound) -> bool:
    grid = np.concatenate([np.linspace(-20, 20, 4001), np.geomspace(1e-5, 20, 1000)])
    size = np.abs(value(statement.component, {"x": grid}, np)) + 0 * grid
    best = [
        mpf(float(grid[k])) for k in np.argsort(-np.nan_to_num(size / np.abs(grid) ** statement.power))[:3]
    ]
    best += [mpf(float(t)) for t in (1e-4, 0.5, 20.0)]
    n, zero = statement.n, mpf(0)
    vectors = [[zero] * n] + [v for t in best for v in ([t] * n, [t] + [zero] * (n - 1))]
    bound = mpmath.mpmathify(value(statement.bound, {}, mpmath))
    for vector in vectors:
        left = mpmath.sqrt(sum(value(statement.component, {"x": t}, mpmath) ** 2 for t in vector))
        norm = mpmath.sqrt(sum(t**2 for t in vector)) if statement.power else mpf(1)
        if left > bound * norm + CLEAR * (1 + left):
            return True
    return False


def _draw(variables: tuple[Variable, ...], count: int) -> dict[str, Any]:
    generator = np.random.default_rng(SEED)
    points = {}
    for v in variables:
        size = 10 ** generator.uniform(-2.0, 2.0, count)
        bounded = v.low is not None
        points[v.name] = float(v.low or 0) + size if bounded else size * generator.choice([-1, 1], count)
    return points


def _implies(statement: Implies) -> bool:
    return any(
        breaks(statement.conclusion, point) and all(meets(h, point) for h in statement.hypotheses)
        for point in _tried(statement.variables, statement.hypotheses, statement.conclusion)
    )


def _tried(variables: tuple[Variable, ...], given: tuple[Relation, ...], wanted: Relation) -> Iterator[Point]:
    """Points that meet the hypotheses and are low; points moved to the border of them; points with zeros."""
    points = _draw(variables, SAMPLES)
    fits = np.ones(SAMPLES, dtype=bool)
    for relation in given:
        fits &= _lowest(relation, points) > 1e-9
    score = np.where(fits, _lowest(wanted, points), np.inf)
    order = np.argsort(score, kind="stable")[:CONFIRMED]
    yield from (_exactly(points, k) for k in order)
    for k in (*order[:BORDER], *range(BORDER)):
        point = _exactly(points, int(k))
        yield _to_border(point, given, variables)
    ends = {v.name: mpf(float(v.low or 0)) for v in variables if v.low is None or not v.strict}
    for at_end in [ends, *({name: end} for name, end in ends.items())]:
        base = _exactly(points, int(order[0])) | at_end
        yield base
        yield _to_border(base, given, variables)


def _to_border(point: Point, given: tuple[Relation, ...], variables: tuple[Variable, ...]) -> Point:
    """The point moved so that the hypotheses hold with equality, where one variable can do that linearly."""
    fixed: set[str] = set()
    for relation in reversed(given):
        for v in variables:
            used = v.name in names_in(relation.left) | names_in(relation.right)
            new = _root(point, relation, v) if used and v.name not in fixed else None
            if new is not None:
                point = point | {v.name: new}
                fixed |= names_in(relation.left) | names_in(relation.right)
                break
    return point


def _difference(relation: Relation, point: Point) -> mpf:
    memo: dict[int, Any] = {}
    return value(relation.right, point, mpmath, memo) - value(relation.left, point, mpmath, memo)


def _root(point: Point, relation: Relation, variable: Variable) -> mpf | None:
    try:
        at = [_difference(relation, point | {variable.name: mpf(t)}) for t in (1, 2, 3)]
    except (ZeroDivisionError, ValueError, OverflowError, TypeError):
        return None
    slope = at[1] - at[0]
    if slope == 0 or abs(at[2] - at[1] - slope) > EQUAL * (abs(slope) + 1):
        return None
    root = 1 - at[0] / slope
    low = variable.low
    return root if low is None or root > low.numerator else None


def _for_small(statement: ForSmall) -> bool:
    variables = statement.variables + tuple(Variable(name, None) for name in statement.bounded)
    points = _draw(variables, SAMPLES)
    for name in statement.bounded:
        points[name] = np.abs(points[name]) / 100.0
    points[statement.small] = np.full(SAMPLES, 1e-7)
    fits = np.ones(SAMPLES, dtype=bool)
    for relation in statement.hypotheses:
        fits &= _lowest(relation, points) > 1e-9
    score = np.where(fits, _lowest(statement.conclusion, points), np.inf)
    for k in np.argsort(score, kind="stable")[:CONFIRMED]:
        for point in (p := _exactly(points, int(k)), _to_border(p, statement.hypotheses, variables)):
            smaller = [point | {statement.small: mpf(10) ** -e} for e in (8, 12, 16)]
            holds = all(meets(h, point) for h in statement.hypotheses)
            if holds and all(breaks(statement.conclusion, s) for s in smaller):
                return True
    return False


def _agrees(statement: Agrees) -> bool:
    """False if the results over the corners and the middle stay clear of the printed interval."""
    ranges = [[(name, end) for end in _half_units(text)] for name, text in statement.inputs]
    results = [value(statement.formula, dict(ends), mpmath) for ends in product(*ranges)]
    if any(isinstance(result, mpmath.mpc) for result in results):
        return False
    low, _, high = _half_units(statement.printed)
    margin = (max(results) - min(results)) / 20 + CLEAR
    return max(results) + margin < low or min(results) - margin > high


def _half_units(text: str) -> tuple[mpf, mpf, mpf]:
    decimals = len(text.partition(".")[2])
    half = mpf(10) ** -decimals / 2
    return mpf(text) - half, mpf(text), mpf(text) + half


def _angles(trees: tuple[Tree, ...]) -> dict[str, Any]:
    names = sorted(set().union(*(names_in(tree) for tree in trees)))
    generator = np.random.default_rng(SEED)
    quarter = generator.integers(0, 4, (len(names), 2000)) * (np.pi / 2)
    columns = {n: np.concatenate([generator.uniform(-4, 4, 20_000), quarter[i]]) for i, n in enumerate(names)}
    return columns or {"none": np.zeros(1)}


def _trigonometric_bound(statement: TrigonometricBound) -> bool:
    points = _angles(tuple(tree for tree, _ in statement.entries))
    return any(
        bound is not None
        and bool(np.any(np.abs(value(tree, points, np)) > float(bound) * (1 + 1e-9) + 1e-12))
        for tree, bound in statement.entries
    )


def _trigonometric_positive(statement: TrigonometricPositive) -> bool:
    points = _angles(statement.entries)
    return any(bool(np.any(value(tree, points, np) < -1e-12)) for tree in statement.entries)


@lru_cache(maxsize=4096)
def names_in(tree: Tree) -> frozenset[str]:
    """The names of the variables of an expression."""
    if tree[0] == "var":
        return frozenset([tree[1]])
    return frozenset().union(*(names_in(part) for part in tree[1:] if isinstance(part, tuple)))


ORACLES: dict[type[Statement], Any] = {
    Identity: _identity,
    ForAll: _for_all,
    Constant: _constant,
    NormBound: _norm_bound,
    Implies: _implies,
    ForSmall: _for_small,
    Agrees: _agrees,
    BoundEveryN: bound_every_n_is_false,
    TrigonometricBound: _trigonometric_bound,
    TrigonometricPositive: _trigonometric_positive,
    EveryN: every_n_is_false,
}
