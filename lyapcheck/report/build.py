"""A report: computed in processes, the figures drawn while they run; then written to disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lyapcheck._types import SEED, Progress, silent
from lyapcheck.computing import main_unnamed, pool
from lyapcheck.errors import argument_error
from lyapcheck.files.reader import holds
from lyapcheck.process_tree import pending, temporary_folder
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.findings import as_the_gate_judges, findings, own_findings
from lyapcheck.report.jobs import (
    TURNS,
    Done,
    GainData,
    derive_job,
    done,
    gains_job,
    own_proofs_job,
    proofs_job,
)
from lyapcheck.report.model import Report, Subject, published_notes
from lyapcheck.report.page import render as page
from lyapcheck.report.pdf import render as pdf
from lyapcheck.report.plots import draw_epsilon, draw_family, draw_set
from lyapcheck.report.tiles import drawn_motions, tiles

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.model import Notes
    from lyapcheck.report.plots import Files

Job = Future[Done]
WORKERS = 2


def build(subject: Subject, on_progress: Progress | None = None) -> Report:
    """Compute a report.

    Raises:
        InputError: the arm cannot be read, or gains do not fit it.

    Soundness: every verdict is the one of the command of the same name.
    """
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.answers.table import build_table
    from lyapcheck.robots import load

    model, notes, judged = load(subject.robot), published_notes(), _judged(subject)
    # the page has the names of gain files alone; the commands of the tiles find the files themselves
    names = {one.file.path: replace(one.file, path=one.file.path.rsplit("/", 1)[-1]) for one in judged}
    gate = GateAnswer(replace(one, file=names[one.file.path]) for one in judged)
    with temporary_folder() as place, pool(WORKERS, place) as workers:
        with main_unnamed():
            jobs = _submit(subject, notes, workers)
        figures = draw_family(subject.ms) | _drawn(jobs, on_progress or silent)
    (proofs, by_size), *rest = (job.result().result for job in jobs)
    count = len(subject.sets)
    parts, derived = rest[:count], rest[count]
    proofs += [one for found, _ in rest[count + 1 :] for one in found]
    epsilon, runs = tuple(part.epsilon for part in parts), tuple(part.row for part in parts)
    certificates: dict[str, str] = {}
    for made in [*(made for _, made in proofs), *(part.certificates for part in parts)]:
        certificates |= made
    rows = [row for some, _ in proofs for row in some]
    if subject.own:
        known = {row.certificate for row in rows}
        rows, fresh = as_the_gate_judges(rows, gate)
        gone = known - {row.certificate for row in rows}
        certificates = {path: text for path, text in certificates.items() if path not in gone} | fresh
    figures |= draw_epsilon(epsilon)
    claims = tuple(row for row in rows if row.proof == "published")
    weighed = own_findings(gate, epsilon, claims) if subject.own else findings(notes, claims, epsilon)
    run_of = {row.name: row for row in runs}
    packages = frozenset[str]().union(*(job.result().packages for job in jobs))
    return Report(
        notes=notes,
        own=subject.own,
        robot=model,
        ms=subject.ms,
        table=build_table(subject.ms),
        derived=derived,
        gate=gate,
        epsilon=epsilon,
        claims=claims,
        others=tuple(row for row in rows if row.proof != "published"),
        by_size=by_size,
        runs=runs,
        findings=weighed,
        figures=dict(sorted(figures.items())),
        certificates=dict(sorted(certificates.items())),
        versions={name: version(name) for name in sorted(packages)},
        seed=SEED,
        tiles={one.name: tiles(one, model, run_of.get(one.name)) for one in judged if subject.own},
        motions={
            part.row.name: drawn_motions(model, part.run.t, part.run.q) for part in parts if subject.own
        },
    )


def _judged(subject: Subject) -> list[GateResult]:
    """What the gate says of the gain sets that the report is about."""
    from lyapcheck.answers.gate import gate

    results = [result for file in subject.gain_files for result in gate(file, subject.robot)]
    return [result for result in results if result.m is None or result.m in subject.ms]


def _submit(subject: Subject, notes: Notes, workers: ProcessPoolExecutor) -> dict[Job, str]:
    """The claims, ε₀ and run of each gain set, and what SymPy derives; each with its name for who waits."""
    labels: dict[Job, str] = {}

    def start(label: str, work: Callable[..., Any], *arguments: Any) -> None:
        labels[workers.submit(done, work, *arguments)] = label

    about = (subject.ms, subject.robot, subject.gain_files[0].path)
    if subject.own:
        start("claims", own_proofs_job, *about, notes)
    else:
        start("claims", proofs_job, TURNS[0], *about)
    for file, name in subject.sets:
        start(name, gains_job, file.path, name, subject.robot, SEED)
    start("derivation", derive_job, subject.ms, subject.robot)
    # last, as they take from the store what the first has found
    for proofs in () if subject.own else TURNS[1:]:
        start(f"claims of {', '.join(proofs)}", proofs_job, proofs, *about)
    return labels


def _drawn(jobs: Mapping[Job, str], progress: Progress) -> Files:
    """The figures of all jobs, each drawn when it is done; the first that fails stops the others."""
    figures: Files = {}
    progress(0.0, f"{len(jobs)} computations on {WORKERS} processes")
    try:
        for done, job in enumerate(as_completed(jobs), start=1):
            result = job.result().result
            progress(done / len(jobs), f"{jobs[job]} done")
            if isinstance(result, GainData):
                figures |= draw_set(result)
    except BaseException:
        for job in jobs:
            job.cancel()
        raise
    return figures


# --- A report on disk: written beside its place first, then moved there.


FORMATS = ("html", "md", "json", "pdf")
USUAL = FORMATS[:3]


def render(report: Report, formats: Sequence[str] = USUAL, appendix: bool = False) -> dict[str, str | bytes]:
    """Every file of a report by its name; figures and certificates are shared by the formats.

    Args:
        appendix: whether the PDF goes on with claims, gate and runs one by one.
    """
    files: dict[str, str | bytes] = {}
    answer = ReportAnswer(report)
    if "html" in formats:
        files["index.html"] = page(report)
    if "md" in formats:
        files["report.md"] = answer.written("markdown")
    if "json" in formats:
        files["report.json"] = answer.written("json")
    if "pdf" in formats:
        files["report.pdf"] = pdf(report, appendix)
    if set(formats) & {"html", "md"}:
        files |= {f"figures/{name}": drawing for name, drawing in report.figures.items()}
    return {**files, **report.certificates}


def write(files: Mapping[str, str | bytes], folder: Path) -> None:
    """Put all files into a folder; what stands there already under other names stays.

    What is not there already word for word is written to a new folder first, so that a full disk leaves the
    old report whole.

    Raises:
        InputError: the file system refuses.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        encoded = {name: one if isinstance(one, bytes) else one.encode() for name, one in files.items()}
        fresh = {name: content for name, content in encoded.items() if not holds(folder / name, content)}
        with TemporaryDirectory(dir=folder, prefix=".writing-") as place, pending(place):
            staged = Path(place)
            for name, content in fresh.items():
                (staged / name).parent.mkdir(parents=True, exist_ok=True)
                (staged / name).write_bytes(content)
            for name in fresh:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(staged / name, folder / name)
    except OSError as error:
        repair = "free some space or name another folder"
        raise argument_error("--out", folder, f"cannot be written ({error.strerror})", repair) from error
