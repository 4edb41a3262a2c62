"""Identities, proved by normal forms over ℚ and refuted by a point where both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import islice

from lyapcheck.check.expressions.expression import Unsupported
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.identity import Identity, NormalForm, gap_of
from lyapcheck.claims.procedures.search import Point, first_refutation, witness_data, witness_of
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open

METHOD = "identity"
TRIES, FIRST = 12, 2


@procedure(Identity)
def find_identity(statement: Identity) -> SearchResult:
    """Try a few points where both sides may differ, then the normal forms, then more points."""
    places = points(statement)
    refuted = _refuted(statement, islice(places, FIRST))
    if refuted is not None:
        return refuted
    try:
        if is_zero(gap_of(statement)):
            return shown(NormalForm(), f"{METHOD}: equal normal forms over the rationals")
        advice = (
            "the normal forms differ but no point tells the sides apart; apply laws of log or atan by hand"
        )
    except Unsupported as problem:
        advice = f"{problem}; rewrite both sides in polynomials, exp, sinh, cosh, sin, cos"
    return _refuted(statement, places) or still_open(advice, METHOD)


def _refuted(statement: Identity, places: Iterator[Point]) -> SearchResult | None:
    result = first_refutation((statement.left, "=", statement.right), places)
    if result is None:
        return None
    return broken(witness_of(result), f"{METHOD}: a point where the sides differ", witness_data(result))


def points(statement: Identity) -> Iterator[Point]:
    """Rational points without symmetry: variables get different values, of both signs where they may."""
    lows = {variable.name: variable.low for variable in statement.variables}
    for k in range(TRIES):
        spread = {name: _spread(k, i) for i, name in enumerate(sorted(statement.names))}
        yield {
            name: value if (low := lows.get(name)) is None else low + abs(value)
            for name, value in spread.items()
        }


def _spread(k: int, i: int) -> Fraction:
    """A fixed low-discrepancy rational in (-2, 2), never 0, positive for k = 0."""
    value = Fraction((37 * (i + 1) + 101 * k) % 997 + 1, 499)
    return value if k == 0 else value * (-1) ** (i * k)
