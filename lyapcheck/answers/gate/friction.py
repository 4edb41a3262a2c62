"""What dry friction does to gains that theory accepts, as the checker judges it.

    rest   |e_i| ≤ X at every state of rest of (11) within dry friction f: K_p h(e) + d = 0, |d_i| ≤ f_i
    held   k_pi ≤ f_i/γ, so that k_pi |h(e_i)| ≤ f_i for every e: joint i rests wherever it stops

References: (6), (11) of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.bench import rest_errors
from lyapcheck.control.conditions import gamma_of
from lyapcheck.control.judgement import ACCEPTED, JudgedStatement, judged_statement
from lyapcheck.control.resting import degrees_above, dry_friction
from lyapcheck.control.threshold import Threshold, scaled
from lyapcheck.family.registry import named
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.check.expressions.expression import Tree
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


ANYWHERE = Fraction(10**6)


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
    """How far from the goal the joints may rest, to six digits, as the checker accepts it.

    ``None`` where nothing is known of dry friction, or no joint has a bound.
    """
    friction = dry_friction(model)
    if not any(friction) or not named(gains.family, gains.m).bounded or gains.angle_unit == "deg":
        return None
    errors = tuple(rest_errors(gains, model))
    if all(e is None for e in errors):
        return None
    from lyapcheck.check.kinds.resting import AtBounds, Resting

    return judged_statement(
        Resting(gains.family, gains.m, tuple(gains.kp), tuple(friction), errors), [AtBounds()]
    )


Fact = tuple[Fraction, str]
"""How far from the goal, rad, and in words."""


def farthest(gains: GainSet, model: RobotModel) -> Fact | None:
    """How far from the goal dry friction may leave the joints; ``None`` without any, or an h unknown here."""
    if not any(dry_friction(model)):
        return None
    assumed = " (assumed)" if any(x is not None and x.assumed for x in model.coulomb) else ""
    result, stuck = resting(gains, model), held(gains, model)
    if stuck:
        joints = ", ".join(model.joints[i] for i in stuck)
        return ANYWHERE, f"dry friction{assumed} may hold {joints} anywhere"
    if result is None or result.verdict != ACCEPTED or None in _errors(result):
        return ANYWHERE, f"dry friction{assumed} may leave it off its goal"
    error = max(x for x in _errors(result) if x is not None)
    return error, f"dry friction{assumed} leaves at most {degrees_above(error)}"


def _errors(result: JudgedStatement) -> tuple[Fraction | None, ...]:
    errors: tuple[Fraction | None, ...] = result.statement.errors  # type: ignore[attr-defined]
    return errors


def friction_lines(gains: GainSet, model: RobotModel, stuck: Sequence[int]) -> list[str]:
    """Where a joint rests anywhere, and how far from the goal the others may."""
    friction = dry_friction(model)
    assumed = " (assumed)" if any(x is not None and x.assumed for x in model.coulomb) else ""
    lines = []
    for i in stuck:
        number, most, k = model.coulomb[i], decimal_text(friction[i]), decimal_text(gains.kp[i])
        upto, may = ("up to ", "may rest") if number is not None and number.ranged else ("", "rests")
        lines.append(
            f"γ k_p of {model.joints[i]} does not exceed its dry friction of {upto}{most} N·m{assumed}: "
            f"the joint {may} wherever it stops; k_p = {k} is in N·m"
        )
    result = resting(gains, model)
    if result is not None and result.verdict == ACCEPTED:
        errors = zip(model.joints, _errors(result), friction, strict=True)
        far = [f"{joint} {degrees_above(e)}" for joint, e, f in errors if f and e is not None]
        if far:
            lines.append(f"dry friction{assumed} leaves at most {', '.join(far)}, at every state of rest")
    return lines
