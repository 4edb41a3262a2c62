"""What the limits of an arm leave to gains, and why there may be none."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.tune.largest import GainRange
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.control.gains import Bounds, GainFile, GainSet
from lyapcheck.control.limits import Limits, limits_for, varied_limits
from lyapcheck.files.decimals import decimal_text, round_down
from lyapcheck.robots.choice import split

if TYPE_CHECKING:
    from lyapcheck.robots.vary import Vary


def arm_limits(robot: str, n: int, bounds: Bounds | None = None, varies: tuple[Vary, ...] = ()) -> Limits:
    """The limits that the gate would judge gains for this arm by.

    Args:
        robot: a built-in arm, or the path of an arm file.
        n: its number of joints.
        bounds: limits to take instead of the arm's.
        varies: ranges that the limits are to hold for.
    """
    ones = (Fraction(1),) * n
    arms = {robot: varied_limits(robot, varies)} if varies else None
    return limits_for(
        GainFile(robot, robot, (GainSet("limits", 1, ones, ones),), bounds or Bounds()), None, arms
    )


def unknown(limits: Limits) -> list[str]:
    """What is not known of the arm and has to be given."""
    result = [
        f"{name}: the arm has no torque limit for this joint; give --torque"
        for name, torque in zip(limits.joints, limits.torque, strict=True)
        if torque is None
    ]
    if limits.viscous_min is None:
        result.append("the arm has no viscous friction; give --viscous-min")
    return result


def impossible(limits: Limits) -> list[str]:
    """Limits that leave nothing to any gain, whatever the member of the family."""
    result = []
    for name, torque, gravity in zip(limits.joints, limits.torque, limits.gravity, strict=True):
        if torque is not None and torque <= gravity:
            result.append(
                f"{name}: the torque limit of {decimal_text(torque)} N·m is not above the gravity torque of "
                f"{_shown(gravity)} N·m, so (10p) admits no gain; take a stronger motor, a lighter arm or a "
                "larger --peak-share"
            )
    if limits.viscous_min is not None and limits.viscous_min <= 0:
        result.append(
            f"λmin(B) is 0, so (19) admits no k_v: {_without_friction(limits)}; measure the friction and "
            f"{_state_it(limits)}, or give --viscous-min, or give targets, such as --overshoot 5: stability "
            "by LaSalle's theorem needs none"
        )
    return result


def _without_friction(limits: Limits) -> str:
    """The joints whose viscous friction may be 0, and where to state another."""
    model = limits.model
    if model is None:
        return "the viscous friction of a joint is not known"
    said: dict[str, list[str]] = {}
    for joint, number in zip(model.joints, model.viscous, strict=True):
        if number.bounds[0] <= 0:
            told = "is not known" if number.assumed else "is 0 in the file"
            said.setdefault("may be 0 in its range" if number.value > 0 else told, []).append(joint)
    return ", ".join(f"the viscous friction of {', '.join(of)} {what}" for what, of in said.items())


def _state_it(limits: Limits) -> str:
    """How to state friction in an arm file."""
    if not split(limits.robot)[0].endswith(".toml") and "." in limits.robot:
        return "state it in an arm file that names this URDF, as viscous = … of the joint under [[joints]]"
    return (
        "state it in the arm file as viscous = … of the joint, under [[joints]] where that names a URDF file"
    )


def obstacle(gain_range: GainRange, joint: int, limits: Limits, targets: Targets) -> str:
    """Why a joint with positive limits still has no gains; empty where it has."""
    name, unit = limits.joints[joint], gain_range.unit
    if min(gain_range.most_kv, gain_range.most_sum - 1) < 1:
        return f"{name}: {targets.digits} decimal places are too few for gains this small; raise --digits"
    if gain_range.least_kv > gain_range.most_kv:
        return (
            f"{name}: k_v ≥ {decimal_text(gain_range.least_kv * unit)} breaks (19), which admits k_v ≤ "
            f"{decimal_text(gain_range.most_kv * unit)}; lower --kv-min"
        )
    if gain_range.least_kv >= gain_range.most_sum:
        return (
            f"{name}: k_v ≥ {decimal_text(gain_range.least_kv * unit)} leaves no room for k_p, "
            f"as (10p) admits k_p + k_v ≤ {decimal_text(gain_range.most_sum * unit)}; "
            f"{_less_damping(joint, limits, targets)}"
        )
    if gain_range.most_kp(gain_range.kv_range[1]) < 1:
        return (
            f"{name}: the damping ratio needs k_p below one unit of the last digit; lower --damping or "
            "raise --digits"
        )
    return ""


def _less_damping(joint: int, limits: Limits, targets: Targets) -> str:
    if targets.kv_min is not None:
        return "lower --kv-min or --kv-share"
    torque, friction = limits.torque[joint], limits.viscous_min
    if torque is None or friction is None:
        return "lower --kv-share"
    share = round_down((torque - limits.gravity[joint]) / friction, 2)
    return f"lower --kv-share below {decimal_text(share)}" if share > 0 else "lower --kv-share"


def _shown(value: Fraction) -> str:
    return decimal_text(round_down(value, 6))
