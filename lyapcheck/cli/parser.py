"""The parser of the command line, and the options that several commands have.

It is argparse, whose refusals name the value, the rule and the repair.
"""

from __future__ import annotations

import argparse
import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from lyapcheck.errors import InputError, Problem, argument_error, nearest
from lyapcheck.output.answer import JUDGED_FORMATS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

WIDTH = 80
FORMATTER: Any = partial(argparse.RawDescriptionHelpFormatter, max_help_position=26, width=WIDTH)
"""Of one width: argparse makes one for every argument, and to ask for that of the terminal takes time."""
_NEGATIVE = re.compile(r"-\.?\d")
"""How a value begins that is not an option: ``-45,0,90``."""
LOOP = {
    "rate": ("HZ", "Rate of the controller. This and the next options replace [loop] of the files."),
    "period": ("TIME", 'The same as a period, for example "2.5 ms".'),
    "longest": ("TIME", "The longest interval between two readings."),
    "delay": ("N", "Whole samples from a reading to its torque."),
    "velocity": ("HOW", "difference (of readings), or measured."),
    "filter": ("TAPS", "Taps of the velocity filter, the newest first, for example 0.5,0.5."),
    "lowpass": ("HZ", "Cut-off frequency of a first-order velocity filter."),
    "encoder": ("BITS", 'Encoder of every joint, "17 bits" or counts per turn.'),
    "unknown_payload": ("KG", "Largest mass at the last link that the controller does not know."),
    "gravity_error": (
        "PERCENT",
        "Largest error of the arm file's gravity, which the controller uses.",
    ),
    "within": ("DEG", "Prove sampled for starts at rest this near to the goal, at exactly this period."),
}
"""Options of the loop as it is run, with what they take; each is a key of ``[loop]``."""
CHOICE_OF_ARM = {
    "base": ("LINK", "First link of the arm in a URDF, xacro or MJCF file."),
    "tip": ("LINK", "Last link of the arm. Default is the longest run of revolute joints."),
    "fixed": ("JOINT=VALUE", "Joint that does not move, with its position in rad or m. May be repeated."),
    "xacro": ("NAME:=VALUE", "Argument of a xacro file. May be repeated."),
}
"""What is chosen of an arm, which `lyapcheck.cli.values.chosen` makes part of its name."""
RANGES = (
    "Range for a number of the arm, in percent of its value or in its unit. For example "
    "viscous=-30%%..+0%%, mass=-5%%..+5%%, payload=0..3 or base_inertia=0.4..0.6. May be repeated."
)


class Joined(argparse.Action):
    """A list that may come in parts: ``--m 1 --m 2`` is ``--m 1,2``."""

    def __call__(self, parser: object, namespace: object, values: Any, option: str | None = None) -> None:
        before = getattr(namespace, self.dest)
        setattr(namespace, self.dest, values if before is self.default else f"{before},{values}")


class Parser(argparse.ArgumentParser):
    """What a command takes; its description has paragraphs, of which those with indented lines are kept."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(
            formatter_class=FORMATTER, allow_abbrev=False, exit_on_error=False, add_help=False, **settings
        )
        self.usage = "%(prog)s [options]"  # all options on one line, as argparse has them, nobody can read
        self._negative_number_matcher = _NEGATIVE  # as in Python 3.14: -45,0,90 is a value
        self.actions: list[argparse.Action] = []
        self.add_argument("-h", "--help", action="help", help="Show this help and leave.")

    def add_argument(self, *names: str, help: str = "", **settings: Any) -> argparse.Action:  # type: ignore[override]  # noqa: A002
        """Add an argument or an option; its default stands at the end of its help."""
        default = settings.get("default")
        # argparse hides the defaults of arguments without a name while it reads them among options
        shown = default is not None and default is not False and default != []
        if shown and names[0].startswith("-"):
            help += " [%(default)s]"  # noqa: A001
        action = super().add_argument(*names, help=help, **settings)
        self.actions.append(action)
        if not action.option_strings:
            name = f"[{action.metavar}]" if action.nargs == "?" else action.metavar
            self.usage = f"{self.usage} {name}"
        return action

    def add_gain_file(self) -> None:
        """``FILE``, a path."""
        self.add_argument("file", metavar="FILE", type=Path, help="A gain file.")

    def add_robot(self, about: str = "Arm by name or file, instead of the arm in the gain file.") -> None:
        """``--robot``, a name or a path, and what is chosen of it."""
        self.add_argument("--robot", metavar="ROBOT", help=about)
        self.add_choice_of_arm()

    def add_choice_of_arm(self) -> None:
        """``--base``, ``--tip``, ``--fixed`` and ``--xacro``."""
        for name, (metavar, about) in CHOICE_OF_ARM.items():
            action = "append" if "repeated" in about else "store"
            self.add_argument(f"--{name}", metavar=metavar, action=action, help=about)

    def add_members(self, default: str | None, about: str = "Orders of h_m", more: str = "") -> None:
        """``--m``, as `lyapcheck.cli.values.parse_m` reads it."""
        about += f", for example 3 or 1,2,5 or 1:12.{more}"
        self.add_argument("--m", metavar="M", action=Joined, default=default, help=about)

    def add_vary(self) -> None:
        """``--vary``, as `lyapcheck.robots.fields.Vary.parsed` reads it."""
        self.add_argument("--vary", metavar="NAME=LO..HI", action="append", help=RANGES)

    def add_loop(self, names: Iterable[str] = LOOP) -> None:
        """``--rate`` and so on: all options of the loop as it is run, or some."""
        for name in names:
            metavar, about = LOOP[name]
            self.add_argument(f"--{name.replace('_', '-')}", metavar=metavar, help=about)

    def add_certificates(self, what: str = "Write the certificates of each gain set to this folder") -> None:
        """``--certificates``, a folder."""
        self.add_argument("--certificates", metavar="DIR", type=Path, help=f"{what}.")

    def add_no_store(self) -> None:
        """``--no-store``."""
        about = "Do not read or write the cache, $XDG_CACHE_HOME/lyapcheck."
        self.add_argument("--no-store", action="store_true", help=about)

    def add_format(self, formats: Iterable[str] = JUDGED_FORMATS) -> None:
        """``--format``, the name of one of some formats, and how a text is shown."""
        self.add_choice("--format", formats, "Output format.", default="text")
        self.add_argument("-q", "--quiet", action="store_true", help="Show the first line only.")
        about = "Add formulas, methods and all rows and columns."
        self.add_argument("-v", "--verbose", action="store_true", help=about)
        self.add_argument("--explain", action="store_true", help="Add all notes to what -v shows.")
        self.add_choice("--color", ("auto", "always", "never"), "Use of colour.", default="auto")

    def add_choice(
        self,
        option: str,
        values: Iterable[str],
        help: str,  # noqa: A002
        *,
        default: str | None = None,
        repeated: bool = False,
        metavar: str = "",
    ) -> None:
        """Add an option that takes one of some words, or a list of them if it may be repeated."""
        words = tuple(map(str, values))

        def read(word: str) -> str:
            if word not in words:
                rule = f"is not one of {', '.join(words)}"
                raise argument_error(option, word, rule, nearest(word, words) or f"write {option} {words[0]}")
            return word

        self.add_argument(
            option,
            type=read,
            choices=words,  # for completion in a shell
            metavar=metavar or option.removeprefix("--").upper(),
            default=default,
            action="append" if repeated else "store",
            help=f"{help} One of {', '.join(words)}.",
        )

    def add_number(
        self,
        option: str,
        kind: type[int] | type[float],
        help: str,  # noqa: A002
        *,
        default: float | None = None,
        least: float | None = None,
        most: float | None = None,
    ) -> None:
        """Add an option that takes a number, or a whole number, between two ends."""
        what = "a whole number" if kind is int else "a number"

        def read(word: str) -> Any:
            try:
                value = kind(word)
            except ValueError:
                example = 1 if least is None else least
                raise argument_error(option, word, f"is not {what}", f"write {option} {example}") from None
            if least is not None and not value >= least:  # which no NaN is
                raise argument_error(option, word, f"must be at least {least}", f"write {option} {least}")
            if most is not None and value > most:
                raise argument_error(option, word, f"must be at most {most}", f"write {option} {most}")
            return value

        self.add_argument(option, type=read, metavar="N", default=default, help=help)

    def parse(self, words: Sequence[str]) -> dict[str, Any]:
        """The values of arguments and options by name, from words in any order.

        Raises:
            InputError: options that there are not, or the first thing that is wrong with the others.
        """
        options = [name for action in self.actions for name in action.option_strings]
        end = words.index("--") if "--" in words else len(words)
        before, after = words[:end], words[end + 1 :]
        given = [word.partition("=")[0] for word in before if _is_option(word)]
        unknown = [word for word in given if word not in options]
        if unknown:
            rule = "is not an option here"
            raise InputError([self._problem(word, rule, nearest(word, options)) for word in unknown])
        try:
            # argparse forgets the -- when it comes to the arguments
            files = [f"./{word}" if _is_option(word) else word for word in after]
            result, surplus = self.parse_known_intermixed_args([*before, *files])
        except argparse.ArgumentError as wrong:
            subject = wrong.argument_name or "arguments"
            raise InputError(self._problem(subject, wrong.message)) from None
        if surplus:
            raise InputError([self._problem(word, "is one argument too many") for word in surplus])
        return vars(result)

    def error(self, message: str) -> NoReturn:
        """Refuse a command line; argparse calls this with what it finds wrong.

        Raises:
            InputError: with that message.
        """
        raise InputError(self._problem("arguments", message))

    def print_help(self, file: object = None) -> None:
        """Write the help to standard output, and raise where it takes none, unlike argparse."""
        print(self.format_help(), end="", flush=True)

    def format_help(self) -> str:
        """The help, its paragraphs filled."""
        from inspect import cleandoc
        from textwrap import fill

        paragraphs = cleandoc(self.description or "").split("\n\n")
        self.description = "\n\n".join(text if "\n  " in text else fill(text, WIDTH) for text in paragraphs)
        return super().format_help()

    def _problem(self, subject: str, rule: str, repair: str = "") -> Problem:
        return Problem(self.prog, None, subject, "", rule, repair or f"see {self.prog} --help")


def _is_option(word: str) -> bool:
    return word.startswith("-") and word != "-" and not _NEGATIVE.match(word)
