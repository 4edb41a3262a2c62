"""Relations that hold for every small enough positive value of one variable ε.

The gap of the conclusion is a polynomial p(ε, t, …), t in (0, 1]. Divided by the powers of ε and t that
divide it, it is continuous on the compact range of t, so p > 0 for small ε as soon as its value at ε = 0 is
positive and free of t. That value is the leading term, and its sign is an implication of its own.
"""

from __future__ import annotations

from lyapcheck.check.expressions.expression import Unsupported
from lyapcheck.check.kinds.for_small import ForSmall, LeadingTerm, leading_term, signs_of
from lyapcheck.claims.finding import Finding, shown, still_open
from lyapcheck.claims.procedures.cancellation import Cancellation
from lyapcheck.claims.procedures.implication import EFFORT

METHOD = "small parameter"


def find_for_small(statement: ForSmall) -> Finding:
    """Search an identity of signs for the leading term; never refutes."""
    try:
        signs = signs_of(statement)
        limit = leading_term(signs, statement)
    except Unsupported as problem:
        return still_open(f"{problem}; write the relation between polynomials", METHOD)
    if limit is None:
        return still_open(
            "the leading term depends on a bounded variable; state the claim without it", METHOD
        )
    depth, nodes = EFFORT[-1]
    identity = Cancellation(signs, nodes).identity(limit, True, depth)
    if identity is not None:
        return shown(
            LeadingTerm(identity),
            f"{METHOD}: the leading term is positive by an identity with terms of known sign",
        )
    return still_open(
        "the leading term is not shown to be positive; add the hypothesis that makes it so", METHOD
    )
