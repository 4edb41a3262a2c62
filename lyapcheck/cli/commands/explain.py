"""``lyapcheck explain``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.cli.show import progress, show
from lyapcheck.output.answer import FORMATS
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "Id of a claim, for example 16.6. Without an id, all ids are listed."
    parser.add_argument("id", metavar="ID", nargs="?", help=about)
    about = "Proof script with the claim. Default: the first script of lyapcheck that has it."
    parser.add_argument("--proof", metavar="FILE", help=about)
    parser.add_no_store()
    parser.add_format(FORMATS)


def run(
    id: str | None,  # noqa: A002
    proof: str | None,
    format: str,  # noqa: A002
) -> Exit:
    """Explain a claim with its statement, verdict, place in the paper, premises and method.

    Without an ID, list all claims.

    Exit code 0: explained, for any verdict, 2: no claim has the ID, or the script cannot be used.

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
