"""Identities in vectors and matrices: entries at which the sides differ."""

from __future__ import annotations

from collections.abc import Mapping
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.entries import all_letters, meets, places, read_letter, shown_entries
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
        values[sort, name] = read_letter(sort, name, n, point, name in statement.symmetric)
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
