"""A sweep as an answer: how many questions came out how, and maps over m and k_v."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from lyapcheck.answers.sweep.question import Row
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_least, at_most
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.verdicts import Exit

MOST_CELLS = 3_000
"""Of one map; a larger one could not be read."""
MOST_MAPS = 40
MOST_ROWS = 12
DIGITS = 3
"""Significant digits of a cell."""
Arm = tuple[str, tuple[str, ...]]
"""A robot, and what varies."""
Cells = dict[tuple[str, str], float | None]
"""Values over m and k_v, in the order of the plan; ``None`` where one of several is missing."""
ORDER = {"error": 0, "refuted": 1, "rejected": 1, "undecided": 2}
"""What is wrong is seen first."""
EXITS = (Exit.INTERNAL, Exit.REFUTED, Exit.UNDECIDED, Exit.PROVED)
SIGNS = {Exit.PROVED: "✓", Exit.REFUTED: "✗", Exit.UNDECIDED: "?", Exit.INTERNAL: "!"}
LEGEND = "Of cells that differ in K_p the worst is shown; empty: not every one has a value."
OBSERVED = "observed: a simulation in floating point that broke no promise; it proves nothing."


@dataclass(frozen=True)
class Measure:
    """What a map shows.

    Args:
        title: in words, with its unit.
        column: of the rows.
        asks: the questions that fill it.
        worst: which of several values counts, where cells differ in K_p.
    """

    title: str
    column: str
    asks: tuple[str, ...]
    worst: Callable[[float, float], float]

    def text(self, value: float | None) -> str:
        """A value of a cell, rounded to the worse side."""
        if value is None:
            return ""
        return (at_least if self.worst is min else at_most)(Fraction(repr(value)), DIGITS)


MEASURES = (
    Measure("least margin of the gate's conditions, as a share of the limit", "margin", ("gate",), min),
    Measure("certified ε₀", "eps0", ("epsilon",), min),
    Measure("simulated settling time in s", "settling", ("simulate", "bounds"), max),
)


class Tally:
    """Counts and maps that grow with every row, up to what can be shown."""

    def __init__(self) -> None:
        self.counts: Counter[tuple[Arm, str, str]] = Counter()
        self.reasons: Counter[str] = Counter()
        self._maps: dict[tuple[Arm, Measure], Cells] = {}

    def add(self, row: Row) -> None:
        """Note a row; the worst of a cell stays, and none is worse than any."""
        arm = row["robot"], tuple(row["variation"])
        self.counts[arm, row["ask"], row["verdict"]] += 1
        if row["reason"] and (row["reason"] in self.reasons or len(self.reasons) < MOST_MAPS):
            self.reasons[row["reason"]] += 1
        for measure in MEASURES if row["kv"] is not None else ():
            known = (arm, measure) in self._maps or len(self._maps) < MOST_MAPS
            if row["ask"] in measure.asks and known:
                cells = self._maps.setdefault((arm, measure), {})
                kv = row["kv"][:1] if len(set(row["kv"])) == 1 else row["kv"]
                key = row["family"] if row["m"] is None else str(row["m"]), ", ".join(kv)
                value = None if row[measure.column] is None else float(row[measure.column])
                if key in cells:
                    old = cells[key]
                    cells[key] = None if old is None or value is None else measure.worst(old, value)
                elif len(cells) <= MOST_CELLS:
                    cells[key] = value

    def maps(self) -> Iterator[tuple[Arm, Measure, Cells]]:
        """Those that are worth showing: more than a line of it, and something in it."""
        for (arm, measure), cells in self._maps.items():
            if 1 < len(cells) <= MOST_CELLS and any(value is not None for value in cells.values()):
                yield arm, measure, cells


@dataclass(frozen=True)
class SweepAnswer(Answer):
    """What a sweep found, as far as it fits a page; the rows are in its folder.

    Args:
        path: of the plan.
        tally: counts and maps.
        certificates: the folder that has some; empty where there are none.
    """

    schema = "lyapcheck/sweep/1"

    path: str
    tally: Tally
    certificates: str = ""

    @property
    def exit_code(self) -> Exit:
        """4 if a question failed, else 1 if something is refuted or rejected, else 3 if undecided, else 0."""
        if not self.tally.counts:
            return Exit.UNDECIDED
        return EXITS[min(ORDER.get(verdict, 3) for _, _, verdict in self.tally.counts)]

    def document(self) -> Document:
        """Counts, what failed first; why nothing was decided; in detail a table of each map."""
        maps = tuple(_map(*one) for one in self.tally.maps())
        notes = [LEGEND] if maps else []
        notes += [OBSERVED] if any(verdict == "observed" for _, _, verdict in self.tally.counts) else []
        rows = sorted(
            ((arm_text(arm), ask, verdict, str(n)) for (arm, ask, verdict), n in self.tally.counts.items()),
            key=lambda row: ORDER.get(row[2], 3),
        )
        more = [f"{len(rows) - MOST_ROWS} further rows: -v"] if len(rows) > MOST_ROWS else []
        reasons = self.tally.reasons.most_common()
        said = (*more, *(f"{count} times: {text}" if count > 1 else text for text, count in reasons))
        plan = command("sweep", self.path, "--out", "sweep")
        return Document(
            self._title(),
            (*([_counts(rows[:MOST_ROWS])] if rows else []), *([Bullets(said[:3])] if said else [])),
            tuple(notes),
            ("maps over m and k_v: -v, or index.html with --out",) if maps else (),
            (
                *([_counts(rows)] if more else []),
                *([Section("Further reasons", (Bullets(said[3:10]),))] if said[3:] else []),
                *maps,
            ),
            "each arm is assumed to be as its file says: lyapcheck robot ARM --assumptions",
            command("recheck", self.certificates) if self.certificates else plan,
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
                    "robot": robot,
                    "variation": list(variation),
                    "column": measure.column,
                    "cells": [{"m": m, "kv": kv, "value": value} for (m, kv), value in cells.items()],
                }
                for (robot, variation), measure, cells in self.tally.maps()
            ],
        }

    def _title(self) -> str:
        verdicts: Counter[str] = Counter()
        for (_, _, verdict), count in self.tally.counts.items():
            verdicts[verdict] += count
        total, parts = verdicts.total(), ", ".join(f"{count} {word}" for word, count in verdicts.items())
        return f"{SIGNS[self.exit_code]} {total} question{'' if total == 1 else 's'}: {parts or 'none asked'}"


def arm_text(arm: Arm) -> str:
    """An arm and what varies, in words."""
    robot, variation = arm
    return f"{robot}, {', '.join(variation)}" if variation else robot


def _counts(rows: Sequence[tuple[str, ...]]) -> Table:
    return Table(("arm", "question", "verdict", "count"), tuple(rows), align="lllr", keys=3)


def _grid(cells: Cells) -> tuple[list[str], list[str]]:
    """The m and the k_v."""
    return list(dict.fromkeys(m for m, _ in cells)), list(dict.fromkeys(kv for _, kv in cells))


def _map(arm: Arm, measure: Measure, cells: Cells) -> Section:
    ms, kvs = _grid(cells)
    rows = tuple((m, *(measure.text(cells.get((m, kv))) for kv in kvs)) for m in ms)
    table = Table(("m", *kvs), rows, caption="m down, k_v in N·m across")
    return Section(f"{measure.title}: {arm_text(arm)}", (table,))


def files(answer: SweepAnswer) -> dict[str, str | bytes]:
    """``index.html`` with the maps in colour, and ``sweep.json``, by their names in the folder."""
    from lyapcheck.output.html import blocks
    from lyapcheck.report.page import markup

    whole, maps = answer.document(), []
    for arm, measure, cells in answer.tally.maps():
        known = [value for value in cells.values() if value is not None]
        low, wide = min(known), (max(known) - min(known)) or 1.0
        shares = {key: None if value is None else (value - low) / wide for key, value in cells.items()}
        ms, kvs = _grid(cells)
        rows = [(m, [(measure.text(cells.get((m, kv))), shares.get((m, kv))) for kv in kvs]) for m in ms]
        maps.append((f"{measure.title}: {arm_text(arm)}", kvs, rows))
    titles = {title for title, _, _ in maps}
    inner = [one for one in whole.body if not isinstance(one, Section) or one.title not in titles]
    page = markup("sweep.html", title=whole.title, inner=list(blocks(inner, 2)), maps=maps)
    return {"index.html": page, "sweep.json": answer.written("json")}
