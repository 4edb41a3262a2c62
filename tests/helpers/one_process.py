"""Scripts run, and certificates are judged, in the process of the test, by the same functions."""

import io
import pickle
from contextlib import contextmanager, redirect_stdout
from dataclasses import asdict
from pathlib import Path
from subprocess import CompletedProcess
from types import SimpleNamespace

import pytest


@contextmanager
def one_process():
    """As long as it lasts; what else is to be replaced as long may be."""
    from lyapcheck import rechecking as checker
    from lyapcheck.check import certificate, guard
    from lyapcheck.claims import decision, script_process
    from lyapcheck.claims import script as ask

    def run_script(words, asked, *to):
        request = pickle.loads(asked)
        Path(request.answer).write_text(script_process.answer(request), encoding="utf-8")
        return 0

    def ask_worker(own, content, full):
        return {"finding": asdict(certificate.judged(content, full))}

    def run_checker(words, **options):
        stdout = io.StringIO()
        with redirect_stdout(stdout):
            code = checker.main(words[words.index("lyapcheck.check") + 1 :])
        return CompletedProcess(words, code, stdout.getvalue().encode(), b"")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ask, "run_apart", run_script)
        patch.setattr(guard.Guard, "_ask", ask_worker)
        patch.setattr(decision, "subprocess", SimpleNamespace(run=run_checker))
        yield patch
