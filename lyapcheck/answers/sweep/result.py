"""A sweep as an answer: how many questions came out how, and maps over m and k_v."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from lyapcheck.answers.sweep.question import Row
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_least, at_most
from lyapcheck.output.document import Bullets, Document, Figure, Section, Table, command
from lyapcheck.output.html import blocks
from lyapcheck.output.mathml import Markup
from lyapcheck.verdicts import Exit

MOST_CELLS = 3_000
"""Of one map; a larger one could not be read."""
MOST_MAPS = 40
MOST_ROWS = 12
DIGITS = 3
"""Significant digits of a cell."""
Arm = tuple[str, tuple[str, ...]]
"""A robot, and what varies."""
ASKED = {
    "margin": ("gate",),
    "eps0": ("epsilon",),
    "settling": ("simulate", "bounds"),
}
"""Which questions fill a column."""
WRONG = ("refuted", "rejected")
OPEN = ("undecided",)
ERROR = "error"
SIGNS = {Exit.PROVED: "✓", Exit.REFUTED: "✗", Exit.UNDECIDED: "?", Exit.INTERNAL: "!"}
LEGEND = "Of cells that differ in K_p the worst is shown; empty: not every one has a value."
OBSERVED = "observed: a simulation in floating point that broke no promise; it proves nothing."


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


@dataclass(frozen=True)
class SweepAnswer(Answer):
    """What a sweep found, as far as it fits a page; the rows are in its folder.

    Args:
        path: of the plan.
        tally: counts and maps.
        figures: whether the maps are drawn beside the document.
        certificates: the folder that has some; empty where there are none.
    """

    schema = "lyapcheck/sweep/1"

    path: str
    tally: Tally
    figures: bool = False
    certificates: str = ""

    @property
    def exit_code(self) -> Exit:
        """4 if a question failed, else 1 if something is refuted or rejected, else 3 if undecided, else 0."""
        verdicts = {verdict for _, _, verdict in self.tally.counts}
        if ERROR in verdicts:
            return Exit.INTERNAL
        if verdicts & set(WRONG):
            return Exit.REFUTED
        return Exit.UNDECIDED if verdicts & set(OPEN) or not verdicts else Exit.PROVED

    def document(self) -> Document:
        """Counts, what failed first; why nothing was decided; a table or a drawing of each map."""
        maps = tuple(self._map(number, one) for number, one in enumerate(self.maps, start=1))
        notes = [LEGEND] if maps else []
        notes += [OBSERVED] if any(verdict == "observed" for _, _, verdict in self.tally.counts) else []
        order = {ERROR: 0, **dict.fromkeys(WRONG, 1), **dict.fromkeys(OPEN, 2)}
        rows = sorted(
            ((arm_text(arm), ask, verdict, str(n)) for (arm, ask, verdict), n in self.tally.counts.items()),
            key=lambda row: order.get(row[2], 3),
        )
        reasons = [
            f"{count} times: {reason}" if count > 1 else reason
            for reason, count in sorted(self.tally.reasons.items(), key=lambda pair: -pair[1])
        ]
        more = [f"{len(rows) - MOST_ROWS} further rows: -v"] if len(rows) > MOST_ROWS else []
        said = (*more, *reasons)
        whole = [_counts(rows)] if more else []
        return Document(
            self._title(),
            (*([_counts(rows[:MOST_ROWS])] if rows else []), *([Bullets(said[:3])] if said else [])),
            tuple(notes),
            ("maps over m and k_v: -v, or index.html with --out",) if maps else (),
            (
                *whole,
                *([Section("Further reasons", (Bullets(said[3:10]),))] if said[3:] else []),
                *maps,
            ),
            "each arm is assumed to be as its file says: lyapcheck robot ARM --assumptions",
            command("recheck", self.certificates)
            if self.certificates
            else command("sweep", self.path, "--out", "sweep"),
        )

    def data(self) -> dict[str, Any]:
        """``results: [{robot, variation, ask, verdict, count}], maps: [{robot, …, cells: [{m, kv, …}]}]``."""
        return {
            "plan": self.path.rsplit("/", 1)[-1],
            "results": [
                {"robot": robot, "variation": list(variation), "ask": ask, "verdict": verdict, "count": count}
                for ((robot, variation), ask, verdict), count in self.tally.counts.items()
            ],
            "maps": [
                {
                    "robot": one.arm[0],
                    "variation": list(one.arm[1]),
                    "column": one.measure.column,
                    "cells": [{"m": m, "kv": kv, "value": value} for (m, kv), value in one.cells.items()],
                }
                for one in self.maps
            ],
        }

    @property
    def maps(self) -> list[Map]:
        """Those that are worth showing."""
        return [one for one in self.tally.maps.values() if one.shown]

    def _title(self) -> str:
        total = sum(self.tally.counts.values())
        verdicts: dict[str, int] = {}
        for (_, _, verdict), count in self.tally.counts.items():
            verdicts[verdict] = verdicts.get(verdict, 0) + count
        parts = ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items())
        return f"{SIGNS[self.exit_code]} {total} question{'' if total == 1 else 's'}: {parts or 'none asked'}"

    def _map(self, number: int, one: Map) -> Section:
        title = f"{one.measure.title}: {arm_text(one.arm)}"
        if self.figures:
            return Section(title, (Figure(f"figures/{stem(number, one)}.svg", f"{title}, over m and k_v"),))
        heads = ("m", *one.columns)
        rows = tuple((m, *(one.measure.text(one.cells.get((m, kv))) for kv in one.columns)) for m in one.rows)
        return Section(title, (Table(heads, rows, caption="m down, k_v in N·m across"),))


def _counts(rows: Sequence[tuple[str, ...]]) -> Table:
    return Table(("arm", "question", "verdict", "count"), tuple(rows), align="lllr", keys=3)


def stem(number: int, one: Map) -> str:
    """The name of a map's files."""
    return f"map{number}_{one.measure.column}"


def files(answer: SweepAnswer) -> dict[str, str | bytes]:
    """``index.html`` and ``sweep.json``, and each map as SVG, PNG and CSV, by their names in the folder."""
    from lyapcheck.report.plots import heat_plot

    drawings: dict[str, str | bytes] = {}
    for number, one in enumerate(answer.maps, start=1):
        plot = heat_plot(one.rows, one.columns, one.cells, one.measure.title, one.measure.text)
        drawings |= {f"figures/{name}": drawing for name, drawing in plot.files(stem(number, one)).items()}
    return {**drawings, "index.html": _page(answer, drawings), "sweep.json": answer.written("json")}


def _page(answer: SweepAnswer, drawings: dict[str, str | bytes]) -> str:
    from lyapcheck.report.page import drawn, markup

    def shown(figure: Figure) -> Markup | None:
        name = figure.path.removeprefix("figures/").removesuffix(".svg")
        return drawn(name, str(drawings[figure.path]), figure.caption)

    document = answer.document()
    return markup("sheet.html", title=document.title, inner=list(blocks(document.body, 2, shown)))
