"""What a user supposes to be uncertain about an arm, on top of what its file says: ``viscous=-30%..+0%``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

from lyapcheck.errors import InputError, Problem, nearest
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.dynamics import Chain, ParameterShare
from lyapcheck.robots.fields import OPTION, PAYLOAD, ROTOR, Number, Vary

if TYPE_CHECKING:
    from lyapcheck.robots.plant import RobotModel

MOTOR = ("viscous", "coulomb", "torque_limit", "gravity_bound")
"""Numbers of a joint that enter neither M nor the potential."""
MASSES = (ROTOR.removeprefix("_"), "mass")
"""Numbers of known links."""
MOST_CORNERS = 32


def varied_numbers(numbers: Mapping[str, Number], varies: Sequence[Vary]) -> dict[str, Number]:
    """The numbers, with ranges where meant; that of one number by its name outdoes that of all."""
    result = dict(numbers)
    for vary in sorted(varies, key=lambda one: one.name in numbers):
        result |= {key: vary.of(number) for key, number in result.items() if vary.matches(key)}
    return result


def varied(model: RobotModel, varies: Sequence[Vary], links: bool = True) -> RobotModel:
    """An arm with ranges for friction and limits, and with a payload where its links are known.

    Args:
        model: the arm.
        varies: the ranges.
        links: whether masses and rotor inertias of known links get their ranges here, too.

    Raises:
        InputError: a range with a friction below 0, or a mass that is not positive.
    """
    motors = {
        f"{joint}_{part}": number
        for part in MOTOR
        for joint, number in zip(model.joints, getattr(model, part), strict=True)
        if number is not None
    }
    rotors = (f"{joint}{ROTOR}" for joint in model.joints)
    bodies = _masses_of(model) | {key: model.numbers[key] for key in rotors if key in model.numbers}
    known = motors | bodies
    now, last = varied_numbers(known if links else motors, varies), f"{model.joints[-1]}_mass"
    for vary in varies:
        if vary.name == PAYLOAD and last in bodies:
            own = now.get(last, bodies[last])
            low, high = (end + more for end, more in zip(own.bounds, (vary.low, vary.high), strict=True))
            now[last] = replace(own, value=own.value + vary.low, low=low, high=high)
    moved = {key: number for key, number in now.items() if number is not known[key]}
    problems = []
    for key, number in moved.items():
        low, said = number.bounds[0], f"{key} from {decimal_text(number.bounds[0])}"
        positive = key.endswith(("mass", "torque_limit"))
        for broken, rule in ((positive and low <= 0, "must be positive"), (low < 0, "must not be negative")):
            if broken:
                problems.append(Problem("argument", None, OPTION, said, rule, "raise the lower end"))
    if problems:
        raise InputError(problems)
    inner = {key: number for key, number in moved.items() if key in bodies}
    parts: dict[str, Any] = {
        part: tuple(now.get(f"{joint}_{part}") for joint in model.joints) for part in MOTOR
    }
    outer = {key: number for key, number in moved.items() if key not in bodies}
    return with_bodies(replace(model, numbers=model.numbers | outer, **parts), inner)


def with_bodies(model: RobotModel, numbers: dict[str, Number]) -> RobotModel:
    """An arm of known links with these masses and rotor inertias, by the names that reports use."""
    chain = model.dynamics
    if not numbers or not isinstance(chain, Chain):
        return model
    ranged = {key: number for key, number in numbers.items() if number.ranged}
    now: dict[str, Any] = {key: number.value for key, number in numbers.items()}
    now |= {key: ParameterShare(key) for key in ranged}
    links = tuple(
        replace(link, mass=now.get(f"{joint}_mass", link.mass), rotor=now.get(f"{joint}{ROTOR}", link.rotor))
        for joint, link in zip(model.joints, chain.links, strict=True)
    )
    return replace(
        model,
        dynamics=Chain(links, chain.fall, tuple(dict.fromkeys((*chain.names, *ranged)))),
        parameters=model.parameters | ranged,
        numbers=model.numbers | numbers,
    )


def _masses_of(model: RobotModel) -> dict[str, Number]:
    """The masses of known links, by the name of their joint."""
    links: Sequence[Any] = model.dynamics.links if isinstance(model.dynamics, Chain) else ()
    masses = {f"{joint}_mass": link.mass for joint, link in zip(model.joints, links, strict=False)}
    return {
        key: model.parameters[x.name] if isinstance(x, ParameterShare) else Number(x, "kg")
        for key, x in masses.items()
    }


def require_known(model: RobotModel, varies: Sequence[Vary]) -> None:
    """Refuse names that the arm has no number for, and names given twice.

    Raises:
        InputError: every such name.
    """
    again = sorted({one.name for one in varies if sum(other.name == one.name for other in varies) > 1})
    if again:
        rule, repair = "has more than one range", "keep one of them"
        raise InputError([Problem("argument", None, OPTION, name, rule, repair) for name in again])
    names = {PAYLOAD} if isinstance(model.dynamics, Chain) else set()
    keys = [*model.numbers, *(f"{joint}_mass" for joint in model.joints if names)]
    wrong = [one for one in varies if one.name not in names and not any(map(one.matches, keys))]
    if wrong:
        known = sorted({_part(key, model.joints) for key in keys if not key[-1].isdigit()} | names)
        repair = f"use one of {', '.join(known)}, or the name of a number that lyapcheck robot shows"
        rule = f"{model.name} has no number of that name"
        raise InputError(_unknown(wrong, [*known, *keys], rule, repair))


def _part(key: str, joints: Sequence[str]) -> str:
    """The name of a number without its joint, which is one of the same number of every joint."""
    return next((key.removeprefix(f"{joint}_") for joint in joints if key.startswith(f"{joint}_")), key)


def require_movable(model: RobotModel, varies: Sequence[Vary]) -> None:
    """Refuse what cannot vary of an arm given by a URDF file: all but numbers of joints, masses, a payload.

    Raises:
        InputError: every such name.
    """
    keys = [f"{joint}_{part}" for joint in model.joints for part in (*MOTOR, *MASSES)]
    wrong = [one for one in varies if one.name != PAYLOAD and not any(map(one.matches, keys))]
    if wrong:
        rule = f"cannot vary on {model.name}, an arm of a URDF file; its friction, limits and masses can"
        rotors = any(key.endswith(ROTOR) for key in model.numbers)
        known = (*MOTOR, *(part for part in MASSES if rotors or part != MASSES[0]), PAYLOAD)
        repair = f"use {', '.join(known)}, or one joint's, such as {keys[-1]}"
        raise InputError(_unknown(wrong, [*known, *keys], rule, repair))


def _unknown(wrong: Sequence[Vary], known: Sequence[str], rule: str, repair: str) -> list[Problem]:
    return [
        Problem("argument", None, OPTION, one.name, rule, nearest(one.name, known, repair)) for one in wrong
    ]


def outside(own: RobotModel, model: RobotModel) -> tuple[str, ...]:
    """Name the numbers whose value in the arm file lies outside their range.

    Args:
        own: the arm as its file describes it, which is not an arm in the ranges if any is named.
        model: the same arm with ranges.
    """
    known = own.numbers | _masses_of(own)
    rows = [(key, known[key].value, number.bounds) for key, number in model.numbers.items() if key in known]
    return tuple(key for key, value, (low, high) in rows if not low <= value <= high)


def corners(model: RobotModel) -> tuple[str, tuple[tuple[str, RobotModel], ...]]:
    """The arm at the ends of what varies: each number alone if these are few, else all of a name together.

    Returns:
        Which corners of the ranges these are, and for each what was changed and the arm with exact numbers.
        Between the ends nothing is tried.
    """
    keys: list[str] = []
    named: dict[str, list[str]] = {}  # a name of one number goes before that of all
    for key, number in model.numbers.items():
        last = key == f"{model.joints[-1]}_mass"
        meant = [one for one in model.varies if one.matches(key) or (last and one.name == PAYLOAD)]
        if meant and number.ranged:
            keys.append(key)
            named.setdefault(next((one for one in meant if one.name == key), meant[0]).name, []).append(key)
    count, groups = 2 ** len(keys), [[key] for key in keys]
    said = "the corner of the ranges" if count == 1 else f"all {count} corners of the ranges"
    if count > MOST_CORNERS:
        groups = list(named.values())
        said = f"{2 ** len(groups)} of {count} corners of the ranges (numbers of one name move together)"
    arms = []
    for ends in product((0, 1), repeat=len(groups)):
        pairs = zip(groups, ends, strict=True)
        values = {key: model.numbers[key].bounds[end] for group, end in pairs for key in group}
        text = ", ".join(f"{key} = {decimal_text(value)}" for key, value in values.items())
        arms.append((text, at_values(model, values)))
    return said, tuple(arms)


def at_values(model: RobotModel, values: Mapping[str, Fraction]) -> RobotModel:
    """The arm with exact values for some of its numbers, the others of M and the potential nominal."""
    fixed = model.fixed(**{key: value for key, value in values.items() if key in model.parameters})
    parts: dict[str, Any] = {}
    for part in MOTOR:
        rows = zip(model.joints, getattr(model, part), strict=True)
        parts[part] = tuple(
            replace(number, value=values[key], low=None, high=None)
            if (key := f"{joint}_{part}") in values
            else number
            for joint, number in rows
        )
    return replace(fixed, **parts, varies=())
