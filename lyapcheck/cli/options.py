"""Arguments and options that several commands have."""

from __future__ import annotations

from argparse import SUPPRESS, Action
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.output.formats import JudgedFormat

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lyapcheck.cli.parser import Parser
    from lyapcheck.robots.vary import Vary


def add_gain_file(parser: Parser) -> None:
    """``FILE``, a path."""
    parser.add_argument("file", metavar="FILE", type=Path, help="A gain file.")


def add_robot(parser: Parser) -> None:
    """``--robot``, a name or a path."""
    about = "A built-in arm or an arm file, instead of the one the gain file names."
    parser.add_argument("--robot", metavar="ROBOT", help=about)


def add_members(parser: Parser, default: str | None, more: str = "") -> None:
    """``--m``, as `lyapcheck.cli.values.parse_m` reads it."""
    about = f"Members of the family: 3, 1,2,5 or 1:12.{more}"
    parser.add_argument("--m", metavar="M", default=default, help=about)


def add_certificates(parser: Parser, what: str = "Write the certificates of each gain set there") -> None:
    """``--certificates``, a folder."""
    parser.add_argument("--certificates", metavar="DIR", type=Path, help=f"{what}; see recheck.")


def add_vary(parser: Parser) -> None:
    """``--vary``, as `lyapcheck.robots.vary.Vary.parsed` reads it."""
    about = (
        "A range for a number of the arm, in percent of its value or in its unit: viscous=-30%%..+0%%, "
        "mass=-5%%..+5%%, payload=0..3, base_inertia=0.4..0.6; may be repeated."
    )
    parser.add_argument("--vary", metavar="NAME=LO..HI", action="append", help=about)


def varies(texts: list[str] | None) -> tuple[Vary, ...]:
    """What ``--vary`` says.

    Raises:
        InputError: every text that says nothing.
    """
    if not texts:
        return ()
    from lyapcheck.cli.values import Complaints
    from lyapcheck.robots.vary import Vary

    wrong = Complaints()
    result = [wrong.reading(Vary.parsed, text) for text in texts]
    wrong.raise_all()
    return tuple(one for one in result if one is not None)


def add_no_store(parser: Parser) -> None:
    """``--no-store``."""
    about = "Take nothing from the store and keep nothing there; see store."
    parser.add_argument("--no-store", action=_SwitchOff, nargs=0, dest=SUPPRESS, help=about)


class _SwitchOff(Action):
    """Keeps this process, and those that it starts, from the store."""

    def __call__(self, *_: object) -> None:
        from lyapcheck import store

        store.switch_off()


def add_format(parser: Parser, formats: Iterable[str] = JudgedFormat) -> None:
    """``--format``, the name of one of some formats."""
    parser.add_choice("--format", formats, "How to write it.", default="text")
