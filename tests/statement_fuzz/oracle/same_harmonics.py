"""What should vanish for all angles: exactly, at points of the circle with rational sines and cosines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import (
    CERTAIN,
    DIGITS,
    Place,
    accurately,
    derivative,
    dot,
    many,
    read,
    some_places,
    turned,
)
from tests.statement_fuzz.oracle.arms import within
from tests.statement_fuzz.oracle.region import Objection

PLACES = 8
Gaps = Callable[[Any, Place, list[Any]], list[Any]]
"""What should be 0 at a place, with these rates."""


def _symmetric(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    m, n = at.matrix(statement.mass), at.n
    return [m[i][j] - m[j][i] for i in range(n) for j in range(i)]


def coriolis(statement: Any, at: Place, w: list[Any]) -> list[list[Any]]:
    """C(q, w), as printed or by Christoffel symbols."""
    if statement.printed:
        rates = [*w, at.number(Fraction(1))]
        return [[dot([at.value(c) for c in entry], rates) for entry in row] for row in statement.printed]
    return [[dot(entry, w) for entry in row] for row in at.symbols(statement.mass)]


def _rate(statement: Any, at: Place, w: list[Any]) -> list[list[Any]]:
    slopes, joints = at.slopes(statement.mass), range(at.n)
    return [[sum(slopes[k][i][j] * w[k] for k in joints) for j in joints] for i in joints]


def _at_rest(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    zero = [at.number(Fraction(0))] * at.n
    return [x for row in coriolis(statement, at, zero) for x in row]


def _sum_with_transpose(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    c, rate, n = coriolis(statement, at, w), _rate(statement, at, w), range(at.n)
    return [rate[i][j] - c[i][j] - c[j][i] for i in n for j in n]


def _skew(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    c, rate, n = coriolis(statement, at, w), _rate(statement, at, w), range(at.n)
    return [rate[i][j] + rate[j][i] - 2 * c[i][j] - 2 * c[j][i] for i in n for j in n]


def _torque(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    own = turned(at.symbols(statement.mass), w, w)
    return [dot(row, w) - x for row, x in zip(coriolis(statement, at, w), own, strict=True)]


def _gradient(statement: Any, at: Place, w: list[Any]) -> list[Any]:
    n = at.n
    return [
        at.value(g) - at.value(derivative(statement.potential, k, n)) for k, g in enumerate(statement.gravity)
    ]


GAPS: dict[str, Gaps] = {
    "MassSymmetric": _symmetric,
    "CoriolisAtRest": _at_rest,
    "RateOfMass": _sum_with_transpose,
    "RateLessTwiceCoriolis": _skew,
    "CoriolisTorque": _torque,
    "GravityOfPotential": _gradient,
}


def _joints(statement: Any) -> int:
    return len(statement.mass if hasattr(statement, "mass") else statement.gravity)


def vanishes(statement: Any, random: Random) -> Objection | None:
    """A place at which a difference is not 0."""
    n, gaps = _joints(statement), GAPS[type(statement).__name__]
    for place in some_places(n, statement.parameters, random, PLACES):
        w = [Fraction(random.choice((-3, -2, -1, 1, 2, 5))) for _ in range(n)]
        if any(gaps(statement, place, w)):
            where = [str(x) for x in place.generators]
            return Objection("false", f"sines, cosines and parameters {where}, rates {[str(x) for x in w]}")
    return None


def differs(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether a difference is not 0 at the posture of a witness, at its rates if it has some."""
    n = _joints(statement)
    place = within(statement, witness, n)
    if place is None:
        return False
    rates = read(witness["point"], "w", n) or [Fraction(1)] * n
    with mp.workdps(2 * DIGITS):
        result = GAPS[type(statement).__name__](statement, accurately(*place), [many(x) for x in rates])
        return any(abs(x) > CERTAIN**2 * _scale(statement, rates) for x in result)


def _scale(statement: Any, rates: list[Fraction]) -> Any:
    """About as large as the numbers that a difference is made of."""
    return max(many(x) for x in _coefficients(statement)) * max(1, *(abs(many(w)) for w in rates))


def _coefficients(data: Any) -> Iterator[Fraction]:
    """The sizes of all fractions in nested data."""
    if isinstance(data, Fraction):
        yield abs(data)
    elif isinstance(data, tuple):
        for part in data:
            yield from _coefficients(part)
    elif is_dataclass(data):
        for field in fields(data):
            yield from _coefficients(getattr(data, field.name))


for kind in GAPS:
    kinds.objections_to(kind)(vanishes)
    kinds.judges(kind)(differs)
