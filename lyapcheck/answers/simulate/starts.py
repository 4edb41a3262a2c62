"""Runs from random starts, as text, Markdown, JSON or CSV."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.output.escapes import csv_text, markdown_text
from lyapcheck.simulate.render import LEGEND, SCHEMA, broken, bullets, cell, section
from lyapcheck.simulate.starts import SHARES, Sweep, quantiles

Array = NDArray[np.float64]

HEADS = ("", *("least" if s == 0 else "most" if s == 1 else f"{100 * s:g} %" for s in SHARES), "without")


def as_text(sweeps: Sequence[Sweep]) -> str:
    """For each gain set a headline, counts, and a row a quantity with its quantiles."""
    return "\n\n".join([*map(_block, sweeps), "\n".join([LEGEND, *bullets(_shared_notes(sweeps))])]) + "\n"


def as_markdown(sweeps: Sequence[Sweep]) -> str:
    """The same as Markdown."""
    notes = bullets(_shared_notes(sweeps), markdown_text)
    return "\n\n".join([*map(_section, sweeps), LEGEND, "\n".join(notes)]).rstrip() + "\n"


def _block(found: Sweep) -> str:
    rows = [HEADS, *_rows(found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]
    return "\n  ".join([_headline(found), *_facts(found), *map(str.rstrip, lines)])


def _section(found: Sweep) -> str:
    return section(_headline(found), _facts(found), HEADS, _rows(found), words=0)


def _headline(found: Sweep) -> str:
    member = "" if found.gains.family.m is None else f" (m = {found.gains.family.m})"
    middle, goal = (", ".join(f"{math.degrees(x):g}" for x in row) for row in (found.task.q0, found.task.q_d))
    box = f"{found.starts.count} starts within ±{math.degrees(found.starts.spread):g}° of ({middle})°"
    way = f"seed {found.starts.seed}: to ({goal})° in {found.task.T:g} s"
    return f"{found.name}{member} on {found.robot}, {box}, {way}"


def _facts(found: Sweep) -> list[str]:
    counts = found.finished, found.starts.count
    rose, beyond = (int(np.count_nonzero(x)) for x in (found.risen, found.beyond))
    line = f"finished {counts[0]} of {counts[1]}, V rose in {rose} (ε₀ = {found.eps0:g})"
    reasons = dict.fromkeys(reason for reason in found.runs.failure if reason)
    failed = [f"not finished: {reason}" for reason in reasons]
    return [f"{line}, a torque left its motor's limit in {beyond}", *failed, *broken(found.breach)]


def _quantities(found: Sweep) -> list[tuple[str, Array, str]]:
    runs = found.runs
    rows = [("L2 [°]", runs.L2, ".4f")]
    for name, table, form in (
        ("settling [s]", runs.settling, "z.3f"),
        ("overshoot [%]", runs.overshoot, "z.2f"),
        ("peak torque [N·m]", runs.peak_torque, "z.2f"),
        ("final error [°]", runs.final_error, "z.4f"),
    ):
        rows += [(f"{joint} {name}", table[:, i], form) for i, joint in enumerate(found.joints)]
    return rows


def _rows(found: Sweep) -> list[tuple[str, ...]]:
    """Quantiles, and how many runs have no such number."""
    return [
        (name, *(cell(x, form) for x in quantiles(values)), str(int(np.count_nonzero(~np.isfinite(values)))))
        for name, values, form in _quantities(found)
    ]


def _shared_notes(sweeps: Sequence[Sweep]) -> list[str]:
    return list(dict.fromkeys(note for found in sweeps for note in found.notes))


def as_json(sweeps: Sequence[Sweep]) -> str:
    """Schema ``lyapcheck/simulate/1`` with ``kind: random starts``; quantiles by name, units in the names."""
    notes = _shared_notes(sweeps)
    results = [_result(found) for found in sweeps]
    data = {"schema": SCHEMA, "version": version("lyapcheck"), "results": results, "notes": notes}
    return json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _result(found: Sweep) -> dict[str, Any]:
    return {
        "name": found.name,
        "m": found.gains.family.m,
        "robot": found.robot,
        "kind": "random starts",
        "runs": found.starts.count,
        "spread": _plain(math.degrees(found.starts.spread)),
        "seed": found.starts.seed,
        "start": [_plain(math.degrees(x)) for x in found.task.q0],
        "target": [_plain(math.degrees(x)) for x in found.task.q_d],
        "time": found.task.T,
        "finished": found.finished,
        "eps0": found.eps0,
        "V_rose": int(np.count_nonzero(found.risen)),
        "beyond_limits": int(np.count_nonzero(found.beyond)),
        "shares": list(SHARES),
        "quantiles": {name: [_plain(x) for x in quantiles(values)] for name, values, _ in _quantities(found)},
        "breach": None if found.breach is None else found.breach.data,
    }


def _plain(value: float) -> float | None:
    return float(f"{value:.9g}") if math.isfinite(value) else None


def sweeps_csv(sweeps: Sequence[Sweep]) -> str:
    """One row a run: its start, whether it is complete, and its indices, in full precision."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for index, found in enumerate(sweeps):
        quantities = _quantities(found)
        starts = [f"q{i + 1}(0) [rad]" for i in range(len(found.joints))]
        if index == 0:
            writer.writerow(
                ["gains", "run", "complete", *starts, *(csv_text(name) for name, _, _ in quantities)]
            )
        table = np.column_stack((found.q0, *(values for _, values, _ in quantities)))
        for number, (row, whole) in enumerate(zip(table.tolist(), found.runs.complete, strict=True), start=1):
            writer.writerow([csv_text(found.name), number, "yes" if whole else "no", *map(repr, row)])
    return text.getvalue()


RENDERERS: dict[str, Callable[[Sequence[Sweep]], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
