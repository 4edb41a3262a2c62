"""Upper bounds for every n by norms: for each term a product of norms is chosen so that all fit in the bound.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from flint import ctx, fmpq

from lyapcheck.check.expressions.expression import Tree, Unsupported, ball
from lyapcheck.check.kinds.bound_every_n import (
    BoundEveryN,
    Cover,
    CoveredTerms,
    Term,
    at_size,
    bound_of,
    drawn_entries,
    terms_in_words,
    terms_of,
    written_letters,
)
from lyapcheck.check.kinds.every_n import EntriesWitness
from lyapcheck.check.letters.words import Words
from lyapcheck.check.numbers.enclosure import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.claims.finding import Finding, broken, shown, still_open
from lyapcheck.claims.procedures.search import BITS, point_of

METHOD = "norms for every n"
TRIES = 60
Spare = dict[tuple[tuple[str, int], ...], fmpq]


def find_bound_every_n(statement: BoundEveryN) -> Finding:
    """Choose covers term by term, going back where the bound has no room left."""
    try:
        statement.require_well_formed()
        found, words = terms_in_words(statement)
        spare = {_key(powers): c for c, powers in terms_of(statement.right)}
    except (Refused, Unsupported) as problem:
        return still_open(f"{problem}; write both sides as polynomials in the letters", METHOD)
    covers = _chosen(statement, words, found, spare)
    if covers is None:
        against = _against(statement)
        if against is not None:
            return against
        return still_open("no choice of norms keeps the terms within the bound; enlarge the bound", METHOD)
    return shown(CoveredTerms(covers), f"{METHOD}: every term within its part of the bound")


def _against(statement: BoundEveryN) -> Finding | None:
    """Entries that meet all bounds of the norms and break the statement."""
    for n, point, sign in drawn_entries(statement, TRIES):
        if sign < 0:
            left, right = at_size(statement, n)[0]
            balls = {name: ball_of(x) for name, x in point.items()}
            with ctx.workprec(BITS):
                sides = (Enclosure.from_arb(ball(side, balls)).decimals(12) for side in (left, right))
            data = dict(zip(("left", "right"), map(list, sides), strict=True)) | {"operator": "<="}
            shown_at = {"n": str(n), **{name: str(x) for name, x in sorted(point.items())}}
            proof = EntriesWitness(n, point_of(point))
            return broken(proof, f"{METHOD}: entries that break the bound", {"point": shown_at, **data})
    return None


def _chosen(
    statement: BoundEveryN, words: Words, terms: list[Term], spare: Spare
) -> tuple[Cover, ...] | None:
    """A cover of each term, such that what is left of the bound has no negative coefficient."""
    if not terms:
        return () if all(c >= 0 for c in spare.values()) else None
    for cover, bound in _covers(statement, words, terms[0]):
        left = dict(spare)
        for c, powers in terms_of(bound):
            left[_key(powers)] = left.get(_key(powers), fmpq(0)) - c
            if c > 0 and left[_key(powers)] < 0:
                break
        else:
            rest = _chosen(statement, words, terms[1:], left)
            if rest is not None:
                return (cover, *rest)
    return None


def _covers(statement: BoundEveryN, words: Words, term: Term) -> Iterator[tuple[Cover, Tree]]:
    """The covers of a term, each with the bound that it gives."""
    least = (Cover((), k) for k in range(len(statement.least)))
    written = written_letters(words, term[1])
    norms = (Cover(choice) for letters in written for choice in _norms(statement, letters))
    for cover in (*least, *dict.fromkeys(norms)):
        try:
            yield cover, bound_of(statement, words, term, cover)
        except (Refused, ValueError):
            continue


def _norms(statement: BoundEveryN, letters: Counter[Tree]) -> Iterator[tuple[int, ...]]:
    """The ways to cover all letters that are not numbers, each by one of the norms known."""
    first = min((letter for letter in letters if letter[0] != "var"), default=None)
    if first is None:
        yield ()
        return
    for index, (known, _) in enumerate(statement.norms):
        taken = Counter(known)
        if first in taken and taken <= letters:
            for rest in _norms(statement, letters - taken):
                yield (index, *rest)


def _key(powers: dict[str, int]) -> tuple[tuple[str, int], ...]:
    return tuple(sorted(powers.items()))
