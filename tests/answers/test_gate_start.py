"""The gate as a process: what it imports, what it leaves behind, and the summary of a job."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.cli import main as cli
from lyapcheck.cli.show import show
from lyapcheck.control import limits
from lyapcheck.control.gains import GainFile, paper_gain_file, read_gain_file
from lyapcheck.control.limits import arm_limits
from lyapcheck.errors import InputError

RUN = "from lyapcheck.cli.main import main; main()"
ARMS = Path(limits.__file__).parents[1] / "robots" / "arms"


def test_an_arm_is_read_once_for_many_files(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """And only for one call: an arm file that has changed since is read again."""
    arm = tmp_path / "arm.toml"
    shutil.copy(ARMS / "pendulum1.toml", arm)
    text = 'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\nkp = [0.1]\nkv = [0.05]\n'
    files = [tmp_path / f"g{i}.toml" for i in range(3)]
    for file in files:
        file.write_text(text)
    reads: list[str] = []
    monkeypatch.setattr(limits, "arm_limits", lambda name: (reads.append(name), arm_limits(name))[1])
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", *map(str, files)])

    def code() -> object:
        with pytest.raises(SystemExit) as left:
            cli.main()
        return left.value.code

    assert code() == 0
    assert reads == [str(arm)]
    arm.write_text(arm.read_text().replace("low = 0.1", "low = 0.01"))
    assert code() == 1


def test_a_reader_that_goes_away_gets_no_traceback() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    words = [sys.executable, "-c", RUN, "gate", str(paper_gain_file())]
    done = subprocess.run(words, stdout=writer, stderr=subprocess.PIPE, check=False)
    os.close(writer)
    assert (done.returncode, done.stderr) == (cli.CLOSED_PIPE, b"")


def test_an_interrupted_gate_says_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(*_: object, **__: object) -> GainFile:
        raise KeyboardInterrupt

    monkeypatch.setattr("lyapcheck.control.gains.read_gain_file", interrupt)
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", "a.toml"])
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == cli.INTERRUPTED
    assert capsys.readouterr().err == ""


# --- the summary of a job ----------------------------------------------------------------------------


def test_the_summary_of_a_job_is_added_to(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "summary.md"
    path.write_text("before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(path))
    answer = gate(read_gain_file(paper_gain_file()))
    show(answer, "github")
    text = path.read_text()
    assert text.startswith("before\n# ✗ 2 break (19), stability proved otherwise; 1 accepted")
    assert "## \\! tau_m1" in text
    show(answer, "text")
    assert path.read_text() == text
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "none" / "summary.md"))
    with pytest.raises(InputError, match="GITHUB_STEP_SUMMARY"):
        show(answer, "github")


@pytest.mark.slow
def test_a_summary_of_many_sets_keeps_to_the_size_that_is_shown(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    sets = (
        f'[[gains]]\nname = "s{i}"\nm = 1\nkp = [1, 1, 1]\nkv = [{0.1 if i % 2 else 0.3}, 0.1, 0.1]\n'
        for i in range(3000)
    )
    (tmp_path / "g.toml").write_text('robot = "buap3"\n' + "".join(sets))
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    show(gate(read_gain_file(tmp_path / "g.toml")), "github")
    text = (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert len(text.encode()) < 2**20
    assert text.startswith("# ✗ 1350 rejected; 150 break (19), stability proved otherwise; 1500 accepted; ")
    assert "## ✓" not in text
