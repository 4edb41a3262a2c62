"""The motion of least jerk from one posture to another."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.tracking.reference.base import BITS, SECONDS, Reference, Suprema, above, angles

Row = tuple[Fraction, ...]


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
