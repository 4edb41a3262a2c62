"""What dry friction does to gains that theory accepts, as the checker judges it.

    rest   |e_i| ≤ X at every state of rest of (11) within dry friction f: K_p h(e) + d = 0, |d_i| ≤ f_i
    held   k_pi ≤ f_i/γ, so that k_pi |h(e_i)| ≤ f_i for every e: joint i rests wherever it stops

References: (6), (11) of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from math import ceil, degrees
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.bench import dry_friction, rest_errors
from lyapcheck.control.conditions import gamma_of
from lyapcheck.control.judgement import ACCEPTED, JudgedStatement, judged_statement
from lyapcheck.control.threshold import Threshold, scaled
from lyapcheck.family.registry import named
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.check.expressions.expression import Tree
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

TENTHS = 10
"""Parts of a degree that are shown."""
RADIANS = Fraction(314159265, 180 * 10**8)
"""A little less than π/180."""


def held(gains: GainSet, model: RobotModel) -> dict[int, JudgedStatement]:
    """The joints, from 0, that dry friction is proved to hold wherever they stop."""
    gamma = gamma_of(gains)
    if gamma is None:
        return {}
    rows = enumerate(zip(gains.kp, dry_friction(model), strict=True))
    result = {i: _limit(f, gamma).judged(kp) for i, (kp, f) in rows if f}
    return {i: one for i, one in result.items() if one.verdict == ACCEPTED}


@lru_cache(maxsize=64)
def _limit(friction: Fraction, gamma: Tree) -> Threshold:
    return scaled(friction, 1, gamma, "<=")


def resting(gains: GainSet, model: RobotModel) -> JudgedStatement | None:
    """How far from the goal the joints may rest, to the next tenth of a degree, as the checker accepts it.

    ``None`` where nothing is known of dry friction, or no joint has a bound.
    """
    friction = dry_friction(model)
    if not any(friction) or not named(gains.family, gains.m).bounded or gains.angle_unit == "deg":
        return None
    errors = tuple(None if e is None else _above(e) for e in rest_errors(gains, model))
    if all(e is None for e in errors):
        return None
    from lyapcheck.check.kinds.resting import AtBounds, Resting

    return judged_statement(
        Resting(gains.family, gains.m, tuple(gains.kp), tuple(friction), errors), [AtBounds()]
    )


def _above(error: float) -> Fraction:
    """rad, a tenth of a degree above what was found in floating point at most."""
    return Fraction(ceil(degrees(error) * TENTHS + 1e-6), TENTHS) * RADIANS


def friction_lines(gains: GainSet, model: RobotModel, stuck: Sequence[int]) -> list[str]:
    """Where a joint rests anywhere, and how far from the goal the others may."""
    friction = dry_friction(model)
    assumed = " (assumed)" if any(x is not None and x.assumed for x in model.coulomb) else ""
    lines = [
        f"γ k_p of {model.joints[i]} does not exceed its dry friction of {decimal_text(friction[i])} N·m"
        f"{assumed}: the joint rests wherever it stops; k_p = {decimal_text(gains.kp[i])} is in N·m"
        for i in stuck
    ]
    result = resting(gains, model)
    if result is not None and result.verdict == ACCEPTED:
        errors = zip(model.joints, result.statement.errors, friction, strict=True)  # type: ignore[attr-defined]
        far = [f"{joint} {float(e / RADIANS):.1f}°" for joint, e, f in errors if f and e is not None]
        if far:
            lines.append(f"dry friction{assumed} leaves at most {', '.join(far)}, at every state of rest")
    return lines
