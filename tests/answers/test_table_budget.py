"""What the table says for one arm, and for m → ∞."""

import csv
import io
import json
from fractions import Fraction

import pytest
from flint import arb

from lyapcheck.answers.gate import gate
from lyapcheck.answers.table import LIMITS
from lyapcheck.check.numbers.balls import precision
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from tests.helpers.command import invoke


def run(*arguments):
    return invoke("table", *arguments)


def test_the_budget_is_the_limit_that_the_gate_judges_by():
    rows = json.loads(run("--m", "1:3", "--digits", "20", "--robot", "buap3", "--format", "json").stdout)[
        "rows"
    ]
    results = gate(read_gain_file(paper_gain_file("table2")))
    for row, result in zip(rows, results, strict=True):
        limits = [check.limit for check in result.checks if check.id == "10p"]
        assert [entry["joint"] for entry in row["budget"]] == ["base", "shoulder", "elbow"]
        for entry, limit in zip(row["budget"], limits, strict=True):
            low, high = (Fraction(entry["limit"][end]) for end in ("lower", "upper"))
            assert low <= limit.upper
            assert limit.lower <= high
            assert high - low < Fraction(1, 10**17)


def test_many_digits_of_the_budget_are_as_good_as_those_of_the_constants():
    command = ("--m", "2", "--digits", "200", "--robot", "buap3", "--format", "json")
    ends = json.loads(run(*command).stdout)["rows"][0]["budget"][0]["limit"]
    low, high = (Fraction(ends[end]) for end in ("lower", "upper"))
    assert high - low <= Fraction(2, 10**198)


def test_a_joint_without_a_torque_limit_has_no_budget():
    command = ("--m", "2", "--robot", "pelican2")
    (row,) = json.loads(run(*command, "--format", "json").stdout)["rows"]
    assert [entry["limit"] for entry in row["budget"]] == [None, None]
    assert "none" in run(*command).stdout


def test_csv_and_latex_have_a_column_for_each_joint():
    command = ("--m", "1:4", "--robot", "buap3", "--digits", "6")
    rows = list(csv.DictReader(io.StringIO(run(*command, "--format", "csv").stdout)))
    assert [row["m"] for row in rows] == ["1", "2", "3", "4"]
    assert all(Fraction(row["budget_elbow_lower"]) < Fraction(row["budget_elbow_upper"]) for row in rows)
    assert run(*command, "--format", "latex").stdout.count(r"\begin{tabular}") == 2


def test_an_unknown_arm_is_refused():
    with pytest.raises(InputError, match="neither a built-in arm"):
        raise run("--robot", "buap4").exception


@pytest.mark.parametrize("form", ["text", "markdown"])
def test_the_limits_for_large_m_are_told_and_right(form):
    assert LIMITS in " ".join(run("--m", "2", "--format", form).stdout.split())
    with precision(80):
        limit = arb(2).sqrt() / arb(1).asinh()
        assert arb("1.6045") < limit < arb("1.6046")
