"""What the kind itself thinks worth trying, in turn; the first that its rules accept."""

from __future__ import annotations

from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open


@procedure(Statement)
def find_attempt(statement: Statement) -> SearchResult:
    """For every kind that has no search of its own."""
    reason = f"no search is known for a {type(statement).__name__}, and it names no proofs to try"
    for proof in statement.attempts():
        try:
            verdict = verify(statement, proof).verdict
        except Refused as refusal:
            reason = str(refusal)
            continue
        if verdict == "proved":
            return shown(proof, proof.rule)
        return broken(proof, proof.rule, {"shown by": proof.rule})
    return still_open(reason, "attempts")
