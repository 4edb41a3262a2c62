"""Polynomials of an arm that should be the same: by their harmonics, else a posture that tells them apart."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from lyapcheck.check.kinds.identity import Compared, Gap, MovingPosture, SameHarmonics, differences
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.claims.procedures.search import BITS
from lyapcheck.claims.search_result import (
    SearchResult,
    broken,
    entries,
    failing,
    procedure,
    shown,
    still_open,
)

METHOD = "comparison of polynomials in normal form"
TRIES = 40


@procedure(Compared)
def find_compared(statement: Compared) -> SearchResult:
    """The harmonics of all differences, else a posture at which the first that is left is not 0."""
    gap = next((gap for gap in statement.gaps() if gap[2]), None)
    if gap is None:
        return shown(SameHarmonics(), METHOD)
    for posture in _postures(statement, gap):
        with precision(BITS):
            value = next(value for place, value in differences(statement, posture) if place == gap[0])
            if value.contains(0):
                continue
            left = Enclosure.from_arb(value)
        rates = posture.x if any(rates for _, rates, _ in statement.gaps()) else ()
        witness = failing(entries(q=posture.q, p=posture.parameters, w=rates), left, "=", 0)
        return replace(broken(posture, METHOD, witness), reason=f"they differ in {_words(gap)}")
    return still_open(f"they differ in {_words(gap)}, and no posture shows it; compare by hand", METHOD)


def _words(gap: Gap) -> str:
    place, rates, _ = gap
    factor = " ".join(f"w{k + 1}" for k in rates)
    return f"{place} (the factor of {factor})" if rates else place


def _postures(statement: Compared, gap: Gap) -> Iterator[MovingPosture]:
    """Angles without symmetry, ends of the ranges of parameters, and rates: those of the gap first."""
    joints = range(statement.joints)
    chosen = tuple(Fraction(int(k in gap[1] or not gap[1])) for k in joints)
    for step in range(1, TRIES):
        q = tuple(Fraction(step * (2 * i + 1), 2 * i + 2) for i in joints)
        parameters = tuple(ends[step % 2] for ends in statement.parameters)
        yield MovingPosture(q, parameters, chosen)
        yield MovingPosture(q, parameters, tuple(Fraction(i + 1) for i in joints))
