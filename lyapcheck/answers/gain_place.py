"""Where a gain set stands, for annotations."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile, GainSet


class GainPlace(NamedTuple):
    """A file, and the line and column of a gain set there, from 1; empty and 0 where there is none."""

    path: str = ""
    line: int = 0
    column: int = 0


def gain_place(file: GainFile | None, gains: GainSet) -> GainPlace:
    """The place of a gain set in the file that it was read from."""
    if file is None:
        return GainPlace()
    place = file.place(gains)
    return GainPlace(file.path) if place is None else GainPlace(file.path, place.line, place.column)
