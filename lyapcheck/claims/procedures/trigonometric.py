"""Bounds of polynomials in sines and cosines: no monomial exceeds 1, so the sum of |coefficients| bounds them.

The bound is the coarsest there is, but exact; where it fails to meet a printed bound, points are searched.

References: ``reyes2019family``, Properties 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.functions import Tree, Unsupported, variables
from lyapcheck.check.normal_form import normal_form
from lyapcheck.claims.decision import Decision, conjunction, proved, undecided
from lyapcheck.claims.expressions import Expr
from lyapcheck.claims.procedures.implication import search
from lyapcheck.claims.statements import Implies, TrigonometricBound, reals
from lyapcheck.verdicts import Grade

METHOD = "sum of absolute coefficients"


def decide_trigonometric(statement: TrigonometricBound) -> Decision:
    """Decide whether polynomials in sines and cosines stay within bounds for all angles."""
    parts = [
        (f"entry {k + 1}", _decide_entry(tree, bound)) for k, (tree, bound) in enumerate(statement.entries)
    ]
    return conjunction(parts)


def _decide_entry(tree: Tree, bound: Fraction | None) -> Decision:
    try:
        largest = coefficient_sum(tree)
    except Unsupported as problem:
        return undecided(f"{problem}; give the entries as polynomials in sin and cos", METHOD)
    if bound is None or largest <= bound:
        return proved(Grade.EXACT, METHOD, bound=str(largest))
    names = reals(*sorted(variables(tree)))
    for side in (Expr(tree) <= bound, -Expr(tree) <= bound):
        found = search(Implies(names, (), side))
        if found is not None:
            return found
    return undecided(
        f"the coefficients sum to {largest}, above {bound}, and no angle was found; bisect over q", METHOD
    )


def coefficient_sum(tree: Tree) -> Fraction:
    """The sum of the absolute coefficients, an upper bound of |f|."""
    ratio, algebra = normal_form(tree)
    angles = set(range(len(algebra.names)))
    if not ratio.bottom.is_constant() or {name for name, _ in algebra.uses} - {"sin", "cos"}:
        raise Unsupported("not a polynomial in sines and cosines")
    total = Fraction(0)
    for exponents, coefficient in (ratio.top / ratio.bottom.leading_coefficient()).to_dict().items():
        if any(exponents[i] for i in angles):
            raise Unsupported("a variable outside sin and cos has no bound")
        total += abs(Fraction(int(coefficient.p), int(coefficient.q)))
    return total
