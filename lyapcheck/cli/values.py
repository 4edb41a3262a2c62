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
    from lyapcheck.robots.fields import Vary

Value = TypeVar("Value")
_WHOLE = re.compile(r"-?[0-9]{1,1000}")


class Complaints:
    """Problems gathered while arguments are read."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def reading(self, read: Callable[..., Value], *arguments: Any, **named: Any) -> Value | None:
        """What ``read`` returns, ``None`` where it cannot use its arguments: the problems are kept."""
        try:
            return read(*arguments, **named)
        except InputError as error:
            self.problems += error.problems
            return None

    def result(self, read: Callable[..., Value], *arguments: Any, **named: Any) -> Value:
        """What ``read`` returns, if nothing was wrong.

        Raises:
            InputError: this, or something before, could not be used.
        """
        value = self.reading(read, *arguments, **named)
        self.raise_all()
        assert value is not None
        return value

    def each(self, read: Callable[[str], Value], texts: Iterable[str]) -> list[Value]:
        """What ``read`` returns for each text, if nothing was wrong.

        Raises:
            InputError: one of them, or something before, could not be used.
        """
        values = [self.reading(read, text) for text in texts]
        self.raise_all()
        return [value for value in values if value is not None]

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
    from lyapcheck.files.decimals import DECIMAL

    def read(word: str) -> Fraction:
        if not DECIMAL.fullmatch(word.strip()):
            value, repair = word.strip() or repr(text), f"write {option} 0.8, or 0.8,0.9,1"
            raise argument_error(option, value, "is not a decimal number", repair)
        return Fraction(word)

    return tuple(Complaints().each(read, text.split(",")))


def parse_m(text: str) -> tuple[int, ...]:
    """The members named by a list of whole numbers and ranges ``low:high``, ascending, each once.

    Raises:
        InputError: one problem for every part of the list that cannot be used.
    """
    from lyapcheck.family.base import LARGEST_M

    def read(part: str) -> range:
        ends = [end.strip() for end in part.split(":")]
        subject = part.strip() or repr(text)
        if len(ends) > 2 or not all(map(_WHOLE.fullmatch, ends)):
            rule = "is not a whole number or a range of them"
            raise argument_error("--m", subject, rule, "write 3, 1,2,5 or 1:12")
        low, high = int(ends[0]), int(ends[-1])
        if low < 1:
            raise argument_error("--m", subject, "m must be at least 1", "the family starts at m = 1")
        if high > LARGEST_M:
            rule = f"m must be at most {LARGEST_M}"
            raise argument_error("--m", subject, rule, f"stay within 1:{LARGEST_M}")
        if low > high:
            raise argument_error("--m", subject, "the range is empty", f"write {high}:{low}")
        return range(low, high + 1)

    return tuple(sorted(set().union(*Complaints().each(read, text.split(",")))))


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
    at = {joint: held_at(value, joint, "--fixed") for joint, value in held.items()}
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
    from lyapcheck.robots.fields import Vary

    return tuple(Complaints().each(Vary.parsed, texts))


def loop_of(options: Mapping[str, Any]) -> LoopEntry:
    """What the options of `add_loop` say, among those of a command.

    Raises:
        InputError: every one that cannot be used.
    """
    from lyapcheck.control.sampling import loop_of_options

    return loop_of_options({name: options.get(name) for name in LOOP})
