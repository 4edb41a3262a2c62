"""Random starts: how the indices of each gain set spread over many runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from lyapcheck.answers.simulate.runs import SETTLED
from lyapcheck.answers.simulate.samples import quantities
from lyapcheck.answers.simulate.simulation import Simulation, breach_record, cell, lower, plain, plains, row
from lyapcheck.output.document import Block, Bullets, Paragraph, Section, Table
from lyapcheck.simulate.starts import SHARES, Sweep, quantiles

OVERVIEW = ("gains", "finished", "V rose in", "beyond a motor's limit in", "ε₀", "promises")
QUANTILES = tuple("least" if s == 0 else "most" if s == 1 else f"{100 * s:g} %" for s in SHARES)
HEADS = ("quantity", *QUANTILES, "without")
WITHOUT = "Of each quantity: its quantiles over the runs, and how many runs are without it."


class RandomStarts(Simulation[Sweep]):
    """Quantiles of the indices over runs from random starts to a set point."""

    promised = "V falls, every motor stays within its limit"

    def about(self) -> str:
        """How many starts there were."""
        counts = {one.starts.count for one in self.results}
        return f", {'/'.join(map(str, sorted(counts)))} random starts each" if counts else ""

    def missing(self, name: str) -> list[str]:
        """Also what was seen of many runs at once and could not be found again in one of them."""
        return [
            *super().missing(name),
            *(_doubt(one) for one in self.results if one.name == name and _doubt(one)),
        ]

    def complaints(self) -> list[str]:
        """What went wrong, and these doubts."""
        return [*super().complaints(), *(f"undecided: {_doubt(one)}" for one in self.results if _doubt(one))]

    def opening(self) -> Sequence[Block]:
        """Where the starts lie, and the set point."""
        return [Paragraph(text) for text in dict.fromkeys(map(_task, self.results))]

    def legend(self) -> Sequence[str]:
        """Settling, and the last column."""
        return SETTLED, WITHOUT

    def overview(self) -> Table:
        """How many runs ended, and how many broke a promise."""
        rows = [
            (
                one.name,
                f"{one.finished} of {one.starts.count}",
                str(_count(one.risen)),
                str(_count(one.beyond)),
                lower(one.eps0),
                self.mark(one.name),
            )
            for one in self.results
        ]
        return Table(OVERVIEW, tuple(rows), align="lrrrrl")

    def section(self, one: Sweep) -> Section:
        """A row a quantity; why runs did not reach their end."""
        member = "" if one.gains.family.m is None else f" (m = {one.gains.family.m})"
        rows = [
            (result.name, *(cell(x, result.form) for x in quantiles(result.values)), str(result.without))
            for result in quantities(one)
        ]
        reasons = dict.fromkeys(reason for reason in one.runs.failure if reason)
        failed = [Bullets(tuple(f"not finished: {reason}" for reason in reasons))] if reasons else []
        blocks: tuple[Block, ...] = (*failed, Table(HEADS, tuple(rows)))
        return Section(f"{self.mark(one.name)} {one.name}{member}", blocks)

    def plain_data(self, one: Sweep) -> dict[str, Any]:
        """Quantiles by name, units in the names."""
        return {
            "name": one.name,
            "m": one.gains.family.m,
            "robot": one.robot,
            "kind": "random starts",
            "runs": one.starts.count,
            "spread": plain(math.degrees(one.starts.spread)),
            "seed": one.starts.seed,
            "start": plains(np.degrees(one.task.q0)),
            "target": plains(np.degrees(one.task.q_d)),
            "time": one.task.T,
            "finished": one.finished,
            "eps0": one.eps0,
            "V_rose": _count(one.risen),
            "beyond_limits": _count(one.beyond),
            "shares": list(SHARES),
            "quantiles": {result.name: plains(quantiles(result.values)) for result in quantities(one)},
            "breach": None if one.breach is None else one.breach.data,
        }

    def rows_of(self, one: Sweep) -> list[dict[str, Any]]:
        """A row a gain set and quantity."""
        data = self.plain_data(one)
        keys = ("name", "m", "robot", "kind", "runs", "spread", "seed", "time", "finished", "eps0")
        head = {key: data[key] for key in (*keys, "V_rose", "beyond_limits")}
        return [
            {
                **head,
                "quantity": result.name,
                **dict(zip(QUANTILES, data["quantiles"][result.name], strict=True)),
                "without": result.without,
                "breach": breach_record(one.breach),
            }
            for result in quantities(one)
        ]


def _doubt(one: Sweep) -> str:
    """What counts against a gain set of which no breach is known."""
    seen = _count((one.risen | one.beyond) & one.runs.complete)
    if not seen or one.breach is not None:
        return ""
    where = (
        f"{one.name} on {one.robot}: V rose or a torque left its limit in {seen} of {one.starts.count} runs"
    )
    return f"{where}, but the first of them breaks no promise when it is run alone"


def _task(one: Sweep) -> str:
    middle, goal = (row(math.degrees(x) for x in ends) for ends in (one.task.q0, one.task.q_d))
    box = f"{one.starts.count} starts within ±{math.degrees(one.starts.spread):g}° of {middle}°"
    return f"{box}, seed {one.starts.seed}: to {goal}° in {one.task.T:g} s."


def _count(flags: np.ndarray[Any, np.dtype[np.bool_]]) -> int:
    return int(np.count_nonzero(flags))
