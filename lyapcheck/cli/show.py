"""Writing an answer to standard output."""

from __future__ import annotations

import os
import sys

from lyapcheck.output.answer import Answer


def show(answer: Answer, format: str) -> None:  # noqa: A002
    """An answer in a format; in colour where a terminal shows it and ``NO_COLOR`` is not set."""
    colour = sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    sys.stdout.write(answer.written(format, colour))
