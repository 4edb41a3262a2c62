"""Everything a report says, computed: claims, gate, ε₀ and simulations of the gain sets asked for."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck._types import SEED, Progress, silent
from lyapcheck.errors import argument_error
from lyapcheck.files.reader import holds
from lyapcheck.report.compute import compute
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.document import render as pdf
from lyapcheck.report.findings import findings, own_findings
from lyapcheck.report.model import Report, Subject
from lyapcheck.report.notes import published_notes
from lyapcheck.report.page.shell import redirect
from lyapcheck.report.page.shell import render as page
from lyapcheck.temporary import pending, try_writing

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


# --- A report on disk: written beside its place first, then moved there.


FORMATS = ("html", "md", "json", "pdf")
USUAL = FORMATS[:3]


def render(report: Report, formats: Sequence[str] = USUAL, appendix: bool = False) -> dict[str, str | bytes]:
    """Every file of a report by its name; figures and certificates are shared by the formats.

    Args:
        report: what it says.
        formats: some of ``FORMATS``.
        appendix: whether the PDF goes on with claims, gate, runs and the experiment one by one.
    """
    files: dict[str, str | bytes] = {}
    answer = ReportAnswer(report)
    if "html" in formats:
        files["index.html"] = page(report)
        files |= {f"m{m}.html": redirect(m) for m in report.ms}
    if "md" in formats:
        files["report.md"] = answer.written("markdown")
    if "json" in formats:
        files["report.json"] = answer.written("json")
    if "pdf" in formats:
        files["report.pdf"] = pdf(report, appendix)
    if set(formats) & {"html", "md"}:
        files |= {f"figures/{name}": drawing for name, drawing in report.figures.items()}
    return {**files, **report.certificates}


def require_folder(option: str, folder: Path) -> None:
    """Refuse a folder that could not be written at the end, before the work is done.

    Raises:
        InputError: it is a file, or neither it nor its parents can be written.
    """
    if folder.exists() and not folder.is_dir():
        raise argument_error(option, folder, "is a file", "name a folder")
    nearest = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    try:
        try_writing(nearest)
    except OSError as error:
        rule = f"{nearest} cannot be written to ({error.strerror})"
        raise argument_error(option, folder, rule, "name a folder elsewhere") from error


def write(files: Mapping[str, str | bytes], folder: Path) -> None:
    """Put all files into a folder; what stands there already under other names stays.

    What is not there already word for word is written to a new folder first, so that a full disk leaves the
    old report whole.

    Raises:
        InputError: the file system refuses.
    """
    staged = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        encoded = {name: one if isinstance(one, bytes) else one.encode() for name, one in files.items()}
        fresh = {name: content for name, content in encoded.items() if not holds(folder / name, content)}
        staged = Path(tempfile.mkdtemp(dir=folder, prefix=".writing-"))
        with pending(staged):
            for name, content in fresh.items():
                (staged / name).parent.mkdir(parents=True, exist_ok=True)
                (staged / name).write_bytes(content)
            for name in fresh:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(staged / name, folder / name)
    except OSError as error:
        repair = "free some space or name another folder"
        raise argument_error("--out", folder, f"cannot be written ({error.strerror})", repair) from error
    finally:
        if staged is not None:
            shutil.rmtree(staged, ignore_errors=True)
