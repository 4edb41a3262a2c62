"""``lyapcheck store``: what is kept between runs, and how much of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck.cli.show import show
from lyapcheck.cli.values import add_format
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Table, command
from lyapcheck.output.formats import Format
from lyapcheck.store import Held
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


WHAT = {
    "answers": "certificates of claims and of ε₀; judged anew when they are taken",
    "kernels": "compiled code of simulations and samplers",
}


@dataclass(frozen=True)
class Kept(Answer):
    """What is in the store.

    Args:
        kinds: how much there is of each.
        cleared: whether all of it was just removed.
    """

    schema = "lyapcheck/store/1"

    kinds: tuple[Held, ...]
    cleared: bool = False

    def document(self) -> Document:
        """A row a kind."""
        total = sum(kind.bytes for kind in self.kinds)
        title = "The store was cleared" if self.cleared else f"{total} bytes are kept between runs"
        rows = tuple(
            (kind.kind, str(kind.files), str(kind.bytes), WHAT.get(kind.kind, "")) for kind in self.kinds
        )
        table = Table(("kind", "files", "bytes", "content"), rows, align="lrrl")
        after = command("store", "--clear") if total else command("init", "bench")
        return Document(title, (table,) if rows else (), next=after)

    def data(self) -> dict[str, Any]:
        """``results: [{kind, files, bytes}]``."""
        return {"cleared": self.cleared, "results": [vars(kind) for kind in self.kinds]}


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("--size", action="store_true", help="Show the size of the cache, as without options.")
    parser.add_argument("--clear", action="store_true", help="Remove the cache.")
    add_format(parser, Format)


def run(size: bool, clear: bool, format: str) -> Exit:  # noqa: A002
    """Show or remove the cache in $XDG_CACHE_HOME/lyapcheck.

    The cache finds an answer by the digest of its question. The checker verifies cached certificates again
    before use.

    Examples:
      lyapcheck store --size
      lyapcheck store --clear
    """
    del size  # said in any case
    if clear:
        store.clear()
    show(Kept(tuple(store.held()), clear), format)
    return Exit.PROVED
