"""Polynomials in sines and cosines: bounds from Fourier sums, or angles at which they leave their bounds.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from lyapcheck.check.expressions.defined import require_defined
from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text, number_text
from lyapcheck.check.numbers.fourier import fourier_sum, is_bounded, size
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import coordinates, require_failure
from lyapcheck.check.statement import Point, Proof, Relation, Statement
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class TrigonometricBound(Statement):
    """``|f_i(q)| <= bound_i`` for all q, each f_i a polynomial in sines and cosines of q.

    A bound of ``None`` asks only that f_i is bounded.
    """

    entries: tuple[tuple[Tree, Fraction | None], ...]

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require(len(self.entries) > 0, "entries", "", "must be one or more")
        require_expressions(tree for tree, _ in self.entries)

    def terms(self) -> list[tuple[Tree, Domain]]:
        """The polynomials, for all angles."""
        return [(tree, {}) for tree, _ in self.entries]

    def text(self) -> str:
        """The statement in one line."""
        parts = [
            f"{expression_text(tree)} is bounded"
            if bound is None
            else f"|{expression_text(tree)}| ≤ {number_text(bound)}"
            for tree, bound in self.entries
        ]
        return f"{'; '.join(parts)}, for all {_angles(tree for tree, _ in self.entries)}"


@dataclass(frozen=True)
class TrigonometricPositive(Statement):
    """``f_i(q) > 0`` for all q, each f_i a polynomial in sines and cosines of q."""

    entries: tuple[Tree, ...]

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require(len(self.entries) > 0, "entries", "", "must be one or more")
        require_expressions(self.entries)

    def terms(self) -> list[tuple[Tree, Domain]]:
        """The polynomials, for all angles."""
        return [(tree, {}) for tree in self.entries]

    def text(self) -> str:
        """The statement in one line."""
        shown = "; ".join(f"{expression_text(tree)} > 0" for tree in self.entries)
        return f"{shown}, for all {_angles(self.entries)}"


def _angles(trees: Iterable[Tree]) -> str:
    """The angles by name."""
    names = sorted(set().union(*map(variables, trees)))
    return f"angles {', '.join(names)}" if names else "angles"


@dataclass(frozen=True)
class FourierBounds(Proof):
    """The mean and the amplitudes of the Fourier sums suffice."""

    rule = "Fourier sums"


@dataclass(frozen=True)
class EntryWitness(Proof):
    """Angles at which one entry leaves its bounds, above (or below, if ``lower``)."""

    rule = "witness of an entry"
    entry: int
    lower: bool
    point: Point
    bits: int = 192


ZERO: Tree = ("num", "0")


@rule(TrigonometricBound, FourierBounds)
def by_bounds(statement: TrigonometricBound, proof: FourierBounds) -> Accepted:
    """Soundness: a Fourier sum lies within the sum of its amplitudes of its mean, and so has some bound."""
    for k, (tree, bound) in enumerate(statement.entries):
        if bound is None:
            require(
                is_bounded(tree), f"entry {k + 1}", "", "must be a polynomial in sines and cosines of angles"
            )
        elif (reached := largest(tree)) > bound:
            raise Refused(f"entry {k + 1}", reached, f"is all that the Fourier sum gives, not {bound}")
    return Accepted("proved", "exact")


@rule(TrigonometricPositive, FourierBounds)
def by_positive_mean(statement: TrigonometricPositive, proof: FourierBounds) -> Accepted:
    """Soundness: as above; the mean exceeds the sum of the amplitudes."""
    for k, tree in enumerate(statement.entries):
        reached = lowest(tree)
        require(reached > 0, f"entry {k + 1}", reached, "is all that the Fourier sum gives, not above 0")
    return Accepted("proved", "exact")


@rule(TrigonometricBound, EntryWitness)
def by_entry_out_of_bounds(statement: TrigonometricBound, proof: EntryWitness) -> Accepted:
    """Soundness: angles at which the entry and its bound lie in disjoint balls."""
    require(0 <= proof.entry < len(statement.entries), "entry", proof.entry, "does not exist")
    tree, bound = statement.entries[proof.entry]
    if bound is None:
        raise Refused("entry", proof.entry, "has no bound to break")
    _require_values(statement)
    return _broken(within(tree, bound)[1 if proof.lower else 0], tree, proof)


@rule(TrigonometricPositive, EntryWitness)
def by_entry_not_positive(statement: TrigonometricPositive, proof: EntryWitness) -> Accepted:
    """Soundness: angles at which the entry is not positive, in balls."""
    require(0 <= proof.entry < len(statement.entries), "entry", proof.entry, "does not exist")
    require(proof.lower, "lower", proof.lower, "must be true: the bound is from below")
    tree = statement.entries[proof.entry]
    _require_values(statement)
    return _broken(above_zero(tree), tree, proof)


def within(tree: Tree, bound: Fraction) -> tuple[Relation, Relation]:
    """f <= bound and −f <= bound."""
    limit = ("num", str(bound))
    return Relation(tree, "<=", limit), Relation(("neg", tree), "<=", limit)


def above_zero(tree: Tree) -> Relation:
    """0 < f."""
    return Relation(ZERO, "<", tree)


@lru_cache(maxsize=4096)
def largest(tree: Tree) -> Fraction:
    """An upper bound of |f|."""
    return size(fourier_sum(tree))


def lowest(tree: Tree) -> Fraction:
    """A lower bound of f."""
    f = fourier_sum(tree)
    return f.mean - f.swing


def _broken(relation: Relation, tree: Tree, proof: EntryWitness) -> Accepted:
    require_failure(relation.comparison, coordinates(proof.point, variables(tree)), proof.bits)
    return Accepted("refuted", "enclosure")


def _require_values(statement: Statement) -> None:
    """Refuse where an entry, also another one, may be without a value: a refutation needs them all."""
    for tree, domain in statement.terms():
        require_defined(tree, domain)
