"""What should vanish for all angles: exactly, at points of the circle with rational sines and cosines."""

from fractions import Fraction

import numpy as np
from mpmath import mp

from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import DIGITS, derivative, many, some_places
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
