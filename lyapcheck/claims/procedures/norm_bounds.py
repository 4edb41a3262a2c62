"""Upper bounds for every n by norms: for each term a product of norms is chosen so that all fit in the bound.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import chain

from flint import arb, ctx

from lyapcheck.check.expressions.expression import Tree, Unsupported, ball
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.kinds.bound_every_n import (
    BoundEveryN,
    Cover,
    CoveredTerms,
    Term,
    at_size,
    bound_of,
    terms_in_words,
    within,
    written_letters,
)
from lyapcheck.check.kinds.every_n import EntriesWitness
from lyapcheck.check.letters.words import Words
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.search import BITS, point_of
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.rechecking.drawn_entries import doubt_bound, drawn_entries

METHOD = "norms for every n"
TRIES, TRIES_OF_ONE = 40, 1_000
"""How often entries are drawn for each n, and then for n = 1 alone: with one entry each no norms are lost, so
that a false bound breaks most often there, and a draw takes a millisecond."""
MOST_SHOWN = 2
Sizes = dict[tuple[int, ...], arb]
"""A ball for the coefficient of each monomial, by the exponents of all numbers of the statement."""
Option = tuple[Cover, Tree, Sizes]
Choice = tuple[tuple[Cover, Tree], ...]


@procedure(BoundEveryN)
def find_bound_every_n(statement: BoundEveryN) -> SearchResult:
    """Choose covers term by term, going back where the bound has no room left."""
    try:
        statement.require_well_formed()
    except (Refused, Unsupported) as problem:
        return still_open(f"{problem}; mend the statement", METHOD)
    try:
        result, words = terms_in_words(statement)
        names = sorted(statement.numbers)
        spare = _sizes(statement.right, names)
        options = [list(_options(statement, words, term, names)) for term in result]
    except (Refused, Unsupported) as problem:
        advice = f"{problem}; write both sides as polynomials in the letters"
        return _against(statement) or still_open(advice, METHOD)
    for chosen in _chosen(options, spare):
        if within(statement, [bound for _, bound in chosen]):
            try:
                doubt_bound(statement)
            except Refused as doubt:
                return still_open(str(doubt), METHOD)
            proof = CoveredTerms(tuple(cover for cover, _ in chosen))
            return shown(proof, f"{METHOD}: every term within its part of the bound")
    against = _against(statement)
    if against is not None:
        return against
    return still_open(_left_over(statement, result, options, spare), METHOD)


def _left_over(statement: BoundEveryN, result: list[Term], options: list[list[Option]], spare: Sizes) -> str:
    """Which term nothing bounds, or how much is missing with the first cover of each."""
    for term, choices in zip(result, options, strict=True):
        if not choices:
            return f"nothing that is known bounds the term {_term_text(term)}; give its letters a bound"
    names = sorted(statement.numbers)
    for choices in options:
        for key, c in choices[0][2].items():
            spare = spare | {key: spare.get(key, arb(0)) - c}
    missing = [(key, c) for key, c in spare.items() if c < 0]
    terms = " and ".join(
        _term_text((-c.mid(), dict(zip(names, key, strict=True)))) for key, c in missing[:MOST_SHOWN]
    )
    lacks = f": it lacks {terms}" if missing else ""
    return f"no choice of norms keeps the terms within the bound{lacks}; enlarge the bound"


def _term_text(term: tuple[object, dict[str, int]]) -> str:
    """A coefficient and the factors beside it."""
    c, powers = term
    size = f"{float(c):.4g}"  # type: ignore[arg-type]
    factors = [f"{name}^{k}" if k > 1 else name for name, k in powers.items() if k]
    return "·".join([size, *factors]).replace("-", "−")


def _against(statement: BoundEveryN) -> SearchResult | None:
    """Entries that meet all bounds of the norms and break the statement."""
    for n, point, sign in chain(
        drawn_entries(statement, TRIES), drawn_entries(statement, TRIES_OF_ONE, (1,))
    ):
        if sign < 0 and _stands(statement, EntriesWitness(n, point_of(point))):
            left, right = at_size(statement, n)[0]
            balls = {name: ball_of(x) for name, x in point.items()}
            with ctx.workprec(BITS):
                below, above = (Enclosure.from_arb(ball(side, balls)) for side in (left, right))
            witness = failing({"n": n, **dict(sorted(point.items()))}, below, "<=", above)
            proof = EntriesWitness(n, point_of(point))
            return broken(proof, f"{METHOD}: entries that break the bound", witness)
    return None


def _stands(statement: BoundEveryN, proof: EntriesWitness) -> bool:
    """Whether functions of time are at the entries; see ``every_n.moved_at``."""
    try:
        return verify(statement, proof).verdict == "refuted"
    except Refused:
        return False


def _chosen(options: list[list[Option]], spare: Sizes) -> Iterator[Choice]:
    """Covers of the terms such that no coefficient of what is left of the bound is surely negative."""
    if not options:
        if not any(c < 0 for c in spare.values()):
            yield ()
        return
    for cover, bound, sizes in options[0]:
        left = dict(spare)
        for key, c in sizes.items():
            left[key] = left.get(key, arb(0)) - c
            if c > 0 and left[key] < 0:
                break
        else:
            yield from (((cover, bound), *rest) for rest in _chosen(options[1:], left))


def _options(statement: BoundEveryN, words: Words, term: Term, names: list[str]) -> Iterator[Option]:
    """The covers of a term, each with the bound that it gives."""
    least = (Cover((), k) for k in range(len(statement.least)))
    written = written_letters(words, term[1])
    norms = (Cover(choice) for letters in written for choice in _norms(statement, letters))
    for cover in (*least, *dict.fromkeys(norms)):
        try:
            bound = bound_of(statement, words, term, cover)
            yield cover, bound, _sizes(bound, names)
        except (Refused, ValueError):
            continue


def _norms(statement: BoundEveryN, letters: Counter[Tree], start: int = 0) -> Iterator[tuple[int, ...]]:
    """The ways to cover all letters that are not numbers, and any of the numbers, by the norms known."""
    first = min((letter for letter in letters if letter[0] != "var"), default=None)
    if first is None:
        yield ()
    for index, (known, _) in enumerate(statement.norms):
        taken = Counter(known)
        wanted = first in taken if first is not None else index >= start
        if wanted and taken <= letters:
            for rest in _norms(statement, letters - taken, index if first is None else 0):
                yield (index, *rest)


def _sizes(tree: Tree, names: list[str]) -> Sizes:
    """A polynomial in the numbers of a statement, whose coefficients may contain constants such as √3.

    Raises:
        Unsupported: it is no such polynomial.
    """
    ratio, algebra = normal_form(tree)
    constants = algebra.constants()
    if not ratio.bottom.is_constant() or len(constants) < len(algebra.uses):
        raise Unsupported("a bound is not a polynomial in its numbers")
    lead = arb(ratio.bottom.leading_coefficient())
    result: Sizes = {}
    for exponents, c in ratio.top.to_dict().items():
        powers = {name: int(e) for name, e in zip(algebra.names, exponents, strict=False)}
        key = tuple(powers.get(name, 0) for name in names)
        size = arb(c) / lead
        for index, constant in constants.items():
            size *= constant ** int(exponents[index])
        result[key] = result.get(key, arb(0)) + size
    return result
