"""``lyapcheck explain``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.cli.progress import progress
from lyapcheck.cli.show import show
from lyapcheck.cli.values import add_format, add_no_store
from lyapcheck.output.formats import Format
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "The id of a claim, such as 7a or 16.6; without one, all ids are listed."
    parser.add_argument("id", metavar="ID", nargs="?", help=about)
    about = "The proof script that makes the claim; the first of lyapcheck's own if missing."
    parser.add_argument("--proof", metavar="FILE", help=about)
    add_no_store(parser)
    add_format(parser, Format)


def run(
    id: str | None,  # noqa: A002
    proof: str | None,
    format: str,  # noqa: A002
) -> Exit:
    """Say what a claim states, what came of it, where the paper makes it, what it uses and how it is decided.

    Without an ID, list the claims that can be explained.

    Examples:
      lyapcheck explain
      lyapcheck explain 16.6
      lyapcheck explain mine --proof my_proof.py
    """
    from lyapcheck.answers.explain import explain, list_claims

    if id is None:
        show(list_claims(proof), format)
        return Exit.PROVED
    with progress("explain") as advance:
        answer = explain(id, proof, decide=True, on_progress=advance)
    show(answer, format)
    return Exit.PROVED
