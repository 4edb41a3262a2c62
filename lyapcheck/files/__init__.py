"""Reading what users write: exact decimals, the place of every key, every problem told at once."""

from lyapcheck.files.decimals import NotFinite, Written, decimal_text, round_down
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.places import KeyPath
from lyapcheck.files.printable import printable
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
