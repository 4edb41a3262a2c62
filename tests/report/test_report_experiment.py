"""The report on the printed experiment: what it says follows from the study, and nothing is said by heart."""

import csv
import json
from dataclasses import fields, replace
from io import StringIO
from typing import Any
from xml.etree import ElementTree

import pytest

from lyapcheck.answers.derive import derivation
from lyapcheck.answers.gate import GateAnswer
from lyapcheck.answers.table import build_table
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.report.build import render
from lyapcheck.report.drawings import draw_comparisons, draw_sensitivity
from lyapcheck.report.experiment import (
    AssumedRow,
    NumberRow,
    StudyRow,
    answer_words,
    hangs_words,
    printed_experiment,
    span,
    tally_words,
    together_words,
    value_words,
)
from lyapcheck.report.findings import findings
from lyapcheck.report.model import Report, RunRow
from lyapcheck.report.notes import published_notes
from lyapcheck.report.plain import read
from lyapcheck.robots import load
from studies.printed_experiment.json import study_json
from studies.printed_experiment.study import study
from tests.report.test_report import Balance

NOTES = published_notes()


@pytest.fixture(scope="module")
def found():
    """A small study of m = 1 and PD, as it stands in a report."""
    sets = [read_gain_file(paper_gain_file(name)).gains[0] for name in ("table2", "table2_pd")]
    small = study(sets, load("buap3"), spread=8, corners=8, seed=1)
    assert small is not None
    return read(StudyRow, json.loads(json.dumps(study_json(small), allow_nan=False)))


@pytest.fixture(scope="module")
def files(found):
    model = load("buap3")
    empty = dict.fromkeys(("epsilon", "claims", "others", "by_size", "runs", "map"), ())
    found_out = findings(NOTES, (), {}, (), found)
    report = Report(
        robot=model,
        ms=(1,),
        notes=NOTES,
        own=False,
        table=build_table((1,)),
        derived=derivation(1),
        gate=GateAnswer(()),
        sensitivity=found,
        figures=draw_sensitivity(found),
        findings=found_out,
        **empty,
    )
    return render(report)


def test_tags_of_its_pages_are_closed_in_their_order(files):
    for name, page in files.items():
        if name.endswith(".html"):
            reader = Balance()
            reader.feed(str(page))
            assert reader.open == []


def number(**changed):
    blank = dict.fromkeys(field.name for field in fields(NumberRow))
    plain = {"quantity": "settling", "joint": "base", "unit": "s", "printed": 1.0, "at_most": False}
    return NumberRow(**(blank | plain | {"nearest": 1.2, "answer": "no", "runs": 10} | changed))


@pytest.mark.slow
def test_the_pages_show_every_printed_number(found, files):
    for one in found.sets:
        for entry in one.numbers:
            assert f">{_shown(entry)}<" in str(files["index.html"])
        assert str(files["report.md"]).count(f"| {one.name}: ") == len(one.numbers)


def _shown(entry):
    unit = "°" if entry.unit == "°" else f" {entry.unit}"
    return f"{'below ' if entry.at_most else ''}{entry.printed:g}{unit}"


def test_json_carries_the_study(found, files):
    assert read(StudyRow, json.loads(str(files["report.json"]))["sensitivity"]) == found


@pytest.mark.slow
def test_figures_draw_what_the_data_beside_them_say(found, files):
    for stem in ("spread", "assumptions"):
        ElementTree.fromstring(str(files[f"figures/{stem}.svg"]))
        assert f"figures/{stem}.csv" in str(files["index.html"])
    rows = list(csv.DictReader(StringIO(str(files["figures/spread.csv"]))))
    assert len(rows) == sum(len(one.numbers) for one in found.sets)
    index = found.sets[0].numbers[0]
    assert float(rows[0]["printed"]) == index.printed == 25.4006
    assert float(rows[0]["least seen"]) == pytest.approx(index.low)
    unsettled = [row for row in rows if row["quantity"] == "settling" and row["nominal"] == ""]
    assert unsettled
    assert draw_sensitivity(found) == draw_sensitivity(found)
    assert draw_sensitivity(None) == {}


@pytest.mark.slow
def test_indices_stand_beside_the_bench(found):
    runs = [
        RunRow(name="tau_m1", L2=31.0, printed={"L2": 25.4}),
        RunRow(name="other", L2=9.0, printed=None),
    ]
    rows = list(csv.reader(StringIO(str(draw_comparisons((), runs, found)["indices.csv"]))))
    assert rows[0] == [
        "gains", "simulation of (11) [deg]", "bench with dry friction [deg]", "measured in the paper [deg]"
    ]  # fmt: skip
    assert rows[1][:2] == ["tau_m1", "31"]
    assert float(rows[1][2]) == pytest.approx(found.sets[0].numbers[0].nominal, rel=1e-5)
    assert rows[2] == ["other", "9", "", ""]


def test_findings_follow_the_answers(found):
    subjects = [item.subject for item in findings(NOTES, (), {}, (), found)]
    assert subjects[0] == "L2 index of tau_m1"
    assert "indices of all gains" in subjects
    sets = tuple(
        replace(one, numbers=tuple(replace(x, answer="yes", nominal=x.printed) for x in one.numbers))
        for one in found.sets
    )
    assert findings(NOTES, (), {}, (), with_together(replace(found, sets=sets), worst=0.0)) == ()


@pytest.mark.parametrize(("nominal", "count"), [(25.4, 0), (25.8, 0), (31.0, 1), (20.0, 1)])
def test_indices_near_the_print_are_no_finding(found, nominal, count):
    first = found.sets[0]
    alone = replace(first, numbers=(replace(first.numbers[0], nominal=nominal),))
    assert len(findings(NOTES, (), {}, (), replace(found, sets=(alone,), together=None))) == count


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"answer": "yes"}, "some arm in range does it"),
        ({"answer": "no"}, "no arm in range among 10 does it: nearest 1.2 s"),
        ({"answer": "no", "nearest": None}, "no arm in range among 10 settles"),
        ({"answer": "between"}, "arms in range do more and less"),
        ({"answer": "no part"}, "no assumption has a part in it: 1.2 s for all arms seen"),
    ],
)
def test_answers_in_words(changed: dict[str, Any], sentence: str) -> None:
    assert answer_words(number(**changed)).startswith(sentence)


def test_small_shares_are_not_what_a_number_hangs_on():
    assumed = tuple(AssumedRow(name, name, "", 0.0, 0.0, 0.0) for name in ("a", "b", "c"))
    about = StudyRow("arm", "", 0, 0, 0, False, 0, assumed, (), None)
    assert hangs_words(number(shares={"a": 0.05, "b": 0.6, "c": 0.2}), about).endswith("on b 60 %, c 20 %")
    assert "no assumption" in hangs_words(number(shares={"a": 0.05, "b": 0.06, "c": 0.0}), about)
    assert "no assumption" in hangs_words(number(), about)


def test_ranges_and_values_in_words():
    assert span((1.0, None)) == "1 to not settled"
    assert span((None, None)) == "not settled"
    assert span((36.0, 36.0)) == "36"
    assert value_words(-0.0001, "°") == "0.000°"
    assert value_words(None, "s") == "not settled"


def test_counts_are_counted(found):
    yes = sum(entry.answer == "yes" for one in found.sets for entry in one.numbers)
    assert f"{yes} are what some arm in range does" in tally_words(found)
    assert "on 6 the arm has no influence" in tally_words(found)
    for ordered, words in ((0.0, "none of them puts"), (0.25, "25 % of them put the gain sets")):
        changed = with_together(found, ordered=ordered)
        assert changed.together is not None
        assert words in together_words(changed, changed.together)


def with_together(found, **changed):
    assert found.together is not None
    return replace(found, together=replace(found.together, **changed))


def test_an_arm_that_the_paper_did_not_run_has_no_such_part():
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains
    assert printed_experiment(gains, load("reyes-kelly2")) is None
    assert printed_experiment([replace(gains[0], m=9)], load("buap3-small")) is None


def test_a_report_takes_the_sets_that_it_is_about_from_the_study():
    """The study was run for the arm as it is now: run ``make study`` after a change of its numbers."""
    model = load("buap3")
    (first, *_, last) = read_gain_file(paper_gain_file("table2")).gains
    both = printed_experiment([replace(last, name="mine"), first], model)
    assert both is not None
    assert [(one.name, one.m) for one in both.sets] == [("tau_m1", 1), ("mine", 3)]
    assert both.together is None


def test_another_arm_of_that_name_has_no_such_part():
    model = load("buap3")
    name, number = next(iter(model.numbers.items()))
    other = replace(model, numbers=model.numbers | {name: replace(number, value=number.value * 2, high=None)})
    assert printed_experiment(read_gain_file(paper_gain_file("table2")).gains, other) is None
