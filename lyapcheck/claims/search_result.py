"""What a search proposes: a proof or a refutation for the checker to judge, or why there is none."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import Any, TypeVar

from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.output.digits import decimals
from lyapcheck.verdicts import Grade, Verdict

Number = Enclosure | Fraction | int


@dataclass(frozen=True)
class SearchResult:
    """A verdict that a search expects the checker to reach with ``proof``; none for an open statement.

    ``grade`` is the one that ``proof`` is expected to get.
    """

    verdict: Verdict
    method: str
    proof: Proof | None = None
    reason: str = ""
    witness: dict[str, Any] | None = None
    evidence: dict[str, Any] = field(default_factory=dict)
    grade: Grade = Grade.NUMERIC

    @property
    def is_proof(self) -> bool:
        """Whether the search expects the statement to be proved."""
        return self.verdict is Verdict.PROVED


def shown(proof: Proof, method: str, **evidence: Any) -> SearchResult:
    """A proof was found."""
    return SearchResult(Verdict.PROVED, method, proof, evidence=evidence)


def broken(proof: Proof, method: str, witness: dict[str, Any], **evidence: Any) -> SearchResult:
    """A counterexample was found."""
    return SearchResult(Verdict.REFUTED, method, proof, witness=witness, evidence=evidence)


def failing(
    point: Mapping[str, object], left: Number | list[str], operator: str, right: Number | list[str]
) -> dict[str, Any]:
    """Where a relation fails: the point, and both sides there to twelve digits unless written already."""
    below, above = (side if isinstance(side, list) else between(side) for side in (left, right))
    shown = {name: str(value) for name, value in point.items()}
    return {"point": shown, "left": below, "operator": operator, "right": above}


def between(number: Number, digits: int = 12) -> list[str]:
    """The two decimals between which a number lies; twice the same where it is short."""
    return list(decimals(number if isinstance(number, Enclosure) else Enclosure.exact(number), digits))


def entries(**vectors: Iterable[object]) -> dict[str, str]:
    """The entries of vectors by their letters: ``q1``, ``q2``, …"""
    return {
        f"{letter}{i}": str(entry)
        for letter, vector in vectors.items()
        for i, entry in enumerate(vector, start=1)
    }


def still_open(reason: str, method: str, **evidence: Any) -> SearchResult:
    """Nothing was found; the reason says what to try next."""
    return SearchResult(Verdict.UNDECIDED, method, reason=reason, evidence=evidence)


# --- Which search decides which kind of statement: each says so where it is defined.


Procedure = Callable[[Any], SearchResult]
PROCEDURES: dict[type[Statement], Procedure] = {}

Search = TypeVar("Search", bound=Procedure)


def procedure(*kinds: type[Statement]) -> Callable[[Search], Search]:
    """Enter a function as the search for some kinds of statement."""

    def enter(search: Search) -> Search:
        PROCEDURES.update(dict.fromkeys(kinds, search))
        return search

    return enter


def procedure_of(kind: type[Statement]) -> Procedure:
    """The search for a kind: its own, else that of the kind it derives from."""
    return next(PROCEDURES[base] for base in kind.__mro__ if base in PROCEDURES)


@lru_cache(maxsize=1024)
def find(statement: Statement) -> SearchResult:
    """What the search for the kind of a statement finds; not yet judged. Claims share facts: each once."""
    return procedure_of(type(statement))(statement)
