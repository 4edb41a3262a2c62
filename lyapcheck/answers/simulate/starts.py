"""Random starts: how the indices of each gain set spread over many runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.answers.simulate import (
    BREACH,
    Simulation,
    breach_record,
    csv_of,
    degrees,
    lower,
    plain,
    plains,
    row,
)
from lyapcheck.answers.simulate.runs import SETTLED
from lyapcheck.output.digits import shown
from lyapcheck.output.document import Bullets, Section, Table
from lyapcheck.output.escapes import csv_text
from lyapcheck.output.fields import Field, records
from lyapcheck.simulate.many import SHARES, Sweep, quantiles

QUANTILES = tuple("least" if s == 0 else "most" if s == 1 else f"{100 * s:g} %" for s in SHARES)
WITHOUT = "Of each quantity: its quantiles over the runs, and how many runs are without it."


@dataclass(frozen=True, eq=False)
class Quantity:
    """One index of every run.

    Args:
        name: with the joint and the unit.
        values: (R,), NaN where a run has none.
        form: how a number of it is shown.
    """

    name: str
    values: Array
    form: str

    @property
    def without(self) -> int:
        """How many runs have no such number."""
        return int(np.count_nonzero(~np.isfinite(self.values)))


def quantities(result: Sweep) -> list[Quantity]:
    """L2, then each index joint by joint."""
    runs = result.runs
    tables = (
        ("settling [s]", runs.settling, "z.3f"),
        ("overshoot [%]", runs.overshoot, "z.2f"),
        ("peak torque [N·m]", runs.peak_torque, "z.2f"),
        ("final error [°]", runs.final_error, "z.4f"),
    )
    return [
        Quantity("L2 [°]", runs.L2, ".4f"),
        *(
            Quantity(f"{joint} {name}", table[:, i], form)
            for name, table, form in tables
            for i, joint in enumerate(result.joints)
        ),
    ]


FIELDS = (
    Field("name", "name", "gains", align="l"),
    Field("m", "m"),
    Field("robot", "robot"),
    Field("kind", lambda one: "random starts"),
    Field("runs", "starts.count"),
    Field("spread", lambda one: plain(math.degrees(one.starts.spread))),
    Field("seed", "starts.seed"),
    Field("start", "task.q0", to=degrees, csv=None),
    Field("target", "task.q_d", to=degrees, csv=None),
    Field("time", "task.T"),
    Field("", lambda one: f"{one.finished} of {one.starts.count}", "finished", csv=None),
    Field("finished", "finished"),
    Field("V_rose", lambda one: _count(one.risen), "V rose in"),
    Field("beyond_limits", lambda one: _count(one.beyond), "beyond a motor's limit in"),
    Field("eps0", "eps0", "ε₀", lower),
    Field("shares", lambda one: list(SHARES), csv=None),
    Field(
        "quantiles", lambda one: {of.name: plains(quantiles(of.values)) for of in quantities(one)}, csv=None
    ),
    BREACH[0],
)
"""Units in the names; quantiles by name."""


class RandomStarts(Simulation[Sweep]):
    """Quantiles of the indices over runs from random starts to a set point."""

    fields = FIELDS
    legend = (SETTLED, WITHOUT)
    promised = "V falls, every motor stays within its limit"

    def motions(self) -> Sequence[str]:
        """From how many starts, and to which goal."""
        return tuple(dict.fromkeys(f"simulated: {_task(one).removesuffix('.')}" for one in self.results))[:2]

    def missing(self, name: str) -> list[str]:
        """Also what was seen of many runs at once and could not be found again in one of them."""
        return [
            *super().missing(name),
            *(_doubt(one) for one in self.results if one.name == name and _doubt(one)),
        ]

    def complaints(self) -> list[str]:
        """What went wrong, and these doubts."""
        return [*super().complaints(), *(f"undecided: {_doubt(one)}" for one in self.results if _doubt(one))]

    def section(self, one: Sweep) -> Section:
        """A row a quantity; why runs did not reach their end."""
        member = "" if one.m is None else f" (m = {one.m})"
        reasons = dict.fromkeys(reason for reason in one.runs.failure if reason)
        failed = [Bullets(tuple(f"not finished: {reason}" for reason in reasons))] if reasons else []
        return Section(f"{self.mark(one.name)} {one.name}{member}", (*failed, self.by_joint(one)))

    def by_joint(self, one: Sweep) -> Table:
        """A row a quantity; in a narrow terminal without its inner quantiles."""
        rows = tuple(
            (of.name, *(shown(x, of.form) for x in quantiles(of.values)), str(of.without))
            for of in quantities(one)
        )
        heads = ("quantity", *QUANTILES, "without")
        return Table(heads, rows, drop=(2, 4))

    def rows_of(self, one: Sweep) -> list[dict[str, Any]]:
        """A row a gain set and quantity."""
        (head,) = records(self.fields, one)
        return [
            {
                **head,
                "quantity": of.name,
                **dict(zip(QUANTILES, plains(quantiles(of.values)), strict=True)),
                "without": of.without,
                "breach": breach_record(one.breach),
            }
            for of in quantities(one)
        ]


def _doubt(one: Sweep) -> str:
    """What counts against a gain set of which no breach is known."""
    seen = _count((one.risen | one.beyond) & one.runs.complete)
    if not seen or one.breach is not None:
        return ""
    where = (
        f"{one.name} on {one.robot}: V rose or a torque left its limit in {seen} of {one.starts.count} runs"
    )
    return f"{where}, but the first of them violates no bound when it runs alone"


def _task(one: Sweep) -> str:
    middle, goal = (row(math.degrees(x) for x in ends) for ends in (one.task.q0, one.task.q_d))
    box = f"{one.starts.count} starts within ±{math.degrees(one.starts.spread):g}° of {middle}°"
    return f"{box}, seed {one.starts.seed}: to {goal}° in {one.task.T:g} s."


def _count(flags: np.ndarray[Any, np.dtype[np.bool_]]) -> int:
    return int(np.count_nonzero(flags))


def starts_csv(sweeps: Sequence[Sweep]) -> str:
    """One row a run from a random start: its start, whether it is complete, and its indices."""
    if not sweeps:
        return csv_of(["gains", "run", "complete"], ())
    starts = [f"q{i + 1}(0) [rad]" for i in range(len(sweeps[0].joints))]
    indices = [csv_text(one.name) for one in quantities(sweeps[0])]
    rows: list[list[object]] = []
    for result in sweeps:
        table = np.column_stack((result.q0, *(one.values for one in quantities(result)))).tolist()
        for number, (sample, whole) in enumerate(zip(table, result.runs.complete, strict=True), start=1):
            rows.append([csv_text(result.name), number, "yes" if whole else "no", *map(repr, sample)])
    return csv_of(["gains", "run", "complete", *starts, *indices], rows)
