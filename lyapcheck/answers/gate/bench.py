"""What an engineer at the bench should know of gains that theory accepts, in floating point.

Near the goal a joint that moves alone obeys J ë + b ė + k_v h(ė) + k_p h(e) = 0. With h(x) = L x, which it is
at most, the damping ratio is ζ = (b + L k_v)/(2 √(J L k_p)), J the largest M_ii. Dry friction f holds the
joint wherever k_p |h(e)| ≤ f; ``friction`` has the checker judge how far that is.

References: (6), (11) of reyes2019family.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import degrees, exp, pi, sqrt
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.otherwise import small
from lyapcheck.check.numbers.harmonics import harmonics, largest
from lyapcheck.control.resting import dry_friction, rest_error
from lyapcheck.family.registry import named
from lyapcheck.robots import trig

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

SWINGS = 0.5
"""A damping ratio below which a joint overshoots by more than a sixth of its step."""


def rest_errors(gains: GainSet, model: RobotModel) -> list[Fraction | None]:
    """Per joint the largest error in rad that dry friction holds, k_p |h(e)| ≤ f; ``None``: it holds any."""
    unit = Fraction(degrees(1.0)) if gains.angle_unit == "deg" else Fraction(1)
    ratios = [f / (kp * unit) for kp, f in zip(gains.kp, dry_friction(model), strict=True)]
    known = named(gains.family, gains.m)
    if not known.bounded:
        return [*ratios]
    _ = known.checked  # or say that the checker does not know the function
    return [rest_error(gains.family, gains.m, ratio) for ratio in ratios]


def damping_lines(gains: GainSet, model: RobotModel) -> list[str]:
    """How gains swing; floating point."""
    if not small(model.fixed()):
        return []
    ratios = damping_ratios(gains, model)
    text = ", ".join(f"{joint} {ratio:.2f}" for joint, ratio in zip(model.joints, ratios, strict=True))
    least = min(ratios)
    end = ""
    if least < SWINGS:
        over = 100 * exp(-pi * least / sqrt(1 - least**2))
        end = f": without dry friction it swings, by about {over:.0f} % of a step"
    soft = " of a large motion, as h is flat at the goal" if gains.m is not None and gains.m > 1 else ""
    return [f"estimated damping ratio{soft}, at the posture of most inertia: {text}{end}"]


def damping_ratios(gains: GainSet, model: RobotModel) -> list[float]:
    """ζ of each joint alone, at the arm's nominal numbers."""
    unit = degrees(1.0) if gains.angle_unit == "deg" else 1.0
    L = float(named(gains.family, gains.m).constants().L.mid)
    rows = zip(gains.kp, gains.kv, model.viscous, _inertias(model), strict=True)
    return [
        (float(b.value) + L * float(kv) * unit) / (2 * sqrt(J * L * float(kp) * unit))
        for kp, kv, b, J in rows
    ]


@lru_cache(maxsize=8)
def _inertias(model: RobotModel) -> tuple[float, ...]:
    """The largest M_ii of each joint as Fourier sums show it, kg·m²."""
    nominal = model.fixed()
    return tuple(
        float(largest(harmonics(trig.to_terms(nominal.mass[i][i]), model.n))) for i in range(model.n)
    )
