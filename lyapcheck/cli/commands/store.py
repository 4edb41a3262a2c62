"""``lyapcheck store``."""

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
    parser.add_argument("--size", action="store_true", help="Say how much is kept; so it does without.")
    parser.add_argument("--clear", action="store_true", help="Remove everything that is kept.")
    add_format(parser, Format)


def run(size: bool, clear: bool, format: str) -> Exit:  # noqa: A002
    """Say what is kept in $XDG_CACHE_HOME/lyapcheck between runs, or remove it.

    Answers are found again by the digest of their question; their certificates are judged anew each time.

    Examples:
      lyapcheck store --size
      lyapcheck store --clear
    """
    from lyapcheck import store
    from lyapcheck.answers.kept import Kept

    del size  # said in any case
    if clear:
        store.clear()
    show(Kept(tuple(store.held()), clear), format)
    return Exit.PROVED
