"""Inequalities in one variable that others have published: each is proved, and refuted once it is sharpened.

The second statement of a row is its negative control: the same inequality with a constant, a power or an end
of the interval changed a little beyond what is true. Keys are those of proofs/references.bib.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from lyapcheck.claims import ForAll, atan, cos, exp, expr, for_all, log, pi, sin, sinh, sqrt, tanh, var
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Grade, Verdict
from tests.helpers.shares import one_in

BIBLIOGRAPHY = Path(__file__).parents[2] / "proofs" / "references.bib"


class Row(NamedTuple):
    """A published inequality, where it is printed, and a false neighbour of it."""

    name: str
    key: str
    place: str
    holds: ForAll
    fails: ForAll


# The circular inequalities end at π/2 or π: a rational end just below stands for it.
x = var("x")
HARRISON = x + expr("8388676") / 2**24 * x**2 + expr("11184876") / 2**26 * x**3
HARRISON_END = "0.010831"
TANG = expr("23/27") / 2**33


def right_of_0(relation):
    """For every x > 0."""
    return for_all(relation, 0, open_low=True)


def up_to(high, relation):
    """For every x with 0 < x <= high."""
    return for_all(relation, 0, high, open_low=True)


def tan(of):
    """The tangent."""
    return sin(of) / cos(of)


HYPERBOLIC = [
    Row(
        "(sinh x / x)² + tanh x / x > 2, hyperbolic Wilker",
        "zhu2007wilker",
        "Theorem 2",
        right_of_0((sinh(x) / x) ** 2 + tanh(x) / x > 2),
        right_of_0((sinh(x) / x) ** 2 + tanh(x) / x > expr("2.0001")),
    ),
    Row(
        "sinh x / x < (π² + x²)/(π² − x²), hyperbolic Redheffer",
        "zhu2008redheffer",
        "Theorem 2",
        up_to("3.14", sinh(x) / x < (pi**2 + x**2) / (pi**2 - x**2)),
        up_to("3.14", sinh(x) / x < (pi**2 + x**2 / 12) / (pi**2 - x**2 / 2)),
    ),
]

LOGARITHM = [
    Row(  # equality inside is not decided, so the published half-line begins beside it
        "ln x ≤ x − 1, right of the equality at 1",
        "olver2010nist",
        "4.5.4",
        for_all(log(x) <= x - 1, "1.001"),
        for_all(log(x) <= x - expr("1.0001"), "1.001"),
    ),
    Row(
        "ln(1 + x) ≤ x(6 + x)/(6 + 4x), Padé",
        "topsoe2007logarithm",
        "Table 1",
        for_all(log(1 + x) <= x * (6 + x) / (6 + 4 * x), 0),
        for_all(log(1 + x) <= x * (6 + x) / (6 + expr("4.01") * x), 0),
    ),
]

EXPONENTIAL = [
    Row(
        "e^r below the cubic of a floating-point exp plus 23/27 · 2⁻³³",
        "harrison1997polynomial",
        "the bound on the exponential's approximation",
        for_all(exp(x) - 1 - HARRISON <= TANG, "-" + HARRISON_END, HARRISON_END),
        for_all(exp(x) - 1 - HARRISON <= expr("0.9") * TANG, "-" + HARRISON_END, HARRISON_END),
    )
]

ARC_TANGENT = [
    Row(
        "3x/(1 + 2√(1 + x²)) < atan x, Shafer",
        "shafer1966problem",
        "Problem E 1867",
        right_of_0(3 * x / (1 + 2 * sqrt(1 + x**2)) < atan(x)),
        right_of_0(expr("3.001") * x / (1 + 2 * sqrt(1 + x**2)) < atan(x)),
    ),
    Row(
        "atan x < 8x/(3 + √(25 + 256x²/π²))",
        "zhu2008shafer",
        "Theorem 1",
        right_of_0(atan(x) < 8 * x / (3 + sqrt(25 + 256 * x**2 / pi**2))),
        right_of_0(atan(x) < 8 * x / (3 + sqrt(25 + 260 * x**2 / pi**2))),
    ),
]

CIRCULAR = [
    Row(
        "2x/π ≤ sin x, Jordan",
        "mitrinovic1970analytic",
        "2.3.1; olver2010nist 4.18.1",
        for_all(2 * x / pi <= sin(x), 0, "1.5707"),
        for_all(expr("0.6367") * x <= sin(x), 0, "1.5707"),
    ),
    Row(
        "8/(π² − 4x²) < tan x / x, Becker–Stark",
        "becker1978hierarchy",
        "left",
        up_to("1.57", expr(8) / (pi**2 - 4 * x**2) < tan(x) / x),
        up_to("1.57", expr("8.1") / (pi**2 - 4 * x**2) < tan(x) / x),
    ),
]

TABLE = [*HYPERBOLIC, *LOGARITHM, *EXPONENTIAL, *ARC_TANGENT, *CIRCULAR]


@pytest.mark.parametrize("row", one_in(3, TABLE), ids=lambda row: row.name)
def test_a_published_inequality_is_proved(row):
    decision = propose(row.holds)
    assert decision.verdict is Verdict.PROVED, decision
    assert decision.grade in (Grade.ENCLOSURE, Grade.EXACT)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.name)
def test_its_false_neighbour_is_refuted(row):
    assert propose(row.fails).verdict is Verdict.REFUTED


def test_every_inequality_is_cited():
    known = BIBLIOGRAPHY.read_text(encoding="utf-8")
    assert [row.name for row in TABLE if f"{{{row.key}," not in known] == []
    assert len({row.name for row in TABLE}) == len(TABLE) >= 9
