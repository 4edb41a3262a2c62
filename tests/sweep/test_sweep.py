"""Sweeps: the same bytes whoever answers, whatever is killed, and every verdict that of the command."""

import errno
import json
import os
import signal
import subprocess
import sys
import time
from fractions import Fraction
from pathlib import Path

import pytest

import lyapcheck
from lyapcheck import InputError, store
from lyapcheck.answers.epsilon import kept
from lyapcheck.answers.gate import gate
from lyapcheck.answers.sweep import questions, read_plan, result
from lyapcheck.answers.sweep.questions import COLUMNS
from lyapcheck.answers.sweep.result import SweepAnswer, Tally
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.limits import arm_limits
from lyapcheck.family.members import tanh
from lyapcheck.robots.fields import Vary
from tests.helpers.command import lyapcheck as command
from tests.helpers.urdf_texts import ARMS

PLAN = """
robots = ["reyes-kelly2"]
variations = [[], ["viscous=-30%..+0%"]]
questions = ["gate"]
[grid]
m = [1, 2]
kp = [[20, 5]]
kv = {from = 0.05, to = 0.2, step = 0.05}
"""
PENDULUM = """
robots = ["pendulum1"]
questions = ["robot", "gate", "epsilon", "bounds", "simulate"]
[[gains]]
name = "one"
m = 1
kp = [0.5]
kv = [0.1]
[epsilon]
max_boxes = 300
starts = 2
[bounds]
time = 1
target = [45]
[simulate]
time = 1
"""


@pytest.fixture
def plan(tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text(PLAN, encoding="utf-8")
    return path


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def rows_of(folder):
    return [json.loads(line) for line in (folder / "rows.jsonl").read_text(encoding="utf-8").splitlines()]


def test_rows_come_in_order_with_the_verdicts_of_the_gate(plan, tmp_path):
    rows = list(lyapcheck.sweep(plan, workers=1, out=tmp_path / "out"))
    assert rows == rows_of(tmp_path / "out")
    assert [row["index"] for row in rows] == list(range(16))
    assert all(list(row) == list(COLUMNS) for row in rows)
    file = lyapcheck.GainFile("plan", "reyes-kelly2", tuple(read_plan(plan).grid.gains(2)))
    verdicts = [result.verdict for result in gate(file)]
    assert [row["verdict"] for row in rows[:8]] == verdicts
    assert {"accepted", "rejected"} <= set(verdicts)
    assert all((row["margin"] > 0) == (row["verdict"] == "accepted") for row in rows)


def test_every_row_names_certificates_that_the_checker_accepts(plan, tmp_path):
    rows = list(lyapcheck.sweep(plan, workers=1, out=tmp_path / "out"))
    place = tmp_path / "out" / "certificates"
    named = {digest for row in rows for digest in row["certificates"]}
    assert {path.stem for path in place.iterdir()} == named
    told = command("recheck", place, "--format", "json")
    judged = {row["digest"]: row for row in json.loads(told.stdout)["certificates"]}
    assert set(judged) == named
    assert all(row["accepted"] for row in judged.values())
    words = {"proved": "accepted", "refuted": "rejected"}
    for row in rows:
        (own,) = [judged[d] for d in row["certificates"] if judged[d]["id"] == row["name"]]
        assert words[own["verdict"]] == row["verdict"]


def test_a_sweep_that_was_broken_off_is_resumed_to_the_same_bytes(plan, tmp_path, monkeypatch):
    list(lyapcheck.sweep(plan, workers=1, out=tmp_path / "whole"))
    whole = contents(tmp_path / "whole")
    broken = tmp_path / "broken"
    rows = lyapcheck.sweep(plan, workers=1, out=broken)
    for _ in range(5):
        next(rows)
    del rows
    some = sorted((broken / "certificates").iterdir())
    assert 0 < len(some) < len(whole) - 1
    some[0].write_bytes(some[0].read_bytes()[:-5])  # altered, and to be written again
    with monkeypatch.context() as patch:

        def no_room(path, content):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        patch.setattr(result, "_write", no_room)
        with pytest.raises(InputError, match="go on with --resume"):
            list(lyapcheck.sweep(plan, workers=1, out=broken, resume=True))
    assert not (broken / "rows.jsonl").exists()
    list(lyapcheck.sweep(plan, workers=1, out=broken, resume=True))
    assert contents(broken) == whole


def test_what_cannot_be_asked_is_a_row_and_not_the_end(plan, monkeypatch):
    def fragile(question, *rest, **cells):
        if question.index == 3:
            raise ValueError("a fault in lyapcheck")
        return own(question, *rest, **cells)

    own = questions.answered
    monkeypatch.setattr(questions, "answered", fragile)
    rows = list(lyapcheck.sweep(plan, workers=1))
    assert [row["index"] for row in rows if row["verdict"] == "error"] == [3]
    assert rows[3]["reason"] == "ValueError: a fault in lyapcheck"
    tally = Tally()
    for row in rows:
        tally.add(row)
    assert SweepAnswer("plan", tally).exit_code == 4


def test_what_is_kept_is_not_asked_again(tmp_path, monkeypatch):
    monkeypatch.delenv(store.OFF)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = tmp_path / "plan.toml"
    text = PENDULUM.replace('["robot", "gate", "epsilon", "bounds", "simulate"]', '["epsilon", "gate"]')
    path.write_text(text, encoding="utf-8")
    rows = lyapcheck.sweep(path, workers=1, out=tmp_path / "out")
    assert next(rows)["verdict"] == "proved"
    del rows  # broken off

    def never(*gains, **budget):
        raise AssertionError("it was searched for again")

    monkeypatch.setattr(kept, "four", never)
    list(lyapcheck.sweep(path, workers=1, out=tmp_path / "out", resume=True))
    monkeypatch.undo()
    list(lyapcheck.sweep(path, workers=1, out=tmp_path / "alone"))
    assert contents(tmp_path / "out") == contents(tmp_path / "alone")


def test_the_loop_of_the_arm_counts_as_in_each_command(tmp_path):
    """1,000 % of gravity more than the controller knows: the shoulder falls, as `bounds` says of the file."""
    text = (ARMS / "init" / "arm.toml").read_text(encoding="utf-8")
    (tmp_path / "known.toml").write_text(text, encoding="utf-8")
    (tmp_path / "loaded.toml").write_text(f"{text}\n[loop]\ngravity_error = 1000\n", encoding="utf-8")
    before = (
        "robots = ['known.toml', 'loaded.toml']\nquestions = ['bounds', 'simulate']\n[bounds]\ntime = 0.1\n"
    )
    plan = tmp_path / "plan.toml"
    plan.write_text(f"{before}[[gains]]\nname = 'a'\nm = 1\nkp = [22, 10]\nkv = [12, 3]\n", encoding="utf-8")
    rows = lyapcheck.sweep(plan, workers=1, out=tmp_path / "out")
    assert [row["verdict"] for row in rows] == ["proved", "observed", "refuted", "seen"]


@pytest.mark.slow
def test_every_question_is_answered_as_by_its_command(tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text(PENDULUM, encoding="utf-8")
    gains = tmp_path / "gains.toml"
    gains.write_text(
        'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [0.5]\nkv = [0.1]\n', encoding="utf-8"
    )
    rows = {row["ask"]: row for row in lyapcheck.sweep(path, workers=1, out=tmp_path / "out")}
    options = {
        "robot": ["pendulum1", "--max-boxes", 2000],
        "epsilon": [gains, "--max-boxes", 300, "--starts", 2],
        "bounds": [gains, "--time", 1, "--target", 45],
        "simulate": [gains, "--time", 1, "--target", 45],
    }
    for ask, words in options.items():
        data = json.loads(command(ask, *words, "--format", "json").stdout)
        told = rows[ask]["answer"]
        data = data["results"][0] if ask in ("epsilon", "bounds") else {key: data[key] for key in told}
        assert told == data, ask
    verdicts = [row["verdict"] for row in rows.values()]
    assert verdicts == ["proved", "rejected", "proved", "undecided", "observed"]
    named = {digest for row in rows.values() for digest in row["certificates"]}
    judged = json.loads(command("recheck", tmp_path / "out" / "certificates", "--format", "json").stdout)
    assert {row["digest"] for row in judged["certificates"] if row["accepted"]} == named


KILLER = """
import multiprocessing, os, signal
if multiprocessing.parent_process() is not None:
    os.kill(os.getpid(), signal.SIGKILL)
"""
SETS = "".join(
    f'[[gains]]\nname = "{name}"\nfamily = "{name}"\nkp = [20, 5]\nkv = [0.05, 0.05]\n'
    for name in ("tanh", "killer", "arctan")
)


@pytest.mark.slow
def test_a_question_that_kills_its_worker_takes_no_other_with_it(tmp_path):
    members = tmp_path / "family" / "members"
    members.mkdir(parents=True)
    own = Path(tanh.__file__).read_text(encoding="utf-8")
    (members / "killer.py").write_text(f"{own}{KILLER}", encoding="utf-8")
    path = tmp_path / "plan.toml"
    head = 'robots = ["reyes-kelly2"]\nvariations = [[], ["viscous=-30%..+0%"]]\nquestions = ["gate"]\n'
    path.write_text(head + SETS, encoding="utf-8")
    words = ["sweep", path, "--out", tmp_path / "out", "--jobs", 2]
    rows = rows_after(words, tmp_path / "out", LYAPCHECK_PATH=str(tmp_path))
    assert [row["name"] for row in rows if row["verdict"] == "error"] == ["killer"] * 2
    assert len(rows) == 6
    assert "was killed" in rows[1]["reason"]


@pytest.mark.slow
def test_two_workers_and_a_kill_change_no_byte(tmp_path):
    """kill -9 of all of it in the middle, then --resume on two workers; beside one that was left alone."""
    path = tmp_path / "plan.toml"
    path.write_text(PLAN.replace("step = 0.05", "step = 0.0005"), encoding="utf-8")
    out = tmp_path / "out"
    words = ["sweep", path, "--out", out, "--jobs", 2]
    process = subprocess.Popen(program(*words), stdout=subprocess.DEVNULL, start_new_session=True)
    while process.poll() is None and not list(out.glob("certificates/*.json")):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    rows = rows_after([*words, "--resume"], out)
    assert len(rows) == read_plan(path).count > 1000
    rows_after(["sweep", path, "--out", tmp_path / "alone", "--jobs", 1], tmp_path / "alone")
    assert contents(out) == contents(tmp_path / "alone")


def program(*words):
    return [sys.executable, "-m", "lyapcheck", *map(str, words)]


def rows_after(words, out, **variables):
    subprocess.run(program(*words), env={**os.environ, **variables}, capture_output=True, check=False)
    return rows_of(out)


def test_over_a_variation_the_gate_answers_as_with_vary(plan, tmp_path):
    command("sweep", plan, "--out", tmp_path / "out")
    rows = rows_of(tmp_path / "out")
    ranges = (Vary.parsed("viscous=-30%..+0%"),)
    limits = {"reyes-kelly2": arm_limits("reyes-kelly2", ranges)}
    for row in rows:
        gains = GainSet("one", row["m"], *(tuple(map(Fraction, row[key])) for key in ("kp", "kv")))
        arms = limits if row["variation"] else {}
        (result,) = gate(GainFile("plan", "reyes-kelly2", (gains,)), arms=dict(arms)).data()["results"]
        assert row["verdict"] == result["verdict"]
        keys = ("id", "joint", "verdict", "value", "limit", "margin")
        seen, expected = (
            [[check[key] for key in keys] for check in answer["checks"]] for answer in (row["answer"], result)
        )
        assert seen == expected
        if row["margin"] is not None:
            deciding = [check for check in result["checks"] if check["id"] in result["deciding"]]
            least = min(Fraction(one["margin"]) / Fraction(one["limit"]["upper"]) for one in deciding)
            assert Fraction(str(row["margin"])) <= least + Fraction(1, 10**9)


@pytest.mark.slow
def test_over_a_variation_nothing_is_proved_of_nominal_numbers_only(tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text(
        'robots = ["reyes-kelly2"]\nvariations = [[], ["viscous=-5%..+5%"], ["viscous=+5%..+5%"]]\n'
        'questions = ["robot", "simulate"]\n[[gains]]\nname = "one"\nm = 1\nkp = [20, 5]\nkv = [0.1, 0.1]\n'
        "[robot]\nmax_boxes = 20\n[simulate]\ntime = 0.2\ntarget = [45, 45]\n"
    )
    command("sweep", path, "--out", tmp_path / "out")
    rows = rows_of(tmp_path / "out")
    told = [(row["verdict"], row["reason"]) for row in rows if row["ask"] == "robot"]
    assert told == [("proved", ""), ("undecided", "shown at nominal numbers only: 2.7"), ("proved", "")]
    arms = [row["answer"]["arms"] for row in rows if row["ask"] == "simulate"]
    assert arms == [
        None,
        "one arm in the ranges and all 4 corners of the ranges",
        "one arm in the ranges and the corner of the ranges",
    ]
