"""Opening an arm file, and refusing what is none."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

from lyapcheck.errors import InputError, Problem
from lyapcheck.robots.fields import KeyPath


class Document(Protocol):
    """A TOML file with exact decimals that knows the line of each key."""

    @property
    def data(self) -> dict[str, Any]:
        """The top-level table."""

    def line(self, path: KeyPath) -> int | None:
        """The line of a key, counted from 1."""


def open_document(path: Path) -> Document:
    """The TOML document of an arm file.

    Raises:
        InputError: not a ``.toml`` file, missing, a directory, too large, not UTF-8 or not TOML.
    """
    if path.suffix == ".urdf":
        raise _refused(
            path, "URDF is not read by this version", "describe the arm by [[links]] in a .toml file"
        )
    if path.suffix != ".toml":
        raise _refused(path, "is no arm file", "give the path of a .toml file")
    return _Plain(tomllib.loads(path.read_text(encoding="utf-8"), parse_float=Fraction))


def _refused(path: Path, rule: str, repair: str) -> InputError:
    return InputError(Problem(path.name, None, "file", "", rule, repair))


@dataclass
class _Plain:
    data: dict[str, Any]

    def line(self, path: KeyPath) -> int | None:
        return None
