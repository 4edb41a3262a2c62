"""What tracking runs found, as text or Markdown: pure functions of runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from lyapcheck.output.escapes import markdown_text
from lyapcheck.simulate.render import broken, bullets, cell, in_columns, section
from lyapcheck.tracking.run import TrackingRun

LEGEND = (
    "promised: certified at the arm's nominal numbers, for every time and every motion from this start; "
    "seen: one run in floating point."
)


def as_text(runs: Sequence[TrackingRun]) -> str:
    """For each run a headline, its facts and a row a joint; then what is assumed."""
    return "\n\n".join([*map(_block, runs), "\n".join([LEGEND, *bullets(_shared_notes(runs))])]) + "\n"


def as_markdown(runs: Sequence[TrackingRun]) -> str:
    """The same as Markdown."""
    legend, notes = markdown_text(LEGEND), bullets(_shared_notes(runs), markdown_text)
    return "\n\n".join([*map(_section, runs), legend, "\n".join(notes)]).rstrip() + "\n"


def _block(run: TrackingRun) -> str:
    return "\n  ".join([_headline(run), *_facts(run), *in_columns([_heads(run), *_rows(run)])])


def _section(run: TrackingRun) -> str:
    return section(_headline(run), _facts(run), _heads(run), _rows(run), words=1)


def _headline(run: TrackingRun) -> str:
    member = "" if run.gains.family.m is None else f" (m = {run.gains.family.m})"
    start = ", ".join(f"{x:g}" for x in np.round(np.degrees(run.motion.q[0]), 9))
    cut = "" if run.complete else f", CUT SHORT at {run.motion.t[-1]:.4g} s"
    return f"{run.name}{member} on {run.robot}, tracking (21) from ({start})° in {run.T:g} s{cut}"


def _facts(run: TrackingRun) -> list[str]:
    speed = up(run.promise.suprema.speed)
    return [
        f"reference: {run.reference.sentence}",
        f"‖q̇_d‖ promised at most v_d = {speed} rad/s, seen {run.seen_speed:.4g}",
        *_promised(run),
        f"L2 {cell(run.indices.L2, '.4f')}°, {_accuracy(run)}work balance {run.work_balance:.0e}",
        *broken(run.breach),
    ]


def _promised(run: TrackingRun) -> list[str]:
    promise = run.promise
    if run.bound is None:
        return [f"no bound of dV/dt or of the torque: {promise.reason}; V with ε₀ = {promise.eps0:g}"]
    admissible = promise.reason or f"Θ' is positive definite up to ε₀ = {float(promise.largest or 0):.4g}"
    kept = run.breach is None or not run.breach.promise.startswith("dV/dt")
    falls = "V must fall" if promise.falls else "V need not fall"
    share = "" if math.isnan(run.tightness) else f"; at most {run.tightness:.1%} of the fall was promised"
    lines = [
        f"ε₀ = {promise.eps0:.4g}: {falls} ({admissible}), V(0) = {run.V[0]:.5g} J, end {run.V[-1]:.3g} J",
        f"dV/dt ≤ −zᵀΘ'z {'at all' if kept else 'NOT at all'} {run.motion.t.size} samples{share}",
    ]
    if promise.torque is not None:
        seen = float(np.max(np.linalg.norm(run.motion.w, axis=1)))
        lines.append(f"‖q̇ − q̇_d‖ promised at most {up(promise.torque.error_rate)} rad/s, seen {seen:.4g}")
    return lines


def _accuracy(run: TrackingRun) -> str:
    if math.isnan(run.accuracy):
        return "accuracy unknown: the run was cut short, "
    return f"accuracy {run.accuracy:.0e} (rad, rad/s) by a second, tighter run, "


def _heads(run: TrackingRun) -> tuple[str, ...]:
    within = f"within {math.degrees(run.band):g}° from [s]"
    heads = ("joint", "rms [°]", "peak error [°]", within, "final error [°]", "peak torque [N·m]")
    return (*heads, "promised [N·m]", "limit [N·m]", "")


def _rows(run: TrackingRun) -> list[tuple[str, ...]]:
    found, torque = run.indices, run.promise.torque
    rows = []
    for i, joint in enumerate(run.joints):
        numbers = (found.rms[i], found.peak_error[i], found.entered[i], found.final_error[i])
        forms = ("z.4f", "z.3f", "z.3f", "z.4f")
        promised = "—" if torque is None else up(torque.total[i])
        limit = run.torque_limit[i]
        cells = [cell(float(x), form) for x, form in zip(numbers, forms, strict=True)]
        torques = [cell(float(found.peak_torque[i]), "z.2f"), promised, cell(limit, "g")]
        rows.append((joint, *cells, *torques, _inside(run, i)))
    return rows


def _inside(run: TrackingRun, i: int) -> str:
    """How a joint stands with its motor's limit."""
    limit, torque = run.torque_limit[i], run.promise.torque
    if limit is None:
        return ""
    if run.indices.peak_torque[i] > limit:
        return "BEYOND LIMIT"
    return "promised inside" if torque is not None and torque.total[i] <= limit else "seen inside"


def up(value: Fraction) -> str:
    """A bound in four digits, never rounded down."""
    if value <= 0:
        return "0"
    scale = Fraction(10) ** (3 - math.floor(math.log10(value)))
    return f"{float(math.ceil(value * scale) / scale):.4g}"


def _shared_notes(runs: Sequence[TrackingRun]) -> list[str]:
    return list(dict.fromkeys(note for run in runs for note in run.notes))
