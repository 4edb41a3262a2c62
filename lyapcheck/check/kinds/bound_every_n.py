"""Upper bounds for every n: each term in words is at most a product of norms.

|xᵀ A … y| <= ‖x‖ ‖A‖ … ‖y‖ with Euclidean and spectral norms, by the Cauchy–Schwarz inequality; the spectral
norm of Aᵀ is that of A.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, product

from flint import fmpq

from lyapcheck.check.expressions.domain import NONNEGATIVE, Domain
from lyapcheck.check.expressions.expression import Tree, shared, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.expressions.signs import require_defined_at
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.every_n import (
    MAX_SIZE,
    EntriesWitness,
    Equation,
    EveryN,
    Given,
    beside,
    known_of,
    moved_at,
    rates_fit,
    sorts_text,
    words_of,
)
from lyapcheck.check.kinds.every_n import at_size as identity_at_size
from lyapcheck.check.kinds.implies import Signs
from lyapcheck.check.letters import DIMENSION, LETTERS, letters, require_sort
from lyapcheck.check.letters.entries import Entries, compared
from lyapcheck.check.letters.words import Words
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import coordinates, require_distinct
from lyapcheck.check.statement import OfTerms, Proof, Relation, Variable
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class BoundEveryN(OfTerms):
    """``left <= right`` for every n, from bounds of norms; ``left`` is as in :class:`EveryN`.

    ``norms`` bounds the product of the norms of some symbols by an expression. The norm of a number is its
    size. ``least`` is a lower bound of a number. The variables of these expressions and of ``right``, and the
    numbers in ``left``, are >= 0.
    """

    left: Tree
    right: Tree
    symmetric: tuple[str, ...]
    rates: tuple[tuple[Tree, Tree], ...]
    given: tuple[Given, ...]
    norms: tuple[tuple[tuple[Tree, ...], Tree], ...]
    least: tuple[tuple[Tree, Tree], ...]

    @property
    def identity(self) -> EveryN:
        return EveryN(self.left, ("num", "0"), self.symmetric, self.rates, self.given)

    def require_well_formed(self) -> None:
        self.identity.require_well_formed()
        used = letters(self.left)
        for known, size in self.norms:
            require_expressions([size])
            require(len(known) > 0, "norms", expression_text(size), "bounds no letter")
            for letter in known:
                sort = next((sort for sort, kind in LETTERS.items() if letter[:1] == (kind,)), "matrix")
                require_sort(letter, sort)
                require(
                    letters(letter) == {letter} or letter[0] == "diag", "norms", letter, "is not a letter"
                )
                used |= letters(letter)
        for number, size in self.least:
            require_sort(number, "number")
            require_expressions([size])
            used |= letters(number)
        sizes = (self.right, *(size for _, size in (*self.norms, *self.least)))
        require_expressions(sizes)
        used |= {("var", name) for size in sizes for name in variables(size)}
        require(("var", DIMENSION) not in used, "letter", DIMENSION, "is the dimension")
        require_distinct("letters", sorted(name for _, name in used))

    def terms_with_values(self) -> Iterator[Tree]:
        yield from (tree for tree, _ in self.identity.terms())
        yield self.right
        for known, size in self.norms:
            yield from (*known, size)
        for number, size in self.least:
            yield from (number, size)

    def terms(self) -> list[tuple[Tree, Domain]]:
        domain = dict.fromkeys(self.numbers, NONNEGATIVE)
        return [(tree, domain) for tree in self.terms_with_values()]

    @property
    def numbers(self) -> set[str]:
        """The numbers that occur, all of them >= 0."""
        return {name for tree in self.terms_with_values() for name in variables(tree)}

    def text(self) -> str:
        sides = f"{expression_text(self.left)} ≤ {expression_text(self.right)}"
        norms = [
            f"{''.join(f'‖{expression_text(letter)}‖' for letter in known)} ≤ {expression_text(size)}"
            for known, size in self.norms
        ]
        least = [f"{expression_text(number)} ≥ {expression_text(size)}" for number, size in self.least]
        known = "; ".join([*known_of(self.identity), *norms, *least])
        over = sorts_text(self.terms_with_values())
        return f"{sides} for every n and all {over}, no number negative, if {known or 'nothing more'}"


@dataclass(frozen=True)
class Cover:
    """How one term is bounded: which ``norms`` cover its letters, or which ``least`` is its one word."""

    norms: tuple[int, ...]
    least: int | None = None


@dataclass(frozen=True)
class CoveredTerms(Proof):
    """A cover of each term of ``left`` in words, the terms in the order of their exponents."""

    rule = "covered terms"
    covers: tuple[Cover, ...]


ZERO: Tree = ("num", "0")
Term = tuple[fmpq, dict[str, int]]
"""A coefficient, and the power of each variable."""


@rule(BoundEveryN, CoveredTerms)
def by_covers(statement: BoundEveryN, proof: CoveredTerms) -> Accepted:
    """Soundness: ``left`` is the sum of its terms, each at most its bound; ``right`` exceeds them together.

    All terms of the difference have coefficients >= 0, variables >= 0 and, with the lower bounds of numbers
    such as γ_m put in, constants >= 0.
    """
    require(rates_fit(statement.identity), "rates", "", "a symmetric matrix must have a symmetric derivative")
    result, words = terms_in_words(statement)
    require(
        len(proof.covers) == len(result), "covers", len(proof.covers), f"must be {len(result)}, one a term"
    )
    bounds = [bound_of(statement, words, *pair) for pair in zip(result, proof.covers, strict=True)]
    require(within(statement, bounds), "right", "", "is not shown to exceed the sum of the bounds")
    return Accepted("proved", "exact")


def within(statement: BoundEveryN, bounds: Iterable[Tree]) -> bool:
    """Whether ``right`` plainly exceeds the sum of some bounds."""
    spare = Relation(("add", ZERO, *bounds), "<=", statement.right)
    numbers = tuple(Variable(name, Fraction(0), strict=False) for name in sorted(statement.numbers))
    signs = Signs(numbers, (), spare)
    return signs.is_nonnegative(signs.conclusion)


@rule(BoundEveryN, EntriesWitness)
def by_entries(statement: BoundEveryN, proof: EntriesWitness) -> Accepted:
    """Soundness: entries at one n that meet all that is supposed, and the left side exceeds the right.

    Functions of time are there at some instant, see :func:`moved_at`; a bound that holds strictly there, or
    in which nothing moves, holds also just before and after it. Numbers that are 0
    may be taken a little above.
    """
    require(1 <= proof.n <= MAX_SIZE, "n", proof.n, f"must be from 1 to {MAX_SIZE}")
    sides, equations = at_size(statement, proof.n)
    bounds = list(bounds_at(statement, proof.n))
    point = coordinates(proof.point, names_at(statement, proof.n, [sides, *equations, *bounds]))
    moved = moved_at(statement.identity, proof.n, point)
    for name in sorted(statement.numbers):
        require(point[name] >= 0, name, point[name], "must not be negative")
    for tree in chain(sides, *equations, *bounds, beside(statement.identity, proof.n)):
        require_defined_at(tree, point)
    given = all(compared(*pair, point) == 0 for pair in equations)
    require(given, "point", proof.n, "breaks what is given")
    for pair in bounds:
        sign = compared(*pair, point)
        require(sign in (0, 1), "point", proof.n, "breaks a bound of the norms")
        free = sign == 1 or not moved & variables(("add", *pair))
        require(free, "point", proof.n, "reaches a bound whose derivatives are not checked; stay below it")
    require(compared(*sides, point) == -1, "point", proof.n, "does not exceed the bound")
    return Accepted("refuted", "enclosure")


def at_size(statement: BoundEveryN, n: int) -> tuple[Equation, list[Equation]]:
    """Both sides at one n, and the equations that are given there."""
    (left, _), equations = identity_at_size(statement.identity, n)
    return (shared(left), statement.right), equations


def bounds_at(statement: BoundEveryN, n: int) -> Iterator[Equation]:
    """Pairs, left <= right, that give all bounds at one n; a full matrix is taken at its Frobenius norm.

    A product of norms is at most a size if the size is >= 0 and the product of squares at most its square;
    the square of the norm of a diagonal matrix is at most something if the squares of all entries are.
    """
    entries = Entries(n, statement.symmetric, dict(statement.rates))
    for known, size in statement.norms:
        yield ZERO, size
        each: list[list[Tree]] = []
        for letter in known:
            squares: list[Tree] = [("pow", ("var", name), 2) for name in entries.names(letter)]
            each.append(squares if letter[0] == "diag" else [("add", *squares)])
        for chosen in product(*each):
            yield ("mul", ("num", "1"), *chosen), ("pow", size, 2)
    for number, size in statement.least:
        yield size, entries.number(number)


def names_at(statement: BoundEveryN, n: int, pairs: list[Equation]) -> set[str]:
    """The variables of some pairs at one n, and all that the statement has there beside."""
    moving = Entries(n, statement.symmetric, dict(statement.rates)).moving.values()
    return statement.numbers.union(*map(variables, chain(*pairs, moving)))


def terms_in_words(statement: BoundEveryN) -> tuple[list[Term], Words]:
    """The terms of the left side."""
    words = words_of(statement.identity)
    return terms_of(words.number(statement.left)), words


def terms_of(tree: Tree) -> list[Term]:
    """The terms of a polynomial in the order of their exponents; refused if it is none."""
    ratio, algebra = normal_form(tree)
    plain = not algebra.uses and ratio.bottom.is_constant()
    require(plain, "expression", "", "is not a polynomial in its variables and words")
    lead = ratio.bottom.leading_coefficient()
    names = algebra.names
    return [
        (c / lead, {name: int(e) for name, e in zip(names, exponents, strict=False) if e})
        for exponents, c in sorted(ratio.top.to_dict().items())
    ]


def bound_of(statement: BoundEveryN, words: Words, term: Term, cover: Cover) -> Tree:
    """What a term is at most, by a cover; refused if that does not fit."""
    c, powers = term
    if cover.least is not None:
        # a negative multiple of a number that is at least something
        require(c < 0 and not cover.norms, "cover", cover.least, "is for terms with a minus")
        require(0 <= cover.least < len(statement.least), "cover", cover.least, "does not exist")
        number, least = statement.least[cover.least]
        [(factor, word)] = terms_of(words.number(number))
        others = Counter(powers) - Counter(word)
        fits = factor == 1 and Counter(word) <= Counter(powers) and not set(others) & set(words.seen)
        require(fits, "cover", cover.least, "is not the word of its term")
        return ("mul", ("num", str(c)), least, *(("var", name) for name in others.elements()))
    for index in cover.norms:
        require(0 <= index < len(statement.norms), "cover", index, "does not exist")
    covered = Counter(letter for index in cover.norms for letter in statement.norms[index][0])
    left = (letters - covered for letters in written_letters(words, powers) if covered <= letters)
    rest = next((some for some in left if all(letter[0] == "var" for letter in some)), None)
    if rest is None:
        raise Refused("cover", cover.norms, "does not cover the letters of its term")
    sizes = (statement.norms[index][1] for index in cover.norms)
    return ("mul", ("num", str(abs(c))), *sizes, *rest.elements())


def written_letters(words: Words, powers: dict[str, int]) -> Iterator[Counter[Tree]]:
    """The letters of a term, for each way in which its words came up."""
    plain = Counter({("var", name): k for name, k in powers.items() if name not in words.seen})
    written = [sorted(words.seen[name]) for name, k in powers.items() if name in words.seen for _ in range(k)]
    for choice in product(*written):
        seen = (letter for word in choice for letter in word)
        yield plain + Counter(("mat" if kind == "transposed" else kind, name) for kind, name in seen)
