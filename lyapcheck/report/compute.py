"""The long computations of a report, spread over processes, and the figures drawn while they run."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lyapcheck._types import SEED, Progress
from lyapcheck.report.drawings import draw_claims, draw_comparisons, draw_family, draw_sensitivity, draw_set
from lyapcheck.report.experiment import printed_experiment
from lyapcheck.report.jobs import claims_job, gains_job
from lyapcheck.report.model import Data
from lyapcheck.robots import load
from lyapcheck.temporary import pending

if TYPE_CHECKING:
    from lyapcheck.report.build import Subject
    from lyapcheck.report.figures.plot import Files

Job = Future[Any]

PROOF = "published.py"
INSTEAD = ("scalar.py", "tracking.py")
"""Proofs of what the paper concludes, that do not rest on what is refuted."""
WORKERS = 2


@dataclass(frozen=True)
class Computed:
    """What the long computations hand back, with their figures."""

    claims: tuple[Data, ...]
    instead: tuple[Data, ...]
    epsilon: tuple[Data, ...]
    runs: tuple[Data, ...]
    sensitivity: Data | None
    figures: Files


def compute(subject: Subject, tell: Progress) -> Computed:
    """The long computations, a process for each core; what can be drawn of one is drawn when it is done.

    Args:
        subject: arm, members and gains.
        tell: told the fraction done and a few words.
    """
    # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
    pool_of = partial(ProcessPoolExecutor, WORKERS, get_context("spawn"), _work_in)
    with TemporaryDirectory(prefix="lyapcheck-") as place, pending(place), pool_of((place,)) as pool:
        jobs = _submit(subject, pool)
        figures = draw_family(subject.ms) | _drawn(jobs, tell)
    of_the_report = (one for file in subject.gain_files for one in file.gains if one.m in (None, *subject.ms))
    study = printed_experiment(of_the_report, load(subject.robot))
    parts = [job.result() for job in jobs.sets]
    epsilon, runs = tuple(part.epsilon for part in parts), tuple(part.run.facts for part in parts)
    return Computed(
        claims=_merged([row for job in jobs.published for row in job.result()]),
        instead=tuple(row for job in jobs.instead for row in conclusions(job.result())),
        epsilon=epsilon,
        runs=runs,
        sensitivity=study,
        figures=figures | draw_sensitivity(study) | draw_comparisons(epsilon, runs, study),
    )


def _work_in(place: str) -> None:
    """Put the temporary files of this process where who started it can remove them."""
    tempfile.tempdir = place


@dataclass(frozen=True)
class Jobs:
    """What was handed to the processes, each in the order of the report.

    Args:
        sets: ε₀ and simulation of each gain set.
        published: the claims of the paper for each m.
        instead: those of the other proofs.
        labels: of each job, for who waits.
        drawings: of each job, what makes its figures out of its result.
    """

    sets: list[Job]
    published: list[Job]
    instead: list[Job]
    labels: dict[Job, str]
    drawings: dict[Job, Callable[[Any], Files]]


def _submit(subject: Subject, pool: ProcessPoolExecutor) -> Jobs:
    """The longest first, so that no process is left with one at the end."""
    labels: dict[Job, str] = {}

    def start(label: str, work: Callable[..., Any], *arguments: Any) -> Job:
        job = pool.submit(work, *arguments)
        labels[job] = label
        return job

    def claims(proof: str, m: int) -> Job:
        return start(f"{proof} for m = {m}", claims_job, proof, m, subject.robot, subject.gain_files[0].path)

    named = [(file.path, name) for file, name in subject.sets]
    sets = [start(name, gains_job, path, name, subject.robot, SEED) for path, name in named]
    published = [claims(PROOF, m) for m in subject.ms]
    instead = [claims(proof, m) for proof in INSTEAD for m in subject.ms]
    drawings: dict[Job, Callable[[Any], Files]] = dict.fromkeys(sets, draw_set)
    drawings |= {job: partial(draw_claims, m) for m, job in zip(subject.ms, published, strict=True)}
    return Jobs(sets, published, instead, labels, drawings)


def _drawn(jobs: Jobs, tell: Progress) -> Files:
    """The figures of all jobs, each drawn when it is done; the first that fails stops the others."""
    figures: Files = {}
    tell(0.0, f"{len(jobs.labels)} computations on {WORKERS} processes")
    try:
        for done, job in enumerate(as_completed(jobs.labels), start=1):
            result = job.result()
            tell(done / len(jobs.labels), f"{jobs.labels[job]} done")
            if job in jobs.drawings:
                figures |= jobs.drawings[job](result)
    except BaseException:
        for job in jobs.labels:
            job.cancel()
        raise
    return figures


def conclusions(rows: Sequence[Data]) -> list[Data]:
    """The claims of a proof that no other claim of it uses."""
    used = {name for row in rows for name in row["uses"]}
    return [row for row in rows if row["id"] not in used]


def _merged(rows: Sequence[Data]) -> tuple[Data, ...]:
    """The rows of all m in the order of the text; a claim without m only once."""
    order = {row["id"]: place for place, row in reversed(list(enumerate(rows)))}
    seen = {(row["id"], row["m"]): row for row in reversed(rows)}
    return tuple(sorted(seen.values(), key=lambda row: (order[row["id"]], row["m"] or 0)))
