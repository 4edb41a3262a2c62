"""Opening an arm file, and refusing what is none."""

from __future__ import annotations

from pathlib import Path

from lyapcheck.errors import file_error
from lyapcheck.files.reader import ARM
from lyapcheck.files.toml import TomlFile, open_document


def open_arm(path: Path, shown: str) -> TomlFile:
    """The TOML document of an arm file; ``shown`` is the name that messages use.

    Raises:
        InputError: not a ``.toml`` file, missing, a folder, too large, not UTF-8 or not TOML.
    """
    if path.suffix.lower() != ".toml" and not path.is_dir():
        raise file_error(shown, "is no arm file", "give the path of a .toml or .urdf file")
    return open_document(path, shown, ARM)
