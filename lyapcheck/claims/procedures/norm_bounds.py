"""Upper bounds for every n by norms: for each term a product of norms is chosen so that all fit in the bound.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from flint import arb

from lyapcheck.check.expressions.defined import Undefined
from lyapcheck.check.expressions.expression import Tree, Unsupported
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.kinds.bound_every_n import (
    BoundEveryN,
    Cover,
    CoveredTerms,
    Term,
    bound_of,
    terms_in_words,
    written_letters,
)
from lyapcheck.check.letters.words import Words
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims.finding import Finding, shown, still_open

METHOD = "norms for every n"
Sizes = dict[tuple[int, ...], arb]
"""A ball for the coefficient of each monomial, by the exponents of all numbers of the statement."""
Option = tuple[Cover, Sizes]


def find_bound_every_n(statement: BoundEveryN) -> Finding:
    """Choose covers term by term, going back where the bound has no room left."""
    try:
        statement.require_well_formed()
        found, words = terms_in_words(statement)
        names = sorted(statement.numbers)
        spare = _sizes(statement.right, names)
        options = [list(_options(statement, words, term, names)) for term in found]
    except (Refused, Unsupported) as problem:
        return still_open(f"{problem}; write both sides as polynomials in the letters", METHOD)
    for covers in _chosen(options, spare):
        proof = CoveredTerms(covers)
        if _accepted(statement, proof):
            return shown(proof, f"{METHOD}: every term within its part of the bound")
    return still_open("no choice of norms keeps the terms within the bound; enlarge the bound", METHOD)


def _accepted(statement: BoundEveryN, proof: CoveredTerms) -> bool:
    """Whether the checker accepts covers, whose balls leave room."""
    try:
        return verify(statement, proof).verdict == "proved"
    except Undefined:
        return True
    except Refused:
        return False


def _chosen(options: list[list[Option]], spare: Sizes) -> Iterator[tuple[Cover, ...]]:
    """Covers of the terms such that no coefficient of what is left of the bound is surely negative."""
    if not options:
        if not any(c < 0 for c in spare.values()):
            yield ()
        return
    for cover, sizes in options[0]:
        left = dict(spare)
        for key, c in sizes.items():
            left[key] = left.get(key, arb(0)) - c
            if c > 0 and left[key] < 0:
                break
        else:
            yield from ((cover, *rest) for rest in _chosen(options[1:], left))


def _options(statement: BoundEveryN, words: Words, term: Term, names: list[str]) -> Iterator[Option]:
    """The covers of a term, each with the bound that it gives."""
    least = (Cover((), k) for k in range(len(statement.least)))
    written = written_letters(words, term[1])
    norms = (Cover(choice) for letters in written for choice in _norms(statement, letters))
    for cover in (*least, *dict.fromkeys(norms)):
        try:
            yield cover, _sizes(bound_of(statement, words, term, cover), names)
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
    found: Sizes = {}
    for exponents, c in ratio.top.to_dict().items():
        powers = {name: int(e) for name, e in zip(algebra.names, exponents, strict=False)}
        key = tuple(powers.get(name, 0) for name in names)
        size = arb(c) / lead
        for index, ball in constants.items():
            size *= ball ** int(exponents[index])
        found[key] = found.get(key, arb(0)) + size
    return found
