"""How small and how large M(q), C(q, x)y and g(q) are: at the worst posture of a search, in many digits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import (
    CERTAIN,
    DIGITS,
    Rows,
    Terms,
    accurately,
    dot,
    in_doubles,
    many,
    quarter_turns,
    read,
    times,
    turned,
)
from tests.statement_fuzz.oracle.climb import climbed
from tests.statement_fuzz.oracle.region import Objection

Ranges = Sequence[tuple[Fraction, Fraction]]


class Posture:
    """Angles, parameters and two directions, as the search moves them about: one column each."""

    def __init__(self, z: Any, n: int, ranges: Ranges) -> None:
        count = len(ranges)
        self.q, shares = z[:n], np.clip(z[n : n + count], 0, 1)
        self.shares = shares
        self.parameters = [
            float(a) + float(b - a) * share for (a, b), share in zip(ranges, shares, strict=True)
        ]
        self.x, self.y = (z[n + count + k * n : n + count + (k + 1) * n] for k in (0, 1))

    def exactly(self, ranges: Ranges) -> tuple[list[Fraction], list[Fraction]]:
        """Angles and parameters of a single column as fractions."""
        q = [Fraction(float(angle)) for angle in self.q]
        return q, [a + (b - a) * Fraction(float(t)) for (a, b), t in zip(ranges, self.shares, strict=True)]


def start(n: int, parameters: int) -> Any:
    """Columns to begin with: any angles, mostly extreme parameters, any directions."""

    def columns(random: Any, count: int) -> Any:
        q = random.uniform(-np.pi, np.pi, (n, count))
        q[:, : count // 4] = np.round(q[:, : count // 4] / (np.pi / 4)) * (np.pi / 4)
        shares = np.clip(random.uniform(-0.5, 1.5, (parameters, count)), 0, 1)
        return np.concatenate([q, shares, random.standard_normal((2 * n, count))])

    return columns


def stacked(rows: Sequence[Sequence[Any]], count: int) -> Any:
    """Entries with one value a column as an array of matrices."""
    return np.array([[np.broadcast_to(entry, count) for entry in row] for row in rows]).transpose(2, 0, 1)


def least_eigenvalue(mass: Rows, ranges: Ranges, z: Any) -> Any:
    """λmin of the symmetric part of M."""
    at = Posture(z, len(mass), ranges)
    m = stacked(in_doubles(at.q, at.parameters).matrix(mass), z.shape[1])
    return np.linalg.eigvalsh((m + m.transpose(0, 2, 1)) / 2)[:, 0]


def size_of_mass(mass: Rows, ranges: Ranges, z: Any) -> Any:
    """‖M‖."""
    at = Posture(z, len(mass), ranges)
    return np.linalg.norm(stacked(in_doubles(at.q, at.parameters).matrix(mass), z.shape[1]), 2, axis=(1, 2))


def size_of_turning(mass: Rows, ranges: Ranges, z: Any) -> Any:
    """‖C(q, x)y‖/(‖x‖‖y‖)."""
    at = Posture(z, len(mass), ranges)
    rows = turned(in_doubles(at.q, at.parameters).symbols(mass), at.x, at.y)
    return _length(rows, z) / (np.linalg.norm(at.x, axis=0) * np.linalg.norm(at.y, axis=0))


def size_of_gravity(gravity: Sequence[Terms], n: int, ranges: Ranges, z: Any) -> Any:
    """‖g‖."""
    at = Posture(z, n, ranges)
    place = in_doubles(at.q, at.parameters)
    return _length([place.value(g) for g in gravity], z)


def _length(rows: Sequence[Any], z: Any) -> Any:
    wide = [np.broadcast_to(row, z.shape[1]) for row in rows]
    largest = np.max(np.abs(wide), axis=0) if wide else np.zeros(z.shape[1])
    scale = np.where(largest > 0, largest, 1.0)
    return scale * np.sqrt(sum((row / scale) ** 2 for row in wide) + np.zeros(z.shape[1]))


def _worst(
    function: Any, n: int, ranges: Ranges, random: Random
) -> tuple[list[Fraction], list[Fraction], Any]:
    """Exact angles and parameters near the largest value, and the columns x, y there."""
    _, z = climbed(function, start(n, len(ranges)), random)
    at = Posture(z, n, ranges)
    q, parameters = at.exactly(ranges)
    return q, parameters, at


@kinds.objections_to("MassAbove")
def mass_above(statement: Any, random: Random) -> Objection | None:
    """A posture with a small eigenvalue; equality at a right angle, exactly."""
    n, ranges = len(statement.mass), statement.parameters
    for place in quarter_turns(n, ranges):
        rows = place.matrix(statement.mass)
        if any(rows[i][j] != rows[j][i] for i in range(n) for j in range(i)):
            return Objection("false", f"M is not symmetric where sines and cosines are {place.generators}")
        if not _definite(
            [[x - statement.low * (i == j) for j, x in enumerate(r)] for i, r in enumerate(rows)]
        ):
            return Objection("false", f"sines and cosines {[str(x) for x in place.generators]}")
    q, parameters, _ = _worst(lambda z: -least_eigenvalue(statement.mass, ranges, z), n, ranges, random)
    with mp.workdps(DIGITS):
        rows = accurately(q, parameters).matrix(statement.mass)
        doubles = np.array([[float(x) for x in row] for row in rows])
        _, vectors = np.linalg.eigh((doubles + doubles.T) / 2)
        x = [many(Fraction(float(v))) for v in vectors[:, 0]]
        if _below(rows, x, statement.low):
            return Objection("false", shown(q, parameters))
    return None


def _definite(rows: list[list[Fraction]]) -> bool:
    """Whether an exact symmetric matrix is positive definite, by elimination."""
    rows = [list(row) for row in rows]
    for k, row in enumerate(rows):
        if row[k] <= 0:
            return False
        for other in rows[k + 1 :]:
            factor = other[k] / row[k]
            other[:] = [a - factor * b for a, b in zip(other, row, strict=True)]
    return True


def _below(rows: list[list[Any]], x: list[Any], low: Fraction) -> bool:
    """xᵀMx < low xᵀx, beyond doubt."""
    form, bound = dot(x, times(rows, x)), many(low) * dot(x, x)
    scale = sum(abs(a) for row in rows for a in row) * dot(x, x) + bound
    return bool(bound - form > CERTAIN * scale)


@kinds.objections_to("MassBelow")
def mass_below(statement: Any, random: Random) -> Objection | None:
    """A posture with a large M(q)x."""
    n, ranges = len(statement.mass), statement.parameters
    q, parameters, _ = _worst(lambda z: size_of_mass(statement.mass, ranges, z), n, ranges, random)
    with mp.workdps(DIGITS):
        rows = accurately(q, parameters).matrix(statement.mass)
        _, _, right = np.linalg.svd(np.array([[float(a) for a in row] for row in rows]))
        x = [many(Fraction(float(v))) for v in right[0]]
        broken = _longer(times(rows, x), statement.high, x)
    return Objection("false", shown(q, parameters)) if broken else None


@kinds.objections_to("CoriolisBelow")
def coriolis_below(statement: Any, random: Random) -> Objection | None:
    """A posture and rates with a large C(q, x)y."""
    n, ranges = len(statement.mass), statement.parameters
    q, parameters, at = _worst(lambda z: size_of_turning(statement.mass, ranges, z), n, ranges, random)
    x, y = ([Fraction(float(v)) for v in vector] for vector in (at.x, at.y))
    if not _breaks_turning(statement, q, parameters, x, y):
        return None
    return Objection("false", shown(q, parameters, x=x, y=y))


@kinds.objections_to("GravityBelow")
def gravity_below(statement: Any, random: Random) -> Objection | None:
    """A posture with a large torque."""
    n, ranges = statement.joints, statement.parameters
    q, parameters, _ = _worst(lambda z: size_of_gravity(statement.gravity, n, ranges, z), n, ranges, random)
    return Objection("false", shown(q, parameters)) if _breaks_gravity(statement, q, parameters) else None


def _longer(result: Sequence[Any], high: Fraction, *vectors: Sequence[Any]) -> bool:
    """‖found‖ > high · the product of the lengths, beyond doubt; no length is below 0."""
    if high < 0:
        return True
    bound = many(high) ** 2
    for vector in vectors:
        bound = bound * dot(vector, vector)
    square = dot(result, result)
    return bool(square - bound > CERTAIN * (square + bound))


def _breaks_turning(
    statement: Any, q: list[Fraction], parameters: list[Fraction], x: list[Fraction], y: list[Fraction]
) -> bool:
    with mp.workdps(DIGITS):
        a, b = [many(v) for v in x], [many(v) for v in y]
        result = turned(accurately(q, parameters).symbols(statement.mass), a, b)
        return _longer(result, statement.high, a, b)


def _breaks_gravity(statement: Any, q: list[Fraction], parameters: list[Fraction]) -> bool:
    with mp.workdps(DIGITS):
        place = accurately(q, parameters)
        return _longer([place.value(g) for g in statement.gravity], statement.high)


def shown(q: Sequence[Fraction], parameters: Sequence[Fraction], **more: Sequence[Fraction]) -> str:
    """A place in short."""
    parts = {"q": q, "p": parameters, **more}
    return ", ".join(f"{name} = {[round(float(v), 6) for v in part]}" for name, part in parts.items() if part)


def within(
    statement: Any, witness: Mapping[str, Any], n: int
) -> tuple[list[Fraction], list[Fraction]] | None:
    """Angles and parameters of a witness, if they are all there and within their ranges."""
    point, ranges = witness["point"], statement.parameters
    q, parameters = read(point, "q", n), read(point, "p", len(ranges))
    if q is None or parameters is None:
        return None
    inside = all(a <= p <= b for p, (a, b) in zip(parameters, ranges, strict=True))
    return (q, parameters) if inside else None


def _product(statement: Any, witness: Mapping[str, Any]) -> tuple[list[list[Any]], list[Any]] | None:
    """M(q) and the x of a witness, if it is one of this arm."""
    n = len(statement.mass)
    place, x = within(statement, witness, n), read(witness["point"], "x", n)
    if place is None or x is None:
        return None
    return accurately(*place).matrix(statement.mass), [many(v) for v in x]


@kinds.judges("MassAbove")
def small_form(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether xᵀMx < low xᵀx at the posture."""
    with mp.workdps(DIGITS):
        result = _product(statement, witness)
        return result is not None and _below(*result, statement.low)


@kinds.judges("MassBelow")
def large_product(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether ‖Mx‖ > high ‖x‖ at the posture."""
    with mp.workdps(DIGITS):
        result = _product(statement, witness)
        return result is not None and _longer(times(*result), statement.high, result[1])


@kinds.judges("CoriolisBelow")
def large_turning(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether ‖C(q, x)y‖ > high ‖x‖ ‖y‖ at the posture."""
    n = len(statement.mass)
    place, x, y = within(statement, witness, n), *(read(witness["point"], v, n) for v in "xy")
    return place is not None and x is not None and y is not None and _breaks_turning(statement, *place, x, y)


@kinds.judges("GravityBelow")
def large_gravity(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether ‖g‖ > high at the posture."""
    place = within(statement, witness, statement.joints)
    return place is not None and _breaks_gravity(statement, *place)
