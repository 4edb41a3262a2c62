"""Bounds of motions: as the search finds them, and with one number a little or far too good."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any

from tests.statement_fuzz.generators import TRUE, Made, generates
from tests.statement_fuzz.generators.robots import scaled
from tests.statement_fuzz.motions import ASKED, found
from tests.statement_fuzz.subject import Settling

BETTER = (Fraction(999, 1000), Fraction(9, 10), Fraction(1, 2), Fraction(1, 20), Fraction(0))
LEAST = Fraction(1, 10**6)
WORSE = (Fraction(1001, 1000), Fraction(11, 10), Fraction(2), Fraction(20))
SMALLER = ("errors", "largest_errors", "kp", "viscous", "kv", "parameters")
LARGER = ("errors_at_start", "rates_at_start", "torque", "dry")


def factored(value: Any, factor: Fraction, least: Fraction = Fraction(0)) -> Any:
    """A number, or the lower end of a range, so many times as large."""
    if isinstance(value, tuple):
        low = max(value[0], least) * factor
        return low, max(low, value[1])
    return max(value, least) * factor


def _with(statement: Settling, name: str, factor: Fraction, least: Fraction = Fraction(0)) -> Settling:
    values = tuple(factored(x, factor, least) for x in getattr(statement, name))
    return replace(statement, **{name: values})


def _earlier(statement: Settling, factor: Fraction) -> Settling:
    (first, level), *rest = statement.envelope
    return replace(
        statement, envelope=((first, level), *((first + (t - first) * factor, v) for t, v in rest))
    )


def _lower(random: Random, statement: Settling, factor: Fraction) -> Settling:
    """All levels, the last or the first one lower."""
    rows: list[Any] = list(statement.envelope)
    chosen = random.choice((range(len(rows)), [0], [len(rows) - 1]))
    for k in chosen:
        rows[k] = (rows[k][0], rows[k][1] * factor)
    return replace(statement, envelope=tuple(rows))


@generates("Settling", 0.6)
def settling(random: Random) -> Made:
    """A bound of a motion."""
    statement, _ = found(random.choice((*range(4), *range(4), *range(len(ASKED)))))
    kind = random.random()
    if kind < 0.1:
        return Made(statement, "a bound of a motion", TRUE)
    if kind < 0.2:
        name = random.choice(("errors", "largest_errors"))
        return Made(_with(statement, name, random.choice(WORSE)), "a larger bound of a motion", TRUE)
    return _altered(random, statement)


def _altered(random: Random, statement: Settling) -> Made:
    """One number changed in a way that may make it false."""
    kind, better, worse = random.random(), random.choice(BETTER), random.choice(WORSE)
    if kind < 0.25:
        return Made(_earlier(statement, better or BETTER[-2]), "an earlier time")
    if kind < 0.45:
        return Made(_lower(random, statement, better), "a lower level")
    if kind < 0.7:
        name = random.choice(SMALLER)
        return Made(_with(statement, name, better), f"smaller {name}")
    if kind < 0.9:
        name = random.choice(LARGER)
        return Made(_with(statement, name, worse, LEAST), f"larger {name}")
    mass = tuple(tuple(scaled(entry, worse) for entry in row) for row in statement.mass)
    return Made(replace(statement, mass=mass), "a heavier arm")
