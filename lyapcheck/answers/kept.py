"""What is kept between runs, and how much of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Paragraph, Table
from lyapcheck.store import Held

WHAT = {
    "answers": "proofs that the checker has accepted, and whole reports; judged anew when they are taken",
    "kernels": "compiled code of simulations and samplers",
}


@dataclass(frozen=True)
class Kept(Answer):
    """The rooms of the store.

    Args:
        rooms: what each holds.
        cleared: whether all of it was just removed.
    """

    schema = "lyapcheck/store/1"

    rooms: tuple[Held, ...]
    cleared: bool = False

    def document(self) -> Document:
        """A row a room."""
        total = sum(room.bytes for room in self.rooms)
        title = "The store is empty" if not total else f"{total} bytes are kept"
        if self.cleared:
            title = "The store was cleared"
        rows = tuple(
            (room.room, str(room.files), str(room.bytes), WHAT.get(room.room, "")) for room in self.rooms
        )
        table = Table(("room", "files", "bytes", "what"), rows, align="lrrl")
        return Document(title, (table,) if rows else (Paragraph("Nothing is kept yet."),))

    def data(self) -> dict[str, Any]:
        """``results: [{room, files, bytes}]``."""
        return {"cleared": self.cleared, "results": [vars(room) for room in self.rooms]}
