"""The table command, from its argument to its five formats."""

import csv
import io
import json
from fractions import Fraction

import mpmath
import pytest

from lyapcheck.answers.table import build_table
from lyapcheck.cli.values import parse_m
from lyapcheck.errors import InputError


@pytest.fixture(scope="module")
def table():
    return build_table((1, 2, 3, 12), 30)


@pytest.mark.parametrize(
    ("text", "members"),
    [
        ("3", (3,)),
        ("1,2,5", (1, 2, 5)),
        ("1:4", (1, 2, 3, 4)),
        ("5, 1:2 ,2", (1, 2, 5)),
        ("7:7", (7,)),
        ("100000", (100_000,)),
    ],
)
def test_members_are_read(text, members):
    assert parse_m(text) == members


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("", ["''"]),
        ("0", ["0"]),
        ("-1", ["-1"]),
        ("2.5", ["2.5"]),
        ("1e3", ["1e3"]),
        ("nan", ["nan"]),
        ("5:2", ["5:2"]),
        ("1:2:3", ["1:2:3"]),
        ("1:", ["1:"]),
        ("100001", ["100001"]),
        ("9" * 5000, ["9" * 5000]),
        ("²", ["²"]),
        ("0,2,x", ["0", "x"]),
    ],
)
def test_bad_members_are_all_named(text, values):
    with pytest.raises(InputError) as caught:
        parse_m(text)
    assert sorted(problem.value for problem in caught.value.problems) == values
    assert all(problem.rule and problem.repair for problem in caught.value.problems)


def test_json_bounds_enclose_and_agree_to_the_digits_asked(table):
    data = json.loads(table.written("json"))
    assert data["schema"] == "lyapcheck/table/1"
    assert [row["m"] for row in data["rows"]] == [1, 2, 3, 12]
    for row, exact in zip(data["rows"], table.rows, strict=True):
        for name in ("gamma", "rho", "L", "gamma_at", "rho_at", "L_at"):
            value = getattr(exact, name)
            if value is None:
                assert row[name] is None
                continue
            low, high = Fraction(row[name]["lower"]), Fraction(row[name]["upper"])
            assert low <= value.lower <= value.upper <= high
            assert high - low <= Fraction(2, 10**29) * max(1, value.upper)


def test_known_values_appear(table):
    """γ_2 and ρ_1 by mpmath from closed forms: u = 2 + √7 at the peak, h_1' = sech²."""
    text = table.written("text")
    with mpmath.workdps(40):
        u = 2 + mpmath.sqrt(7)
        gamma = u ** mpmath.mpf("1.5") * mpmath.sqrt(1 + u) / (1 + u**2)
        assert str(gamma)[:31] in text
    assert "γ_2 = 1.05: not an upper bound" in text
    assert "γ_1 = 1: an upper bound" in text


def test_csv_has_a_line_for_each_member(table):
    rows = list(csv.DictReader(io.StringIO(table.written("csv"))))
    assert [row["m"] for row in rows] == ["1", "2", "3", "12"]
    assert rows[0]["gamma_at_lower"] == ""
    assert Fraction(rows[1]["L_lower"]) < Fraction(rows[1]["L_upper"])


def test_fewer_digits_are_a_prefix_of_more():
    few, many = (build_table((2,), digits).document().blocks[1].rows[0] for digits in (5, 25))
    assert all(b.startswith(a) for a, b in zip(few, many, strict=True))
    assert sum(map(len, few)) < sum(map(len, many))
