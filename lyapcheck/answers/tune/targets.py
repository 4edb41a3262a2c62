"""What a user asks of tuned gains, and what the limits of an arm leave to any."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.control.gains import Bounds, GainFile, GainSet
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.files.decimals import decimal_text, round_down
from lyapcheck.robots import ArmLike, RobotModel, load
from lyapcheck.robots.choice import split

if TYPE_CHECKING:
    from lyapcheck.robots.fields import Vary

MOST_DIGITS = 12
Number = int | str | Fraction | Decimal
Numbers = Number | Sequence[Number]
"""One exact number for all joints, or one a joint."""
ONE = (Fraction(1),)


@dataclass(frozen=True)
class Targets:
    """Targets for stiffness, damping and torque. A tuple of one number counts for every joint.

    ``Targets.of`` makes them from numbers as one writes them.

    Args:
        digits: decimal places of the gains, 0 to 12.
        peak_share: the share of each torque limit that may be used, in (0, 1].
        kv_share: smallest share of the largest k_v under (19), in (0, 1]. None is 1.
        damping: a lower bound of the damping ratio ζ_i of each joint. See ``lyapcheck.answers.tune.largest``.
    """

    digits: int = 3
    peak_share: tuple[Fraction, ...] = ONE
    kv_share: tuple[Fraction, ...] | None = None
    damping: tuple[Fraction, ...] | None = None

    @classmethod
    def of(
        cls,
        *,
        digits: int = 3,
        peak_share: Numbers = 1,
        kv_share: Numbers | None = None,
        damping: Numbers | None = None,
    ) -> Targets:
        """The targets from one number for all joints, or one a joint.

        Numbers are exact: an ``int``, a ``Fraction``, a ``Decimal`` or decimal text such as ``"0.8"``.

        Raises:
            TypeError: a ``float``, which is not the decimal it looks like.
            ValueError: text that is no number.

        Example:
            >>> Targets.of(peak_share="0.8", damping=["0.05", "0.1"]).peak_share
            (Fraction(4, 5),)
        """
        optional = (None if each is None else _exact(each) for each in (kv_share, damping))
        return cls(digits, _exact(peak_share), *optional)

    @property
    def unit(self) -> Fraction:
        """One unit in the last decimal place of a gain."""
        return Fraction(1, 10**self.digits)

    def for_joints(self, n: int) -> Targets:
        """The same with one value per joint.

        Raises:
            InputError: one problem for every target that no gains could mean.
        """
        rule = f"must be from 0 to {MOST_DIGITS}"
        wrong = Problem("argument", None, "--digits", str(self.digits), rule, "write --digits 3")
        problems = [] if 0 <= self.digits <= MOST_DIGITS else [wrong]
        each: dict[str, Any] = {}
        tops = {"peak_share": Fraction(1), "kv_share": Fraction(1), "damping": None}
        for name, top in tops.items():
            values = getattr(self, name)
            if values is not None:
                problems += _complaints(f"--{name.replace('_', '-')}", values, top, n)
                each[name] = tuple(values) * n if len(values) == 1 else tuple(values)
        if problems:
            raise InputError(problems)
        return replace(self, **each)

    def text(self) -> str:
        """What is asked for, in one line."""
        parts = [f"{self.digits} decimal places"]
        for words, values in (
            ("no more than {} of each torque limit", self.peak_share),
            ("k_v ≥ {} of what (19) admits", self.kv_share),
            ("damping ratio ≥ {}", self.damping),
        ):
            if values is not None and (values is not self.peak_share or min(values) < 1):
                shown = values if len(set(values)) > 1 else values[:1]
                parts.append(words.format(", ".join(map(decimal_text, shown))))
        return "; ".join(parts)


def _exact(numbers: Numbers) -> tuple[Fraction, ...]:
    each = numbers if isinstance(numbers, Sequence) and not isinstance(numbers, str) else (numbers,)
    for number in each:
        if not isinstance(number, Number):
            raise TypeError(f"{number!r} is not exact; write it as text, such as '0.8'")
    return tuple(Fraction(number) for number in each)


def _complaints(option: str, values: Sequence[Fraction], top: Fraction | None, n: int) -> list[Problem]:
    shown = ",".join(map(decimal_text, values))
    if len(values) not in (1, n):
        rule = f"has {len(values)} values for {n} joints"
        return [Problem("argument", None, option, shown, rule, f"give one value, or {n}, one a joint")]
    if min(values) <= 0:
        return [Problem("argument", None, option, shown, "must be positive", "correct the value")]
    if top is not None and max(values) > top:
        return [Problem("argument", None, option, shown, "is a share, at most 1", "write for instance 0.8")]
    return []


# --- What the limits of an arm leave to gains, and why there may be none.


def limits_with(arm: RobotModel, bounds: Bounds | None = None) -> Limits:
    """The limits that the gate would judge gains for this arm by.

    Args:
        arm: the arm, with its ranges.
        bounds: limits to take instead of the arm's.
    """
    ones = (Fraction(1),) * arm.n
    gains = GainSet("limits", 1, ones, ones)
    return limits_for(GainFile(arm.address, None, (gains,), bounds or Bounds()), arm)


def arms_over(robot: ArmLike, varies: tuple[Vary, ...]) -> tuple[RobotModel, RobotModel]:
    """The arm as its file describes it, and the same with ranges.

    Raises:
        InputError: no such arm, or ranges for an arm that is already loaded.
    """
    if isinstance(robot, RobotModel) and varies:
        asked, rule = ", ".join(one.text for one in varies), "come too late for an arm that is loaded"
        raise argument_error("varies", asked, rule, "give load_robot(name, vary=…) the ranges")
    arm = robot if isinstance(robot, RobotModel) else load(robot, vary=varies)
    return load(arm.address) if arm.varies else arm, arm


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
                f"{decimal_text(round_down(gravity, 6))} N·m, so (10p) admits no gain; take a stronger "
                "motor, a lighter arm or a larger --peak-share"
            )
    if limits.viscous_min is not None and limits.viscous_min <= 0:
        state = "state it in an arm file that names this URDF, as viscous = … of the joint under [[joints]]"
        if split(limits.robot)[0].endswith(".toml") or "." not in limits.robot:
            where = "under [[joints]] where that names a URDF file"
            state = f"state it in the arm file as viscous = … of the joint, {where}"
        result.append(
            f"λmin(B) is 0, so (19) admits no k_v: {_without_friction(limits)}; measure the friction and "
            f"{state}, or give --viscous-min, or give targets, such as --overshoot 5: stability "
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
