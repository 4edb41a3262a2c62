"""Products of norms: values of the symbols at which every choice of majorants exceeds the bound."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure, Value, sign
from tests.statement_fuzz.oracle.region import Objection, shown

TRIES = 40


@kinds.objections_to("NormChain")
def norm_chain(statement: Any, random: Random) -> Objection | None:
    """Each factor as large as its smallest majorant allows, against the bound."""
    with mp.workdps(DIGITS), exact.kept(True):
        for majorant in (statement.bound, *(m for factor in statement.factors for m in factor)):
            try:
                Evaluation({}).of(majorant.constant)
            except Undefined as why:
                return Objection("undefined", f"every point ({why})")
            except Unsure:
                pass
        symbols = sorted({s for m in _majorants(statement) for s, _ in m.powers} | _paired(statement))
        for _ in range(TRIES):
            point = {
                s: Fraction(random.choice((0, 1, 1, 3, 10, 100)), random.choice((1, 2, 10))) for s in symbols
            }
            try:
                if _fits(statement, point) and _exceeds(statement, point):
                    return Objection("false", shown(point))
            except (Undefined, Unsure):
                continue
    return None


def _majorants(statement: Any) -> list[Any]:
    return [statement.bound, *(m for factor in statement.factors for m in factor)]


def _paired(statement: Any) -> set[str]:
    return {symbol for pair in statement.smaller for symbol in pair}


def _fits(statement: Any, point: dict[str, Fraction]) -> bool:
    return all(point[a] <= point[b] for a, b in statement.smaller)


def _exceeds(statement: Any, point: dict[str, Fraction]) -> bool:
    """Whether Π min exceeds the bound; a majorant below zero bounds no factor, and nothing is said."""
    product: Value = Fraction(1)
    for factor in statement.factors:
        values = [_value(majorant, point) for majorant in factor]
        if not values or any(sign(value) < 0 for value in values):
            return False
        least = values[0]
        for value in values[1:]:
            least = value if sign(least - value) > 0 else least
        product = product * least
    return sign(product - _value(statement.bound, point)) > 0


def _value(majorant: Any, point: dict[str, Fraction]) -> Value:
    result = Evaluation({}).of(majorant.constant)
    for symbol, k in majorant.powers:
        result = result * point[symbol] ** k
    return result
