"""What the conditions take from the arm: torque limits, gravity bounds and the smallest viscous friction."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.control.gains import arm_named_in
from lyapcheck.control.gravity import Gravity, RefutedBound, computed_bounds, settled
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots import Number, RobotModel, load
from lyapcheck.robots.choice import named

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.robots.vary import Vary


# --- What an arm's model says about its limits.


@dataclass(frozen=True)
class ArmLimits:
    """What the conditions take from an arm: see ``Limits``.

    Args:
        name: of the arm.
        joints: their names.
        torque: torque limit of each joint, N·m; ``None`` where there is none.
        gravity: bound of each gravity torque, N·m.
        viscous_min: λmin(B), N·m·s/rad.
        torque_notes: which torque limits are assumed, and why.
        viscous_notes: which friction is assumed, and why.
        model: the arm itself.
        varied: whether the limits, and proofs about the arm, are to hold for all of its ranges.
        gravity_notes: which printed bounds of gravity the model does not keep.
        refuted: those that it breaks.
        own: the arm as its file gives it, without ranges that are supposed beside it.
    """

    name: str
    joints: tuple[str, ...]
    torque: tuple[Fraction | None, ...]
    gravity: tuple[Fraction, ...]
    viscous_min: Fraction
    torque_notes: tuple[str, ...] = ()
    viscous_notes: tuple[str, ...] = ()
    model: RobotModel | None = field(default=None, compare=False, repr=False)
    varied: bool = False
    gravity_notes: tuple[str, ...] = ()
    refuted: tuple[RefutedBound, ...] = field(default=(), compare=False, repr=False)
    own: RobotModel | None = field(default=None, compare=False, repr=False)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What looks like a template or another unit, and gravity that no motor holds."""
        held = [t is None or k < t for t, k in zip(self.torque, self.gravity, strict=True)]
        above = "Gravity may exceed the torque limit of every joint: are masses in grams, or lengths in mm?"
        return (*(self.own.doubts if self.own else ()), *(() if any(held) else (above,)))

    @property
    def n(self) -> int:
        return len(self.joints)


def arm_limits(name: str) -> ArmLimits:
    """The limits of an arm.

    Raises:
        InputError: no such arm, or a file that describes none.
    """
    return model_limits(load(name))


def varied_limits(name: str, varies: tuple[Vary, ...]) -> ArmLimits:
    """The limits of an arm for all values in some ranges, with what these cost in its notes.

    Raises:
        InputError: no such arm, or a range of nothing that it has.
    """
    nominal = arm_limits(name)
    result = model_limits(load(name, vary=varies), nominal.model)
    asked = ", ".join(one.text for one in varies)
    pairs = [("λmin(B)", "N·m·s/rad", nominal.viscous_min, result.viscous_min)]
    pairs += [
        (f"{what} of {joint}", "N·m", before, after)
        for what, key in (("torque limit", "torque"), ("gravity bound", "gravity"))
        for joint, before, after in zip(
            result.joints, getattr(nominal, key), getattr(result, key), strict=True
        )
    ]
    cost = [
        f"{what} {_shown(after)} instead of {_shown(before)} {unit}"
        for what, unit, before, after in pairs
        if before != after and before is not None and after is not None
    ]
    note = f"--vary {asked}: {'; '.join(cost) or 'no limit changes'}"
    return replace(result, viscous_notes=(note, *result.viscous_notes), varied=True)


def _shown(value: Fraction) -> str:
    return f"{float(value):.6g}"


def model_limits(model: RobotModel, own: RobotModel | None = None) -> ArmLimits:
    """The limits for all values of what is uncertain about the arm, with what they assume.

    Args:
        model: the arm.
        own: the arm as its file gives it, where ranges are supposed beside it.
    """
    gravity = settled(model, stated_bounds(model), own or model)
    return ArmLimits(
        name=model.name,
        joints=model.joints,
        torque=tuple(None if limit is None else limit.bounds[0] for limit in model.torque_limit),
        gravity=gravity.bounds,
        viscous_min=min(number.bounds[0] for number in model.viscous),
        torque_notes=_assumed("torque limit", model.joints, model.torque_limit),
        viscous_notes=_assumed("friction", model.joints, model.viscous),
        model=model,
        gravity_notes=gravity.notes,
        refuted=gravity.refuted,
        own=own or model,
    )


def gravity_bounds(model: RobotModel) -> tuple[Fraction, ...]:
    """k_gi of each joint: as the source prints it, whatever the model says, else computed."""
    pairs = zip(stated_bounds(model), computed_bounds(model), strict=True)
    return tuple(own if bound is None else bound for bound, own in pairs)


def kept_bounds(model: RobotModel) -> tuple[Fraction, ...]:
    """k_gi of each joint: as the source prints it where the model keeps it for all of its ranges."""
    return settled(model, stated_bounds(model), model).bounds


def stated_bounds(model: RobotModel) -> tuple[Fraction | None, ...]:
    """The bounds that the source of the arm prints, N·m."""
    return tuple(None if bound is None else bound.bounds[1] for bound in model.gravity_bound)


def _assumed(what: str, joints: tuple[str, ...], numbers: tuple[Number | None, ...]) -> tuple[str, ...]:
    """The assumed numbers among some of the joints', each as a sentence."""
    return tuple(
        number.sentence(f"{what} of {joint}")
        for joint, number in zip(joints, numbers, strict=True)
        if number is not None and number.assumed
    )


@dataclass(frozen=True)
class Limits:
    """Exact limits of an arm. An entry is None if neither the arm nor the gain file gives it.

    Args:
        torque: torque limit τmax_i of each joint, N·m.
        gravity: bound k_gi of each gravity torque, N·m.
        viscous_min: λmin(B), N·m·s/rad.
        joints: their names.
        assumptions: numbers that no source prints.
        robot: the name of the arm. Empty if the gain file gives all numbers.
        model: the arm, or None if the gain file gives all numbers.
        varied: True if proofs must hold for all ranges of the arm, not only at nominal numbers.
        refuted: stated bounds of gravity that the arm itself breaks, which are not among ``gravity``.
        gravity_notes: notes about ``gravity``.
        doubts: signs that the arm file is a template or in other units.

    References: (9), (10), (19) and property 2.8 of reyes2019family.
    """

    torque: tuple[Fraction | None, ...]
    gravity: tuple[Fraction, ...]
    viscous_min: Fraction | None
    joints: tuple[str, ...]
    assumptions: tuple[str, ...] = ()
    robot: str = ""
    model: RobotModel | None = field(default=None, compare=False, repr=False)
    varied: bool = False
    refuted: tuple[RefutedBound, ...] = field(default=(), compare=False, repr=False)
    gravity_notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()

    @property
    def n(self) -> int:
        return len(self.joints)

    @property
    def ranges(self) -> tuple[str, ...]:
        """What the ranges of --vary cost."""
        return tuple(text for text in self.assumptions if text.startswith("--vary "))

    def resting_on(self, assumptions: tuple[str, ...]) -> Limits:
        return replace(self, assumptions=assumptions)


def limits_for(
    gain_file: GainFile, robot: str | None = None, arms: dict[str, ArmLimits] | None = None
) -> Limits:
    """Return the limits for a gain file, from its own ``[bounds]`` first and then from the arm.

    Args:
        gain_file: the gains.
        robot: an arm that replaces the one the file names.
        arms: arms already read, by name. Arms that are read now are added.

    Raises:
        InputError: no arm and no bounds, an unknown arm, or another number of joints.
    """
    bounds, name = gain_file.bounds, named(robot, gain_file.robot)
    n = gain_file.gains[0].n
    if name is None:
        if None in (bounds.torque, bounds.gravity, bounds.viscous_min):
            raise _without_arm(gain_file)
        told = ", ".join(map(decimal_text, bounds.gravity or ()))
        premise = f"premise: gravity exerts up to ({told}) N·m, by [bounds] gravity; no arm shows it"
        numbers = bounds.torque or (), bounds.gravity or (), bounds.viscous_min, _numbered(n)
        return Limits(*numbers, (premise,), gravity_notes=(premise,))
    known = {} if arms is None else arms
    if name not in known:
        with arm_named_in(gain_file, robot):
            known[name] = arm_limits(name)
    arm = known[name]
    if arm.n != n:
        raise _wrong_arm(gain_file, arm.name, arm.n)
    notes = (*(() if bounds.torque else arm.torque_notes), *(() if bounds.viscous_min else arm.viscous_notes))
    notes += arm.doubts
    gravity = Gravity(arm.gravity, arm.gravity_notes, arm.refuted)
    if bounds.gravity is not None and arm.model is not None:
        gravity = settled(arm.model, bounds.gravity, arm.own or arm.model)
    return Limits(
        torque=bounds.torque or arm.torque,
        gravity=gravity.bounds,
        viscous_min=bounds.viscous_min or arm.viscous_min,
        joints=arm.joints,
        assumptions=(*gravity.notes, *notes),
        robot=name,
        model=arm.model,
        varied=arm.varied,
        refuted=gravity.refuted,
        gravity_notes=gravity.notes,
        doubts=arm.doubts,
    )


def _numbered(n: int) -> tuple[str, ...]:
    return tuple(f"joint {i + 1}" for i in range(n))


def _without_arm(gain_file: GainFile) -> InputError:
    rule = "is missing and [bounds] does not give viscous_min, torque and gravity"
    return InputError(
        Problem(gain_file.path, None, "robot", "", rule, 'name an arm, for instance robot = "buap3"')
    )


def _wrong_arm(gain_file: GainFile, name: str, n: int) -> InputError:
    place = gain_file.place(gain_file.gains[0], "kp")
    rule = f"has gains for {gain_file.gains[0].n} joints, but the arm {name} has {n}"
    repair = "name the arm the gains were made for, or give one gain a joint"
    return InputError(Problem(gain_file.path, place.line if place else None, "gains", "", rule, repair))
