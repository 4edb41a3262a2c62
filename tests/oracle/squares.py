"""Sums of squares by their values at random points, in fractions: no polynomial is multiplied out here.

For sines and cosines of an argument there are random points of the unit circle.
"""

from fractions import Fraction
from math import prod

from tests.oracle.trees import Evaluation, names

POINTS, SIZE = 5, 10**9
"""Polynomials that differ, of a degree below 100, agree at all points for one seed in 10^30 at most."""


def shows(document, random):
    """Whether a certificate proves its statement; the numbers in it may be anything, its form is right."""
    statement, proof = document["statement"], document["proof"]
    relations = [*statement["hypotheses"], statement["conclusion"]]
    gaps = [(_tree(one["left"]), _tree(one["right"])) for one in relations]
    letters = sorted(names(*(side for gap in gaps for side in gap)))
    turned = []
    for side in (side for gap in (gaps[-1], *gaps[:-1]) for side in gap[::-1]):
        _circular(side, turned)
    circular = [[bool(_circular(side, [])) for side in gap] for gap in gaps]
    gaps = [tuple(_plain(side, turned) for side in gap) for gap in gaps]
    known = {one["name"]: one for one in statement["variables"]}
    lows = [Fraction(known[name]["low"] or 0) for name in letters]
    signs = [
        None if known[name]["low"] is None else "> 0" if known[name]["strict"] else ">= 0" for name in letters
    ]
    names_of_all = [*letters, *(f"{wave} {k}" for k, _ in enumerate(turned) for wave in ("sin", "cos"))]
    lows += [Fraction(0)] * (2 * len(turned))
    signs += [None] * (2 * len(turned))
    points = []
    for _ in range(POINTS):
        u = [Fraction(random.randint(-SIZE, SIZE), random.randint(1, SIZE)) for _ in turned]
        waves = [value for x in u for value in (2 * x / (1 + x**2), (1 - x**2) / (1 + x**2))]
        points.append([*(Fraction(random.randint(-SIZE, SIZE)) for _ in letters), *waves])
    at_points = [_gaps(gaps, names_of_all, lows, t) for t in points]
    known_0 = {
        k
        for k, _ in enumerate(gaps[:-1])
        if any(all(one[k] == -one[j] for one in at_points) for j, _ in enumerate(gaps[:-1]))
    }
    products = proof["products"]
    forms = [proof["lift"], *(one["squares"] for one in products if one["hypothesis"] not in known_0)]
    if any(Fraction(d) < 0 for form in forms for d in form["diagonal"]):
        return False
    free = (one for one in products if one["hypothesis"] not in known_0)
    if any(signs[i] is None and k % 2 for one in free for i, k in one["monomial"]):
        return False
    for t, values in zip(points, at_points, strict=True):
        right = sum(
            (
                _monomial(one["monomial"], t)
                * _form(one["squares"], t)
                * (1 if one["hypothesis"] is None else values[:-1][one["hypothesis"]])
                for one in products
            ),
            start=Fraction(0),
        )
        if (1 + _form(proof["lift"], t)) * values[-1] != right:
            return False
    if statement["conclusion"]["operator"] == "<=":
        return True
    strict = [one["operator"] == "<" for one in relations]
    at_zero = _gaps(gaps, names_of_all, lows, [Fraction(0)] * len(names_of_all))[:-1]
    excluded = "> 0" in signs or any(
        (value < 0 or (value == 0 and open_)) and not any(waves)
        for value, open_, waves in zip(at_zero, strict, circular, strict=False)
    )
    able = (one for one in products if one["hypothesis"] not in known_0)
    return any(_positive(one, signs, strict, excluded, len(letters)) for one in able)


def _positive(one, signs, strict, excluded, count):
    """Whether a product is positive wherever the hypotheses hold."""
    vector = [{i: sum(k for j, k in z if j == i) for i, _ in z} for z in one["squares"]["monomials"]]
    never_0 = any(all(signs[i] == "> 0" for i in z) for z in vector)
    at_0_alone = excluded and all({i: 1} in vector for i in range(count))
    return (
        all(Fraction(d) > 0 for d in one["squares"]["diagonal"])
        and all(signs[i] == "> 0" for i, _ in one["monomial"])
        and (one["hypothesis"] is None or strict[one["hypothesis"]])
        and (never_0 or at_0_alone)
    )


def _gaps(gaps, letters, lows, t):
    evaluation = Evaluation({name: low + x for name, low, x in zip(letters, lows, t, strict=True)})
    return [evaluation.of(right) - evaluation.of(left) for left, right in gaps]


def _monomial(monomial, t):
    return prod((t[i] ** k for i, k in monomial), start=Fraction(1))


def _form(form, t):
    """zᵀ(L D Lᵀ)z by the entries of the matrix."""
    z = [_monomial(one, t) for one in form["monomials"]]
    lower = [[*map(Fraction, row), Fraction(1)] for row in form["lower"]]
    weights = list(map(Fraction, form["diagonal"]))
    return sum(
        (
            z[i] * z[j] * sum(lower[i][k] * weights[k] * lower[j][k] for k in range(min(i, j) + 1))
            for i in range(len(z))
            for j in range(len(z))
        ),
        start=Fraction(0),
    )


def _circular(tree, found):
    """The arguments of sines and cosines, in the order in which they are come to."""
    for part in tree[1:]:
        if isinstance(part, tuple):
            _circular(part, found)
    if tree[0] in ("sin", "cos") and tree[1] not in found:
        found.append(tree[1])
    return found


def _plain(tree, turned):
    """The expression with names for sines and cosines."""
    if tree[0] in ("sin", "cos"):
        return ("var", f"{tree[0]} {turned.index(tree[1])}")
    return tuple(_plain(part, turned) if isinstance(part, tuple) else part for part in tree)


def _tree(data):
    return tuple(_tree(part) if isinstance(part, list) else part for part in data)
