"""Everything a report says, computed: claims, gate, ε₀ and simulations of the gain sets asked for."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING

from lyapcheck._types import SEED, Progress, silent
from lyapcheck.report.compute import compute
from lyapcheck.report.findings import findings, own_findings
from lyapcheck.report.model import Data, Report
from lyapcheck.report.notes import published_notes
from lyapcheck.report.subject import Subject

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

PACKAGES = ("lyapcheck", "sympy", "casadi", "cvxpy", "clarabel", "numpy", "scipy", "python-flint")


def build(subject: Subject, on_progress: Progress | None = None) -> Report:
    """Compute a report.

    Args:
        subject: arm, members and gains.
        on_progress: receives the fraction done and a few words.

    Raises:
        InputError: the arm cannot be read, or gains do not fit it.

    Soundness: every verdict is the one of the command of the same name.
    """
    from lyapcheck.robots import load

    model, notes = load(subject.robot), published_notes()
    gate = tuple(_gate(subject))
    result = compute(subject, notes, gate, on_progress or silent)
    if subject.own:
        weighed = own_findings(gate, result.epsilon, result.claims)
    else:
        weighed = findings(notes, result.claims, result.small, result.epsilon, result.sensitivity)
    return Report(
        notes=notes,
        own=subject.own,
        robot=_robot(model),
        ms=subject.ms,
        table=tuple(_table(subject.ms)),
        gate=gate,
        epsilon=result.epsilon,
        claims=result.claims,
        others=result.others,
        runs=result.runs,
        sensitivity=result.sensitivity,
        findings=weighed,
        bench=_bench(subject, model, result.cells),
        figures=dict(sorted(result.figures.items())),
        certificates=dict(sorted(result.certificates.items())),
        versions={name: version(name) for name in PACKAGES},
        seed=SEED,
    )


def _bench(subject: Subject, model: RobotModel, cells: Sequence[Data]) -> Data:
    from lyapcheck.report.bench import bench
    from lyapcheck.report.jobs import goal_of

    return bench(model, tuple(subject.of_family.values()), goal_of(model), cells)


def _gate(subject: Subject) -> list[Data]:
    from lyapcheck.answers.gate import gate

    result = [gate(file, subject.robot).data() for file in subject.gain_files]
    rows = [row for data in result for row in data["results"] if row["m"] is None or row["m"] in subject.ms]
    return [{**row, "file": row["file"].rsplit("/", 1)[-1]} for row in rows]


def _table(ms: Sequence[int]) -> list[Data]:
    from lyapcheck.answers.table import build_table

    rows: list[Data] = build_table(ms).data()["rows"]
    return rows


def _robot(model: RobotModel) -> Data:
    return {
        "name": model.name,
        "title": model.title,
        "joints": list(model.joints),
        "numbers": [
            {"name": name, "value": str(number.value), "unit": number.unit, "source": number.source}
            for name, number in model.numbers.items()
        ],
        "assumptions": list(model.assumptions),
    }
