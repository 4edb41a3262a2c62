"""What should vanish for all angles: exactly, at points of the circle with rational sines and cosines."""

from dataclasses import fields, is_dataclass
from fractions import Fraction

import numpy as np
from mpmath import mp

from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import CERTAIN, DIGITS, accurately, derivative, many, some_places, within
from tests.oracle.bounds import Bound

PLACES = 8


def coriolis(statement, at, w):
    """C(q, w), as printed or by Christoffel symbols."""
    if getattr(statement, "printed", ()):
        rates = np.array([*w, at.number(Fraction(1))])
        return np.array(
            [[np.array([at.value(c) for c in e]) @ rates for e in row] for row in statement.printed]
        )
    return np.array(at.symbols(statement.mass)) @ w


def _rate(statement, at, w):
    return np.einsum("kij,k->ij", np.array(at.slopes(statement.mass)), w)


def _symmetric(statement, at, w):
    mass = np.array(at.matrix(statement.mass))
    return mass - mass.T


def _sum_with_transpose(statement, at, w):
    c = coriolis(statement, at, w)
    return _rate(statement, at, w) - c - c.T


def _skew(statement, at, w):
    gap = _rate(statement, at, w) - 2 * coriolis(statement, at, w)
    return gap + gap.T


def _gradient(statement, at, w):
    slopes = (derivative(statement.potential, k, at.n) for k in range(at.n))
    return np.array([at.value(g) - at.value(u) for g, u in zip(statement.gravity, slopes, strict=True)])


GAPS = {
    "MassSymmetric": _symmetric,
    "CoriolisAtRest": lambda s, at, w: coriolis(s, at, 0 * w),
    "RateOfMass": _sum_with_transpose,
    "RateLessTwiceCoriolis": _skew,
    "CoriolisTorque": lambda s, at, w: coriolis(s, at, w) @ w - np.array(at.symbols(s.mass)) @ w @ w,
    "GravityOfPotential": _gradient,
}


def _joints(statement):
    return len(statement.mass if hasattr(statement, "mass") else statement.gravity)


@oracle.objections_to(*GAPS)
def _vanishes(statement, random):
    """A place at which a difference is not 0."""
    n, gap = _joints(statement), GAPS[type(statement).__name__]
    for place in some_places(n, statement.parameters, random, PLACES):
        w = np.array([Fraction(random.choice((-3, -2, -1, 1, 2, 5))) for _ in range(n)])
        if gap(statement, place, w).any():
            return Objection(
                "false", f"sines, cosines, parameters {list(map(str, place.generators))}, rates {w}"
            )
    return None


@oracle.judges(*GAPS)
def _differs(statement, point):
    """Whether a difference is not 0 at the posture of a witness, at its rates if it has some."""
    n = _joints(statement)
    place = within(statement, point, n, "w") or within(statement, point, n, "")
    if place is None:
        return False
    q, free, *rates = place
    with mp.workdps(2 * DIGITS):
        w = np.array([many(x) for x in (rates[0] if rates else [1] * n)])
        gap = GAPS[type(statement).__name__](statement, accurately(q, free), w)
        size = max(many(x) for x in _coefficients(statement)) * max(1, *map(abs, w))
        return bool((abs(gap) > CERTAIN**2 * size).any())


def _coefficients(data):
    """The sizes of all fractions in nested data."""
    if isinstance(data, Fraction):
        yield abs(data)
    elif is_dataclass(data):
        for field in fields(data):
            yield from _coefficients(getattr(data, field.name))
    elif isinstance(data, tuple):
        for part in data:
            yield from _coefficients(part)


@oracle.objections_to("ChainIdentity")
def _of_links(statement, random):
    """The same of links, body by body, at a random posture in 60 digits."""
    bound = Bound(statement)
    with mp.workdps(DIGITS):
        q, w = (np.array([many(random.randint(-300, 300)) / 100 for _ in range(bound.n)]) for _ in range(2))
        step = many(Fraction(1, 10**20))
        units = np.eye(bound.n, dtype=int)
        ends = [[bound._mass(q + sign * step * unit, (), many) for sign in (1, -1)] for unit in units]
        slopes = np.array([(a - b) / (2 * step) for a, b in ends])
        turned = (np.transpose(slopes, (1, 2, 0)) + np.transpose(slopes, (1, 0, 2)) - slopes) / 2
        mass, rate, c = bound._mass(q, (), many), np.einsum("kij,k->ij", slopes, w), turned @ w
        gap = {
            "symmetric": mass - mass.T,
            "at rest": turned @ (0 * w),
            "rate": rate - c - c.T,
            "skew": rate - 2 * c + (rate - 2 * c).T,
        }[statement.identity]
        broken = (abs(gap) > mp.mpf(10) ** -30).any()
    return Objection("false", f"q = {list(map(float, q))}, w = {list(map(float, w))}") if broken else None
