"""The fixture in a real pytest run of another project, and the function alone."""

import subprocess
import sys
from importlib.metadata import entry_points

import pytest

from lyapcheck.answers.gate.promises import NO_GROUNDS
from lyapcheck.control.gains import paper_gain_file
from lyapcheck.errors import InputError
from lyapcheck.pytest_plugin import assert_accepted

GOOD = 'robot = "buap3"\n\n[[gains]]\nname = "mine"\nm = 1\nkp = [28, 60, 5]\nkv = [0.233, 0.233, 0.233]\n'
BAD = GOOD.replace("60", "70")


def test_rejected_gains_say_where_why_and_what_to_change(tmp_path):
    (tmp_path / "gains.toml").write_text(BAD, encoding="utf-8")
    with pytest.raises(AssertionError) as caught:
        assert_accepted(tmp_path / "gains.toml")
    message = str(caught.value)
    assert f"{tmp_path / 'gains.toml'}:6:11: mine rejected: (10p) shoulder" in message
    assert "lower k_p to at most" in message
    assert message.count("\n") == 0


def test_undecided_gains_are_no_pass(tmp_path):
    text = 'robot = "pelican2"\n[[gains]]\nname = "a"\nm = 1\nkp = [1, 1]\nkv = [0.01, 0.01]\n'
    (tmp_path / "gains.toml").write_text(text, encoding="utf-8")
    with pytest.raises(AssertionError, match="undecided"):
        assert_accepted(tmp_path / "gains.toml")
    assert_accepted(tmp_path / "gains.toml", conditions=("19",))


def test_checks_that_pass_without_a_promise_are_no_pass(tmp_path, monkeypatch):
    (tmp_path / "gains.toml").write_text(GOOD, encoding="utf-8")
    monkeypatch.setattr("lyapcheck.answers.gate.judge.grounds", lambda *_: NO_GROUNDS)
    with pytest.raises(AssertionError, match="undecided"):
        assert_accepted(tmp_path / "gains.toml")


@pytest.mark.parametrize("conditions", [(), ("11",), ("10p", "all")])
def test_unknown_conditions_are_refused(conditions):
    with pytest.raises(InputError):
        assert_accepted(paper_gain_file(), conditions=conditions)


@pytest.mark.slow
def test_another_projects_tests_use_the_fixture(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    (tmp_path / "good.toml").write_text(GOOD, encoding="utf-8")
    (tmp_path / "bad.toml").write_text(BAD, encoding="utf-8")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "test_gains.py").write_text(
        "def test_good(accepted_gains):\n    accepted_gains('good.toml')\n\n"
        "def test_bad(accepted_gains):\n    accepted_gains('bad.toml')\n",
        encoding="utf-8",
    )
    known = {entry.value for entry in entry_points(group="pytest11")}
    plugin = () if "lyapcheck.pytest_plugin" in known else ("-p", "lyapcheck.pytest_plugin")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *plugin, "-W", "error", "inner"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "1 failed, 1 passed" in done.stdout
    assert "lower k_p to at most" in done.stdout
    assert "pytest_plugin.py" not in done.stdout
