"""What the conditions take from the arm: torque limits, gravity bounds and the smallest viscous friction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from flint import fmpq_mpoly

from lyapcheck.control.gains import GainFile
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.printable import printable

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class Limits:
    """Exact limits of an arm; an entry is ``None`` where neither the arm nor the gain file gives it.

    Args:
        torque: torque limit τmax_i of each joint, N·m.
        gravity: bound k_gi of each gravity torque, N·m.
        viscous_min: λmin(B), N·m·s/rad.
        assumptions: what the numbers rest on that no source prints.

    References: (9), (10), (19) and property 2.8 of reyes2019family.
    """

    torque: tuple[Fraction | None, ...]
    gravity: tuple[Fraction, ...]
    viscous_min: Fraction | None
    joints: tuple[str, ...]
    assumptions: tuple[str, ...] = ()

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)


def limits_for(gain_file: GainFile, robot: str | None = None) -> Limits:
    """The limits that a gain file is judged by: its own ``[bounds]`` first, the arm for the rest.

    Args:
        gain_file: the gains.
        robot: an arm that replaces the one the file names.

    Raises:
        InputError: no arm and no bounds, an unknown arm, or another number of joints.
    """
    bounds, name = gain_file.bounds, robot or gain_file.robot
    given = (bounds.torque, bounds.gravity, bounds.viscous_min)
    n = gain_file.gains[0].n
    if name is None:
        if None in given:
            raise _without_arm(gain_file)
        return Limits(bounds.torque or (), bounds.gravity or (), bounds.viscous_min, _numbered(n))
    from lyapcheck.robots import load

    model = load(name) if robot else _named_arm(gain_file, name)
    if model.n != n:
        raise _wrong_arm(gain_file, model.name, model.n)
    return Limits(
        torque=bounds.torque or tuple(_least(limit) for limit in model.torque_limit),
        gravity=bounds.gravity or gravity_bounds(model),
        viscous_min=bounds.viscous_min or min(_low(b) for b in model.viscous),
        joints=model.joints,
        assumptions=_assumptions(model, bounds.torque is None, bounds.viscous_min is None),
    )


def gravity_bounds(model: RobotModel) -> tuple[Fraction, ...]:
    """k_gi of each joint: as the source prints it, else the smaller of two bounds.

    The sum of the coefficients of g_i in size, and for a chain of links what masses and distances say.

    Soundness: every monomial is a product of sines and cosines, at most 1 in size, and of parameters, at
    most the larger end of their range; see `lyapcheck.robots.chain_bounds` for the other.
    """
    printed = (None if bound is None else bound.bounds[1] for bound in model.gravity_bound)
    sums = [_coefficient_sum(model, torque) for torque in model.gravity]
    chain = sums if model.chain_bounds is None else model.chain_bounds.gravity
    return tuple(
        min(a, b) if bound is None else bound for bound, a, b in zip(printed, sums, chain, strict=True)
    )


def _coefficient_sum(model: RobotModel, poly: fmpq_mpoly) -> Fraction:
    sizes = [Fraction(1)] * (2 * model.n)
    sizes += [max(map(abs, number.bounds)) for number in model.parameters.values()]
    total = Fraction(0)
    for powers, coefficient in poly.terms():
        size = abs(Fraction(int(coefficient.p), int(coefficient.q)))
        for base, power in zip(sizes, powers, strict=True):
            size *= base ** int(power)
        total += size
    return total


def _least(limit: object) -> Fraction | None:
    return None if limit is None else _low(limit)


def _low(number: object) -> Fraction:
    low: Fraction = number.bounds[0]  # type: ignore[attr-defined]
    return low


def _numbered(n: int) -> tuple[str, ...]:
    return tuple(f"joint {i + 1}" for i in range(n))


def _assumptions(model: RobotModel, torque: bool, viscous: bool) -> tuple[str, ...]:
    """The arm's assumed numbers among those that are used."""
    used = [*(model.torque_limit if torque else ()), *(model.viscous if viscous else ())]
    names = zip(
        [f"torque limit of {j}" for j in model.joints if torque]
        + [f"friction of {j}" for j in model.joints if viscous],
        used,
        strict=True,
    )
    return tuple(number.sentence(name) for name, number in names if number is not None and number.assumed)


def _named_arm(gain_file: GainFile, name: str) -> RobotModel:
    """The arm that the gain file names; an unknown name is a mistake on a line of that file."""
    from lyapcheck.robots import load

    try:
        return load(name)
    except InputError as error:
        place = None if gain_file.document is None else gain_file.document.place(("robot",))
        line = place.line if place else None
        raise InputError(
            [
                replace(problem, file=gain_file.path, line=line, value=printable(problem.value))
                if problem.key == "robot"
                else problem
                for problem in error.problems
            ]
        ) from None


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
