"""Relations that hold for every small enough positive value of one variable ε.

The gap of the conclusion is a polynomial p(ε, t, …), t in (0, 1]. Divided by the powers of ε and t that
divide it, it is continuous on the compact range of t, so p > 0 for small ε as soon as its value at ε = 0 is
positive and free of t. That value is the leading term, and its sign is an implication of its own.
"""

from __future__ import annotations

from flint import fmpq_mpoly

from lyapcheck.check.functions import Unsupported
from lyapcheck.claims.decision import Decision, proved, undecided
from lyapcheck.claims.procedures.implication import EFFORT, Cancellation, Signs
from lyapcheck.claims.statements import ForSmall, Implies, positive
from lyapcheck.verdicts import Grade

METHOD = "small parameter"


def decide_for_small(statement: ForSmall) -> Decision:
    """Decide a relation for every small enough positive value of ``statement.small``; never refutes.

    Soundness: the bounded variables run over a compact range and the gap is a polynomial, so a positive limit
    persists below some threshold that serves them all.
    """
    variables = (*statement.variables, *positive(statement.small, *statement.bounded))
    try:
        signs = Signs(Implies(variables, statement.hypotheses, statement.conclusion))
        limit = leading_term(signs, statement)
        hypotheses = [(signs.polynomial(h), h.strict) for h in statement.hypotheses]
    except Unsupported as problem:
        return undecided(f"{problem}; write the relation between polynomials", METHOD)
    if limit is None:
        return undecided("the leading term depends on a bounded variable; state the claim without it", METHOD)
    depth, nodes = EFFORT[-1]
    if Cancellation(signs, hypotheses, nodes).reaches(limit, True, depth):
        return proved(
            Grade.EXACT, f"{METHOD}: the leading term is positive by an identity with terms of known sign"
        )
    return undecided(
        "the leading term is not shown to be positive; add the hypothesis that makes it so", METHOD
    )


def leading_term(signs: Signs, statement: ForSmall) -> fmpq_mpoly | None:
    """What is left of the gap at ε = 0 after division by common powers; ``None`` if it contains some t."""
    terms = signs.polynomial(statement.conclusion).to_dict()
    names = signs.algebra.names
    free = [names.index(name) for name in (statement.small, *statement.bounded) if name in names]
    lowest = [min((int(e[i]) for e in terms), default=0) for i in free]
    leading = {}
    for exponents, coefficient in terms.items():
        rest = list(map(int, exponents))
        for i, low in zip(free, lowest, strict=True):
            rest[i] -= low
        if rest[free[0]] == 0:
            if any(rest[i] for i in free):
                return None
            leading[tuple(rest)] = coefficient
    return signs.ring.from_dict(leading)
