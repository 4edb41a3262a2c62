"""What a simulation found, as text, Markdown or JSON: pure functions of runs."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.markdown import markdown_table
from lyapcheck.output.escapes import markdown_text
from lyapcheck.simulate.breach import Breach
from lyapcheck.simulate.indices import SETTLING_BAND
from lyapcheck.simulate.printed import printed_for
from lyapcheck.simulate.run import Run

SCHEMA = "lyapcheck/simulate/1"
HEADS = (
    "joint",
    "settling [s]",
    "overshoot [%]",
    "final error [°]",
    "peak torque [N·m]",
    "bound [N·m]",
    "limit [N·m]",
    "",
)
LEGEND = f"Settled: within {100 * SETTLING_BAND:g} % of the step for good; — where that was not reached."


def as_text(runs: Sequence[Run]) -> str:
    """For each run a headline, its facts and a row a joint; then what is assumed."""
    return "\n\n".join([*map(_block, runs), "\n".join([LEGEND, *bullets(_shared_notes(runs))])]) + "\n"


def _block(run: Run) -> str:
    return "\n  ".join([_headline(run), *_facts(run), *in_columns([HEADS, *_rows(run)])])


def in_columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows of words, numbers and a word as lines with straight columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(_padded(row, widths)).rstrip() for row in rows]


def _padded(row: Sequence[str], widths: Sequence[int]) -> list[str]:
    """Words to the left, numbers to the right."""
    cells = [cell.rjust(width) for cell, width in zip(row, widths, strict=True)]
    return [row[0].ljust(widths[0]), *cells[1:-1], row[-1]]


def as_markdown(runs: Sequence[Run]) -> str:
    """The same as Markdown."""
    notes = bullets(_shared_notes(runs), markdown_text)
    return "\n\n".join([*map(_section, runs), LEGEND, "\n".join(notes)]).rstrip() + "\n"


def _section(run: Run) -> str:
    return section(_headline(run), _facts(run), HEADS, _rows(run), words=1)


def section(
    headline: str, facts: Sequence[str], heads: Sequence[str], rows: Sequence[Sequence[str]], words: int
) -> str:
    """A heading, a list of facts and a table in Markdown, see `markdown_table`."""
    head, items = f"## {markdown_text(headline)}", bullets(facts, markdown_text)
    return "\n".join([head, "", *items, "", *markdown_table(heads, rows, words)])


def bullets(sentences: Sequence[str], escape: Callable[[str], str] = str) -> list[str]:
    """The items of a list."""
    return [f"- {escape(sentence)}" for sentence in sentences]


def _headline(run: Run) -> str:
    member = "" if run.m is None else f" (m = {run.m})"
    start, goal = (", ".join(f"{math.degrees(x):g}" for x in ends) for ends in (run.task.q0, run.task.q_d))
    cut = "" if run.complete else f", CUT SHORT at {run.t[-1]:.4g} s"
    return f"{run.name}{member} on {run.robot}, {run.kind}: ({start})° to ({goal})° in {run.task.T:g} s{cut}"


def _facts(run: Run) -> list[str]:
    return [
        f"L2 {run.L2:.4f}°, V(0) = {run.V[0]:.5g} J, V {_fall(run)} (ε₀ = {run.eps0:g})",
        f"largest ‖τ‖ {run.promises.torque_norm:.4g} N·m, {_bound(run)}",
        _checks(run),
        *broken(run.breach),
        *_beside(run),
    ]


def broken(breach: Breach | None) -> list[str]:
    """A line on the promise that broke, if one did."""
    return [] if breach is None else [f"PROMISE BROKEN: {breach.sentence}"]


def _beside(run: Run) -> list[str]:
    """What the paper measured on its bench, where it ran the same."""
    paper = printed_for(run)
    if paper is None or not run.complete:
        return []
    error = ", ".join(f"{x:g}" for x in paper.final_error)
    when = "below 1.4" if paper.settling is None else ", ".join(f"{x:g}" for x in paper.settling)
    return [
        f"the paper measured: L2 {paper.L2:.4f}°, settling {when} s (band not printed), final error {error}°"
    ]


def _fall(run: Run) -> str:
    seen = run.promises
    return "never rose" if seen.V_rises_at is None else f"ROSE at t = {seen.V_rises_at:.4g} s"


def _bound(run: Run) -> str:
    seen = run.promises
    if seen.torque_bound is None:
        return "no bound (9): h is unbounded"
    return f"{'inside' if seen.inside_bound else 'BEYOND'} the bound (9) of {seen.torque_bound:.4g} N·m"


def _checks(run: Run) -> str:
    if math.isnan(run.accuracy):
        return "accuracy unknown: the run was cut short"
    accuracy = f"accuracy {run.accuracy:.0e} (rad, rad/s) by a second, tighter run"
    balance = "" if math.isnan(run.energy_balance) else f", energy balance {run.energy_balance:.0e}"
    return accuracy + balance


def _rows(run: Run) -> list[tuple[str, ...]]:
    found, bounds = run.indices, run.promises.joint_bounds
    return [
        (
            joint,
            cell(found.settling[i], "z.3f"),
            cell(found.overshoot[i], "z.2f"),
            cell(found.final_error[i], "z.4f"),
            cell(found.peak_torque[i], "z.2f"),
            cell(None if bounds is None else bounds[i], "z.2f"),
            cell(run.torque_limit[i], "g"),
            _WORDS[run.promises.inside_limits[i]],
        )
        for i, joint in enumerate(run.joints)
    ]


_WORDS = {True: "inside", False: "LIMIT REACHED", None: ""}


def cell(value: float | None, form: str) -> str:
    """A number in a form, a dash where there is none."""
    return "—" if value is None or math.isnan(value) else format(value, form)


def _shared_notes(runs: Sequence[Run]) -> list[str]:
    return list(dict.fromkeys(note for run in runs for note in run.notes))


def as_json(runs: Sequence[Run]) -> str:
    """Schema ``lyapcheck/simulate/1``: degrees, N·m, s, J; ``null`` where there is no number."""
    from importlib.metadata import version

    results = [result_json(run) for run in runs]
    data = {
        "schema": SCHEMA,
        "version": version("lyapcheck"),
        "results": results,
        "notes": _shared_notes(runs),
    }
    return json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def result_json(run: Run) -> dict[str, Any]:
    """One run as plain data: degrees, N·m, s, J; ``None`` where there is no number."""
    found, seen = run.indices, run.promises
    return {
        "name": run.name,
        "m": run.m,
        "robot": run.robot,
        "kind": run.kind,
        "complete": run.complete,
        "time": run.task.T,
        "reached": _plain(run.t[-1]),
        "start": _list(np.degrees(run.task.q0)),
        "target": _list(np.degrees(run.task.q_d)),
        "joints": list(run.joints),
        "L2": _plain(found.L2),
        "settling_band": SETTLING_BAND,
        "settling": _list(found.settling),
        "overshoot": _list(found.overshoot),
        "final_error": _list(found.final_error),
        "peak_torque": _list(found.peak_torque),
        "torque_limit": list(run.torque_limit),
        "inside_limits": list(seen.inside_limits),
        "joint_bounds": None if seen.joint_bounds is None else [_plain(x) for x in seen.joint_bounds],
        "torque_norm": _plain(seen.torque_norm),
        "torque_bound": None if seen.torque_bound is None else _plain(seen.torque_bound),
        "inside_bound": seen.inside_bound,
        "eps0": run.eps0,
        "V_start": _plain(run.V[0]),
        "V_end": _plain(run.V[-1]),
        "V_decreases": seen.V_decreases,
        "V_rises_at": seen.V_rises_at,
        "accuracy": _plain(run.accuracy),
        "energy_balance": _plain(run.energy_balance),
        "breach": None if run.breach is None else run.breach.data,
        "printed": _paper(run),
    }


def _paper(run: Run) -> dict[str, Any] | None:
    paper = printed_for(run)
    if paper is None:
        return None
    settling = None if paper.settling is None else list(paper.settling)
    return {"L2": paper.L2, "settling": settling, "final_error": list(paper.final_error)}


def _plain(value: float) -> float | None:
    """The number to nine digits, which is what the accuracy of a run supports; none for NaN."""
    return float(f"{value:.9g}") if math.isfinite(value) else None


def _list(values: NDArray[np.float64]) -> list[float | None]:
    return [_plain(float(x)) for x in values]


RENDERERS: dict[str, Callable[[Sequence[Run]], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
