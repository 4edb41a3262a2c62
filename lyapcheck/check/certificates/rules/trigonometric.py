"""Polynomials in sines and cosines: bounds from Fourier sums, or angles at which they leave their bounds.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from lyapcheck.check.certificates.proofs import EntryWitness, FourierBounds
from lyapcheck.check.certificates.refusal import Refused, require
from lyapcheck.check.certificates.rules.replay import coordinates, require_failure
from lyapcheck.check.certificates.statements import Relation, TrigonometricBound, TrigonometricPositive
from lyapcheck.check.certificates.verify import Accepted, rule
from lyapcheck.check.fourier import fourier_sum, is_bounded, size
from lyapcheck.check.functions import Tree, variables

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
    return _broken(within(tree, bound)[1 if proof.lower else 0], tree, proof)


@rule(TrigonometricPositive, EntryWitness)
def by_entry_not_positive(statement: TrigonometricPositive, proof: EntryWitness) -> Accepted:
    """Soundness: angles at which the entry is not positive, in balls."""
    require(0 <= proof.entry < len(statement.entries), "entry", proof.entry, "does not exist")
    require(proof.lower, "lower", proof.lower, "must be true: the bound is from below")
    tree = statement.entries[proof.entry]
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
