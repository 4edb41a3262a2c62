"""What holds for all tests."""

from __future__ import annotations

import io
import os
from contextlib import redirect_stdout
from pathlib import Path
from subprocess import CompletedProcess
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import settings

from lyapcheck import store

# The same properties in both; ``make test-slow`` looks at more examples. No deadlines: how long an example
# takes says more of the machine than of the code.
settings.register_profile("fast", deadline=None, max_examples=10)
settings.register_profile("thorough", deadline=None, max_examples=400)
settings.load_profile("fast")

# What an earlier run has found is not what is tested, nor does a test leave anything to a later run.
os.environ[store.OFF] = "1"


@pytest.fixture(scope="module")
def in_this_process():
    """Scripts run, and certificates are judged, in the process of the test, by the same functions.

    For tests of what is decided. That processes of their own do it, and outlive what scripts and certificates
    do to them, is what tests/claims/test_script_process.py and tests/check/test_recheck_door.py are about.
    """
    from lyapcheck.check import __main__ as checker
    from lyapcheck.check import guard, judging, worker
    from lyapcheck.claims import ask, fresh_check, script_process

    def run_script(request: Any) -> int:
        Path(request.answer).write_text(script_process.answer(request), encoding="utf-8")
        return 0

    def ask_worker(own: guard.Guard, request: dict[str, Any], documents: list[bytes]) -> dict[str, Any]:
        return worker._answer(judging, request, documents)

    def run_checker(words: list[str], **options: Any) -> CompletedProcess[bytes]:
        stdout = io.StringIO()
        with redirect_stdout(stdout):
            code = checker.main(words[words.index("lyapcheck.check") + 1 :])
        return CompletedProcess(words, code, stdout.getvalue().encode(), b"")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ask, "_run", run_script)
        patch.setattr(guard.Guard, "_ask", ask_worker)
        patch.setattr(fresh_check, "subprocess", SimpleNamespace(run=run_checker))
        yield
