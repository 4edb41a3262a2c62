"""Bounds of polynomials in sines and cosines, from the mean and the amplitudes of their Fourier sums.

The bounds are exact but coarse; where they do not reach a claimed one, points are searched.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, Unsupported, variables
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.trigonometric import (
    EntryWitness,
    FourierBounds,
    TrigonometricBound,
    TrigonometricPositive,
    above_zero,
    is_bounded,
    largest,
    lowest,
    within,
)
from lyapcheck.check.statement import Relation
from lyapcheck.claims.procedures.implication import counterexample, sampled
from lyapcheck.claims.procedures.search import BITS, point_of, witness_data
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open
from lyapcheck.claims.statements import reals

METHOD = "mean and amplitudes of the Fourier sum"

Doubt = tuple[str, list[tuple[bool, Relation]]]
"""Why Fourier sums do not settle an entry, and the relations (from below?) to break."""


@procedure(TrigonometricBound)
def find_bounds(statement: TrigonometricBound) -> SearchResult:
    """Compute |mean| plus amplitudes of each entry; where that is above the bound, look for angles."""

    def doubt(entry: tuple[Tree, Fraction | None]) -> Doubt | None:
        tree, bound = entry
        if bound is None:
            if is_bounded(tree):
                return None
            raise Unsupported("a variable outside sin and cos has no bound")
        reached = largest(tree)
        if reached <= bound:
            return None
        above, below = within(tree, bound)
        return f"{reached} is above {bound}", [(False, above), (True, below)]

    return _find(statement.entries, doubt, lambda entry: entry[0])


@procedure(TrigonometricPositive)
def find_positive(statement: TrigonometricPositive) -> SearchResult:
    """Compute mean minus amplitudes of each entry; where that is not positive, look for angles."""

    def doubt(tree: Tree) -> Doubt | None:
        reached = lowest(tree)
        if reached > 0:
            return None
        return f"mean minus amplitudes is {reached}", [(True, above_zero(tree))]

    return _find(statement.entries, doubt, lambda tree: tree)


def _find(
    entries: Sequence[tuple[object, ...]],
    doubt: Callable[..., Doubt | None],
    tree_of: Callable[..., Tree],
) -> SearchResult:
    open_ones: list[str] = []
    for k, entry in enumerate(entries):
        try:
            doubted = doubt(entry)
        except Unsupported as problem:
            return still_open(f"{problem}; give the entries as polynomials in sin and cos", METHOD)
        if doubted is not None:
            why, relations = doubted
            result = _counterexample(k, tree_of(entry), relations)
            if result is not None:
                return result
            open_ones.append(f"entry {k + 1}: {why}, and no angle that decides was found")
    if open_ones:
        return still_open(f"{open_ones[0]}; bisect over the angles", METHOD)
    return shown(FourierBounds(), METHOD)


def _counterexample(entry: int, tree: Tree, relations: list[tuple[bool, Relation]]) -> SearchResult | None:
    names = reals(*sorted(variables(tree)))
    for lower, relation in relations:
        result = counterexample(Implies(names, (), relation))
        if result is not None:
            proof = EntryWitness(entry, lower, point_of(result[1]), BITS)
            method = f"{METHOD}: angles at which entry {entry + 1} leaves its bound"
            return broken(proof, method, witness_data(result), **sampled())
    return None
