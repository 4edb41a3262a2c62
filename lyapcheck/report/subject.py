"""What a report is about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile, GainSet


@dataclass(frozen=True)
class Subject:
    """An arm, members of the family, and gains.

    Args:
        robot: name or file of the arm, as ``lyapcheck.robots.load`` takes it.
        ms: the members of the family.
        gain_files: the gains; sets of other members are left out, those without a member (PD) stay.
        own: whether arm or gains are others than the paper's: it is then about these alone.
        map: whether the map over m and k_v is to be computed; that of the paper's arm is at hand.
    """

    robot: str
    ms: tuple[int, ...]
    gain_files: tuple[GainFile, ...]
    own: bool = False
    map: bool = False

    @property
    def sets(self) -> list[tuple[GainFile, str]]:
        """The gain sets that belong in the report, each with its file."""
        return [
            (file, item.name)
            for file in self.gain_files
            for item in file.gains
            if item.m is None or item.m in self.ms
        ]

    @property
    def of_family(self) -> dict[int, GainSet]:
        """The first gain set of each member."""
        result: dict[int, GainSet] = {}
        for file in self.gain_files:
            for item in file.gains:
                if item.m in self.ms and item.family == "hyperbolic":
                    result.setdefault(item.m, item)
        return result
