"""Ctrl-C and SIGTERM: every command ends at once, with its processes, and leaves nothing half written."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from lyapcheck import process_tree
from lyapcheck.process_tree import Stopping
from tests.helpers.shares import but, one_in

ROOT = Path(__file__).parents[2]
UR5 = str(ROOT / "examples" / "ur5_gains.toml")
TABLE2 = str(ROOT / "proofs" / "table2.toml")
PATIENCE = 20.0
"""Seconds; a command ends in hundredths of one, and none of these would have finished by then."""
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143}
COMMANDS = {
    "epsilon": ["epsilon", UR5, "--max-boxes", "100000000"],
    "simulate": ["simulate", TABLE2, "--runs", "100000", "--time", "60"],
    "check": ["check", "published.py", "--m", "1:400"],
    "table": ["table", "--m", "1:9000", "--digits", "1500"],
    "gate": ["gate", UR5, "--condition", "global"],
    "tune": ["tune", "buap3", "--m", "1:9000"],
    "robot": ["robot", str(ROOT / "examples" / "panda.toml")],
    "bench": ["simulate", TABLE2, "--experiment", "--time", "3600"],
}

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc for processes")


def in_session(session):
    """The processes of a session that still run."""
    result = []
    for path in Path("/proc").iterdir():
        if path.name.isdigit():
            try:
                state, _, _, its_session = (path / "stat").read_text().rpartition(")")[2].split()[:4]
            except OSError:
                continue
            if int(its_session) == session and state != "Z":
                result.append(int(path.name))
    return result


def wait_for(what, who=None):
    """Whether it comes true in time, while a process runs."""
    end = time.monotonic() + 3 * PATIENCE
    while time.monotonic() < end:
        if what():
            return True
        if who is not None and who.poll() is not None:
            return False
        time.sleep(0.02)
    return False


@contextmanager
def started(words, place):
    """A command in a session of its own that takes Ctrl-C, however pytest was started."""
    (place / "tmp").mkdir()
    with open(place / "out", "wb") as output, open(place / "err", "wb") as errors:
        process = subprocess.Popen(
            [sys.executable, "-m", "lyapcheck", *words],
            stdout=output,
            stderr=errors,
            cwd=place,
            env={**os.environ, "TMPDIR": str(place / "tmp"), "XDG_CACHE_HOME": str(place / "cache")},
            start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),  # noqa: PLW1509
        )
    try:
        yield process
    finally:
        for left in in_session(process.pid):
            os.kill(left, signal.SIGKILL)
        process.wait()


def check_end(process, number, place):
    """It ended by the signal, silently, with all its processes and temporary files."""
    assert process.wait(PATIENCE) == CODES[number]
    assert (place / "out").read_bytes() == b""
    assert wait_for(lambda: not in_session(process.pid)), "processes are left"
    said = (place / "err").read_text()
    assert all(re.match(r"\w+: +\d+ % ", line) for line in said.splitlines()), said
    assert list((place / "tmp").iterdir()) == []


ONLY_IT, ALL_OF_IT = False, True
SIGNALLED = [(name, ONLY_IT) for name in COMMANDS] + [("epsilon", ALL_OF_IT), ("simulate", ALL_OF_IT)]


@pytest.mark.parametrize(("name", "to_all"), but([("check", ONLY_IT)], SIGNALLED))
@pytest.mark.parametrize("number", one_in(2, CODES))
def test_a_signal_ends_a_command(name, number, to_all, tmp_path):
    with started(COMMANDS[name], tmp_path) as process:
        busy = wait_for(lambda: catches_term(process.pid), process)
        assert busy, (tmp_path / "err").read_text()
        time.sleep(1.0)  # into the work: any moment will do
        (os.killpg if to_all else os.kill)(process.pid, number)
        check_end(process, number, tmp_path)


def catches_term(pid):
    """Whether a process has a handler for SIGTERM, which Python has not."""
    result = re.search(r"^SigCgt:\s*(\w+)$", Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)
    return result is not None and bool(int(result[1], 16) >> (signal.SIGTERM - 1) & 1)


@pytest.mark.slow
@pytest.mark.parametrize("number", CODES)
@pytest.mark.parametrize("to_all", [False, True], ids=["process", "group"])
def test_a_signal_ends_a_report_and_its_processes(number, to_all, tmp_path):
    with started(["report", "--out", str(tmp_path / "pages")], tmp_path) as process:
        assert wait_for(
            lambda: len(in_session(process.pid)) >= 4, process
        )  # two workers, and who counts locks
        time.sleep(2.0)
        (os.killpg if to_all else os.kill)(process.pid, number)
        check_end(process, number, tmp_path)
    assert not any((tmp_path / "pages").glob("*"))


def test_processes_of_processes_end_too(tmp_path):
    """And a child that takes no Ctrl-C itself; what was being written is gone."""
    code = (
        "import subprocess, sys, time\n"
        "from lyapcheck.process_tree import Stopping, pending\n"
        "with Stopping(), pending('half'), pending('folder'):\n"
        "    open('half', 'w').close()\n"
        "    subprocess.Popen(['sh', '-c', 'sleep 300 & sleep 300 & wait'])\n"
        "    open('folder/ready', 'w').close()\n    time.sleep(300)\n"
    )
    (tmp_path / "folder").mkdir()
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),  # noqa: PLW1509
    )
    assert wait_for(lambda: len(in_session(process.pid)) == 4 and (tmp_path / "folder" / "ready").exists())
    os.kill(process.pid, signal.SIGINT)
    assert process.wait(PATIENCE) == 130
    assert wait_for(lambda: not in_session(process.pid))
    assert list(tmp_path.iterdir()) == []


def test_signals_are_as_before_afterwards():
    before = [signal.getsignal(number) for number in CODES], signal.pthread_sigmask(signal.SIG_BLOCK, [])
    with Stopping():
        assert [signal.getsignal(number) for number in CODES] != before[0]
    now = [signal.getsignal(number) for number in CODES], signal.pthread_sigmask(signal.SIG_BLOCK, [])
    assert now == before


def test_a_signal_that_is_ignored_stays_ignored():
    """As in a job that a script has put into the background."""
    kept = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with Stopping():
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, kept)


def test_what_is_pending_no_more_stays(tmp_path):
    file = tmp_path / "file"
    with process_tree.pending(file):
        file.write_text("")
    process_tree.clear()
    assert file.exists()
    with process_tree.pending(file), process_tree.pending(tempfile.mkdtemp(dir=tmp_path)):
        process_tree.clear()
    assert list(tmp_path.iterdir()) == []
