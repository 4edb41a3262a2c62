"""Points of a box at which a statement may fail: ends, special numbers, zeros, lowest places."""

from fractions import Fraction

import numpy as np

from tests.oracle.numbers import Undefined, Unsure
from tests.oracle.trees import Evaluation, floats, names

GRID = 400
SCATTER = 800
KEPT = 5
DENOMINATORS = (12, 1000, 10**6, 10**12)
GUARDED = ("div", "sqrt", "log", "tan", "asin", "acos")


def candidates(region, random):
    """Points to try, the cheap ones first."""
    if not region.axes:
        yield {}
        return
    if len(region.axes) == 1:
        yield from _on_a_line(region, random)
        return
    yield from _special(region, random)
    yield from _guided(region, random)


def _on_a_line(region, random):
    (axis,) = region.axes
    for value in special_values(region, axis, random):
        yield {axis.name: value}
    yield from _guided(region, random)


def special_values(region, axis, random):
    """Ends, places beside them, the numbers of the statement, small numbers, roots and turns."""
    numbers = [Fraction(node[1]) for node in region.nodes() if node[0] == "num"]
    result = [end for end in (axis.low, axis.high) if end is not None]
    tiny = Fraction(1, 10 ** random.choice((1, 3, 9, 20)))
    result += [end + s * tiny for end in result for s in (1, -1)]
    result += [Fraction(0), Fraction(1), Fraction(-1), Fraction(1, 2), Fraction(2)]
    result += [s * a for a in dict.fromkeys(numbers) for s in (1, -1) if a]
    result += [a / b for a in numbers[:6] for b in numbers[:6] if b]
    result += [Fraction(random.randint(-40, 40), random.randint(1, 8)) for _ in range(4)]
    result += [Fraction(s * 10**k) for k in (2, 5, 7, 13, random.randint(14, 40)) for s in (1, -1)]
    kinds = {node[0] for node in region.nodes()}
    if kinds & {"sin", "cos", "tan"}:
        turns = (*(Fraction(k, 2) for k in (-3, -2, -1, 1, 2, 3)), *(Fraction(k, 4) for k in (-1, 1, 3)))
        result += [("mul", ("pi",), ("num", str(turn))) for turn in turns]
    if kinds & {"div", "sqrt"}:
        roots = [("sqrt", ("num", str(abs(a)))) for a in numbers[:4] if a]
        result += [one for root in roots for one in (root, ("neg", root))]
    return [value for value in dict.fromkeys(result) if axis.holds(_near(value))]


def _near(value):
    return Evaluation({}).of(value) if isinstance(value, tuple) else value


def _special(region, random):
    pools = {axis.name: special_values(region, axis, random) for axis in region.axes}
    base = {name: _rational(random, region, name) for name in pools}
    yield {axis.name: axis.low or Fraction(0) for axis in region.axes}
    for name, pool in pools.items():
        for value in pool[:8]:
            yield base | {name: value}
    for _ in range(24):
        yield {name: random.choice(pool) for name, pool in pools.items()}
    for _ in range(6):
        same = random.choice(pools[random.choice(list(pools))])
        yield dict.fromkeys(pools, same)
        drawn = {name: _rational(random, region, name) for name in pools}
        yield drawn
        some = random.sample(list(pools), min(2, len(pools)))
        yield drawn | dict.fromkeys(some, drawn[some[0]])


def _rational(random, region, name):
    axis = next(axis for axis in region.axes if axis.name == name)
    size = Fraction(random.randint(1, 60), random.randint(1, 12))
    if axis.low is not None and axis.high is not None:
        return axis.low + (axis.high - axis.low) * Fraction(random.randint(1, 99), 100)
    if axis.low is not None:
        return axis.low + size
    return axis.high - size if axis.high is not None else size * random.choice((1, -1))


# Points that floating point suggests ------------------------------------------------------------------------


def _guided(region, random):
    """Lowest places of the gaps and of what must not vanish or be negative, zeros of divisors first."""
    generator = np.random.default_rng(random.getrandbits(32))
    with np.errstate(all="ignore"):
        points = {axis.name: _drawn(axis, generator, len(region.axes)) for axis in region.axes}
        known = {}
        for target in _targets(region):
            score = _score(target, region, points, known)
            yield from _best(target, score, points, region, generator)
    yield from _on_borders(region, random)


def _targets(region):
    """What to make small: the size of a divisor, the argument of a root, the gap of a claim."""
    result = {}
    for node in region.nodes():
        if node[0] in GUARDED and (part := _guarded(node)) is not None and names(part[1]):
            result[part] = None
    for left, operator, right in region.claims:
        result["size" if operator == "=" else "gap", ("add", right, ("neg", left))] = None
    return list(result)


def _guarded(node):
    kind, *parts = node
    if kind == "div":
        return "zero", parts[1]
    if kind == "tan":
        return "zero", ("cos", parts[0])
    if kind in ("asin", "acos"):
        return "least", ("add", ("num", "1"), ("neg", ("abs", parts[0])))
    return "least", parts[0]


def _drawn(axis, generator, dimensions):
    count = GRID if dimensions == 1 else SCATTER
    low = None if axis.low is None else float(axis.low)
    high = None if axis.high is None else float(axis.high)
    if low is not None and high is not None:
        even = low + (high - low) * generator.random(count)
        return np.sort(even) if dimensions == 1 else even
    size = np.exp(generator.uniform(-7, 5, count))
    if low is not None:
        result = low + size
    elif high is not None:
        result = high - size
    else:
        result = size * generator.choice([-1.0, 1.0], count)
    return np.sort(result) if dimensions == 1 else result


def _score(target, region, points, known):
    what, tree = target
    count = len(next(iter(points.values())))
    if what == "gap":
        right, left = tree[1], tree[2][1]
        a, b = floats(left, points, known), floats(right, points, known)
        value = (b - a) / (np.abs(a) + np.abs(b) + 1e-300)
        for given in region.hypotheses:
            c, d = floats(given[0], points, known), floats(given[2], points, known)
            value = np.where(d - c >= -1e-12 * (np.abs(c) + np.abs(d)), value, np.inf)
    else:
        value = floats(tree, points, known)
        value = -np.abs(value) if what == "size" else np.abs(value) if what == "zero" else value
    return np.where(np.isnan(value), np.inf, value) + np.zeros(count)


def _best(target, score, points, region, generator):
    """The points of lowest score and what a few rounds of small moves make of them."""
    order = np.argsort(score, kind="stable")[:KEPT]
    if not np.isfinite(score[order[0]]):
        return
    best = {name: column[order] for name, column in points.items()}
    yield from _rounded(best, region, 1)
    if target[0] == "gap" and score[order[0]] < -1e-9:
        return
    width = 0.2
    rounds = 9
    for _ in range(rounds):
        moved = {name: np.repeat(column, 24) for name, column in best.items()}
        for axis in region.axes:
            column = moved[axis.name]
            step = generator.normal(size=column.size) * width * (generator.random(column.size) < 0.7)
            base = float(axis.low) if axis.low is not None and axis.high is None else 0.0
            column = base + (column - base) * np.exp(step) if axis.high is None else column + step
            ends = (float(e) if e is not None else None for e in (axis.low, axis.high))
            column = np.clip(column, *ends) if axis.low is not None or axis.high is not None else column
            moved[axis.name] = np.concatenate([column, best[axis.name]])
        again = _score(target, region, moved, {})
        keep = np.argsort(again, kind="stable")[:3]
        best = {name: column[keep] for name, column in moved.items()}
        width *= 0.2
    yield from _rounded(best, region, 2)


def _rounded(best, region, how_many):
    """Rational points near: short ones, and the floating-point number itself."""
    for k in range(min(how_many, len(next(iter(best.values()))))):
        if not all(np.isfinite(column[k]) for column in best.values()):
            continue
        exactly = {name: Fraction(float(column[k])) for name, column in best.items()}
        for bound in DENOMINATORS:
            yield {name: value.limit_denominator(bound) for name, value in exactly.items()}
        yield dict(exactly)


def _on_borders(region, random):
    """Points where hypotheses hold with equality, or divisors vanish, by a variable that enters linearly."""
    gaps = [("add", right, ("neg", left)) for left, _, right in region.hypotheses]
    zeros = [part for node in region.nodes() if node[0] == "div" and names(part := node[2])]
    for _ in range(3):
        start = {axis.name: _rational(random, region, axis.name) for axis in region.axes}
        for zero in zeros[:3]:
            moved = _moved(zero, start, random)
            if moved is not None:
                yield moved
        point = dict(start)
        for gap in random.sample(gaps, len(gaps)):
            result = _moved(gap, point, random) if point is not None else None
            point = result if result is not None else point
        if gaps and point is not None:
            yield point
            yield {name: value * (1 + Fraction(1, 10**7)) for name, value in point.items()}


def _moved(tree, point, random):
    """The point moved in one variable to a zero of an expression that is linear in it."""
    own = sorted(names(tree))
    random.shuffle(own)
    for name in own:
        try:
            at = [Evaluation(point | {name: Fraction(t)}).of(tree) for t in (1, 2, 3)]
        except (Undefined, Unsure, ZeroDivisionError):
            continue
        if all(isinstance(value, Fraction) for value in at):
            slope = at[1] - at[0]
            if slope and at[2] - at[1] == slope:
                return point | {name: 1 - at[0] / slope}
    return None
