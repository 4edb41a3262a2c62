"""What an arm's model says about its limits."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.control.gravity import RefutedBound, computed_bounds, settled
from lyapcheck.robots import Number, RobotModel, load

if TYPE_CHECKING:
    from lyapcheck.robots.vary import Vary


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
    def n(self) -> int:
        """Number of joints."""
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
