"""What ``make test`` promises of commands: each does its work once."""

from pathlib import Path

import pytest

from lyapcheck.cli.commands import NAMES
from lyapcheck.verdicts import Exit
from tests.helpers.command import lyapcheck

pytestmark = pytest.mark.usefixtures("in_this_process")

GAINS = 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [0.5]\nkv = [0.1]\n'
PLAN = 'robots = ["pendulum1"]\nquestions = ["gate"]\n[grid]\nm = [1]\nkp = [[3]]\nkv = [0.1]\n'
CERTIFICATE = Path(__file__).parents[1] / "arena" / "good" / "asy.A.rho.m1.json"
CALLS = {
    "bounds": ("one.toml --target 10 --time 0.1 --friction 0.01", Exit.PROVED),
    "check": ("scalar.py --m 1 --only h.odd", Exit.PROVED),
    "derive": ("--m 1 --n 1", Exit.PROVED),
    "epsilon": ("one.toml --max-boxes 20 --starts 1", Exit.PROVED),
    "explain": ("16.6", Exit.PROVED),
    "export": ("one.toml --out c --rate 1000", Exit.PROVED),
    "gate": ("one.toml", Exit.REFUTED),
    "init": ("mine", Exit.PROVED),
    "recheck": (str(CERTIFICATE), Exit.PROVED),
    # a whole report takes ten seconds: slow tests (tests/report/) make one, by what the command calls
    "report": ("--m 0", Exit.USAGE),
    "robot": ("pendulum1 --max-boxes 20", Exit.PROVED),
    "simulate": ("one.toml --target 10 --time 0.1", Exit.PROVED),
    "sweep": ("plan.toml --jobs 1", Exit.REFUTED),
    "table": ("--m 1", Exit.PROVED),
    "tune": ("pelican2", Exit.UNDECIDED),
}


SLOWLY = [pytest.param(name, 2, marks=pytest.mark.slow) for name in NAMES if name not in ("init", "sweep")]
"""But those which find what the first run has left."""


@pytest.mark.parametrize(("name", "times"), [*((name, 1) for name in NAMES), *SLOWLY])
def test_it_does_its_work_and_says_the_same_twice(name, times, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "one.toml").write_text(GAINS, encoding="utf-8")
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf-8")
    words, code = CALLS[name]
    done = lyapcheck(name, *words.split(), folder=tmp_path)
    assert done.returncode == code, done.stderr
    assert done.stdout or code == Exit.USAGE
    for _ in range(times - 1):
        assert lyapcheck(name, *words.split(), folder=tmp_path).stdout == done.stdout
