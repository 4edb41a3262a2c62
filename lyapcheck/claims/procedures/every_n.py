"""Identities for every n, proved by normal forms of words xᵀ A B … y and refuted by entries for some n.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from lyapcheck.check.expressions.expression import Unsupported
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.every_n import (
    EntriesWitness,
    EveryN,
    at_size,
    in_words,
    moved_at,
    names_of,
    rates_fit,
)
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.letters.entries import exact
from lyapcheck.check.refusal import Refused
from lyapcheck.claims.procedures.search import Point, point_of
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.rechecking.drawn_entries import doubt_identity, drawn, solved_at

METHOD = "identity for every n"
SIZES = (1, 2, 3)
TRIES = 4
SEED = 1


@procedure(EveryN)
def find_every_n(statement: EveryN) -> SearchResult:
    """Try the normal forms in words, then entries for n = 1, 2, 3."""
    try:
        statement.require_well_formed()
        if not rates_fit(statement):
            return still_open("a symmetric matrix has a derivative that is not; correct it", METHOD)
        if is_zero(in_words(statement)):
            return _proved(statement)
    except Refused as refusal:
        return still_open(f"{refusal}; correct the statement", METHOD)
    except Unsupported as problem:
        return still_open(f"{problem}; write both sides in sums, products and quotients", METHOD)
    seen = "no entries for n = 1, 2, 3 tell the sides apart"
    for n, point in _attempts(statement):
        try:
            result = _difference(statement, n, point)
            moved_at(statement, n, point)
        except Refused as refusal:
            seen = str(refusal)
            continue
        except (Unsupported, ZeroDivisionError):
            continue
        if result is not None:
            return result
    return still_open(f"the normal forms differ, but {seen}; compare by hand", METHOD)


def _proved(statement: EveryN) -> SearchResult:
    """Equal words, unless entries that are drawn say otherwise, or none are found."""
    try:
        doubt_identity(statement)
    except Refused as doubt:
        return still_open(str(doubt), METHOD)
    return shown(NormalForm(), f"{METHOD}: equal normal forms in words of vectors and matrices")


def _attempts(statement: EveryN) -> Iterator[tuple[int, Point]]:
    """Entries that meet what is given: small rational numbers, then one linear system for each vector."""
    random = Random(SEED)
    for n in SIZES:
        for _ in range(TRIES):
            names = names_of(statement, n)
            try:
                yield n, solved_at(statement, n, drawn(names, statement.positive, random))
            except (Unsupported, ZeroDivisionError):
                continue


def _difference(statement: EveryN, n: int, point: Point) -> SearchResult | None:
    """The finding that both sides differ at a point, if they do."""
    sides, _ = at_size(statement, n)
    left, right = (exact(side, point) for side in sides)
    if left == right:
        return None
    data = failing({"n": n, **dict(sorted(point.items()))}, [str(left)] * 2, "=", [str(right)] * 2)
    return broken(EntriesWitness(n, point_of(point)), f"{METHOD}: entries at which the sides differ", data)
