"""Everything a report says, computed: claims, gate, ε₀ and simulations of the gain sets asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from importlib.metadata import version
from multiprocessing import get_context
from typing import TYPE_CHECKING, Any

from lyapcheck.report.drawings import draw
from lyapcheck.report.findings import findings
from lyapcheck.report.jobs import GainData, claims_job, gains_job
from lyapcheck.report.model import Data, Report

if TYPE_CHECKING:
    from lyapcheck.control import GainFile
    from lyapcheck.robots import RobotModel

Progress = Callable[[float, str], None]

SEED = 20190301
PROOF = "published.py"
INSTEAD = ("scalar.py", "tracking.py")
"""Proofs of what the paper concludes, that do not rest on what is refuted."""
WORKERS = 2
PACKAGES = ("lyapcheck", "sympy", "casadi", "cvxpy", "clarabel", "numpy", "scipy", "python-flint")
EQUATIONS = ("V12", "V13", "rate", "Q", "X", "Y", "S")


@dataclass(frozen=True)
class Subject:
    """What a report is about.

    Args:
        robot: name or file of the arm, as ``lyapcheck.robots.load`` takes it.
        ms: the members of the family.
        gain_files: the gains; sets of other members are left out, those without a member (PD) stay.
    """

    robot: str
    ms: tuple[int, ...]
    gain_files: tuple[GainFile, ...]

    @property
    def sets(self) -> list[tuple[GainFile, str]]:
        """The gain sets that belong in the report, each with its file."""
        return [
            (file, item.name)
            for file in self.gain_files
            for item in file.gains
            if item.m is None or item.m in self.ms
        ]


def build(subject: Subject, on_progress: Progress | None = None) -> Report:
    """Compute a report.

    Args:
        subject: arm, members and gains.
        on_progress: told the fraction done and a few words.

    Raises:
        InputError: the arm cannot be read, or gains do not fit it.

    Soundness: every verdict is the one of the command of the same name.
    """
    from lyapcheck.robots import load

    model = load(subject.robot)
    claims, instead, parts = _compute(subject, on_progress or (lambda fraction, note: None))
    epsilon = tuple(part.epsilon for part in parts)
    runs = tuple(part.run.facts for part in parts)
    gate = tuple(_gate(subject))
    table = tuple(_table(subject.ms))
    return Report(
        robot=_robot(model),
        ms=subject.ms,
        table=table,
        equations=_equations(),
        gate=gate,
        epsilon=epsilon,
        claims=claims,
        instead=instead,
        runs=runs,
        findings=findings(claims, gate, epsilon, runs),
        figures=draw(subject.ms, claims, epsilon, [part.run for part in parts]),
        versions={name: version(name) for name in PACKAGES},
        seed=SEED,
    )


def _compute(subject: Subject, tell: Progress) -> tuple[tuple[Data, ...], tuple[Data, ...], list[GainData]]:
    """The long computations, a process for each core: each gain set, then the claims of each proof by m."""
    # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
    with ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool:
        sets: list[tuple[str, Future[Any]]] = [
            (name, pool.submit(gains_job, file.path, name, subject.robot, SEED))
            for file, name in subject.sets
        ]
        gains_of = subject.gain_files[0].path
        proofs: list[tuple[str, Future[Any]]] = [
            (f"{proof} for m = {m}", pool.submit(claims_job, proof, m, subject.robot, gains_of))
            for proof in (PROOF, *INSTEAD)
            for m in subject.ms
        ]
        _watch({job: label for label, job in sets} | {job: label for label, job in proofs}, tell)
        parts = [job.result() for _, job in sets]
        decided = [job.result() for _, job in proofs]
    count = len(subject.ms)
    published = [row for rows in decided[:count] for row in rows]
    instead = [row for rows in decided[count:] for row in conclusions(rows)]
    return _merged(published), tuple(instead), parts


def conclusions(rows: Sequence[Data]) -> list[Data]:
    """The claims of a proof that no other claim of it uses."""
    used = {name for row in rows for name in row["uses"]}
    return [row for row in rows if row["id"] not in used]


def _watch(labels: dict[Future[Any], str], tell: Progress) -> None:
    """Say when each job is done; the first that fails stops the others."""
    tell(0.0, f"{len(labels)} computations on {WORKERS} processes")
    try:
        for done, job in enumerate(as_completed(labels), start=1):
            job.result()
            tell(done / len(labels), f"{labels[job]} done")
    except BaseException:
        for job in labels:
            job.cancel()
        raise


def _merged(rows: Sequence[Data]) -> tuple[Data, ...]:
    """The rows of all m in the order of the text; a claim without m only once."""
    order = {row["id"]: place for place, row in reversed(list(enumerate(rows)))}
    seen = {(row["id"], row["m"]): row for row in reversed(rows)}
    return tuple(sorted(seen.values(), key=lambda row: (order[row["id"]], row["m"] or 0)))


def _gate(subject: Subject) -> list[Data]:
    from lyapcheck.control.gate import gate
    from lyapcheck.control.gate_formats.json import result_json

    results = [result for file in subject.gain_files for result in gate(file, subject.robot)]
    kept = [item for item in results if item.m is None or item.m in subject.ms]
    return [{**result_json(item), "file": item.file.path.rsplit("/", 1)[-1]} for item in kept]


def _table(ms: Sequence[int]) -> list[Data]:
    import json

    from lyapcheck.family.table import build_table
    from lyapcheck.family.table_formats import renderer

    rows: list[Data] = json.loads(renderer("json")(build_table(ms)))["rows"]
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


def _equations() -> dict[str, str]:
    from lyapcheck.lyapunov.latex import latex_forms

    forms = latex_forms()
    return {name: forms[name] for name in EQUATIONS}
