"""The long computations of a report, spread over processes, and the figures drawn while they run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lyapcheck._types import SEED, Progress
from lyapcheck.answers.derive import Derivation
from lyapcheck.computing import main_unnamed
from lyapcheck.report.at_hand import as_the_gate_judges
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.drawings import (
    draw_comparisons,
    draw_damping,
    draw_family,
    draw_sensitivity,
    draw_set,
    draw_sides,
)
from lyapcheck.report.experiment import printed_experiment
from lyapcheck.report.findings import light, small_path
from lyapcheck.report.gain_rows import EpsilonRow, RunRow
from lyapcheck.report.jobs import Done, derive_job, done, gains_job, map_job, proofs_job, with_the_map
from lyapcheck.report.model import MapCell, WitnessRow
from lyapcheck.report.study import StudyRow
from lyapcheck.robots import load
from lyapcheck.temporary import pending, work_in

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.figures.style import Files
    from lyapcheck.report.jobs import MapData, ProofsData
    from lyapcheck.report.model import Subject
    from lyapcheck.report.notes import Notes


# --- What the long computations of a report hand back.


@dataclass(frozen=True)
class Computed:
    """Rows, figures by file name, certificates by their paths, and the packages that were loaded for it."""

    claims: tuple[ClaimRow, ...]
    others: tuple[ClaimRow, ...]
    small: Mapping[str, WitnessRow]
    epsilon: tuple[EpsilonRow, ...]
    runs: tuple[RunRow, ...]
    sensitivity: StudyRow | None
    derived: Derivation
    cells: tuple[MapCell, ...]
    figures: Mapping[str, str | bytes]
    certificates: Mapping[str, str]
    packages: tuple[str, ...]


Job = Future[Done]

WORKERS = 2


def compute(subject: Subject, notes: Notes, gate: Sequence[GateResult], progress: Progress) -> Computed:
    """The long computations: a process for each core; what can be drawn of one is drawn when it is done.

    Args:
        subject: arm, members and gains.
        notes: on the paper.
        gate: the gate's results, for a figure.
        progress: receives the fraction done and a few words.
    """
    # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
    pool_of = partial(ProcessPoolExecutor, WORKERS, get_context("spawn"), work_in)
    with TemporaryDirectory(prefix="lyapcheck-") as place, pending(place), pool_of((place,)) as pool:
        with main_unnamed():
            jobs = _submit(subject, notes, pool)
        figures = draw_family(subject.ms) | draw_damping(gate) | _drawn(jobs, progress)
    of_the_report = (one for file in subject.gain_files for one in file.gains if one.m in (None, *subject.ms))
    study = None if subject.own else printed_experiment(of_the_report, load(subject.robot))
    mapped: MapData = jobs.map.result().result
    parts = [with_the_map(job.result().result, mapped.for_sets) for job in jobs.sets]
    proofs: ProofsData = jobs.proofs.result().result
    epsilon, runs = tuple(part.epsilon for part in parts), tuple(part.row for part in parts)
    certificates: dict[str, str] = {}
    for made in [*(one.certificates for one in proofs.proofs), *(part.certificates for part in parts)]:
        certificates |= made
    certificates |= {small_path(name): one.certificate.text() for name, one in proofs.small.items()}
    certificates |= {one.cell.path: one.certificate for one in mapped.cells if one.certificate}
    rows = [row for part in proofs.proofs for row in part.rows]
    if subject.own:
        known = {row.certificate for row in rows}
        rows, fresh = as_the_gate_judges(rows, gate)
        gone = known - {row.certificate for row in rows}
        certificates = {path: text for path, text in certificates.items() if path not in gone} | fresh
    figures |= draw_sides(proofs.small) | draw_sensitivity(study) | draw_comparisons(epsilon, runs, study)
    return Computed(
        claims=tuple(row for row in rows if row.proof == "published"),
        others=tuple(row for row in rows if row.proof != "published"),
        small={name: light(one) for name, one in proofs.small.items()},
        epsilon=epsilon,
        runs=runs,
        sensitivity=study,
        derived=jobs.derived.result().result,
        cells=tuple(one.cell for one in mapped.cells),
        figures=figures,
        certificates=certificates,
        packages=tuple(sorted(frozenset[str]().union(*(job.result().packages for job in jobs.labels)))),
    )


@dataclass(frozen=True)
class Jobs:
    """What was handed to the processes, each in the order of the report.

    Args:
        sets: ε₀ and simulation of each gain set.
        proofs: the claims of the paper and of the other proofs, with small witnesses.
        derived: what SymPy derives.
        map: the map over m and k_v, computed where that is asked for.
        labels: of each job, for who waits.
        drawings: of each job, what makes its figures out of its result.
    """

    sets: list[Job]
    proofs: Job
    derived: Job
    map: Job
    labels: dict[Job, str]
    drawings: dict[Job, Callable[[Any], Files]]


def _submit(subject: Subject, notes: Notes, pool: ProcessPoolExecutor) -> Jobs:
    """The longest first, so that no process is left with one at the end."""
    labels: dict[Job, str] = {}

    def start(label: str, work: Callable[..., Any], *arguments: Any) -> Job:
        job = pool.submit(done, work, *arguments)
        labels[job] = label
        return job

    about = (subject.ms, subject.robot, subject.gain_files[0].path)
    proofs = start("claims", proofs_job, *about, notes, subject.own)
    named = [(file.path, name) for file, name in subject.sets]
    sets = [start(name, gains_job, path, name, subject.robot, SEED) for path, name in named]
    derived = start("derivation", derive_job, subject.ms, subject.robot)
    cells = start("map", map_job, subject.robot, subject.of_family, subject.map)
    return Jobs(sets, proofs, derived, cells, labels, dict.fromkeys(sets, draw_set))


def _drawn(jobs: Jobs, progress: Progress) -> Files:
    """The figures of all jobs, each drawn when it is done; the first that fails stops the others."""
    figures: Files = {}
    progress(0.0, f"{len(jobs.labels)} computations on {WORKERS} processes")
    try:
        for done, job in enumerate(as_completed(jobs.labels), start=1):
            result = job.result().result
            progress(done / len(jobs.labels), f"{jobs.labels[job]} done")
            if job in jobs.drawings:
                figures |= jobs.drawings[job](result)
    except BaseException:
        for job in jobs.labels:
            job.cancel()
        raise
    return figures
