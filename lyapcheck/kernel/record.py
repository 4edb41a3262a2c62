"""What Coq's kernel has accepted before, so that ``check`` and reports can say so without Coq.

The record has digests: of the page of definitions, and of each printed proposition. Whatever changes a claim,
the way in which it is printed or what its words mean changes a digest, and the claim has no kernel verdict
until Coq has accepted it anew. ``recheck --kernel`` never looks here.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from lyapcheck.check.statement import Proof, Statement
from lyapcheck.kernel.coq import Kernel, formal
from lyapcheck.kernel.statements import shown
from lyapcheck.kernel.terms import NotPrinted

GRADE = "kernel"
FILE = Path(__file__).with_name("accepted.json")


def accepted_before(statement: Statement, proof: Proof, verdict: str) -> bool:
    """Whether the record has the proposition that a certificate shows."""
    try:
        proposition = shown(statement, proof, verdict)
    except NotPrinted:
        return False
    return digest(proposition) in _record()


def written(results: Iterable[Kernel]) -> str:
    """The record as text: that of the same definitions so far, and what Coq's kernel has accepted now."""
    known = _record() | {digest(one.theorem): one.axioms for one in results if one.accepted}
    return json.dumps({"definitions": _definitions(), "accepted": known}, indent=1, sort_keys=True) + "\n"


def digest(proposition: str) -> str:
    """SHA-256 of a printed proposition."""
    return hashlib.sha256(proposition.encode()).hexdigest()


@cache
def _record() -> dict[str, str]:
    """The golden list of each accepted proposition by its digest; none if the definitions have changed."""
    data = json.loads(FILE.read_text(encoding="utf-8"))
    accepted: dict[str, str] = data["accepted"]
    return accepted if data["definitions"] == _definitions() else {}


def _definitions() -> str:
    return hashlib.sha256((formal() / "Definitions.v").read_bytes()).hexdigest()
