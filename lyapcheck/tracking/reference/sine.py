"""A sine in every joint."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from flint import acb, arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.tracking.reference.base import BITS, Reference, Suprema, above, angles

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
