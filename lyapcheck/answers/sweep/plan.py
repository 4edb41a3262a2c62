"""Plans (TOML): which arms, with which uncertainties and gains, are asked which questions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import chain, product
from pathlib import Path
from typing import Any

from lyapcheck.answers.sweep.questions import OPTIONS, WITHOUT_GAINS, Question, arm
from lyapcheck.control.gains import GainSet, beside, conditions_of, gain_set_of
from lyapcheck.control.sampling import loop_of_options
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.decimals import decimal_text, exact_decimal
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.toml import PLAN, open_document, require_kind

Gain = Fraction | tuple[Fraction, ...]
"""The same in every joint, or one a joint; N·m."""
LONGEST_NAME = 120
LARGEST = 10**9
"""Whole number of an option."""
MOST = 100_000
"""Values of one row of a grid."""


@dataclass(frozen=True)
class Grid:
    """Every m with every K_p and every K_v."""

    m: tuple[int, ...]
    kp: tuple[Gain, ...]
    kv: tuple[Gain, ...]

    def __len__(self) -> int:
        return len(self.m) * len(self.kp) * len(self.kv)

    def gains(self, n: int) -> Iterator[GainSet]:
        """The gain sets for an arm of n joints, k_v the fastest."""
        for m, kp, kv in product(self.m, self.kp, self.kv):
            both = _of_joints(kp, n), _of_joints(kv, n)
            yield GainSet(_name(m, *both), m, *both)


@dataclass(frozen=True)
class Plan:
    """A sweep: robots × variations × gains × questions, in that order.

    Args:
        path: the plan file.
        robots: names or files.
        variations: the ranges of each, as for ``--vary``. An empty one is the arm as it is.
        joints: the number of joints of each robot.
        listed: gain sets one by one.
        grid: gain sets of the grid, after the listed sets.
        asks: each question by its name, with its options.
    """

    path: str
    robots: tuple[str, ...]
    variations: tuple[tuple[str, ...], ...]
    joints: tuple[int, ...]
    listed: tuple[GainSet, ...]
    grid: Grid | None
    asks: tuple[tuple[str, tuple[tuple[str, Any], ...]], ...]

    @cached_property
    def count(self) -> int:
        """How many questions."""
        alone = sum(name in WITHOUT_GAINS for name, _ in self.asks)
        sets = len(self.listed) + (0 if self.grid is None else len(self.grid))
        return len(self.robots) * len(self.variations) * (alone + sets * (len(self.asks) - alone))

    def questions(self) -> Iterator[Question]:
        """One after the other: none is kept, however many there are."""
        places = iter(range(self.count))
        for (robot, n), variation in product(zip(self.robots, self.joints, strict=True), self.variations):
            grid = () if self.grid is None else self.grid.gains(n)
            for gains in chain((None,), self.listed, grid):
                for name, options in self.asks:
                    if (gains is None) == (name in WITHOUT_GAINS):
                        yield Question(next(places), robot, variation, gains, name, options)


def _of_joints(gain: Gain, n: int) -> tuple[Fraction, ...]:
    return gain if isinstance(gain, tuple) else (gain,) * n


def _name(m: int, kp: tuple[Fraction, ...], kv: tuple[Fraction, ...]) -> str:
    """What a gain set of a grid is called: what it is; one number where it is the same in every joint."""
    parts = (
        f"{key} {','.join(map(decimal_text, gains[:1] if len(set(gains)) == 1 else gains))}"
        for key, gains in (("kp", kp), ("kv", kv))
    )
    return f"m{m} {' '.join(parts)}"[:LONGEST_NAME]


def read_plan(path: str | Path) -> Plan:
    """The plan of a TOML file.

    Raises:
        InputError: everything that is wrong with the file, each problem with its line and repair.
    """
    document = open_document(Path(path), str(path))
    require_kind(document.name, document.data, PLAN)
    notes = Notes(document.name, document.line)
    top = Fields(document.data, (), notes)
    robots = tuple(str(beside(name, Path(path))) for name in _texts(top, "robots", required=True))
    variations = _variations(top)
    options = {name: _options(top, name) for name in OPTIONS}
    asks = tuple((name, options[name]) for name in _asked(top))
    tables = top.tables("gains")
    listed = [gain_set_of(table, index) for index, table in enumerate(tables)]
    grid = _grid(top.table("grid"))
    needs_gains = any(name not in WITHOUT_GAINS for name, _ in asks)
    if asks and needs_gains and not tables and "grid" not in document.data:
        top.fail("gains", "is missing, as is grid", "give [[gains]], or a [grid] of m, kp and kv")
    top.close()
    sets = tuple(one for one in listed if one is not None)
    plan = Plan(document.name, robots, variations, (), sets, grid, asks)
    joints = [] if notes.problems else _joints(plan, notes)
    if notes.problems:
        raise InputError(notes.problems)
    return replace(plan, joints=tuple(joints))


def _texts(table: Fields, key: str, required: bool = False) -> tuple[str, ...]:
    value = table.raw(key, required)
    if value is None:
        return ()
    if not isinstance(value, list) or not value or not all(isinstance(x, str) and x.strip() for x in value):
        table.fail(key, "must be a list of texts", f'write {key} = ["…"]')
        return ()
    return tuple(value)


def _asked(top: Fields) -> tuple[str, ...]:
    asked = _texts(top, "questions", required=True)
    unknown = [name for name in asked if name not in OPTIONS]
    if unknown:
        top.fail("questions", f"there is no question {unknown[0]}", f"use some of: {', '.join(OPTIONS)}")
    if len(set(asked)) < len(asked):
        top.fail("questions", "has one twice", "ask each once")
    return tuple(name for name in dict.fromkeys(asked) if name not in unknown)


def _variations(top: Fields) -> tuple[tuple[str, ...], ...]:
    value = top.raw("variations")
    if value is None:
        return ((),)
    if (
        not isinstance(value, list)
        or not value
        or not all(isinstance(row, list) and all(isinstance(text, str) for text in row) for row in value)
    ):
        repair = 'write variations = [[], ["viscous=-30%..+0%"]]'
        top.fail("variations", "must be a list of lists of ranges", repair)
        return ((),)
    return tuple(map(tuple, value))


def _options(top: Fields, name: str) -> tuple[tuple[str, Any], ...]:
    """What a question is asked with; only what is written, each of the type that it has by default."""
    table = top.table(name)
    if table is None:
        return ()
    result = {key: _option(table, key, default) for key, default in sorted(OPTIONS[name].items())}
    table.close()
    return tuple((key, value) for key, value in result.items() if value is not None)


def _option(table: Fields, key: str, default: Any) -> Any:
    if isinstance(default, tuple):
        return _list(table, key)
    if isinstance(default, bool):
        value = table.raw(key)
        if value is not None and not isinstance(value, bool):
            table.fail(key, "must be true or false", f"write {key} = {str(default).lower()}")
            return None
        return value
    if isinstance(default, int):
        return table.integer(key, 1, LARGEST)
    number = table.number(key)
    return None if number is None else float(number)


def _list(table: Fields, key: str) -> tuple[Any, ...] | None:
    if key == "condition":
        return conditions_of(table) or None
    value, text = table.raw(key), key == "loop"
    if value is None:
        return None
    sort: Any = str if text else int | Fraction
    if not isinstance(value, list) or not all(isinstance(x, sort) and not isinstance(x, bool) for x in value):
        table.fail(key, f"must be a list of {'texts' if text else 'angles in degrees'}", f"write {key} = […]")
        return None
    try:
        loop_of_options(dict(one.partition("=")[::2] for one in value) if text else {})
    except InputError as error:
        for one in error.problems:
            table.fail(key, f"{one.key} {one.rule}", one.repair)
    if text and len({one.partition("=")[0] for one in value}) < len(value):
        table.fail(key, "says something twice", "give each once")
    return tuple(value) if text else tuple(map(float, value))


def _grid(table: Fields | None) -> Grid | None:
    if table is None:
        return None
    m = _row(table, "m", _member)
    kp, kv = (_row(table, key, _gain) for key in ("kp", "kv"))
    table.close()
    return Grid(m, kp, kv) if m and kp and kv else None


def _row(table: Fields, key: str, read: Callable[[Any], Any]) -> tuple[Any, ...]:
    """The values of one row: a list, or from … to … in steps."""
    value = table.raw(key, required=True)
    if isinstance(value, dict):
        value = _steps(table, key, value)
    if value is None:
        return ()
    result = [read(one) for one in value] if isinstance(value, list) and value else [None]
    if any(one is None for one in result):
        what = "members of the family from 1" if key == "m" else "gains above 0, or lists of one a joint"
        repair = f"write {key} = [1, 2, 3]" if key == "m" else f"write {key} = [0.1, 0.2], or [[0.1, 0.2], …]"
        table.fail(key, f"must be a list of {what}, or {{from, to, step}}", repair)
        return ()
    if len(set(result)) < len(result):
        table.fail(key, "has a value twice", "give each once")
        return ()
    return tuple(result)


def _steps(table: Fields, key: str, value: dict[str, Any]) -> list[Any] | None:
    ends = [value.get(name) for name in ("from", "to", "step")]
    good = set(value) == {"from", "to", "step"} and all(
        isinstance(x, int | Fraction) and not isinstance(x, bool) and x > 0 for x in ends
    )
    low, high, step = (Fraction(x) if good else Fraction(1) for x in (end or 1 for end in ends))
    if not good or high < low or (high - low) / step >= MOST:
        rule = f"must have from ≤ to and a step above 0, at most {MOST} values"
        table.fail(key, rule, f"write {key} = {{from = 0.05, to = 0.5, step = 0.05}}")
        return None
    values = [low + k * step for k in range(math.floor((high - low) / step) + 1)]
    return [int(x) if x.denominator == 1 and key == "m" else exact_decimal(decimal_text(x)) for x in values]


def _member(value: Any) -> int | None:
    from lyapcheck.family.base import LARGEST_M

    good = isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= LARGEST_M
    return value if good else None


def _gain(value: Any) -> Gain | None:
    if isinstance(value, list):
        parts = [_gain(one) for one in value]
        return tuple(parts) if parts and all(isinstance(x, Fraction) for x in parts) else None  # type: ignore[arg-type]
    if not isinstance(value, int | Fraction) or isinstance(value, bool) or value <= 0:
        return None
    return value if isinstance(value, Fraction) else Fraction(value)


def _joints(plan: Plan, notes: Notes) -> list[int]:
    """How many joints each robot has; what cannot be read, or has others than gains or angles, is noted."""
    result: list[int] = []
    for k, robot in enumerate(plan.robots):
        for number, variation in enumerate(plan.variations):
            try:
                n = arm(robot, variation)[0].n
            except InputError as error:
                notes.problems += [_placed(one, notes, k, number) for one in error.problems]
                n = 0
        result.append(n)
        for key, size, what in _sizes(plan):
            if n and size != n:
                rule = f"has {size} {what}{'s' if size > 1 else ''}, but the arm {robot} has {n} joints"
                repair = f"give one {what} a joint; arms with other joints need a plan of their own"
                notes.fail(key, None, rule, repair)
    return result


def _placed(problem: Problem, notes: Notes, robot: int, variation: int) -> Problem:
    """A complaint about an arm or a range, at its line of the plan; about another file as it is."""
    if problem.file != "argument":
        return problem
    path = ("variations", variation) if problem.key == "--vary" else ("robots", robot)
    return replace(problem, file=notes.file, line=notes.line(path), key=str(path[0]))


def _sizes(plan: Plan) -> Iterator[tuple[tuple[str | int, ...], int, str]]:
    """Where the plan has one number a joint, how many, and of what; none where it is the usual posture."""
    for one in plan.listed:
        yield ("gains", one.index, "kp"), one.n, "gain"
    for name in ("kp", "kv") if plan.grid is not None else ():
        for gains in getattr(plan.grid, name):
            if isinstance(gains, tuple):
                yield ("grid", name), len(gains), "gain"
    for ask, options in plan.asks:
        for key, value in options:
            if key in ("target", "start") and value:
                yield (ask, key), len(value), "angle"
