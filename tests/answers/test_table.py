"""The table: formats, digits found by ways that share no code with it, leading terms, budgets of an arm."""

import csv
import io
import json
from fractions import Fraction

import mpmath
import pytest
from flint import arb

from lyapcheck.answers.table import build_table, slope_at_zero
from lyapcheck.check.numbers.balls import precision
from lyapcheck.cli.values import parse_m
from tests.helpers.command import invoke
from tests.oracle.numbers import supremum


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
        ("10000", (10_000,)),
    ],
)
def test_members_are_read(text, members):
    assert parse_m(text) == members


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


def test_csv_has_a_line_for_each_member(table):
    rows = list(csv.DictReader(io.StringIO(table.written("csv"))))
    assert [row["m"] for row in rows] == ["1", "2", "3", "12"]
    assert rows[0]["gamma_at_lower"] == ""
    assert Fraction(rows[1]["L_lower"]) < Fraction(rows[1]["L_upper"])


SAMPLE = (2, 3, 4, 7, 19, 100, 333, 1000)
DIGITS = 50


@pytest.fixture(scope="module")
def rows():
    """What the table says of the sample: {m: row}."""
    table = build_table(SAMPLE, DIGITS)
    return {row["m"]: row for row in json.loads(table.written("json"))["rows"]}


@pytest.fixture(scope="module")
def shown():
    """The cells of the text: {m: [γ, ρ, L, x of γ, x of ρ, x of L]}."""
    result = {}
    for line in build_table(SAMPLE, DIGITS).written("text").splitlines():
        first, *cells = line.split() or [""]
        if first.isdecimal():
            result.setdefault(int(first), []).extend(cells)
    return result


@pytest.mark.slow
@pytest.mark.parametrize("m", [m for m in SAMPLE if 1 < m < 60])
def test_the_oracle_gives_the_same_digits(m, shown, rows):
    with mpmath.workdps(DIGITS + 25):
        for name, cell in zip(("gamma", "rho", "L"), shown[m], strict=False):
            low, high = (mpmath.mpf(rows[m][name][end]) for end in ("lower", "upper"))
            value = supremum(name, m, DIGITS + 15)
            assert low <= value <= high
            assert mpmath.nstr(value, DIGITS + 10, strip_zeros=False).startswith(cell)


@pytest.mark.parametrize("m", SAMPLE)
def test_the_extreme_lies_between_its_value_at_the_place_and_what_the_slope_can_add(m, rows):
    with precision(2000):
        for name, function in (("gamma", h), ("L", lambda m, x: h(m, x) / x), ("rho", dh)):
            low, high = (arb(rows[m][name][end]) for end in ("lower", "upper"))
            x = (arb(rows[m][f"{name}_at"]["lower"]) + arb(rows[m][f"{name}_at"]["upper"])) / 2
            value = function(m, x)
            assert low < value < high
            assert high - low < arb(10) ** (3 - DIGITS) * m


def h(m, x):
    s = x.sinh()
    return s ** (2 * m - 1) * x.cosh() / (1 + s ** (2 * m))


def dh(m, x):
    s = x.sinh()
    top = (2 * m - 1) * s ** (2 * m - 2) + 2 * m * s ** (2 * m) - s ** (4 * m - 2)
    return top / (1 + s ** (2 * m)) ** 2


def run(*arguments):
    return invoke("table", *arguments)


def test_the_slope_at_0_is_that_of_the_symbolic_derivative():
    import sympy as sp

    x = sp.Symbol("x")
    for m in (1, 2, 3):
        assert symbolic_slope(sp, m, x) == slope_at_zero(m)
    rows = json.loads(run("--m", "1:4", "--format", "json").stdout)["rows"]
    assert [row["slope_at_0"] for row in rows] == ["1", "0", "0", "0"]


def symbolic_slope(sp, m, x):
    s = sp.sinh(x)
    return sp.diff(s ** (2 * m - 1) * sp.cosh(x) / (1 + s ** (2 * m)), x).subs(x, 0)


def test_certificates_bound_gamma_and_rho_as_they_are_shown(tmp_path):
    found = run("--m", "1:2", "--digits", "12", "--certificates", str(tmp_path), "--format", "json")
    assert found.exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {
        f"m{m}.{name}.json" for m in (1, 2) for name in ("gamma", "rho")
    }
    upper = json.loads(found.stdout)["rows"][1]["gamma"]["upper"]
    statement = json.loads((tmp_path / "m2.gamma.json").read_text(encoding="utf-8"))["statement"]
    assert statement["bound"] == ["num", str(Fraction(upper))]
    assert "4 accepted (4 proved" in invoke("recheck", str(tmp_path)).stdout
