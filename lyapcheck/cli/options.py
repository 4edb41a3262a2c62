"""Arguments and options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.output.formats import JudgedFormat

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lyapcheck.cli.parser import Parser


def add_gain_file(parser: Parser) -> None:
    """``FILE``, a path."""
    parser.add_argument("file", metavar="FILE", type=Path, help="A gain file.")


def add_robot(parser: Parser) -> None:
    """``--robot``, a name or a path."""
    about = "A built-in arm or an arm file, instead of the one the gain file names."
    parser.add_argument("--robot", metavar="ROBOT", help=about)


def add_members(parser: Parser, default: str) -> None:
    """``--m``, as `lyapcheck.cli.m_range.parse_m` reads it."""
    parser.add_argument("--m", metavar="M", default=default, help="Members of the family: 3, 1,2,5 or 1:12.")


def add_certificates(parser: Parser, what: str = "Write the certificates of each gain set there") -> None:
    """``--certificates``, a folder."""
    parser.add_argument("--certificates", metavar="DIR", type=Path, help=f"{what}; see recheck.")


def add_format(parser: Parser, formats: Iterable[str] = JudgedFormat, default: str = "text") -> None:
    """``--format``, the name of one of some formats."""
    parser.add_choice("--format", formats, "How to write it.", default=default)
