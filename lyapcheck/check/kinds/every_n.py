"""Identities for every n: equal normal forms in words, or entries at which both sides differ."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain

from flint import fmpq_mat

from lyapcheck.check.expressions.domain import POSITIVE, Domain, Interval
from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.signs import require_defined_at
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.letters import LETTERS, letters, require_sort
from lyapcheck.check.letters.entries import Entries, exact
from lyapcheck.check.letters.words import Words
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import coordinates, require_distinct
from lyapcheck.check.statement import OfTerms, Point, Proof
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Given:
    """``A x = equals`` for a matrix A and a vector x."""

    matrix: str
    vector: str
    equals: Tree


@dataclass(frozen=True)
class EveryN(OfTerms):
    """``left = right`` for every n >= 1, all numbers, vectors of Rⁿ and n × n matrices.

    ``symmetric`` names the matrices with Aᵀ = A, ``positive`` the numbers that are > 0. The symbols are
    functions of time, over some interval, with the derivatives ``rates``, pairs (letter, derivative), and
    ``given`` holds at all its times; apart from that they are free.
    """

    left: Tree
    right: Tree
    symmetric: tuple[str, ...] = ()
    rates: tuple[tuple[Tree, Tree], ...] = ()
    given: tuple[Given, ...] = ()
    positive: tuple[str, ...] = ()

    def require_well_formed(self) -> None:
        """One name for one letter; what is given is solved for vectors that it does not contain itself."""
        require_sort(self.left, "number", rate=True)
        require_sort(self.right, "number", rate=True)
        used = letters(self.left) | letters(self.right)
        sorts = {letter: sort for sort, letter in LETTERS.items()}
        for letter, value in self.rates:
            require(len(letter) == 2 and letter[0] in sorts, "rates", letter, "has no derivative of its own")
            for tree in (letter, value):
                require_sort(tree, sorts[letter[0]])
                used |= letters(tree)
        for known in self.given:
            require_sort(("mat", known.matrix), "matrix")
            require_sort(("vec", known.vector), "vector")
            require_sort(known.equals, "vector")
            used |= letters(known.equals) | {("mat", known.matrix), ("vec", known.vector)}
            solved = {("vec", other.vector) for other in self.given}
            require(not solved & letters(known.equals), "given", known.vector, "occurs on a right side")
        require_distinct("letters", sorted(name for _, name in used))
        require_distinct("rates", [letter[1] for letter, _ in self.rates])
        require_distinct("given", [f"{known.matrix} {known.vector}" for known in self.given])
        require_distinct("positive", list(self.positive))
        for name in self.positive:
            require(("var", name) in used, "positive", name, "is not a number of the statement")
        require_distinct("symmetric", list(self.symmetric))
        for name in self.symmetric:
            require(("mat", name) in used, "symmetric", name, "is not a matrix of the self")

    @property
    def domain(self) -> dict[str, Interval]:
        return dict.fromkeys(self.positive, POSITIVE)

    def terms(self) -> list[tuple[Tree, Domain]]:
        known = (*(value for _, value in self.rates), *(one.equals for one in self.given))
        return [(tree, self.domain) for tree in (self.left, self.right, *known)]

    def text(self) -> str:
        sides = f"{expression_text(self.left)} = {expression_text(self.right)}"
        known = "; ".join(known_of(self))
        over = sorts_text(tree for tree, _ in self.terms())
        return f"{sides} for every n and all {over}{f', if {known}' if known else ''}"


@dataclass(frozen=True)
class EntriesWitness(Proof):
    """An n and rational entries at which all that is given holds and both sides differ."""

    rule = "entries"
    n: int
    point: Point


MAX_SIZE = 6
Equation = tuple[Tree, Tree]


@rule(EveryN, NormalForm)
def by_words(statement: EveryN, proof: NormalForm) -> Accepted:
    """Soundness: see :meth:`Words.number`; a zero normal form in words is zero whatever the words are."""
    require(rates_fit(statement), "rates", "", "a symmetric matrix must have a symmetric derivative")
    require(is_zero(in_words(statement)), "normal form", "", "that of the difference is not zero")
    return Accepted("proved", "exact")


@rule(EveryN, EntriesWitness)
def by_entries(statement: EveryN, proof: EntriesWitness) -> Accepted:
    """Soundness: exact arithmetic at one n, with the derivatives taken entry by entry, within a motion."""
    require(1 <= proof.n <= MAX_SIZE, "n", proof.n, f"must be from 1 to {MAX_SIZE}")
    sides, given = at_size(statement, proof.n)
    point = coordinates(proof.point, names_of(statement, proof.n))
    for name in statement.positive:
        require(point[name] > 0, name, point[name], "must be positive")
    for tree in chain(sides, *given, beside(statement, proof.n)):
        require_defined_at(tree, point)
    for left, right in given:
        require(exact(left, point) == exact(right, point), "point", proof.n, "breaks what is given")
    moved_at(statement, proof.n, point)
    require(exact(sides[0], point) != exact(sides[1], point), "point", proof.n, "gives equal sides")
    return Accepted("refuted", "exact")


def moved_at(statement: EveryN, n: int, point: Mapping[str, Fraction]) -> set[str]:
    """The variables at one n that move, if functions of time are at the point at some instant.

    Refused where that is not shown, as the derivatives of what is given are not checked.

    Soundness: letters without a derivative stay as they are, but for vectors solved for by a matrix that is
        invertible there: they follow the others, whose derivatives are continuous functions (Peano).
    """
    require(rates_fit(statement), "rates", "", "a symmetric matrix must have a symmetric derivative")
    entries, rated = Entries(n, statement.symmetric, dict(statement.rates)), dict(statement.rates)
    moved, solved = set(entries.moving), Counter(known.vector for known in statement.given)
    for known in statement.given:
        vector: Tree = ("vec", known.vector)
        if rated.keys() & (letters(known.equals) | {("mat", known.matrix), vector}):
            alone = vector not in rated and solved[known.vector] == 1
            rows = [
                [rational(point[entry[1]]) for entry in row] for row in entries.matrix(("mat", known.matrix))
            ]
            follows = alone and fmpq_mat(rows).det() != 0
            equation = f"{known.matrix}·{known.vector} = {expression_text(known.equals)}"
            require(follows, "given", equation, "has derivatives, which entries at one instant do not meet")
            moved |= set(entries.names(vector))
    return moved


def in_words(statement: EveryN) -> Tree:
    """The difference of both sides as an expression in words."""
    words = words_of(statement)
    return ("add", words.number(statement.right), ("neg", words.number(statement.left)))


def rates_fit(statement: EveryN) -> bool:
    """Whether the derivative of each symmetric matrix is symmetric, word by word."""
    words = words_of(statement)
    changes = [value for (_, name), value in statement.rates if name in statement.symmetric]
    skew = (words.expand(("sum", a, ("scale", ("num", "-1"), ("transpose", a)))) for a in changes)
    return all(is_zero(coefficient) for word in skew for coefficient in word.values())


def at_size(statement: EveryN, n: int) -> tuple[Equation, list[Equation]]:
    """Both sides at one n, and the equations that are given there, as ordinary expressions."""
    entries = Entries(n, statement.symmetric, dict(statement.rates))
    given: list[Equation] = []
    for known in statement.given:
        left = entries.vector(("apply", ("mat", known.matrix), ("vec", known.vector)))
        given += zip(left, entries.vector(known.equals), strict=True)
    for (_, name), value in statement.rates:
        if name in statement.symmetric:
            rows = entries.matrix(value)
            given += [(rows[i][j], rows[j][i]) for i in range(n) for j in range(i)]
    return (entries.number(statement.left), entries.number(statement.right)), given


def beside(statement: EveryN, n: int) -> list[Tree]:
    """What must have a value at one n beside both sides: all derivatives, and what stands under d/dt."""
    entries = Entries(n, statement.symmetric, dict(statement.rates))
    sides = (statement.left, statement.right)
    return [*entries.moving.values(), *(tree for side in sides for tree in entries.differentiated(side))]


def names_of(statement: EveryN, n: int) -> set[str]:
    """The variables of a statement at one n, also of what both sides there do not show."""
    names = (variables(tree) for tree in beside(statement, n))
    return names_at(*at_size(statement, n)).union(*names)


def names_at(sides: Equation, given: list[Equation]) -> set[str]:
    """The variables of both sides and of what is given."""
    return set().union(*(variables(tree) for pair in (sides, *given) for tree in pair))


def words_of(statement: EveryN) -> Words:
    """The words of a statement."""
    given = {(known.matrix, known.vector): known.equals for known in statement.given}
    return Words(statement.symmetric, dict(statement.rates), given)


def sorts_text(trees: Iterable[Tree]) -> str:
    """The letters by what they are: ``numbers s; vectors x, y; n × n matrices M``."""
    result: dict[str, set[str]] = {kind: set() for kind in ("var", "vec", "mat")}
    for kind, name in {letter for tree in trees for letter in letters(tree)}:
        result[kind].add(name)
    named = zip(("numbers", "vectors", "n × n matrices"), result.values(), strict=True)
    return "; ".join(f"{sort} {', '.join(sorted(names))}" for sort, names in named if names) or "letters"


def known_of(statement: EveryN) -> list[str]:
    """What is supposed of the letters, in sentences."""
    known = [f"{name}ᵀ = {name}" for name in statement.symmetric]
    known += [f"{name} > 0" for name in statement.positive]
    known += [f"d/dt({expression_text(x)}) = {expression_text(value)}" for x, value in statement.rates]
    known += [f"{one.matrix}·{one.vector} = {expression_text(one.equals)}" for one in statement.given]
    return known
