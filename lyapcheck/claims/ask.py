"""Asking a proof script for its statements, without running it in this process."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from lyapcheck.check.refusal import Refused
from lyapcheck.claims.handover import Handover, ScriptRequest, read
from lyapcheck.claims.order import in_order
from lyapcheck.claims.python_process import command, environment
from lyapcheck.claims.script import check_ids
from lyapcheck.errors import InputError, Problem
from lyapcheck.temporary import temporary_folder

MAX_BYTES = 400_000_000
STANDARD_ERROR = 2


def ask(request: ScriptRequest) -> Handover:
    """What a script hands over; it is over, with all it has started, when this returns.

    Soundness: nothing comes back but claims in words and statements as data, which are read strictly.

    Raises:
        InputError: the script cannot be used, or hands over something else.
    """
    with temporary_folder() as folder:
        answer = Path(folder, "answer.json")
        code = _run(replace(request, answer=str(answer)))
        handover = _read(answer, request, code)
    if handover.problems:
        raise InputError([Problem(*problem) for problem in handover.problems])
    claims = {claim.id: claim for claim in handover.claims}
    check_ids(claims, request.only, request.shown)
    in_order(claims, request.shown)
    return handover


def _run(request: ScriptRequest) -> int:
    """The exit code of the process of the script.

    It has a session of its own, so that what it leaves running can be ended; and as long as its standard
    input is open it knows that this process lives.
    """
    process = subprocess.Popen(
        command("lyapcheck.claims.script_process"),
        stdin=subprocess.PIPE,
        stdout=STANDARD_ERROR,
        env=environment(),
        start_new_session=True,
    )
    assert process.stdin is not None
    try:
        with suppress(BrokenPipeError):
            process.stdin.write(pickle.dumps(request))
            process.stdin.flush()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    finally:
        os.killpg(process.pid, signal.SIGKILL)  # its id cannot be another's before wait has returned
        with suppress(BrokenPipeError):
            process.stdin.close()
        process.wait()
    return process.returncode


def _read(answer: Path, request: ScriptRequest, code: int) -> Handover:
    try:
        if code or not answer.is_file():
            raise Refused("process", _ending(code), "must end with its claims handed over")
        size = answer.stat().st_size
        if size > MAX_BYTES:
            raise Refused("answer", f"{size} bytes", f"must not exceed {MAX_BYTES}")
        return read(answer.read_text(encoding="utf-8"), len(request.asked) + len(request.others))
    except (Refused, ValueError, RecursionError) as error:
        rule = f"does not hand over its claims ({error})"
        raise InputError(Problem(request.shown, None, "script", "", rule, "correct the script")) from error


def _ending(code: int) -> str:
    """How a process has ended."""
    return f"exit code {code}" if code >= 0 else f"signal {-code}"
