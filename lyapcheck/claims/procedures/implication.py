"""Implications between inequalities: proved by a certificate of signs, refuted by an exact point.

The proof is an identity  μ·C = Σ λ_k μ_k H_k + R  in which C is the gap of the conclusion, H_k are gaps of
hypotheses, λ_k > 0 are rational, μ and μ_k are monomials that are positive, and R has no negative term. It is
found by cancelling the negative terms of C one after the other.

References: ``stengle1974nullstellensatz`` (the certificates are its simplest members).
"""

from __future__ import annotations

from lyapcheck.check.expressions.expression import LEAVES, Tree, Unsupported
from lyapcheck.check.expressions.witness import Comparison
from lyapcheck.check.kinds.implies import Implies, signs_of
from lyapcheck.check.kinds.signs import SignIdentity, Signs
from lyapcheck.check.statement import Variable
from lyapcheck.claims.procedures.cancellation import Cancellation
from lyapcheck.claims.procedures.search import Failure, first_refutation, rounder, witness_data, witness_of
from lyapcheck.claims.registry import procedure
from lyapcheck.claims.search_result import SearchResult, broken, shown, still_open

METHOD = "implication between inequalities"
EFFORT = ((1, 40), (2, 80), (3, 160), (4, 320), (5, 640), (7, 2000))
"""Depth and number of nodes of the tries at a certificate."""
SEARCH_AFTER = 2
"""The depth after which counterexamples are searched, before deeper certificates are."""

ARITHMETIC = ("add", "mul", "neg", "div", "pow", "sqrt")


@procedure(Implies)
def find_implies(statement: Implies) -> SearchResult:
    """Look for an identity of signs and for counterexamples by turns."""
    if not all(is_algebraic(r.gap) for r in (*statement.hypotheses, statement.conclusion)):
        return _refuted(statement) or still_open(
            "no counterexample among the points tried, and no proof for functions that are not algebraic; "
            "bound them by claims of one variable and name the bounds",
            METHOD,
        )
    signs = _signs(statement)
    for depth, nodes in EFFORT:
        identity = _identity(signs, statement, depth, nodes)
        if identity is not None:
            return shown(identity, f"{METHOD}: identity with terms of known sign")
        result = _refuted(statement) if depth == SEARCH_AFTER else None
        if result is not None:
            return result
    return still_open(
        "no certificate of signs and no counterexample among the points tried; "
        "split the claim, or add a hypothesis: a bound of the variables, or what always holds, as "
        "0 <= (x - y)**2",
        METHOD,
    )


def is_algebraic(tree: Tree) -> bool:
    """Whether an expression is built from numbers and variables by arithmetic and roots."""
    if tree[0] in LEAVES:
        return True
    return tree[0] in ARITHMETIC and all(is_algebraic(part) for part in tree[1:] if isinstance(part, tuple))


def counterexample(statement: Implies) -> Failure | None:
    """A point that balls confirm, or None."""
    from lyapcheck.claims.procedures.sampling import candidates

    given = [hypothesis.comparison for hypothesis in statement.hypotheses]
    given += [bound_of(v) for v in statement.variables if v.low is not None]
    points = candidates(statement.variables, statement.hypotheses, statement.conclusion)
    result = first_refutation(statement.conclusion.comparison, points, given)
    return None if result is None else rounder(result, given)


def sampled() -> dict[str, int]:
    """How counterexamples are searched, for the record."""
    from lyapcheck.claims.procedures.sampling import SAMPLES, SEED

    return {"samples": SAMPLES, "seed": SEED}


def _refuted(statement: Implies) -> SearchResult | None:
    result = counterexample(statement)
    if result is None:
        return None
    return broken(witness_of(result), f"{METHOD}: a point where it fails", witness_data(result), **sampled())


def bound_of(variable: Variable) -> Comparison:
    """The lower bound of a variable as a relation."""
    return ("num", str(variable.low)), "<" if variable.strict else "<=", ("var", variable.name)


def _signs(statement: Implies) -> Signs | None:
    try:
        return signs_of(statement)
    except Unsupported:
        return None


def _identity(signs: Signs | None, statement: Implies, depth: int, nodes: int) -> SignIdentity | None:
    if signs is None:
        return None
    return Cancellation(signs, nodes).identity(signs.conclusion, statement.conclusion.strict, depth)
