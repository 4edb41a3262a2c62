"""What the three simulations say: verdicts, records and annotations, in every format."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.simulate import Simulation, Unfinished
from lyapcheck.answers.simulate.runs import SetPointRuns
from lyapcheck.answers.simulate.starts import RandomStarts, starts_csv
from lyapcheck.answers.simulate.tracking import TrackingRuns
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.output.answer import JUDGED_FORMATS, Level
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.many import Starts, sweep
from lyapcheck.simulate.reference import MinimumJerk
from lyapcheck.simulate.run import Run, SimulationFailed
from lyapcheck.simulate.task import PAPER_TASK
from lyapcheck.simulate.tracking import track
from lyapcheck.simulate.trial import experiment
from lyapcheck.verdicts import Exit

FILE = read_gain_file(paper_gain_file("table2"))
TABLE2 = FILE.gains
TARGET = PAPER_TASK.q_d
WAY = MinimumJerk((Fraction(0),) * 3, (Fraction(45), Fraction(45), Fraction(90)), Fraction(2))


@cache
def short_run(number: int = 0) -> Run:
    return simulate(TABLE2[number], robots.load("buap3"), TARGET, T=0.2, points=21)


@cache
def broken_run() -> Run:
    return simulate(TABLE2[0], robots.load("buap3"), TARGET, T=0.5, points=101, eps0=50.0, stop=False)


@cache
def answers() -> Mapping[str, Simulation]:
    model = robots.load("buap3")
    tracked = [track(one, model, WAY, T=0.2, points=21) for one in TABLE2[:2]]
    starts = [sweep(one, model, PAPER_TASK, Starts(4, 0.5, 1)) for one in TABLE2[:2]]
    return {
        "runs": SetPointRuns((short_run(0), short_run(1)), file=FILE),
        "starts": RandomStarts(tuple(starts), file=FILE),
        "tracking": TrackingRuns(tuple(tracked), file=FILE),
    }


KINDS = ("runs", "starts", "tracking")


def read_csv(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text), strict=True))


IDEAL = ", without the dry friction of the file"


@pytest.mark.parametrize("kind", KINDS)
def test_kept_promises_pass_at_the_line_of_the_gain_set(kind: str) -> None:
    answer = answers()[kind]
    assert answer.exit_code is Exit.PROVED
    title = answer.document().title
    assert title.startswith("! buap3: no bound violated by 2 gain sets")
    assert title.endswith(IDEAL)
    assert [(case.level, case.group, case.message) for case in answer.annotations()] == [
        (Level.PASSED, "tau_m1", ""),
        (Level.PASSED, "tau_m2", ""),
    ]
    for case, gain_set in zip(answer.annotations(), TABLE2, strict=False):
        place = FILE.place(gain_set)
        assert place is not None
        assert (case.path, case.line, case.column) == (FILE.path, place.line, place.column)


@pytest.mark.parametrize("kind", ["runs", "tracking"])
def test_a_record_is_a_run_and_joint_with_the_numbers_of_the_data(kind: str) -> None:
    answer = answers()[kind]
    rows = read_csv(answer.written("csv"))
    assert [(row["name"], row["joint"]) for row in rows] == [
        (name, joint) for name in ("tau_m1", "tau_m2") for joint in ("base", "shoulder", "elbow")
    ]
    for row, (result, i) in zip(
        rows, [(result, i) for result in answer.data()["results"] for i in range(3)], strict=True
    ):
        assert float(row["L2"]) == result["L2"]
        for key in ("peak_torque", "final_error", "torque_limit"):
            assert float(row[key]) == result[key][i]
        assert row["breach_promise"] == ""


def test_joints_of_a_record_have_the_printed_numbers_beside_them() -> None:
    run = simulate(TABLE2[1], robots.load("buap3"), TARGET, points=51)
    rows = SetPointRuns((run,)).records()
    assert [row["printed_settling"] for row in rows] == [0.994, 0.997, 0.929]
    assert {row["printed_L2"] for row in rows} == {24.6892}
    assert {row["printed_L2"] for row in SetPointRuns((short_run(),)).records()} == {None}


def test_a_broken_promise_fails_in_every_system() -> None:
    answer = SetPointRuns((broken_run(), short_run(1)), file=FILE)
    assert answer.exit_code is Exit.REFUTED
    assert answer.document().title == f"✗ buap3: bounds violated by 1 of 2 gain sets{IDEAL}"
    log = json.loads(answer.written("sarif"))["runs"][0]
    assert [(one["ruleId"], one["level"]) for one in log["results"]] == [("promises", "error")]
    assert log["tool"]["driver"]["rules"][0]["shortDescription"]["text"] == SetPointRuns.promised
    suites = ET.fromstring(answer.written("junit"))
    assert [(suite.get("name"), suite.get("failures")) for suite in suites] == [
        ("tau_m1", "1"),
        ("tau_m2", "0"),
    ]
    first, last = answer.written("github").splitlines()
    assert first.startswith("::error file=")
    assert "is violated at t" in first
    assert last.endswith(f"bounds violated by 1 of 2 gain sets{IDEAL}")
    (row, *_) = read_csv(answer.written("csv"))
    assert row["breach_grade"] == "enclosure"
    assert float(row["breach_value"]) > float(row["breach_limit"])


def test_what_is_seen_in_floating_point_alone_decides_nothing() -> None:
    run = broken_run()
    assert run.breach is not None
    seen = replace(run, breach=replace(run.breach, confirmed=False))
    answer = SetPointRuns((seen,))
    assert answer.exit_code is Exit.UNDECIDED
    assert answer.annotations()[0].level is Level.UNDECIDED
    assert answer.document().title == f"? buap3: undecided for 1 of 1 gain set{IDEAL}"


def test_a_rise_that_no_single_run_shows_again_is_undecided() -> None:
    (first, second) = answers()["starts"].results
    doubtful = replace(first, risen=np.array([False, True, False, False]))
    answer = RandomStarts((doubtful, second))
    assert answer.exit_code is Exit.UNDECIDED
    assert [case.level for case in answer.annotations()] == [Level.UNDECIDED, Level.PASSED]
    assert "in 1 of 4 runs" in answer.annotations()[0].message
    (complaint,) = answer.complaints()
    assert complaint.startswith("undecided: tau_m1 on buap3: V rose")


def test_what_was_not_finished_is_said_first() -> None:
    answer = SetPointRuns((short_run(),), (Unfinished("tau_m1", "tau_m1 on buap3: no ε₀ is certified"),))
    assert answer.exit_code is Exit.UNDECIDED
    assert answer.annotations()[0].message == "tau_m1 on buap3: no ε₀ is certified"
    lines = str(answer).splitlines()
    assert lines[0] == f"? buap3: undecided for 1 of 1 gain set{IDEAL}"
    assert "- not finished: tau_m1 on buap3: no ε₀ is certified" in lines


def test_a_gain_set_without_a_run_is_told_all_the_same() -> None:
    answer = SetPointRuns((), (Unfinished("lost", "lost on buap3: nothing was reached"),))
    assert answer.exit_code is Exit.UNDECIDED
    assert "nothing was reached" in str(answer)
    assert [case.level for case in answer.annotations()] == [Level.UNDECIDED]
    for form in JUDGED_FORMATS:
        assert answer.written(form)


def test_the_experiment_is_held_against_nothing() -> None:
    run = experiment(TABLE2[0], robots.load("buap3"), TARGET, T=0.1)
    answer = SetPointRuns((run,))
    document = answer.document()
    assert document.title == "! buap3: no limit cycle seen in 1 gain set"
    far, how = document.lead
    assert far.startswith("ends up to 88.")
    assert far.endswith("° from the goal (elbow)")
    assert how == "simulated at 2.5 ms, no delay: 0° each to (45, 45, 90)° in 0.1 s"
    (case,) = answer.annotations()
    assert (case.level, case.rule) == (Level.PASSED, "finished")
    assert answer.exit_code is Exit.PROVED


def test_initial_rates_are_told() -> None:
    run = simulate(TABLE2[0], robots.load("buap3"), TARGET, None, [np.pi / 2, 0.0, 0.0], 0.1, points=11)
    assert "initial rates (90, 0, 0) °/s" in SetPointRuns((run,)).written("markdown")
    assert "initial rates" not in SetPointRuns((short_run(),)).written("markdown")


def test_unbounded_gains_have_no_bound() -> None:
    pd = read_gain_file(paper_gain_file("table2_pd")).gains[0]
    run = track(pd, robots.load("buap3"), WAY, T=0.1, points=11)
    answer = TrackingRuns((run,))
    assert "no bound of dV/dt or of the torque: h is unbounded" in answer.written("markdown")
    assert answer.records()[0]["promised_torque"] is None
    still = SetPointRuns((simulate(pd, robots.load("buap3"), TARGET, T=0.1, points=11),))
    assert still.records()[0]["joint_bound"] is None
    assert still.data()["results"][0]["torque_bound"] is None


def test_gains_beyond_all_sense_have_json() -> None:
    """Infinity and NaN are no JSON."""
    huge = GainSet("h", 1, (Fraction(10**300), Fraction(1), Fraction(1)), (Fraction(1),) * 3)
    with pytest.raises(SimulationFailed) as stopped:
        simulate(huge, robots.load("buap3"), TARGET, T=0.1, points=11, max_steps=50, stop=False)
    assert stopped.value.partial is not None
    result = json.loads(SetPointRuns((stopped.value.partial,)).written("json"))
    assert result["results"][0]["accuracy"] is None


def test_samples_of_no_starts_are_a_head() -> None:
    assert starts_csv([]) == "gains,run,complete\n"
