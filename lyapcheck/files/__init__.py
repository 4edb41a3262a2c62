"""Reading what users write: exact decimals, the place of every key, every problem told at once.

Each name is imported from its home when it is first used: reading decimals needs no TOML.
"""

from __future__ import annotations

from lyapcheck.lazy import exporter
from lyapcheck.output.escapes import printable  # now: its module has the same name

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.files.decimals import NotFinite, Written, decimal_text, round_down
    from lyapcheck.files.fields import Fields, Notes
    from lyapcheck.files.place import KeyPath
    from lyapcheck.files.toml import Document, open_document

__all__ = [
    "Document",
    "Fields",
    "KeyPath",
    "NotFinite",
    "Notes",
    "Written",
    "decimal_text",
    "open_document",
    "printable",
    "round_down",
]

_HOMES = {
    "Document": "toml",
    "Fields": "fields",
    "KeyPath": "place",
    "NotFinite": "decimals",
    "Notes": "fields",
    "Written": "decimals",
    "decimal_text": "decimals",
    "open_document": "toml",
    "round_down": "decimals",
}

__getattr__ = exporter(__name__, _HOMES)
