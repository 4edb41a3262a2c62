"""A theorem applied; whether its hypotheses hold, the claims that it uses show.

The checker compares the hypotheses that are named with those of the theorem, and looks into the claim behind
each, which must state what the hypothesis comes to for this loop.
"""

from __future__ import annotations

from lyapcheck.check.kinds.theorem import THEOREMS, Application, Theorem
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims.registry import procedure
from lyapcheck.claims.search_result import SearchResult, shown, still_open


@procedure(Theorem)
def apply_theorem(statement: Theorem) -> SearchResult:
    """The step itself holds; whether its hypotheses do is for the chain of claims to say."""
    if statement.name not in THEOREMS:
        known = "; ".join(sorted(THEOREMS))
        return still_open(f"the checker knows no theorem of that name, only: {known}", "theorem")
    try:
        verify(statement, Application())
    except Refused as refusal:
        return still_open(f"{refusal}; correct the hypotheses or the numbers of the loop", "theorem")
    hypotheses = dict(statement.hypotheses)
    return shown(Application(), f"theorem: {statement.name}", hypotheses=hypotheses)
