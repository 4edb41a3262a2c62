"""A sweep as an answer: how many questions came out how, and maps over m and k_v."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from lyapcheck.answers.sweep.tally import Map, Tally, arm_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Document, Figure, Section, Table
from lyapcheck.verdicts import Exit

WRONG = ("refuted", "rejected")
OPEN = ("undecided",)
ERROR = "error"
SIGNS = {Exit.PROVED: "✓", Exit.REFUTED: "✗", Exit.UNDECIDED: "?", Exit.INTERNAL: "!"}
LEGEND = "Of cells that differ in K_p the worst is shown; empty: not every one has a value."
OBSERVED = "observed: a simulation in floating point that broke no promise; it proves nothing."


@dataclass(frozen=True)
class SweepAnswer(Answer):
    """What a sweep found, as far as it fits a page; the rows are in its folder.

    Args:
        path: of the plan.
        tally: counts and maps.
        figures: whether the maps are drawn beside the document.
    """

    schema = "lyapcheck/sweep/1"

    path: str
    tally: Tally
    figures: bool = False

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
        """Counts, why nothing was decided, and a table or a drawing of each map."""
        maps = tuple(self._map(number, one) for number, one in enumerate(self.maps, start=1))
        notes = [LEGEND] if maps else []
        notes += [OBSERVED] if any(verdict == "observed" for _, _, verdict in self.tally.counts) else []
        return Document(self._title(), (*self._counts(), *self._reasons(), *maps), tuple(notes))

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

    def _counts(self) -> Iterator[Block]:
        rows = [
            (arm_text(arm), ask, verdict, str(count))
            for (arm, ask, verdict), count in self.tally.counts.items()
        ]
        if rows:
            yield Table(("arm", "question", "verdict", "count"), tuple(rows), align="lllr", keys=3)

    def _reasons(self) -> Iterator[Block]:
        reasons = sorted(self.tally.reasons.items(), key=lambda pair: -pair[1])
        if reasons:
            shown = tuple(
                f"{count} times: {reason}" if count > 1 else reason for reason, count in reasons[:10]
            )
            yield Section("Why not more was decided", (Bullets(shown),))

    def _map(self, number: int, one: Map) -> Section:
        title = f"{one.measure.title}: {arm_text(one.arm)}"
        if self.figures:
            return Section(title, (Figure(f"figures/{stem(number, one)}.svg", f"{title}, over m and k_v"),))
        heads = ("m", *one.columns)
        rows = tuple((m, *(one.measure.text(one.cells.get((m, kv))) for kv in one.columns)) for m in one.rows)
        return Section(title, (Table(heads, rows, caption="m down, k_v in N·m across"),))


def stem(number: int, one: Map) -> str:
    """The name of a map's files."""
    return f"map{number}_{one.measure.column}"
