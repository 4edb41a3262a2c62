"""A thousand members to 50 digits: fast, and every digit right by ways that share no code with the table."""

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
from flint import arb

from lyapcheck.answers.table import build_table
from lyapcheck.check.numbers.balls import hyperbolic_constants, precision
from tests.oracle.numbers import supremum

SCRIPT = str(Path(sys.executable).with_name("lyapcheck"))
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
    for line in build_table(range(1, 1001), DIGITS).written("text").splitlines():
        first, *cells = line.split() or [""]
        if first.isdecimal():
            result.setdefault(int(first), []).extend(cells)
    return result


@pytest.mark.slow
def test_a_thousand_rows_of_fifty_digits():
    done = subprocess.run(
        [SCRIPT, "table", "--m", "1:1000", "--digits", "50"], capture_output=True, text=True, check=True
    )
    assert done.stdout.count("\n") > 2000


@pytest.mark.slow
def test_every_digit_shown_is_that_of_an_enclosure_of_120_digits(shown):
    assert set(shown) == set(range(1, 1001))
    for m in range(2, 1001):
        exact = hyperbolic_constants(m, 120)
        values = (exact.gamma, exact.rho, exact.L, exact.gamma_at, exact.rho_at, exact.L_at)
        for cell, value in zip(shown[m][:6], values, strict=True):
            unit = Fraction(1, 10 ** len(cell.partition(".")[2]))
            assert len(cell.replace(".", "").lstrip("0")) >= DIGITS - 1
            assert Fraction(cell) <= value.lower <= value.upper < Fraction(cell) + unit


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
def test_the_slope_changes_sign_within_one_unit_of_the_places(m, rows):
    """Straight from (6) and (8) in balls of 2000 bits: h' at the place of γ, (h/x)' at that of L."""
    with precision(2000):
        for name, slope in (("gamma_at", dh), ("L_at", secant_slope)):
            low, high = (arb(rows[m][name][end]) for end in ("lower", "upper"))
            assert slope(m, low) > 0
            assert slope(m, high) < 0


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


def secant_slope(m, x):
    return x * dh(m, x) - h(m, x)
