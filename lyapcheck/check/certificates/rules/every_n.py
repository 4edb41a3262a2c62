"""Identities for every n: equal normal forms in words, or entries at which both sides differ."""

from __future__ import annotations

from lyapcheck.check.certificates.every_n import EntriesWitness, EveryN
from lyapcheck.check.certificates.proofs import NormalForm
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.rules.replay import coordinates
from lyapcheck.check.certificates.verify import Accepted, rule
from lyapcheck.check.functions import Tree, variables
from lyapcheck.check.letters.entries import Entries, exact
from lyapcheck.check.letters.words import Words
from lyapcheck.check.normal_form import is_zero

MAX_SIZE = 6
Equation = tuple[Tree, Tree]


@rule(EveryN, NormalForm)
def bywords_of(statement: EveryN, proof: NormalForm) -> Accepted:
    """Soundness: see :meth:`Words.number`; a zero normal form in words is zero whatever the words are."""
    require(rates_fit(statement), "rates", "", "a symmetric matrix must have a symmetric derivative")
    require(is_zero(in_words(statement)), "normal form", "", "that of the difference is not zero")
    return Accepted("proved", "exact")


@rule(EveryN, EntriesWitness)
def by_entries(statement: EveryN, proof: EntriesWitness) -> Accepted:
    """Soundness: exact arithmetic at one n, with the derivatives taken entry by entry."""
    require(1 <= proof.n <= MAX_SIZE, "n", proof.n, f"must be from 1 to {MAX_SIZE}")
    sides, given = at_size(statement, proof.n)
    point = coordinates(proof.point, names_at(sides, given))
    for left, right in given:
        require(exact(left, point) == exact(right, point), "point", proof.n, "breaks what is given")
    require(exact(sides[0], point) != exact(sides[1], point), "point", proof.n, "gives equal sides")
    return Accepted("refuted", "exact")


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


def names_at(sides: Equation, given: list[Equation]) -> set[str]:
    """The variables of both sides and of what is given."""
    return set().union(*(variables(tree) for pair in (sides, *given) for tree in pair))


def words_of(statement: EveryN) -> Words:
    """The words of a statement."""
    given = {(known.matrix, known.vector): known.equals for known in statement.given}
    return Words(statement.symmetric, dict(statement.rates), given)
