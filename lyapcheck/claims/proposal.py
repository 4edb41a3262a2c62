"""What is to be decided about one claim for one m, and what the search proposes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from lyapcheck.check.statement import Statement
from lyapcheck.claims.handover import ClaimData, Key
from lyapcheck.claims.search_result import SearchResult, still_open
from lyapcheck.claims.statements import Missing


@dataclass(frozen=True)
class Proposal:
    """A claim for one m (``None``: it does not depend on m), its statement, and what was found.

    ``used`` are the rows that it uses, ``finding`` takes them into account.
    """

    claim: ClaimData
    m: int | None
    n: int | None
    stated: Statement | Missing
    used: tuple[Key, ...]
    finding: SearchResult
    seconds: float


def rests_on(ids: Iterable[str]) -> str:
    """Why a step that holds is not enough."""
    return f"its own step holds, but it rests on {', '.join(ids)}; prove those, or prove it without them"


def chained(finding: SearchResult, statement: Statement | Missing, used: Iterable[Proposal]) -> SearchResult:
    """The finding on a step, open if what it uses does not carry it; a counterexample needs none of that."""
    if not finding.is_proof or isinstance(statement, Missing):
        return finding
    rows = list(used)
    open_uses = [row.claim.id for row in rows if not row.finding.is_proof]
    if open_uses:
        return replace(still_open(rests_on(open_uses), finding.method), evidence=finding.evidence)
    return finding
