"""Condition (10) decided exactly: a rational against a difference of square roots over √n γ.

With T = ‖τmax‖², G = k_g², s = n k² and x = γ² the condition k ≤ (√T − √G)/(√n γ) reads x ≤ (√T − √G)²/s,
for T > G. That number is the smaller root of the rational quadratic

    s² x² − 2 s (T + G) x + (T − G)² = 0,

whose larger root is (√T + √G)²/s. Balls of rising precision decide all but equality, and equality is whether
γ² is a root of the quadratic.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from flint import arb

from lyapcheck.check.balls import precision, to_arb
from lyapcheck.check.enclosure import Enclosure
from lyapcheck.control.bound import GammaBound

_FIRST_BITS = 128


@dataclass(frozen=True)
class NormLimit:
    """(√T − √G)/(√n γ) with T = ``torque_squared`` and G = ``gravity_squared``, N²·m².

    References: (10) of reyes2019family.
    """

    torque_squared: Fraction
    gravity_squared: Fraction
    n: int
    gamma: GammaBound

    @classmethod
    def of(cls, torques: Sequence[Fraction], gravity: Sequence[Fraction], gamma: GammaBound) -> NormLimit:
        """The limit for the torque limits and the gravity bounds of an arm's joints."""
        torque, k_g = (sum((x * x for x in values), Fraction(0)) for values in (torques, gravity))
        return cls(torque, k_g, len(torques), gamma)

    def admits(self, value: Fraction) -> bool:
        """Decide value ≤ limit for value > 0.

        Soundness: see the module; a decision in balls is certified, and the exact one is algebra.
        """
        if self.torque_squared <= self.gravity_squared:
            return False
        if self.equals(value):
            return True
        limit, bits = self._near, _FIRST_BITS
        while limit.lower < value < limit.upper:
            bits *= 2
            limit = self.enclosure(bits)
        return value <= limit.lower

    def equals(self, value: Fraction) -> bool:
        """Decide value = limit for value > 0 and T > G.

        Soundness: of the two roots of the quadratic only the smaller one is below (T + G)/s; for G = 0 they
        are one.
        """
        if not self._near.lower <= value <= self._near.upper:
            return False
        t, g, s = self.torque_squared, self.gravity_squared, self.n * value**2
        if not self.gamma.squared_is_root((t - g) ** 2, -2 * s * (t + g), s * s):
            return False
        return g == 0 or self.gamma.squared_less((t + g) / s)

    @cached_property
    def _near(self) -> Enclosure:
        return self.enclosure(_FIRST_BITS)

    def enclosure(self, bits: int = _FIRST_BITS) -> Enclosure:
        """The limit in balls of so many bits."""
        gamma = self.gamma.within(bits // 3)
        with precision(bits):
            torque, gravity = (to_arb(x).sqrt() for x in (self.torque_squared, self.gravity_squared))
            return Enclosure.from_arb((torque - gravity) / (arb(self.n).sqrt() * gamma.to_arb()))
