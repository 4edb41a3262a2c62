"""A report on disk: written beside its place first, then moved there."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from lyapcheck.errors import argument_error
from lyapcheck.files.reader import holds
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.model import Report
from lyapcheck.report.page.shell import redirect
from lyapcheck.report.page.shell import render as page
from lyapcheck.report.pdf import render as pdf
from lyapcheck.temporary import pending, try_writing

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
