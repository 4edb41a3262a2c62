"""``lyapcheck table``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import certificate_folder, progress, show, write_certificates
from lyapcheck.cli.values import parse_m
from lyapcheck.errors import argument_error
from lyapcheck.output.answer import FORMATS
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser

_MOST_DIGITS = 2_000


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_members("1:12")
    parser.add_number("--digits", int, "Significant digits.", default=30)
    parser.add_certificates("Write the certificates of γ and ρ to this folder")
    parser.add_format(FORMATS)


def run(
    m: str,
    digits: int,
    certificates: Path | None,
    format: str,  # noqa: A002
) -> Exit:
    """Print certified γ, ρ and L of the hyperbolic family, and where each is reached.

    The constants are γ = sup h, ρ = sup |h'| and L = sup h(x)/x over x > 0. Every printed digit is correct.
    The bounds in JSON and CSV enclose the exact number.

    Examples:
      lyapcheck table --m 1:3 --digits 50
      lyapcheck table --m 1,2,5 --format latex
    """
    members = parse_m(m)
    if not 1 <= digits <= _MOST_DIGITS:
        raise argument_error("--digits", digits, f"must be from 1 to {_MOST_DIGITS}", "write --digits 30")
    from lyapcheck.answers.table import build_table
    from lyapcheck.answers.table import certificates as certificates_of

    folder = certificate_folder(certificates)
    with progress("table") as advance:
        table = build_table(members, digits, advance)
    if folder is not None:
        write_certificates(folder, certificates_of(table))
    show(table, format)
    return Exit.PROVED
