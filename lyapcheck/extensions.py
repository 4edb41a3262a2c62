"""Folders of the user's own: files in them count as if they lay in the folders of this package.

``LYAPCHECK_PATH`` names them, separated as in ``PATH``. Inside, they are laid out as this package is: a
family is ``family/members/NAME.py`` there, an arm ``robots/arms/NAME.toml``. The checker does not look there:
what it trusts lies in its own folder.
"""

from __future__ import annotations

import os

TYPE_CHECKING = False  # typing takes longer to import than a short command to run
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

VARIABLE = "LYAPCHECK_PATH"


def folders(package: str) -> list[str]:
    """The user's own folders for a package, such as ``lyapcheck.family.members``; they need not exist."""
    inner = package.split(".")[1:]
    roots = os.environ.get(VARIABLE, "").split(os.pathsep)
    return [os.path.join(os.path.abspath(root), *inner) for root in roots if root]


def shipped(name: str) -> Path:
    """A folder that travels with lyapcheck: inside an installed package, or at the top of a checkout."""
    from pathlib import Path

    package = Path(__file__).parent
    inside = package / name
    return inside if inside.is_dir() else package.parent / name


def modules(path: Iterable[str]) -> tuple[str, ...]:
    """The modules in some folders that are not private, sorted."""
    return tuple(sorted({name[:-3] for _, name in _files(path) if name[0] != "_"}))


def defining(function: str, path: Iterable[str]) -> tuple[str, ...]:
    """The modules in some folders that define a function, sorted; they are read, not imported."""
    from lyapcheck.files.reader import SCRIPT, read_bytes

    start = f"\ndef {function}(".encode()
    found = {name for file, name in _files(path) if start in b"\n" + read_bytes(file, SCRIPT)}
    return tuple(sorted(name[:-3] for name in found))


def _files(path: Iterable[str]) -> Iterator[tuple[str, str]]:
    """The Python files in some folders, and their names; a pipe or a device is none."""
    for folder in filter(os.path.isdir, path):
        for name in os.listdir(folder):
            file = os.path.join(folder, name)
            if name.endswith(".py") and os.path.isfile(file):
                yield file, name
