"""What every reference trajectory offers: q_d, q̇_d and q̈_d at any time, and bounds of them for all times."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np
from flint import acb, arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.errors import InputError, near
from lyapcheck.files.decimals import NotFinite
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.toml import open_document

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
        turn = np.multiply.outer(t, self._pace) + self._shift
        sine, cosine = np.sin(turn), np.cos(turn)
        rows = (self._middle + self._size * sine, self._size * self._pace * cosine)
        return np.stack((*rows, -self._size * self._pace**2 * sine), axis=-2)

    def suprema(self) -> Suprema:
        with precision(BITS):
            rates, pushes = (tuple(above(self._peak(i, order)) for i in range(self.n)) for order in (1, 2))
            return Suprema(rates, pushes, above(self._norm(1)), above(self._norm(2)))

    @property
    def sentence(self) -> str:
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
        T = float(self.seconds)
        s = np.clip(t / T, 0.0, 1.0)
        share = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        rate = 30.0 * (s * (1.0 - s)) ** 2 / T
        acceleration_norm = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / T**2
        moved = np.multiply.outer(np.stack((share, rate, acceleration_norm), axis=-1), self._step)
        moved[..., 0, :] += self._from
        return np.asarray(moved)

    def suprema(self) -> Suprema:
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
        return f"minimum jerk from {angles(self.start)} to {angles(self.end)} in {float(self.seconds):g} s"


# --- Reference files (TOML): one trajectory, described in a few lines.


FARTHEST = Fraction(36_000)
"""Degrees: a hundred turns of a joint."""
FASTEST = Fraction(1000)
"""Hz."""
LONGEST = Fraction(3600)
"""s"""
QUICKEST = Fraction(1, 1000)
"""s, the shortest motion from one posture to another."""


def read_reference(path: str | Path, joints: int | None = None) -> Reference:
    """The trajectory that a reference file describes.

    Args:
        path: of the TOML file.
        joints: of the arm; any number if missing.

    Raises:
        InputError: everything that is wrong with the file.
    """
    document = open_document(Path(path), str(path))
    notes = Notes(document.name, document.line)
    fields = Fields(document.data, (), notes)
    kind = fields.text("kind", required=True)
    maker = _KINDS.get(kind)
    if maker is None:
        if kind:
            meant = near(kind, _KINDS) or "sine"
            fields.fail("kind", f"must be one of {', '.join(_KINDS)}", f'write kind = "{meant}"')
        raise InputError(notes.problems)
    result = maker(fields)
    fields.close()
    if result is not None and joints is not None and result.n != joints:
        rule = f"moves {result.n} joints, but the arm has {joints}"
        fields.fail("kind", rule, f"give {joints} values, one a joint")
    if notes.problems or result is None:
        raise InputError(notes.problems)
    return result


def _row(
    fields: Fields, key: str, low: Fraction, high: Fraction, unit: str, single: bool = False
) -> Row | None:
    """The numbers of a list, or a single one, of any sign and between two bounds; ``None`` when bad."""
    value = fields.raw(key, required=True)
    if value is None:
        return None
    if not single and (not isinstance(value, list) or not value):
        fields.fail(key, "must be a list of numbers, one a joint", f"write {key} = [0, 0, 0]")
        return None
    values, kept = [value] if single else value, []
    for i, one in enumerate(values):
        plain = isinstance(one, int | Fraction) and not isinstance(one, bool)
        if plain and low <= one <= high:
            kept.append(Fraction(one))
            continue
        rule = f"must be a number from {float(low):g} to {float(high):g} {unit}"
        rule = one.rule if isinstance(one, NotFinite) else rule
        fields.notes.fail((key,) if single else (key, i), one, rule, f"give a plain decimal in {unit}")
    return tuple(kept) if len(kept) == len(values) else None


def _same_length(fields: Fields, *keys: str) -> None:
    """Note lists of another length than the first."""
    given = {key: value for key in keys if isinstance(value := fields.data.get(key), list) and value}
    first = next(iter(given), "")
    for key, row in given.items():
        if len(row) != len(given[first]):
            rule = f"has {len(row)} values where {first} has {len(given[first])}"
            fields.fail(key, rule, f"give {len(given[first])} values, one a joint")


def _sine(fields: Fields) -> Reference | None:
    amplitude = _row(fields, "amplitude", -FARTHEST, FARTHEST, "degrees")
    frequency = _row(fields, "frequency", Fraction(0), FASTEST, "Hz")
    zeros = (Fraction(0),) * len(amplitude or frequency or ())
    phase, offset = (
        _row(fields, key, -FARTHEST, FARTHEST, "degrees") if fields.raw(key) is not None else zeros
        for key in ("phase", "offset")
    )
    _same_length(fields, "amplitude", "frequency", "phase", "offset")
    if fields.notes.problems or None in (amplitude, frequency, phase, offset):
        return None
    return Sine(*(row for row in (amplitude, frequency, phase, offset) if row is not None))


def _minimum_jerk(fields: Fields) -> Reference | None:
    start, end = (_row(fields, key, -FARTHEST, FARTHEST, "degrees") for key in ("from", "to"))
    seconds = _row(fields, "duration", QUICKEST, LONGEST, "s", single=True)
    _same_length(fields, "from", "to")
    if fields.notes.problems or start is None or end is None or seconds is None:
        return None
    return MinimumJerk(start, end, seconds[0])


_KINDS: dict[str, Callable[[Fields], Reference | None]] = {"sine": _sine, "minimum-jerk": _minimum_jerk}
