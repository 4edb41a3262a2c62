"""The damping ratio of one joint, with h replaced by its steepest secant.

A joint that moves alone obeys  J ë + b ė + k_v h(ė) + k_p h(e) = 0. Both h(x) are at most L x in size; with
L x in their place the joint is a linear oscillator with

    ζ = (b + L k_v) / (2 √(J L k_p)).

For m = 1 it is the linearisation at the goal (L = h'(0) = 1). For m >= 2 it describes a motion as large as
the one at which h(x)/x is largest; closer to the goal the spring goes soft.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.harmonics import harmonics, largest
from lyapcheck.robots import RobotModel, trig

DIGITS = 30


@dataclass(frozen=True)
class Damping:
    """What the damping ratio of a joint depends on beside its gains.

    Args:
        ratio: the ζ that is asked for.
        friction: b, N·m·s/rad.
        inertia: J, an upper bound of M_ii over all angles, kg·m².
        slope: L_m from below and from above.
    """

    ratio: Fraction
    friction: Fraction
    inertia: Fraction
    slope: tuple[Fraction, Fraction]

    def largest_kp(self, kv: Fraction) -> Fraction:
        """The largest k_p that keeps ζ: (b + L k_v)²/(4 ζ² J L), from below.

        Soundness: L enters the square by its lower and the divisor by its upper end.
        """
        low, high = self.slope
        return (self.friction + low * kv) ** 2 / (4 * self.ratio**2 * self.inertia * high)

    def reached(self, kp: Fraction, kv: Fraction) -> Fraction:
        """ζ of two gains, from below, to nine decimal places."""
        low, high = self.slope
        square = (self.friction + low * kv) ** 2 / (4 * self.inertia * high * kp)
        return Fraction(isqrt(int(square * 10**18)), 10**9)


def damping_of(model: RobotModel, m: int, ratios: tuple[Fraction, ...]) -> tuple[Damping, ...]:
    """The damping of every joint of an arm at its nominal inertia and its least friction."""
    L = hyperbolic_constants(m, DIGITS).L
    nominal = model.fixed()
    inertias = [largest(harmonics(trig.to_terms(nominal.mass[i][i]), model.n)) for i in range(model.n)]
    frictions = [number.bounds[0] for number in model.viscous]
    return tuple(
        Damping(ratio, friction, inertia, (L.lower, L.upper))
        for ratio, friction, inertia in zip(ratios, frictions, inertias, strict=True)
    )
