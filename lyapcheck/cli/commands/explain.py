"""``lyapcheck explain``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.cli.options import add_format
from lyapcheck.cli.show import show
from lyapcheck.output.formats import Format
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("id", metavar="ID", help="The id of a claim, such as 7a or 16.6.")
    about = "The proof script that makes the claim; the first of lyapcheck's own if missing."
    parser.add_argument("--proof", metavar="FILE", help=about)
    add_format(parser, Format)


def run(
    id: str,  # noqa: A002
    proof: str | None,
    format: str,  # noqa: A002
) -> Exit:
    """Say what a claim states, where the paper makes it, what it uses and how it is decided.

    Examples:
      lyapcheck explain 16.6
      lyapcheck explain mine --proof my_proof.py
    """
    from lyapcheck.answers.explain import explain

    show(explain(id, proof), format)
    return Exit.PROVED
