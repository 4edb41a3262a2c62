"""What an engineer at the bench should know of accepted gains: how they swing, where they may rest.

Near the goal a joint that moves alone obeys J ë + b ė + k_v h(ė) + k_p h(e) = 0. With h(x) = L x, which it is
at most, the damping ratio is ζ = (b + L k_v)/(2 √(J L k_p)), J the largest M_ii. Dry friction f holds the
joint wherever k_p |h(e)| ≤ f. That is in floating point; the checker judges

    rest   |e_i| ≤ X at every state of rest of (11) within dry friction f: K_p h(e) + d = 0, |d_i| ≤ f_i
    held   k_pi ≤ f_i/γ, so that k_pi |h(e_i)| ≤ f_i for every e: joint i rests wherever it stops

References: (6), (11) of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from math import degrees, exp, pi, sqrt
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.stability import small
from lyapcheck.asked import resting as asked_resting
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.numbers.harmonics import harmonics, largest
from lyapcheck.control.judgement import (
    ACCEPTED,
    DEGREES,
    JudgedStatement,
    Room,
    dry_friction,
    judged_statement,
    rest_error,
    stalls,
)
from lyapcheck.control.sampling import exact_only
from lyapcheck.control.threshold import Threshold, scaled
from lyapcheck.errors import installed
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.promise import promised
from lyapcheck.robots import trig

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.check.expressions.expression import Tree
    from lyapcheck.control.gains import GainSet
    from lyapcheck.promise import Promise
    from lyapcheck.robots import RobotModel

SWINGS = 0.5
"""A damping ratio below which a joint overshoots by more than a sixth of its step."""
POSTURES = 20_000
"""At which M(q) is looked at where it is too long to be written out."""
HARDLY = 0.1
"""A damping ratio below which nobody wants gains: they overshoot by more than 70 %."""
ANYWHERE = Fraction(10**6)
Fact = tuple[Fraction, str]
"""How far from the goal, in degrees, and in words."""


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
    if not small(model.fixed()) and not installed("numpy"):
        return []
    ratios = damping_ratios(gains, model)
    text = ", ".join(f"{joint} {ratio:.2f}" for joint, ratio in zip(model.joints, ratios, strict=True))
    least = min(ratios)
    end = ""
    if least < SWINGS:
        over = 100 * exp(-pi * least / sqrt(1 - least**2))
        end = f": without dry friction it swings, by about {over:.0f} % of a step"
    soft = " of a large motion, as h is flat at the goal" if gains.m is not None and gains.m > 1 else ""
    return [f"estimated damping ratio{soft}{_nominal(model)}, at the posture of most inertia: {text}{end}"]


def swinging(gains: GainSet, model: RobotModel) -> str:
    """That gains hardly damp a joint, in words; empty where they do, or nothing is known of it."""
    if not small(model.fixed()) and not installed("numpy"):
        return ""
    least = min(damping_ratios(gains, model))
    if least >= HARDLY:
        return ""
    return f"estimated damping ratio {least:.2g}{_nominal(model)}: it hardly stops swinging"


def _nominal(model: RobotModel) -> str:
    ranged = any(number.ranged for number in (*model.parameters.values(), *model.viscous))
    return " at nominal numbers" if ranged else ""


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
    """The largest M_ii of each joint as Fourier sums show it, or many postures, kg·m²."""
    nominal = model.fixed()
    if not small(nominal):
        import numpy as np

        from lyapcheck.robots.numeric import NumericModel

        postures = np.random.default_rng(POSTURES).uniform(-np.pi, np.pi, (POSTURES, model.n))
        inertias = NumericModel(nominal).mass(postures).diagonal(axis1=1, axis2=2).max(axis=0)
        return tuple(map(float, inertias))
    return tuple(
        float(largest(harmonics(trig.to_terms(nominal.mass[i][i]), model.n))) for i in range(model.n)
    )


def held(gains: GainSet, model: RobotModel) -> dict[int, JudgedStatement]:
    """The joints, from 0, that dry friction is proved to hold wherever they stop."""
    gamma = named(gains.family, gains.m).gamma
    if gamma is None:
        return {}
    rows = enumerate(zip(gains.kp, dry_friction(model), strict=True))
    result = {i: _limit(f, gamma).judged(kp) for i, (kp, f) in rows if f}
    return {i: one for i, one in result.items() if one.verdict == ACCEPTED}


@lru_cache(maxsize=64)
def _limit(friction: Fraction, gamma: Tree) -> Threshold:
    return scaled(friction, 1, gamma, "<=")


@lru_cache(maxsize=64)
def resting(gains: GainSet, model: RobotModel, room: Room) -> Promise | None:
    """How far from the goal the joints may rest, in angles as they are printed.

    ``None`` where nothing is known of dry friction, or no joint has a bound.
    """
    friction = dry_friction(model)
    if not any(friction) or not named(gains.family, gains.m).bounded or gains.angle_unit == "deg":
        return None
    _ = named(gains.family, gains.m).checked  # or say that the checker does not know the function
    return promised_rest(gains, friction, room, lambda angle: significant_up(angle, 4))[0]


def promised_rest(
    gains: GainSet, dry: Sequence[Fraction], room: Room, rounded: Callable[[Fraction], Fraction]
) -> tuple[Promise | None, str]:
    """The promise of bounds of |e_i| at every state of rest, as they are printed, or why there is none.

    Args:
        gains: of a bounded h that the checker knows.
        dry: bounds of dry friction, N·m.
        room: of each motor.
        rounded: an angle in degrees as it is printed, which is not below it.
    """
    errors = [
        None if stalls(f, most) else rest_error(gains.family, gains.m, f / k)
        for f, k, most in zip(dry, gains.kp, room, strict=True)
    ]
    if all(e is None for e in errors):
        return None, ""
    shown = judged_statement(asked_resting(gains, dry, errors), [AtBounds()])
    if shown.verdict != ACCEPTED:
        return None, ""
    printed = [None if e is None else rounded(e * DEGREES) / DEGREES for e in errors]
    return promised(asked_resting(gains, dry, printed), shown)


def promised_errors(promise: Promise | None, n: int) -> tuple[Fraction | None, ...]:
    """The bounds of |e_i|, rad, of a promise of `promised_rest`; ``None`` for each joint without one."""
    if promise is None:
        return (None,) * n
    assert isinstance(promise.asked, Resting)
    return promise.asked.errors


def farthest(result: GateResult, model: RobotModel) -> Fact | None:
    """How far from the goal dry friction may leave the joints; ``None`` without any, or an h unknown here."""
    gains = result.gains
    if not any(dry_friction(model)):
        return None
    assumed = " (assumed)" if any(x is not None and x.assumed for x in model.coulomb) else ""
    rest, stuck = resting(gains, model, result.limits.room), held(gains, model)
    if stuck:
        joints = ", ".join(model.joints[i] for i in stuck)
        return ANYWHERE, f"dry friction{assumed} may hold {joints} anywhere"
    known = [error * DEGREES for error in promised_errors(rest, model.n) if error is not None]
    if rest is None or len(known) < model.n:
        return ANYWHERE, f"dry friction{assumed} may leave it off its goal"
    most = max(known)
    words = rest.says(f"dry friction{assumed} leaves at most {decimal_text(most)}°")
    return most, words + without_friction(model) + exact_only(result.record)


def without_friction(model: RobotModel) -> str:
    """What a bound of the error leaves out: joints without dry friction in a file that has some."""
    joints = model.of_unknown_friction if model.dry else ()
    few = joints[0] if len(joints) == 1 else f"{len(joints)} joints"
    return f", unknown at {few}" if joints else ""


def friction_lines(result: GateResult, model: RobotModel, stuck: Sequence[int]) -> list[str]:
    """Where a joint rests anywhere, and how far from the goal the others may."""
    gains, room = result.gains, result.limits.room
    friction = dry_friction(model)
    assumed = " (assumed)" if any(x is not None and x.assumed for x in model.coulomb) else ""
    lines = []
    for i in stuck:
        number, most, k = model.coulomb[i], decimal_text(friction[i]), decimal_text(gains.kp[i])
        ranged, weak = number is not None and number.ranged, stalls(Fraction(0), room[i])
        upto, may = "up to " * ranged, "may rest" if ranged or weak else "rests"  # a weak motor lets it fall
        lines.append(
            f"γ k_p of {model.joints[i]} does not exceed its dry friction of {upto}{most} N·m{assumed}: "
            f"the joint {may} wherever it stops; k_p = {k} is in N·m"
        )
    lines += [
        f"gravity and dry friction{assumed} may hold {joint} anywhere, with its motor at its limit"
        for joint, f, most in zip(model.joints, friction, room, strict=True)
        if f and stalls(f, most)
    ]
    rest = resting(gains, model, room)
    if rest is not None:
        rows = zip(model.joints, promised_errors(rest, model.n), friction, strict=True)
        far = [
            f"{joint} {decimal_text(error * DEGREES)}°" for joint, error, f in rows if f and error is not None
        ]
        if far:
            leaves = f"dry friction{assumed} leaves at most {', '.join(far)}, at every state of rest"
            leaves += exact_only(result.record)
            lines.append(rest.says(leaves))
    return lines
