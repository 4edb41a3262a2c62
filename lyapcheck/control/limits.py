"""What the conditions take from the arm: torque limits, gravity bounds and the smallest viscous friction."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.control.arm_limits import ArmLimits, arm_limits
from lyapcheck.control.gains import arm_named_in
from lyapcheck.control.gravity import Gravity, RefutedBound, settled
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class Limits:
    """Exact limits of an arm; an entry is ``None`` where neither the arm nor the gain file gives it.

    Args:
        torque: torque limit τmax_i of each joint, N·m.
        gravity: bound k_gi of each gravity torque, N·m.
        viscous_min: λmin(B), N·m·s/rad.
        joints: their names.
        assumptions: what the numbers rest on that no source prints.
        robot: the arm as it was named; empty where the gain file gives all numbers itself.
        model: the arm; ``None`` where the gain file gives all numbers itself.
        varied: whether proofs about the arm are to hold for all of its ranges, not at its nominal numbers.
        refuted: stated bounds of gravity that the arm itself breaks, which are not among ``gravity``.
        gravity_notes: what there is to say of ``gravity``.

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

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def resting_on(self, assumptions: tuple[str, ...]) -> Limits:
        """The same limits with other assumptions."""
        return replace(self, assumptions=assumptions)


def limits_for(
    gain_file: GainFile, robot: str | None = None, arms: dict[str, ArmLimits] | None = None
) -> Limits:
    """The limits that a gain file is judged by: its own ``[bounds]`` first, the arm for the rest.

    Args:
        gain_file: the gains.
        robot: an arm that replaces the one the file names.
        arms: arms that need not be read again, by name; those that are read now are added.

    Raises:
        InputError: no arm and no bounds, an unknown arm, or another number of joints.
    """
    bounds, name = gain_file.bounds, robot or gain_file.robot
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
