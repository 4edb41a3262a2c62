"""Writing an answer to standard output, and to the summary of a GitHub job."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from typing import Any

from lyapcheck.errors import InputError, Problem
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Section

SUMMARY = "GITHUB_STEP_SUMMARY"
"""The variable by which GitHub names the file that it shows under a job."""
LARGEST_SUMMARY = 1_000_000
"""Bytes; GitHub refuses more than a mebibyte."""


def show(answer: Answer, format: str) -> None:  # noqa: A002
    """An answer in a format; in colour where a terminal shows it and ``NO_COLOR`` is not set.

    Annotations for GitHub are not the whole answer: that goes to the job's summary, if there is one.
    A fault in the wording does not cost what was computed: the data are written, and the fault is raised.

    Raises:
        InputError: the summary cannot be written.
    """
    colour = sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    try:
        text = answer.written(format, colour)
    except Exception:
        sys.stdout.write(_bare(answer))
        sys.stdout.flush()
        raise
    sys.stdout.write(text)
    if format == "github" and os.environ.get(SUMMARY):
        _append_summary(os.environ[SUMMARY], answer.document())


def _bare(answer: Answer) -> str:
    """The data of an answer as JSON, whatever is in them."""
    try:
        data: Any = answer.data()
    except Exception:
        data = getattr(answer, "__dict__", None) or list(answer)  # type: ignore[call-overload]
    return json.dumps({"schema": answer.schema, "data": data}, indent=2, default=str, skipkeys=True) + "\n"


def _append_summary(path: str, document: Document) -> None:
    """Add a document to a file; of one that is too large the sections that did not pass, as many as fit."""
    from lyapcheck.output.markdown import render

    text = render(document)
    if len(text.encode()) > LARGEST_SUMMARY:
        sections = [block for block in document.blocks if isinstance(block, Section)]
        others = [section for section in sections if not section.title.startswith("✓")]
        size = len(render(replace(document, blocks=tuple(others))).encode())
        shown = others[: max(1, len(others) * LARGEST_SUMMARY // max(size, LARGEST_SUMMARY))]
        title = f"{document.title}; {len(shown)} of {len(others)} that did not pass are shown"
        text = render(Document(title, tuple(shown), document.notes))
    try:
        with open(path, "a", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise InputError(
            Problem("environment", None, SUMMARY, path, f"cannot be written ({error.strerror})", "unset it")
        ) from error
