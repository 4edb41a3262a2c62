"""Statements with the proof beside them: what ``propose`` does not look for is put to the checker.

One class a rule, so that each has its row among the counts; the oracle knows of the statement alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.check.verify import verify
from lyapcheck.verdicts import Verdict


@dataclass(frozen=True)
class Proposed:
    """A statement, and a proof of it or of another one like it."""

    statement: Statement
    proof: Proof


class ByLinks(Proposed):
    """dV/dt < 0 by bounds along the links."""


class ByLargerKv(Proposed):
    """dV/dt < 0 by a proof for a larger K_v."""


class ByMassAtCorners(Proposed):
    """M ≻ 0 at each corner of the ranges of its parameters."""


class ByRates(Proposed):
    """‖C(q, x)x‖ below a bound by rates of M along the links."""


class Altered(Proposed):
    """A certificate of the arena, in which something was changed; it may ask for more than anyone waits."""

    patience = 2


def decide_proposed(proposed: Proposed) -> Any:
    """What the checker takes the proof to show of the statement; whatever goes wrong shows nothing."""
    proof, reason = proposed.proof, ""
    try:
        proposed.statement.require_well_formed()
        verdict = Verdict(verify(proposed.statement, proof).verdict)
    except Exception as refusal:  # as ``check.judging`` does
        verdict, reason = Verdict.UNDECIDED, str(refusal)
    point = {name: str(value) for name, value in proof.point} if isinstance(proof, Witness) else None
    return SimpleNamespace(
        verdict=verdict, method=type(proof).rule, reason=reason, witness=point and {"point": point}
    )
