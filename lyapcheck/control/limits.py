"""What the conditions take from the arm: torque limits, gravity bounds and the smallest viscous friction."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.control.gains import arm_named_in
from lyapcheck.control.gravity import Gravity, RefutedBound, computed_bounds, settled
from lyapcheck.control.judgement import Room
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots import ArmLike, Number, RobotModel, load
from lyapcheck.robots.choice import named

if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainFile
    from lyapcheck.robots.fields import Vary


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
        torque_notes: which torque limits are assumed, and why.
        viscous_notes: which friction is assumed, and why.
        doubts: signs that the arm file is a template or in other units.
        own: the arm of the file alone, without ranges of the command line.

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
    torque_notes: tuple[str, ...] = ()
    viscous_notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    own: RobotModel | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        torque = ", ".join("?" if one is None else decimal_text(one) for one in self.torque)
        return f"<Limits: {self.robot or 'no arm'}, {self.n} joints, torque ({torque}) N·m>"

    @property
    def n(self) -> int:
        return len(self.joints)

    @property
    def room(self) -> Room:
        """What each motor can do beyond gravity. A load that is not below it may hold a joint anywhere."""
        pairs = zip(self.torque, self.gravity, strict=True)
        return tuple(None if torque is None else torque - k_g for torque, k_g in pairs)

    @property
    def nominal(self) -> bool:
        """Whether proofs of stability are about one arm out of ranges."""
        arm = None if self.varied else self.model
        return arm is not None and any(one.ranged for one in (*arm.parameters.values(), *arm.viscous))

    @property
    def ranges(self) -> tuple[str, ...]:
        """What the ranges of --vary cost."""
        return tuple(text for text in self.assumptions if text.startswith("--vary "))


def arm_limits(name: str, varies: tuple[Vary, ...] = ()) -> Limits:
    """The limits of an arm; for all values in ranges, if there are some, with what these cost in its notes.

    Raises:
        InputError: no such arm, a file that describes none, or a range of nothing that it has.
    """
    return limits_of(load(name, vary=varies))


def limits_of(model: RobotModel) -> Limits:
    """The limits of an arm, for all values in the ranges that it was loaded with."""
    if not model.varies:
        return model_limits(model)
    return replace(model_limits(model, load(model.address)), varied=True)


def _cost(arm: Limits, bounds: Bounds) -> list[str]:
    """What the ranges of --vary change among the limits that a gain file does not replace, as one note."""
    if not arm.varied or arm.model is None:
        return []
    before = model_limits(arm.own or arm.model)
    pairs = [] if bounds.viscous_min else [("λmin(B)", "N·m·s/rad", before.viscous_min, arm.viscous_min)]
    pairs += [
        (f"{what} of {joint}", "N·m", first, then)
        for what, key in (("torque limit", "torque"), ("gravity bound", "gravity"))
        if not getattr(bounds, key)
        for joint, first, then in zip(arm.joints, getattr(before, key), getattr(arm, key), strict=True)
    ]
    cost = [
        f"{what} {float(then):.6g} instead of {float(first):.6g} {unit}"
        for what, unit, first, then in pairs
        if first != then and first is not None and then is not None
    ]
    costs = "; ".join(cost) or f"no limit changes{bounds.said}"
    return [f"--vary {', '.join(one.text for one in arm.model.varies)}: {costs}"]


def model_limits(model: RobotModel, own: RobotModel | None = None) -> Limits:
    """The limits for all values of what is uncertain about the arm, with what they assume.

    Args:
        model: the arm.
        own: the arm as its file gives it, where ranges are supposed beside it.
    """
    own = own or model
    gravity = settled(model, stated_bounds(model), own)
    torque = tuple(None if limit is None else limit.bounds[0] for limit in model.torque_limit)
    held = any(t is None or k < t for t, k in zip(torque, gravity.bounds, strict=True))
    above = "Gravity may exceed the torque limit of every joint: are masses in grams, or lengths in mm?"
    return Limits(
        torque=torque,
        gravity=gravity.bounds,
        viscous_min=min(number.bounds[0] for number in model.viscous),
        joints=model.joints,
        robot=model.name,
        model=model,
        refuted=gravity.refuted,
        gravity_notes=gravity.notes,
        torque_notes=_assumed("torque limit", model.joints, model.torque_limit),
        viscous_notes=_assumed("friction", model.joints, model.viscous),
        doubts=own.doubts if held else (*own.doubts, above),
        own=own,
    )


def gravity_bounds(model: RobotModel) -> tuple[Fraction, ...]:
    """k_gi of each joint: as the source prints it, whatever the model says, else computed."""
    pairs = zip(stated_bounds(model), computed_bounds(model), strict=True)
    return tuple(own if bound is None else bound for bound, own in pairs)


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


def limits_for(
    gain_file: GainFile,
    robot: ArmLike | None = None,
    arms: dict[str, Limits] | None = None,
) -> Limits:
    """Return the limits for a gain file, from its own ``[bounds]`` first and then from the arm.

    Args:
        gain_file: the gains.
        robot: an arm, its name or the path of its file, instead of the arm that the gain file names.
        arms: arms already read, by name. Arms that are read now are added.

    Raises:
        InputError: no arm and no bounds, an unknown arm, or another number of joints.
    """
    bounds, first, given = gain_file.bounds, gain_file.gains[0], None
    if isinstance(robot, RobotModel):
        name: str | None = robot.address
        given = limits_of(robot)
    else:
        name = named(robot, gain_file.robot)
    if name is None:
        if bounds.torque is None or bounds.gravity is None or bounds.viscous_min is None:
            rule = "is missing and [bounds] does not give viscous_min, torque and gravity"
            repair = 'name an arm, for instance robot = "buap3"'
            raise InputError(Problem(gain_file.path, None, "robot", "", rule, repair))
        told = ", ".join(map(decimal_text, bounds.gravity))
        premise = f"premise: gravity exerts up to ({told}) N·m, by [bounds] gravity; no arm shows it"
        joints = tuple(f"joint {i + 1}" for i in range(first.n))
        numbers = bounds.torque, bounds.gravity, bounds.viscous_min, joints
        return Limits(*numbers, (premise,), gravity_notes=(premise,))
    known = {} if arms is None else arms
    if given is None and name not in known:
        with arm_named_in(gain_file, robot):
            known[name] = arm_limits(name)
    arm = given or known[name]
    if arm.n != first.n:
        place = gain_file.place(first, "kp")
        rule = f"has gains for {first.n} joints, but the arm {arm.robot} has {arm.n}"
        repair = "name the arm the gains were made for, or give one gain a joint"
        raise InputError(Problem(gain_file.path, place.line if place else None, "gains", "", rule, repair))
    notes = (*(() if bounds.torque else arm.torque_notes), *_cost(arm, bounds))
    notes += () if bounds.viscous_min else arm.viscous_notes
    gravity = Gravity(arm.gravity, arm.gravity_notes, arm.refuted)
    if bounds.gravity is not None and arm.model is not None:
        gravity = settled(arm.model, bounds.gravity, arm.own or arm.model)
    return replace(
        arm,
        torque=bounds.torque or arm.torque,
        gravity=gravity.bounds,
        viscous_min=bounds.viscous_min or arm.viscous_min,
        assumptions=(*gravity.notes, *notes, *arm.doubts),
        robot=name,
        refuted=gravity.refuted,
        gravity_notes=gravity.notes,
    )
