"""Everything a report says, computed: claims, gate, ε₀ and simulations of the gain sets asked for."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import version
from typing import TYPE_CHECKING

from lyapcheck._types import SEED, Progress, silent
from lyapcheck.report.compute import compute
from lyapcheck.report.findings import findings, own_findings
from lyapcheck.report.model import Report
from lyapcheck.report.notes import published_notes
from lyapcheck.report.subject import Subject

if TYPE_CHECKING:
    from lyapcheck.answers.gate import GateAnswer


def build(subject: Subject, on_progress: Progress | None = None) -> Report:
    """Compute a report.

    Args:
        subject: arm, members and gains.
        on_progress: receives the fraction done and a few words.

    Raises:
        InputError: the arm cannot be read, or gains do not fit it.

    Soundness: every verdict is the one of the command of the same name.
    """
    from lyapcheck.answers.table import build_table
    from lyapcheck.robots import load

    model, notes = load(subject.robot), published_notes()
    gate = _gate(subject)
    result = compute(subject, notes, gate, on_progress or silent)
    if subject.own:
        weighed = own_findings(gate, result.epsilon, result.claims)
    else:
        weighed = findings(notes, result.claims, result.small, result.epsilon, result.sensitivity)
    return Report(
        notes=notes,
        own=subject.own,
        robot=model,
        ms=subject.ms,
        table=build_table(subject.ms),
        derived=result.derived,
        gate=gate,
        epsilon=result.epsilon,
        claims=result.claims,
        others=result.others,
        runs=result.runs,
        sensitivity=result.sensitivity,
        findings=weighed,
        map=result.cells,
        figures=dict(sorted(result.figures.items())),
        certificates=dict(sorted(result.certificates.items())),
        versions={name: version(name) for name in result.packages},
        seed=SEED,
    )


def _gate(subject: Subject) -> GateAnswer:
    """What the gate says of the gain sets that the report is about, with the names of their files alone."""
    from lyapcheck.answers.gate import GateAnswer, gate

    results = [result for file in subject.gain_files for result in gate(file, subject.robot)]
    return GateAnswer(
        replace(result, file=replace(result.file, path=result.file.path.rsplit("/", 1)[-1]))
        for result in results
        if result.m is None or result.m in subject.ms
    )
