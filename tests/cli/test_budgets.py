"""A budget that is spent is neither a pass nor a failure, and time is what was computed, not what went by."""

import math
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest

from lyapcheck import computing
from lyapcheck.computing import Spent, computing_time, run_within, time_of
from lyapcheck.verdicts import Exit
from tests.helpers.command import lyapcheck

GAINS = 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 2\nkp = [5]\nkv = [2]\n'


def compute(seconds):
    """Compute for so long."""
    end, value = time.process_time() + seconds, 0.0
    while time.process_time() < end:
        value += math.sin(value)
    return value


def test_to_wait_is_not_to_compute():
    before = computing_time()
    time.sleep(0.3)
    assert computing_time() - before < 0.2


def test_what_others_compute_for_us_counts_while_they_run_and_when_they_have_ended():
    before = computing_time()
    with ProcessPoolExecutor(1, get_context("fork")) as pool:
        pool.submit(compute, 0.4).result()
        running = computing_time() - before
    assert running > 0.3
    assert computing_time() - before > 0.3  # the system counts what has ended in hundredths


def test_the_time_of_a_process_that_is_gone_is_not_known():
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    assert time_of(gone.pid) is None


def test_a_program_that_waits_is_let_go_on(tmp_path):
    wait = [sys.executable, "-c", "import time; time.sleep(0.8); print('done')"]
    done = run_within(wait, 0.5, tmp_path)
    assert (done.returncode, done.stdout) == (0, "done\n")


def test_a_program_that_computes_for_too_long_is_ended(tmp_path):
    with pytest.raises(Spent):
        run_within([sys.executable, "-c", "while True: pass"], 0.5, tmp_path)


def test_where_the_system_does_not_count_the_clock_does(tmp_path, monkeypatch):
    monkeypatch.setattr(computing, "time_of", lambda pid: None)
    with pytest.raises(Spent):
        run_within([sys.executable, "-c", "import time; time.sleep(60)"], 0.1, tmp_path)


BUDGETS = {
    "--seconds 0": "was not proved in time: allow more seconds",
    "--max-boxes 1": "was not proved within 1 boxes: allow more boxes",
}


@pytest.mark.parametrize("option", BUDGETS)
def test_a_spent_budget_leaves_what_was_proved_and_says_what_to_allow(tmp_path, option):
    (tmp_path / "one.toml").write_text(GAINS, encoding="utf-8")
    done = lyapcheck("epsilon", "one.toml", "--starts", "1", *option.split(), folder=tmp_path)
    assert done.returncode == Exit.PROVED  # by norms alone
    assert BUDGETS[option] in " ".join(done.stdout.split())


def test_a_time_that_is_no_number_is_refused(tmp_path):
    done = lyapcheck("epsilon", "one.toml", "--seconds", "nan", folder=tmp_path)
    assert done.returncode == Exit.USAGE
    assert "--seconds = nan: must be at least 0" in done.stderr
