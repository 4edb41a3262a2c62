"""Printed numbers: the formula over all roundings of its inputs, in one enclosure or many."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.functions import ends
from tests.statement_fuzz.oracle.numbers import DIGITS, Num, Undefined, Unsure, interval
from tests.statement_fuzz.oracle.region import Objection

CELLS = 64
Box = dict[str, tuple[Fraction, Fraction]]


def rounding(text: str) -> tuple[Fraction, Fraction]:
    """The reals that round to a printed number."""
    half = Fraction(10) ** int(Decimal(text).as_tuple().exponent) / 2
    return Fraction(text) - half, Fraction(text) + half


@kinds.objections_to("Agrees")
def agrees(statement: Any, random: Random) -> Objection | None:
    """Every part of the box of inputs gives results outside the printed one, or none at all."""
    low, high = rounding(statement.printed)
    box = {name: rounding(text) for name, text in statement.inputs}
    undefined = 0
    with mp.workdps(DIGITS), exact.kept(True):
        cells = list(_cells(box))
        for cell in cells:
            try:
                value = Evaluation(_inputs(cell)).of(statement.formula)
            except Undefined:
                undefined += 1
                continue
            except Unsure:
                return None
            below, above = ends(value)
            target = ends(interval(low, high, None))
            if not (above < target[0] or below > target[1]):
                return None
    what = "undefined" if undefined == len(cells) else "false"
    return Objection(what, "all inputs within their roundings")


def _inputs(cell: Box) -> dict[str, Num]:
    return {name: interval(*pair, exact.atom("input", name)) for name, pair in cell.items()}


def _cells(box: Box) -> Iterator[Box]:
    """The box cut along its sides in turn, until there are enough parts."""
    parts: list[Box] = [box]
    for name in list(box) * 3:
        if len(parts) * 2 > CELLS:
            break
        parts = [half for part in parts for half in _halves(part, name)]
    yield from parts


def _halves(part: Box, name: str) -> Iterator[Box]:
    low, high = part[name]
    middle = (low + high) / 2
    yield {**part, name: (low, middle)}
    yield {**part, name: (middle, high)}


@kinds.judges("Agrees")
def disagrees(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether no inputs give the printed result; too coarse an enclosure leaves it open."""
    result = agrees(statement, Random(0))
    if result is not None:
        return result.what == "false"
    return False if _some_inputs_agree(statement) else None


def _some_inputs_agree(statement: Any) -> bool:
    low, high = rounding(statement.printed)
    random = Random(1)
    with mp.workdps(DIGITS):
        for _ in range(200):
            point = {}
            for name, text in statement.inputs:
                a, b = rounding(text)
                point[name] = a + (b - a) * Fraction(random.randint(0, 100), 100)
            try:
                value = ends(Evaluation(point).of(statement.formula))
            except (Undefined, Unsure):
                continue
            target = ends(interval(low, high, None))
            if target[0] <= value[0] and value[1] <= target[1]:
                return True
    return False
