"""A command run in this process."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass

from lyapcheck.cli.main import run
from lyapcheck.errors import InputError


@dataclass(frozen=True)
class Done:
    """What a command left: its exit code, what it wrote, and the refusal of its input if there was one."""

    exit_code: int
    stdout: str
    stderr: str
    exception: InputError | None = None

    @property
    def output(self) -> str:
        """Both streams."""
        return self.stdout + self.stderr


def invoke(*words: str) -> Done:
    """Run ``lyapcheck`` with some words."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code, refusal = run(words), None
        except InputError as error:
            code, refusal = 2, error
    return Done(int(code), out.getvalue(), err.getvalue(), refusal)
