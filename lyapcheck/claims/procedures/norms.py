"""Bounds ``‖(f(x_1), …, f(x_n))‖ <= c · ‖x‖^k`` for every x in Rⁿ, reduced to one variable.

- k = 0: the worst x repeats one worst entry, so the bound holds if and only if |f(t)| <= c/√n for every t.
- k = 1, f(0) = 0: put all but one entry to 0 and the bound needs |f(t)| <= c|t|; squared and summed over the
  entries, that also gives it. If f(0) ≠ 0, the bound fails at x = 0.

A bound by a certified supremum (c = √n·γ with f = h, or √n·ρ with f = h') holds by its definition.

References: ``reyes2019family`` (7), (8).
"""

from __future__ import annotations

from fractions import Fraction

from flint import arb, ctx

from lyapcheck.check.functions import CONSTANTS, Tree, Unsupported, ball
from lyapcheck.check.normal_form import is_zero
from lyapcheck.claims.decision import Decision, conjunction, proved, refuted, undecided
from lyapcheck.claims.expressions import Expr, Relation, expr, sqrt, total, var
from lyapcheck.claims.procedures.constants import decide_relation
from lyapcheck.claims.procedures.one_variable import decide_for_all, sample
from lyapcheck.claims.procedures.search import Point, first_refutation, witness_data
from lyapcheck.claims.statements import ForAll, NormBound
from lyapcheck.verdicts import Grade, Verdict

METHOD = "norm inequality"
SUPREMUM_OF = {"h": "gamma", "dh": "rho"}


def decide_norm_bound(statement: NormBound) -> Decision:
    """Decide a norm bound for every x in Rⁿ, for the n it names.

    Soundness: see the two reductions above; a refutation names x itself, with both norms in balls.
    """
    found = first_refutation(vector_relation(statement), vector_points(statement))
    if found is not None:
        return refuted(Grade.ENCLOSURE, f"{METHOD}: a vector where it fails", witness_data(*found))
    return _prove_uniform(statement) if statement.power == 0 else _prove_linear(statement)


def vector_relation(statement: NormBound) -> Relation:
    """The claim written out in x1, …, xn."""
    entries = [var(f"x{i + 1}") for i in range(statement.n)]
    left = sqrt(total(Expr(substitute(statement.component, "x", x.tree)) ** 2 for x in entries))
    size = sqrt(total(x**2 for x in entries)) if statement.power else expr(1)
    return left <= Expr(statement.bound) * size


def vector_points(statement: NormBound) -> list[Point]:
    """The vectors that the reductions say are worst: all entries equal, or one entry alone."""
    grid = sample(ForAll(Expr(statement.component) <= 0))
    peaks = _peaks(statement)
    names = [f"x{i + 1}" for i in range(statement.n)]
    if statement.power == 0:
        return [dict.fromkeys(names, t) for t in [*peaks, *grid]]
    zero = dict.fromkeys(names, Fraction(0))
    return [zero, *({**zero, "x1": t} for t in [*peaks, *grid])]


def _peaks(statement: NormBound) -> list[Fraction]:
    """Where |f(t)| (or |f(t)/t|) is largest on a fine grid of floating point, as exact rationals."""
    import numpy as np

    from lyapcheck.claims.procedures.sampling import values_of

    x = np.linspace(1e-3, 12.0, 24_000)
    with np.errstate(all="ignore"):
        size = np.abs(values_of(statement.component, {"x": x})) / x**statement.power
    best = float(x[int(np.nanargmax(size))])
    return [Fraction(best).limit_denominator(10**6)]


def _prove_uniform(statement: NormBound) -> Decision:
    supremum = SUPREMUM_OF.get(statement.component[0])
    if supremum is not None and statement.component[2] == ("var", "x"):
        own = Expr((supremum, statement.component[1]))
        by_definition = decide_relation(sqrt(statement.n) * own <= Expr(statement.bound), METHOD)
        if by_definition.verdict is Verdict.PROVED:
            return by_definition
    return _both_signs(
        statement, statement.bound, Fraction(statement.n), "all entries equal is the worst case"
    )


def _prove_linear(statement: NormBound) -> Decision:
    with ctx.workprec(192):
        at_zero = ball(statement.component, {"x": arb(0)})
    if not at_zero.is_zero() and not _vanishes_at_zero(statement.component):
        return undecided("f(0) is not shown to be 0; simplify f so that its value at 0 is exact", METHOD)
    line = Expr(statement.bound) * var("x")
    f = Expr(statement.component)
    parts = [
        (label, decide_for_all(ForAll(relation, low, high)))
        for low, high, slope in ((Fraction(0), None, line), (None, Fraction(0), -line))
        for label, relation in (("f(t) <= c|t|", f <= slope), ("-f(t) <= c|t|", -f <= slope))
    ]
    return _named(conjunction(parts), "one entry alone is the worst case")


def _both_signs(statement: NormBound, bound: Tree, n: Fraction, why: str) -> Decision:
    f, c = Expr(statement.component), Expr(bound) / sqrt(n)
    parts = [
        ("f(t) <= c/√n", decide_for_all(ForAll(f <= c))),
        ("-f(t) <= c/√n", decide_for_all(ForAll(-f <= c))),
    ]
    return _named(conjunction(parts), why)


def _named(decision: Decision, why: str) -> Decision:
    if decision.verdict is Verdict.PROVED:
        return proved(decision.grade, f"{METHOD}: {why}; {decision.method}", **decision.evidence)
    reason = decision.reason or "the inequality in one variable is open"
    return undecided(f"reduced to one variable ({why}), which stays open: {reason}", METHOD)


def _vanishes_at_zero(tree: Tree) -> bool:
    try:
        return is_zero(substitute(tree, "x", ("num", "0")))
    except Unsupported:
        return False


def substitute(tree: Tree, name: str, by: Tree) -> Tree:
    """An expression with a variable replaced by another expression."""
    if tree[0] == "var":
        return by if tree[1] == name else tree
    if tree[0] == "num" or tree[0] in CONSTANTS:
        return tree
    return (tree[0], *(substitute(part, name, by) if isinstance(part, tuple) else part for part in tree[1:]))
