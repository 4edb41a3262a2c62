"""A recorded motion, made smooth by a spline."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.tracking.reference.base import Reference, Suprema

DEGREES = {"cubic": 3, "quintic": 5}
"""Splines with two and with four continuous derivatives."""

HALVINGS = 3
"""How often the pieces of the spline are halved before their control points are taken for bounds."""
_SHARE = 2.0**-45
"""More than what some thirty roundings do to a sum, relative to the sum of its absolute terms."""


class Recorded(Reference):
    """The interpolating spline through samples, with not-a-knot ends (``scipy.interpolate``).

    Args:
        t: (N,) s, increasing; the first is taken for 0.
        q: (N, n) rad.
        spline: ``cubic``, q_d of class C², or ``quintic``, of class C⁴.
        name: of the file.
    """

    kind = "recorded"

    def __init__(self, t: Array, q: Array, spline: str = "cubic", name: str = "samples") -> None:
        self.n = q.shape[1]
        self.name, self.spline, self.samples = name, spline, t.size
        path = _spline(t - t[0], q, DEGREES[spline])
        self._parts: tuple[Any, ...] = (path, path.derivative(), path.derivative(2))
        self._together = _stacked(self._parts)
        self.span = self.duration = float(t[-1] - t[0])

    def at(self, t: Array) -> Array:
        """See `Reference.at`; past its end a recording has no value, and the last one is given."""
        return np.asarray(self._together(np.minimum(t, self.duration)))

    def suprema(self) -> Suprema:
        """See `Reference.suprema`.

        In Bernstein form a polynomial is a convex combination of its control points, so the largest of these
        bounds it, joint by joint and in norm.
        """
        (rate, speed), (acceleration, acceleration_norm) = (_bounds(part) for part in self._parts[1:])
        return Suprema(rate, acceleration, speed, acceleration_norm)

    @property
    def sentence(self) -> str:
        """See `Reference.sentence`."""
        return f"{self.samples} samples of {self.name} over {self.span:g} s, {self.spline} spline"


def _spline(t: Array, q: Array, degree: int) -> Any:
    """The spline as polynomials between its knots, coefficients (degree + 1, pieces, n)."""
    from scipy.interpolate import PPoly, make_interp_spline

    joints = [PPoly.from_spline(make_interp_spline(t, column, k=degree)) for column in q.T]
    knots = joints[0].x
    live = np.diff(knots) > 0  # a spline repeats its end knots
    coefficients = np.stack([joint.c[:, live] for joint in joints], axis=-1)
    return PPoly(coefficients, np.append(knots[:-1][live], knots[-1]))


def _stacked(parts: Sequence[Any]) -> Any:
    """Piecewise polynomials with the same knots as one, with values (len(parts), n)."""
    from scipy.interpolate import PPoly

    degree = len(parts[0].c)
    padded = [np.concatenate((np.zeros((degree - len(p.c), *p.c.shape[1:])), p.c)) for p in parts]
    return PPoly(np.stack(padded, axis=-2), parts[0].x)


def _bounds(path: Any) -> tuple[tuple[Fraction, ...], Fraction]:
    """Bounds of each component of a piecewise polynomial, and of its norm, from above."""
    points, error = _control_points(path)
    for _ in range(HALVINGS):
        points = _halved(points)
    size = np.abs(points)
    each = [_up(float(x)) for x in size.max(axis=(0, 1)) + error]
    norm = float(np.max(np.linalg.norm(size, axis=-1)) + np.linalg.norm(error))
    return tuple(each), _up(norm)


def _control_points(path: Any) -> tuple[Array, Array]:
    """(degree + 1, pieces, n) control points, and how far rounding may have moved them, (n,)."""
    powers, widths = path.c[::-1], np.diff(path.x)
    degree = len(powers) - 1
    scaled = powers * widths[None, :, None] ** np.arange(degree + 1)[:, None, None]
    table = np.array([[comb(k, j) / comb(degree, j) for j in range(degree + 1)] for k in range(degree + 1)])
    points = np.einsum("kj,jpn->kpn", table, scaled)
    terms = np.einsum("kj,jpn->kpn", table, np.abs(scaled))
    return points, _SHARE * terms.max(axis=(0, 1))


def _halved(points: Array) -> Array:
    """The control points of both halves of every piece (de Casteljau)."""
    row, left, right = points, [points[0]], [points[-1]]
    while len(row) > 1:
        row = (row[:-1] + row[1:]) / 2
        left.append(row[0])
        right.append(row[-1])
    return np.concatenate((np.stack(left), np.stack(right[::-1])), axis=1)


def _up(value: float) -> Fraction:
    """A little above, exactly: more than the last roundings do, and than squares that underflow in a norm."""
    return Fraction(value * (1.0 + 2.0**-40) + 2.0**-500)
