"""Bounds ``‖(f(x_1), …, f(x_n))‖ <= c · ‖x‖^k`` for every x in Rⁿ, reduced to one variable.

- k = 0: the worst x repeats one worst entry, so the bound holds if and only if |f(t)| <= c/√n for every t.
- k = 1, f(0) = 0: put all but one entry to 0 and the bound needs |f(t)| <= c|t|; squared and summed over the
  entries, that also gives it. If f(0) ≠ 0, the bound fails at x = 0.

A bound by a certified supremum (c = √n·γ with f = h, or √n·ρ with f = h') holds by its definition.

References: ``reyes2019family`` (7), (8).
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np

from lyapcheck.check.kinds import norm_bound as rules
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.norm_bound import EqualEntries, NormBound, OneEntry, Supremum
from lyapcheck.check.statement import Proof, Relation
from lyapcheck.claims.procedures.constants import find_relation
from lyapcheck.claims.procedures.one_variable import find_for_all, sample
from lyapcheck.claims.procedures.search import (
    Point,
    doubtful,
    first_refutation,
    values_of,
    witness_data,
    witness_of,
)
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open

METHOD = "norm inequality"


@procedure(NormBound)
def find_norm_bound(statement: NormBound) -> SearchResult:
    """Try the vectors that are worst; where none breaks the bound, prove it by one variable."""
    claim, points = rules.vector_relation(statement).comparison, vector_points(statement)
    result, proof = first_refutation(claim, doubtful(claim, points)), None
    if result is None:
        proof = _by_supremum(statement)
        proof = proof or (_prove_uniform(statement) if statement.power == 0 else _prove_linear(statement))
        result = None if proof.is_proof else first_refutation(claim, points)
    if result is not None:
        return broken(witness_of(result), f"{METHOD}: a vector where it fails", witness_data(result))
    assert proof is not None
    return proof


def vector_points(statement: NormBound) -> list[Point]:
    """The vectors that the reductions say are worst: all entries equal, or one entry alone."""
    grid = sample(ForAll(Relation(statement.component, "<=", ("num", "0"))))
    # where |f(t)| (or |f(t)/t|) is largest on a fine grid of floating point
    x = np.linspace(1e-3, 12.0, 24_000)
    with np.errstate(all="ignore"):
        size = np.abs(values_of(statement.component, {"x": x})) / x**statement.power
    best = float(x[int(np.nanargmax(size))])
    peaks = [Fraction(best).limit_denominator(10**6)]
    names = rules.entries(statement)
    if statement.power == 0:
        return [dict.fromkeys(names, t) for t in [*peaks, *grid]]
    zero = dict.fromkeys(names, Fraction(0))
    return [zero, *({**zero, "x1": t} for t in [*peaks, *grid])]


def _by_supremum(statement: NormBound) -> SearchResult | None:
    relation = rules.supremum_relation(statement)
    numbers = find_relation(relation, METHOD) if relation is not None else None
    if numbers is None or not numbers.is_proof or numbers.proof is None:
        return None
    return shown(Supremum(numbers.proof), numbers.method)


def _prove_uniform(statement: NormBound) -> SearchResult:
    parts = [find_for_all(part) for part in rules.uniform_parts(statement)]
    labels = ("f(t) <= c/√n", "-f(t) <= c/√n")
    why = "all entries equal is the worst case"
    return _reduced(parts, labels, why, lambda proofs: EqualEntries(proofs[0], proofs[1]))


def _prove_linear(statement: NormBound) -> SearchResult:
    parts = [find_for_all(part) for part in rules.linear_parts(statement)]
    labels = ("f(t) <= c|t|", "-f(t) <= c|t|") * 2
    return _reduced(parts, labels, "one entry alone is the worst case", OneEntry)


def _reduced(
    parts: list[SearchResult],
    labels: tuple[str, ...],
    why: str,
    combine: Callable[[tuple[Proof, ...]], Proof],
) -> SearchResult:
    """The norm bound from its inequalities in one variable; a part that fails leaves it open."""
    for label, part in zip(labels, parts, strict=True):
        if not part.is_proof:
            reason = part.reason or "the inequality in one variable fails"
            return still_open(f"reduced to one variable ({why}), which stays open: {label}: {reason}", METHOD)
    methods = "; ".join(dict.fromkeys(part.method for part in parts))
    proofs = tuple(part.proof for part in parts if part.proof is not None)
    return shown(combine(proofs), f"{METHOD}: {why}; {methods}")
