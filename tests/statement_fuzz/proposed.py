"""Statements with the proof beside them: what ``propose`` does not look for is put to the checker.

One class a rule, so that each has its row among the counts; the oracle knows of the statement alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.inertia import MassAbove
from lyapcheck.check.kinds.nearby import DecreasingNearby
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import verify
from lyapcheck.verdicts import Verdict


@dataclass(frozen=True)
class Proposed:
    """A statement, and a proof of it or of another one like it."""

    statement: Decreasing | DecreasingNearby | MassAbove
    proof: Proof


class ByLinks(Proposed):
    """dV/dt < 0 by bounds along the links."""


class ByCorners(Proposed):
    """dV/dt < 0 by a tree of boxes at each corner of the ranges of M's parameters."""


class ByLargerKv(Proposed):
    """dV/dt < 0 by a proof for a larger K_v."""


class ByMassAtCorners(Proposed):
    """M ≻ 0 at each corner of the ranges of its parameters."""


class ByLimits(Proposed):
    """dV/dt < 0 within limits of speed and of error."""


def decide_proposed(proposed: Proposed) -> Any:
    """Proved, if the checker takes the proof for the statement."""
    verdict, reason = Verdict.PROVED, ""
    try:
        proposed.statement.require_well_formed()
        verify(proposed.statement, proposed.proof)
    except Refused as refusal:
        verdict, reason = Verdict.UNDECIDED, str(refusal)
    rule = type(proposed.proof).rule
    return SimpleNamespace(verdict=verdict, method=rule, reason=reason, witness=None)
