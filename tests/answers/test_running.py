"""Tune, bounds, simulate and sweep on the loop as it is run: they say what the gate says."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from lyapcheck.control.gains import read_gain_file
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.loop import NOTHING, LoopEntry, read_loop
from lyapcheck.files.toml import open_document
from tests.answers.test_gate_running import pendulum
from tests.control.test_sampling import RECORD
from tests.helpers.command import invoke
from tests.helpers.words_of_proof import left_over

LOOP = ("--rate", "500", "--delay", "0")


def test_tune_writes_the_loop_that_it_was_asked_for(tmp_path: Path) -> None:
    out = tmp_path / "tuned.toml"
    done = invoke("tune", "reyes-kelly2", "--m", "1", *LOOP, "--out", str(out), "--format", "json")
    assert done.exit_code == 0, done.stderr
    (row,) = json.loads(done.stdout)["results"]
    assert any("for every period up to" in text for text in row["as_run"])
    assert read_gain_file(out).loop == LoopEntry(period=read_gain_file(out).loop.period, delay=0)
    told = json.loads(invoke("gate", str(out), "--format", "json").stdout)["results"][0]
    assert told["verdict"] == "accepted"
    assert "2 ms, no delay" in told["loop"]


def test_tune_supposes_a_loop_where_none_is_known() -> None:
    text = " ".join(invoke("tune", "reyes-kelly2", "--m", "1", "-v").stdout.split())
    assert "as run (1 sample late, velocity by differences)" in text


@pytest.mark.parametrize("entry", [RECORD.entry, LoopEntry(), LoopEntry(period=RECORD.period / 3)])  # type: ignore[operator]
def test_a_written_loop_is_read_as_it_was(tmp_path: Path, entry: LoopEntry) -> None:
    file = tmp_path / "loop.toml"
    file.write_text(entry.toml, encoding="utf-8")
    notes = Notes("loop.toml", lambda _: None)
    assert read_loop(Fields(open_document(file).data, (), notes).table("loop")) == entry
    assert (notes.problems, NOTHING.toml) == ([], "[loop]")


def test_bounds_count_what_is_unknown(tmp_path: Path) -> None:
    """10 N·m a kilogram beside k_p = 12 N·m: 0.3 kg and 1 N·m of friction hold, 2 kg fall."""
    file = str(pendulum(tmp_path, 1, "12"))
    words = ("bounds", file, "--target", "45", "--time", "0.5", "--friction", "1", "--format", "json")
    held = invoke(*words, "--unknown-payload", "0.3")
    assert held.exit_code == 0, held.stderr
    (row,) = json.loads(held.stdout)["results"]
    assert row["disturbance"]["rest"][0] == pytest.approx(4.786, abs=2e-3)  # atanh(1/12)
    assert row["disturbance"]["unknown_rest"][0] == pytest.approx(19.86, abs=1e-2)  # atanh(4/12)
    fallen = invoke(*words, "--unknown-payload", "2")
    assert fallen.exit_code == 1
    assert "pivot falls" in fallen.stdout


def test_simulations_stay_within_what_is_said_of_them(tmp_path: Path) -> None:
    file = str(pendulum(tmp_path, 1, "12"))
    words = ("simulate", file, "--target", "90", "--time", "40", "--rate", "500", "--unknown-payload", "0.3")
    done = invoke(*words, "--format", "json")
    (row,) = json.loads(done.stdout)["results"]
    assert any("leaves at most pivot 14.64°" in text for text in row["as_run"])  # atanh(3/12)
    e = math.radians(row["final_error"][0])
    assert 12 * math.tanh(abs(e)) == pytest.approx(3 * math.cos(e), rel=1e-3)  # Δg at q = 90° − e
    assert abs(e) <= math.atanh(3 / 12)


def test_a_sweep_has_a_loop(tmp_path: Path) -> None:
    plan = tmp_path / "plan.toml"
    plan.write_text(
        'robots = ["ur5"]\nquestions = ["gate"]\n[[gains]]\nname = "a"\nm = 1\nkp = [40, 35, 30, 8, 8, 8]\n'
        "kv = [0.5, 0.5, 0.5, 0.5, 0.5, 0.5]\n[gate]\ncondition = ['10i', 'sampled', 'holds']\n"
        'loop = ["rate=1000", "unknown_payload=1"]\n'
    )
    done = invoke("sweep", str(plan), "--out", str(tmp_path / "out"))
    assert done.exit_code == 0, done.stdout + done.stderr
    assert invoke("recheck", str(tmp_path / "out" / "certificates")).exit_code == 0


@pytest.mark.parametrize(
    "words",
    [
        ("tune", "reyes-kelly2", "--m", "1"),
        ("tune", "reyes-kelly2", "--m", "1", "--rate", "30"),
        ("simulate", "FILE", "--target", "45", "--time", "0.2", "--rate", "500", "--unknown-payload", "2"),
        ("bounds", "FILE", "--target", "45", "--time", "0.2", "--friction", "1", "--unknown-payload", "0.3"),
    ],
)
def test_words_of_proof_are_those_of_promises(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = str(pendulum(tmp_path, 1, "12"))
    assert left_over(tuple(file if word == "FILE" else word for word in words), monkeypatch) == []
