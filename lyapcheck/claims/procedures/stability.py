"""Stability of a system that is data: each obligation of the theorem by the search for its kind."""

from __future__ import annotations

from lyapcheck.check.kinds.stability import ByObligations, Property, Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.systems.obligations import never_met
from lyapcheck.claims.procedures.implication import counterexample
from lyapcheck.claims.procedures.search import witness_of
from lyapcheck.claims.search_result import SearchResult, find, procedure, proposed_word, shown, still_open

METHOD = "obligations of a theorem"
SHORT = 60
"""Characters up to which an obligation that fails is written out."""


@procedure(Stable, StableArm, Property)
def find_stable(statement: Stable | StableArm | Property) -> SearchResult:
    """Decide the obligations up to one that fails: the conclusion is open then, as it is sufficient only."""
    never = None if isinstance(statement, StableArm) else never_met(statement.argument)
    point = None if never is None else counterexample(never)
    if never is not None and point is None:
        return still_open("conditions: no constants were found that meet them; a theorem needs some", METHOD)
    proofs, rows = [], []
    for name, obligation in statement.obligations():
        one = find(obligation)
        rows.append({"part": name, "verdict": proposed_word(one.verdict), "method": one.method})
        if not one.is_proof or one.proof is None:
            text = obligation.text()
            what = text if len(text) <= SHORT else "it"
            why = one.reason or f"{what} is {one.verdict.value}, {one.method}"
            return still_open(f"{name}: {why}", METHOD, parts=rows)
        proofs.append(one.proof)
    met = None if point is None else witness_of(point)
    return shown(ByObligations(tuple(proofs), met), METHOD, parts=rows)
