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
from math import isqrt, prod

from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.harmonics import by_parameters, largest
from lyapcheck.robots import RobotModel
from lyapcheck.robots.trig import to_terms

DIGITS = 30


@dataclass(frozen=True)
class Damping:
    """What the damping ratio of a joint depends on beside its gains.

    Args:
        ratio: the ζ that is asked for.
        friction: b, the least of the ranges, N·m·s/rad.
        inertia: J, an upper bound of M_ii over all angles and ranges, kg·m².
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


def damping_of(
    model: RobotModel, m: int, ratios: tuple[Fraction, ...], viscous_min: Fraction | None = None
) -> tuple[Damping, ...]:
    """The least damping of every joint over the ranges of an arm.

    Args:
        model: the arm with its ranges.
        m: the member of the family.
        ratios: one ζ a joint.
        viscous_min: λmin(B) to judge by; it is the friction of each joint, unless it is the arm's own.

    Soundness: ζ falls with the inertia and grows with the friction, so that the ends of both give the least.
    """
    L = hyperbolic_constants(m, DIGITS).L
    inertias = [_largest_inertia(model, i) for i in range(model.n)]
    frictions = [number.bounds[0] for number in model.viscous]
    if viscous_min not in (None, min(frictions)):
        frictions = [viscous_min or Fraction(0)] * model.n
    return tuple(
        Damping(ratio, friction, inertia, (L.lower, L.upper))
        for ratio, friction, inertia in zip(ratios, frictions, inertias, strict=True)
    )


def _largest_inertia(model: RobotModel, i: int) -> Fraction:
    """An upper bound of M_ii over all angles and all values of the parameters, kg·m²."""
    sizes = [max(map(abs, number.bounds)) for number in model.parameters.values()]
    parts = by_parameters(to_terms(model.mass[i][i]), model.n).items()
    rows = (largest(part) * prod(map(pow, sizes, powers), start=Fraction(1)) for powers, part in parts)
    return sum(rows, Fraction(0))
