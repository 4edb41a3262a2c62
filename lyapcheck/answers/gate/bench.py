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

from flint import arb

from lyapcheck.answers.gate.otherwise import small
from lyapcheck.check.numbers.harmonics import harmonics, largest
from lyapcheck.family.registry import named
from lyapcheck.robots import trig

if TYPE_CHECKING:
    from lyapcheck.check.numbers.members import Member
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

SWINGS = 0.5
"""A damping ratio below which a joint overshoots by more than a sixth of its step."""
HALVINGS = 30
FARTHEST = 50.0
"""rad: a joint held so far away is held anywhere."""


def dry_friction(model: RobotModel) -> list[Fraction]:
    """Coulomb torques in N·m; 0 where nothing is known."""
    return [Fraction(0) if number is None else number.value for number in model.coulomb]


def rest_errors(gains: GainSet, model: RobotModel) -> list[float | None]:
    """Per joint the largest error in rad that dry friction holds, k_p |h(e)| ≤ f; ``None``: it holds any."""
    unit = degrees(1.0) if gains.angle_unit == "deg" else 1.0
    family = named(gains.family, gains.m)
    ratios = [float(f) / (float(kp) * unit) for kp, f in zip(gains.kp, dry_friction(model), strict=True)]
    return [_held(family.checked, ratio) for ratio in ratios] if family.bounded else [*ratios]


@lru_cache(maxsize=4096)
def _held(member: Member, ratio: float) -> float | None:
    """The largest x with h(x) ≤ ratio before h stays above it; 0 without friction."""
    if ratio <= 0:
        return 0.0

    def h(x: float) -> float:
        return float(member.h(arb(x)).mid())

    if h(FARTHEST) <= ratio:
        return None
    low, high = 0.0, 1.0
    while h(high) <= ratio:
        low, high = high, 2 * high
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if h(middle) <= ratio else (low, middle)
    return high


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
    return [f"damping ratio{soft}, at the posture of most inertia: {text}{end}"]


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
