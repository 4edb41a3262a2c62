"""A command run in this process."""

from __future__ import annotations

import io
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from subprocess import CompletedProcess
from unittest.mock import patch

from lyapcheck.cli.main import main, run
from lyapcheck.errors import InputError


@dataclass(frozen=True)
class Done:
    """What a command left: its exit code, what it wrote, and the refusal of its input if there was one."""

    exit_code: int
    stdout: str
    stderr: str
    exception: InputError | None = None

    @property
    def output(self):
        """Both streams."""
        return self.stdout + self.stderr


def invoke(*words):
    """Run ``lyapcheck`` with some words."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code, refusal = run(words), None
        except InputError as error:
            code, refusal = 2, error
    return Done(int(code), out.getvalue(), err.getvalue(), refusal)


def lyapcheck(*arguments, folder=None):
    """The whole program in a folder, with what it makes of errors: what a shell would see of it."""
    words = ["lyapcheck", *map(str, arguments)]
    out, err = io.StringIO(), io.StringIO()
    code = None
    with patch.object(sys, "argv", words), chdir(folder or "."), redirect_stdout(out), redirect_stderr(err):
        try:
            main()
        except SystemExit as left:
            code = left.code
    assert isinstance(code, int), "a command leaves with its exit code"
    return CompletedProcess(words, code, out.getvalue(), err.getvalue())
