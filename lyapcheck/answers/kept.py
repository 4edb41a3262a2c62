"""What is kept between runs, and how much of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Paragraph, Table
from lyapcheck.store import Held

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
        title = "The store is empty" if not total else f"{total} bytes are kept"
        if self.cleared:
            title = "The store was cleared"
        rows = tuple(
            (kind.kind, str(kind.files), str(kind.bytes), WHAT.get(kind.kind, "")) for kind in self.kinds
        )
        table = Table(("kind", "files", "bytes", "what"), rows, align="lrrl")
        return Document(title, (table,) if rows else (Paragraph("Nothing is kept yet."),))

    def data(self) -> dict[str, Any]:
        """``results: [{kind, files, bytes}]``."""
        return {"cleared": self.cleared, "results": [vars(kind) for kind in self.kinds]}
