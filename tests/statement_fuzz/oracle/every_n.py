"""Identities in vectors and matrices: entries at which the sides differ."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.entries import all_letters, meets, places, shown_entries
from tests.statement_fuzz.oracle.letters import Entries, Values
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure
from tests.statement_fuzz.oracle.region import Objection, holds


@kinds.objections_to("EveryN")
def every_n(statement: Any, random: Random) -> Objection | None:
    """Entries at which the sides differ, or one of them is undefined."""
    with mp.workdps(DIGITS):
        for at in places(statement, random):
            try:
                if not meets(statement, at):
                    continue
                equal = holds("=", at.of(statement.left), at.of(statement.right))
            except Undefined as why:
                return Objection("undefined", f"{shown_entries(at)} ({why})")
            except Unsure:
                continue
            if not equal:
                return Objection("false", shown_entries(at))
    return None


@kinds.judges("EveryN")
def entries_refute(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether entries refute an identity."""
    point = dict(witness["point"])
    n = int(point.pop("n"))
    values: Values = {}
    for sort, name in all_letters(statement):
        values[sort, name] = _read(sort, name, n, point, name in statement.symmetric)
    at = Entries(values, n, dict(statement.rates))
    try:
        positive = getattr(statement, "positive", ()) or ()
        ranges = all(values.get(("var", name), 1) > 0 for name in positive)
        return (
            ranges and meets(statement, at) and not holds("=", at.of(statement.left), at.of(statement.right))
        )
    except Undefined:
        return False
    except Unsure:
        return None


def _read(sort: str, name: str, n: int, point: Mapping[str, str], symmetric: bool) -> Any:
    """The value of a letter; an entry that the witness does not give does not matter and is 1."""
    if sort == "var":
        return Fraction(point.get(name, "1"))
    if sort == "vec":
        return [Fraction(point.get(f"{name}[{i + 1}]", "1")) for i in range(n)]

    def entry(i: int, j: int) -> Fraction:
        i, j = (min(i, j), max(i, j)) if symmetric else (i, j)
        return Fraction(point.get(f"{name}[{i + 1},{j + 1}]", "1"))

    return [[entry(i, j) for j in range(n)] for i in range(n)]
