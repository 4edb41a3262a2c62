"""Names of users as names of files."""

from __future__ import annotations

from hashlib import sha256
from urllib.parse import quote

LONGEST = 100
"""Characters of a file's name that a user's name may take; file systems stop at 255 for the whole."""


def file_stem(name: str) -> str:
    """A name as the start of a file's name, with what some file system refuses escaped as in an address.

    A long name is cut, and set apart from others by the start of its SHA-256.
    """
    stem = quote(name, safe="")
    if stem.startswith("."):
        stem = f"%2E{stem[1:]}"
    return stem if len(stem) <= LONGEST else f"{stem[:LONGEST]}-{sha256(name.encode()).hexdigest()[:12]}"
