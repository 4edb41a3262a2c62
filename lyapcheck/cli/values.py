"""What is typed on a command line, read at once with all that is wrong with it: numbers, members, the arm."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lyapcheck.cli.parser import LOOP
from lyapcheck.errors import InputError, Problem, argument_error

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.files.loop import LoopEntry
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.vary import Vary

Value = TypeVar("Value")
_DECIMAL = re.compile(r"[+-]?(\d{1,30}(\.\d{0,30})?|\.\d{1,30})(e[+-]?\d{1,2})?", re.IGNORECASE | re.ASCII)
_MOST_DIGITS = 1_000


class Complaints:
    """Problems gathered while arguments are read."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def reading(self, read: Callable[..., Value], *arguments: Any) -> Value | None:
        """What ``read`` returns, ``None`` where it cannot use its arguments: the problems are kept."""
        try:
            return read(*arguments)
        except InputError as error:
            self.problems += error.problems
            return None

    def result(self, read: Callable[..., Value], *arguments: Any) -> Value:
        """What ``read`` returns, if nothing was wrong.

        Raises:
            InputError: this, or something before, could not be used.
        """
        value = self.reading(read, *arguments)
        self.raise_all()
        assert value is not None
        return value

    def raise_all(self) -> None:
        """Raise what was gathered.

        Raises:
            InputError: every problem so far, if there is one.
        """
        if self.problems:
            raise InputError(self.problems)


def parse_decimals(option: str, text: str | None) -> tuple[Fraction, ...] | None:
    """The exact values, ``None`` where the option is not given.

    Raises:
        InputError: a problem for each word that is not a finite decimal.
    """
    if text is None:
        return None
    words = [word.strip() for word in text.split(",")]
    rule, repair = "is not a decimal number", f"write {option} 0.8, or 0.8,0.9,1"
    problems = [
        Problem("argument", None, option, word or repr(text), rule, repair)
        for word in words
        if not _DECIMAL.fullmatch(word)
    ]
    if problems:
        raise InputError(problems)
    return tuple(map(Fraction, words))


def parse_decimal(option: str, text: str | None) -> Fraction | None:
    """One exact value, ``None`` where the option is not given.

    Raises:
        InputError: not a decimal, or more than one.
    """
    values = parse_decimals(option, text)
    if values is not None and len(values) != 1:
        raise argument_error(option, text, "must be one number", f"write {option} 0.406")
    return None if values is None else values[0]


def parse_m(text: str, option: str = "--m") -> tuple[int, ...]:
    """The members named by a list of whole numbers and ranges ``low:high``, ascending, each once.

    Raises:
        InputError: one problem for every part of the list that cannot be used.
    """
    result: set[int] = set()
    problems: list[Problem] = []
    for part in text.split(","):
        rule, repair = _complaint(part)
        if rule:
            problems.append(Problem("argument", None, option, part.strip() or repr(text), rule, repair))
        else:
            ends = [int(end) for end in part.split(":")]
            result.update(range(ends[0], ends[-1] + 1))
    if problems:
        raise InputError(problems)
    return tuple(sorted(result))


def _complaint(part: str) -> tuple[str, str]:
    """What is wrong with one part, and the repair; two empty strings if nothing is."""
    from lyapcheck.family.base import LARGEST_M

    ends = [end.strip() for end in part.split(":")]
    if len(ends) > 2 or not all(_is_whole(end) for end in ends):
        return "is not a whole number or a range of them", "write 3, 1,2,5 or 1:12"
    low, high = int(ends[0]), int(ends[-1])
    if low < 1:
        return "m must be at least 1", "the family starts at m = 1"
    if high > LARGEST_M:
        return f"m must be at most {LARGEST_M}", f"stay within 1:{LARGEST_M}"
    if low > high:
        return "the range is empty", f"write {high}:{low}"
    return "", ""


def _is_whole(text: str) -> bool:
    digits = text.removeprefix("-")
    return digits.isascii() and digits.isdecimal() and len(digits) <= _MOST_DIGITS


def robot_name(robot: str | None, gain_files: Iterable[GainFile]) -> str:
    """The arm of ``--robot``, else the first that a gain file names.

    Raises:
        InputError: nobody names an arm.
    """
    from lyapcheck.robots.choice import named

    files = list(gain_files)
    name = named(robot, next((file.robot for file in files if file.robot), None))
    if name is None:
        rule = f"{', '.join(file.path for file in files)} names no arm and --robot is missing"
        raise argument_error("--robot", "", rule, "add --robot buap3, or robot = … to the file")
    return name


def gains_on_arm(file: Path, robot: str | None, **numbers: Any) -> tuple[GainFile, str, RobotModel]:
    """A gain file, the name of its arm or that of ``--robot``, and the arm; numbers are those of `load`.

    Raises:
        InputError: the file or the arm cannot be used.
    """
    from lyapcheck.control.gains import arm_named_in, read_gain_file
    from lyapcheck.robots import load

    gain_file = read_gain_file(file, robot)
    name = robot_name(robot, [gain_file])
    with arm_named_in(gain_file, robot):
        return gain_file, name, load(name, **numbers)


def require_joints(gain_files: Iterable[GainFile], model: RobotModel) -> None:
    """Refuse gains for another number of joints, at the lines where they stand.

    Raises:
        InputError: one problem a gain set.
    """
    problems = []
    for file in gain_files:
        for item in file.gains:
            if item.n != model.n:
                place = file.place(item, "kp")
                rule = f"{item.name} has gains for {item.n} joints, but the arm {model.name} has {model.n}"
                repair = f"choose an arm of {item.n} joints, or give {model.n} gains, one a joint"
                problems.append(Problem(file.path, place.line if place else None, "kp", "", rule, repair))
    if problems:
        raise InputError(problems)


def chosen(values: dict[str, Any]) -> dict[str, Any]:
    """The values of a command line with what is chosen of the arm as part of ``robot``.

    Raises:
        InputError: a choice that says nothing.
    """
    if "fixed" not in values:
        return values
    base, tip, fixed, xacro = (values.pop(key) for key in ("base", "tip", "fixed", "xacro"))
    if not (base or tip or fixed or xacro):
        return values
    from lyapcheck.robots.choice import Choice, held_at

    wrong = Complaints()
    held = dict(wrong.reading(_pair, "--fixed", word, "=") or ("", "") for word in fixed or ())
    given = dict(wrong.reading(_pair, "--xacro", word, ":=") or ("", "") for word in xacro or ())
    wrong.raise_all()
    at = {joint: held_at(value, joint) for joint, value in held.items()}
    return values | {"robot": Choice(base or "", tip or "", at, given).of(values["robot"] or "")}


def _pair(option: str, word: str, mark: str) -> tuple[str, str]:
    name, found, value = word.partition(mark)
    if not found or not name:
        raise argument_error(option, word, f"must be NAME{mark}VALUE", f"write {option} joint{mark}0")
    return name, value


def varies(texts: list[str] | None) -> tuple[Vary, ...]:
    """What ``--vary`` says.

    Raises:
        InputError: every text that says nothing.
    """
    if not texts:
        return ()
    from lyapcheck.robots.vary import Vary

    wrong = Complaints()
    result = [wrong.reading(Vary.parsed, text) for text in texts]
    wrong.raise_all()
    return tuple(one for one in result if one is not None)


def loop_of(options: Mapping[str, Any]) -> LoopEntry:
    """What the options of `add_loop` say, among those of a command.

    Raises:
        InputError: every one that cannot be used.
    """
    from lyapcheck.control.sampling import loop_of_options

    return loop_of_options({name: options.get(name) for name in LOOP})
