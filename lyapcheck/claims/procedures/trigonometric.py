"""Bounds of polynomials in sines and cosines, from the mean and the amplitudes of their Fourier sums.

The bounds are exact but coarse; where they do not reach a claimed one, points are searched.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.fourier import fourier_sum
from lyapcheck.check.functions import Tree, Unsupported, variables
from lyapcheck.claims.decision import Decision, conjunction, proved, undecided
from lyapcheck.claims.expressions import Expr, Relation, expr
from lyapcheck.claims.procedures.implication import search
from lyapcheck.claims.statements import Implies, TrigonometricBound, TrigonometricPositive, reals
from lyapcheck.verdicts import Grade

METHOD = "mean and amplitudes of the Fourier sum"


def decide_bounds(statement: TrigonometricBound) -> Decision:
    """Decide whether polynomials in sines and cosines stay within bounds for all angles."""
    return conjunction((f"entry {k + 1}", _within(*entry)) for k, entry in enumerate(statement.entries))


def decide_positive(statement: TrigonometricPositive) -> Decision:
    """Decide whether polynomials in sines and cosines are positive for all angles."""
    return conjunction((f"entry {k + 1}", _above_zero(tree)) for k, tree in enumerate(statement.entries))


def _within(tree: Tree, bound: Fraction | None) -> Decision:
    try:
        f = fourier_sum(tree)
    except Unsupported as problem:
        return undecided(f"{problem}; give the entries as polynomials in sin and cos", METHOD)
    largest = abs(f.mean) + f.swing
    if bound is None or largest <= bound:
        return proved(Grade.EXACT, METHOD, bound=str(largest))
    return _searched(tree, (Expr(tree) <= bound, -Expr(tree) <= bound), f"{largest} is above {bound}")


def _above_zero(tree: Tree) -> Decision:
    try:
        f = fourier_sum(tree)
    except Unsupported as problem:
        return undecided(f"{problem}; give the entries as polynomials in sin and cos", METHOD)
    lowest = f.mean - f.swing
    if lowest > 0:
        return proved(Grade.EXACT, METHOD, lower_bound=str(lowest))
    return _searched(tree, (expr(0) < Expr(tree),), f"mean minus amplitudes is {lowest}")


def _searched(tree: Tree, relations: tuple[Relation, ...], why: str) -> Decision:
    names = reals(*sorted(variables(tree)))
    for relation in relations:
        found = search(Implies(names, (), relation))
        if found is not None:
            return found
    return undecided(f"{why}, and no angle that decides was found; bisect over the angles", METHOD)
