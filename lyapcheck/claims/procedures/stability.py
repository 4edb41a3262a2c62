"""Stability of a system that is data: each obligation of the theorem by the search for its kind."""

from __future__ import annotations

from lyapcheck.check.kinds.stability import ByObligations, Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.claims.registry import find, procedure
from lyapcheck.claims.search_result import SearchResult, shown, still_open

METHOD = "obligations of a theorem"


@procedure(Stable, StableArm)
def find_stable(statement: Stable | StableArm) -> SearchResult:
    """Decide every obligation; one that fails leaves the conclusion open, as it is only sufficient."""
    result = [(name, find(one)) for name, one in statement.obligations()]
    rows = [{"part": name, "verdict": one.verdict.value, "method": one.method} for name, one in result]
    for name, one in result:
        if not one.is_proof:
            why = one.reason or f"it is {one.verdict.value}, {one.method}"
            return still_open(f"{name}: {why}", METHOD, parts=rows)
    proofs = tuple(one.proof for _, one in result if one.proof is not None)
    return shown(ByObligations(proofs), METHOD, parts=rows)
