"""What every reference trajectory offers: q_d, q̇_d and q̈_d at any time, and bounds of them for all times."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import comb
from typing import Any

import numpy as np
from flint import acb, arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure

SECONDS = 5.0
"""Duration of a run of which nothing else is said."""

BITS = 128
_PLACES = 10**12


@dataclass(frozen=True)
class Suprema:
    """Bounds from above for all times, exact.

    Args:
        rate: sup |q̇_di| of each joint, rad/s.
        acceleration: sup |q̈_di| of each joint, rad/s².
        speed: v_d, sup ‖q̇_d‖, rad/s.
        acceleration_norm: sup ‖q̈_d‖, rad/s².
    """

    rate: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]
    speed: Fraction
    acceleration_norm: Fraction


class Reference(ABC):
    """A trajectory with two continuous derivatives, which is what (21) takes for granted.

    References: (21) of ``reyes2019family``.
    """

    kind: str
    n: int
    duration: float = SECONDS
    """s, how long a run takes of which nothing else is said."""
    span: float | None = None
    """s, where the trajectory ends; none if it goes on for ever."""

    @abstractmethod
    def at(self, t: Array) -> Array:
        """q_d, q̇_d and q̈_d at times (N,) in s: (N, 3, n) in rad, rad/s and rad/s²."""

    @abstractmethod
    def suprema(self) -> Suprema:
        """Bounds of q̇_d and q̈_d for all times.

        Soundness: rounded outward; they bound the trajectory itself, of which ``at`` is the nearest double.
        """

    @property
    @abstractmethod
    def sentence(self) -> str:
        """The trajectory in one line."""


def above(ball: arb) -> Fraction:
    """A decimal of twelve places that is not below any number of a ball."""
    with precision(BITS):
        value = Enclosure.from_arb(ball).upper
    return -Fraction(-value.numerator * _PLACES // value.denominator, _PLACES)


def angles(values: Sequence[Fraction]) -> str:
    """Angles as they were written, in degrees."""
    return f"({', '.join(f'{float(x):g}' for x in values)})°"


# --- A sine in every joint.


Row = tuple[Fraction, ...]


class Sine(Reference):
    """q_di = o_i + A_i sin(2π f_i t + φ_i).

    Args:
        amplitude: A, degrees, one a joint.
        frequency: f, Hz.
        phase: φ, degrees.
        offset: o, degrees.
    """

    kind = "sine"

    def __init__(self, amplitude: Row, frequency: Row, phase: Row, offset: Row) -> None:
        self.n = len(amplitude)
        self.amplitude, self.frequency, self.phase, self.offset = amplitude, frequency, phase, offset
        self._size, self._shift, self._middle = (
            np.radians([float(x) for x in row]) for row in (amplitude, phase, offset)
        )
        self._pace = 2.0 * math.pi * np.array([float(x) for x in frequency])

    def at(self, t: Array) -> Array:
        """See `Reference.at`."""
        turn = np.multiply.outer(t, self._pace) + self._shift
        sine, cosine = np.sin(turn), np.cos(turn)
        rows = (self._middle + self._size * sine, self._size * self._pace * cosine)
        return np.stack((*rows, -self._size * self._pace**2 * sine), axis=-2)

    def suprema(self) -> Suprema:
        """See `Reference.suprema`; v_d is exact where all frequencies agree."""
        with precision(BITS):
            rates = [self._peak(i, 1) for i in range(self.n)]
            pushes = [self._peak(i, 2) for i in range(self.n)]
            return Suprema(
                tuple(map(above, rates)),
                tuple(map(above, pushes)),
                above(self._norm(1)),
                above(self._norm(2)),
            )

    @property
    def sentence(self) -> str:
        """See `Reference.sentence`."""
        pace = ", ".join(f"{float(f):g}" for f in self.frequency)
        return f"sine of {angles(self.amplitude)} at ({pace}) Hz about {angles(self.offset)}"

    def _peak(self, i: int, order: int) -> arb:
        """A_i ω_i^order in rad/s^order."""
        pace = 2 * arb.pi() * to_arb(self.frequency[i])
        return abs(to_arb(self.amplitude[i])) * arb.pi() / 180 * pace**order

    def _norm(self, order: int) -> arb:
        """A bound of the norm of the derivative of an order.

        In joints of one frequency Σ a_i² cos²(ωt + φ_i) = ½ Σ a_i² + ½ Re e^(2iωt) Σ a_i² e^(2iφ_i), which is
        largest where the last product is real; joints of different frequencies are added.
        """
        total = arb(0)
        for pace in sorted(set(self.frequency)):
            joints = [i for i in range(self.n) if self.frequency[i] == pace]
            squares = [self._peak(i, order) ** 2 for i in joints]
            turned = acb(0)
            for i, square in zip(joints, squares, strict=True):
                turned += square * acb(0, to_arb(self.phase[i]) * arb.pi() / 90).exp()
            total += (sum(squares, arb(0)) + abs(turned)) / 2
        return total.sqrt()


# --- The motion of least jerk from one posture to another.


class MinimumJerk(Reference):
    """q_d = a + (b − a)(10 s³ − 15 s⁴ + 6 s⁵) with s = t/T from 0 to 1, and at rest from then on.

    Rate and acceleration are 0 at both ends, so that q_d has two continuous derivatives. With Δ = b − a,
    ‖q̇_d‖ is largest at s = ½, (15/8) ‖Δ‖/T, and ‖q̈_d‖ at s = ½ ± √3/6, (10/√3) ‖Δ‖/T².

    Args:
        start: a, degrees, one a joint.
        end: b, degrees.
        seconds: T.

    References: ``flash1985coordination``.
    """

    kind = "minimum-jerk"

    def __init__(self, start: Row, end: Row, seconds: Fraction) -> None:
        self.n = len(start)
        self.start, self.end, self.seconds = start, end, seconds
        self.duration = max(SECONDS, float(seconds))
        self._from = np.radians([float(x) for x in start])
        self._step = np.radians([float(b - a) for a, b in zip(start, end, strict=True)])

    def at(self, t: Array) -> Array:
        """See `Reference.at`."""
        T = float(self.seconds)
        s = np.clip(t / T, 0.0, 1.0)
        share = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        rate = 30.0 * (s * (1.0 - s)) ** 2 / T
        acceleration_norm = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / T**2
        moved = np.multiply.outer(np.stack((share, rate, acceleration_norm), axis=-1), self._step)
        moved[..., 0, :] += self._from
        return np.asarray(moved)

    def suprema(self) -> Suprema:
        """See `Reference.suprema`; both norms are exact, as all joints move alike."""
        with precision(BITS):
            T = to_arb(self.seconds)
            fast, acceleration_norm = arb(15) / 8 / T, 10 / arb(3).sqrt() / T**2
            steps = [abs(to_arb(b - a)) * arb.pi() / 180 for a, b in zip(self.start, self.end, strict=True)]
            size = sum((step * step for step in steps), arb(0)).sqrt()
            rates, pushes = (
                tuple(above(most * step) for step in steps) for most in (fast, acceleration_norm)
            )
            return Suprema(rates, pushes, above(fast * size), above(acceleration_norm * size))

    @property
    def sentence(self) -> str:
        """See `Reference.sentence`."""
        return f"minimum jerk from {angles(self.start)} to {angles(self.end)} in {float(self.seconds):g} s"


# --- A recorded motion, made smooth by a spline.


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
