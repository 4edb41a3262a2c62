"""What is said of a sweep as a whole: counts, and maps over m and k_v; no more than is shown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from lyapcheck.answers.sweep.question import Row
from lyapcheck.output.digits import at_least, at_most

MOST_CELLS = 3_000
"""Of one map; a larger one could not be read."""
MOST_MAPS = 40
DIGITS = 3
"""Significant digits of a cell."""
Arm = tuple[str, tuple[str, ...]]
"""A robot, and what varies."""


@dataclass(frozen=True)
class Measure:
    """What a map shows.

    Args:
        title: in words, with its unit.
        column: of the rows.
        worst: which of several values counts, where cells differ in K_p.
    """

    title: str
    column: str
    worst: Callable[[float, float], float]

    def text(self, value: float | None) -> str:
        """A value of a cell, rounded to the worse side."""
        if value is None:
            return ""
        return (at_least if self.worst is min else at_most)(Fraction(repr(value)), DIGITS)


MEASURES = (
    Measure("least margin of the gate's conditions, as a share of the limit", "margin", min),
    Measure("certified ε₀", "eps0", min),
    Measure("simulated settling time in s", "settling", max),
)
ASKED = {
    "margin": ("gate",),
    "eps0": ("epsilon",),
    "settling": ("simulate", "bounds"),
}
"""Which questions fill a column."""


@dataclass
class Map:
    """Values over m and k_v, in the order of the plan; ``None`` where one of several is missing."""

    arm: Arm
    measure: Measure
    cells: dict[tuple[str, str], float | None] = field(default_factory=dict)
    whole: bool = True

    def add(self, m: str, kv: str, value: float | None) -> None:
        """Note a value; the worst of a cell stays, and none is worse than any."""
        key = m, kv
        if key not in self.cells and len(self.cells) == MOST_CELLS:
            self.whole = False
        elif key not in self.cells:
            self.cells[key] = value
        else:
            known = self.cells[key]
            self.cells[key] = None if known is None or value is None else self.measure.worst(known, value)

    @property
    def rows(self) -> list[str]:
        """The m."""
        return list(dict.fromkeys(m for m, _ in self.cells))

    @property
    def columns(self) -> list[str]:
        """The k_v."""
        return list(dict.fromkeys(kv for _, kv in self.cells))

    @property
    def shown(self) -> bool:
        """Whether there is more than a line of it, and something in it."""
        known = any(value is not None for value in self.cells.values())
        return self.whole and known and len(self.cells) > 1


class Tally:
    """Counts and maps that grow with every row, up to what can be shown."""

    def __init__(self) -> None:
        self.counts: Counter[tuple[Arm, str, str]] = Counter()
        self.reasons: dict[str, int] = {}
        self.maps: dict[tuple[Arm, str], Map] = {}

    def add(self, row: Row) -> None:
        """Note a row."""
        arm = row["robot"], tuple(row["variation"])
        self.counts[arm, row["ask"], row["verdict"]] += 1
        if row["reason"] and (row["reason"] in self.reasons or len(self.reasons) < MOST_MAPS):
            self.reasons[row["reason"]] = self.reasons.get(row["reason"], 0) + 1
        if row["kv"] is None:
            return
        for measure in MEASURES:
            if row["ask"] in ASKED[measure.column]:
                self._add(arm, measure, row)

    def _add(self, arm: Arm, measure: Measure, row: dict[str, Any]) -> None:
        key = arm, measure.column
        if key not in self.maps and len(self.maps) == MOST_MAPS:
            return
        member = row["family"] if row["m"] is None else f"{row['m']}"
        value = row[measure.column]
        number = None if value is None else float(value)
        kv = row["kv"][:1] if len(set(row["kv"])) == 1 else row["kv"]
        self.maps.setdefault(key, Map(arm, measure)).add(member, ", ".join(kv), number)


def arm_text(arm: Arm) -> str:
    """An arm and what varies, in words."""
    robot, variation = arm
    return f"{robot}, {', '.join(variation)}" if variation else robot
