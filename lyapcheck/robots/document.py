"""Opening an arm file, and refusing what is none."""

from __future__ import annotations

from pathlib import Path

from lyapcheck.errors import file_error
from lyapcheck.files.toml import TomlFile, open_document

LARGEST_ARM_FILE = 1_000_000
"""Bytes; an arm of nine joints with a page of notes has about twenty thousand."""


def open_arm(path: Path, shown: str) -> TomlFile:
    """The TOML document of an arm file; ``shown`` is the name that messages use.

    Raises:
        InputError: not a ``.toml`` file, missing, a folder, too large, not UTF-8 or not TOML.
    """
    if path.suffix.lower() != ".toml" and not path.is_dir():
        raise file_error(shown, "is no arm file", "give the path of a .toml or .urdf file")
    if path.is_file() and path.stat().st_size > LARGEST_ARM_FILE:
        raise file_error(shown, f"is larger than {LARGEST_ARM_FILE} bytes", "give an arm of one page")
    return open_document(path, shown)
