"""Statements that come with a proof: what is known against them is known of the statement alone."""

from __future__ import annotations

from random import Random
from typing import Any

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.region import Objection


@kinds.objections_to("ByLinks")
@kinds.objections_to("ByCorners")
@kinds.objections_to("ByLargerKv")
@kinds.objections_to("ByMassAtCorners")
@kinds.objections_to("ByLimits")
def inner(proposed: Any, random: Random) -> Objection | None:
    """Of the statement."""
    return kinds.OBJECTIONS[type(proposed.statement).__name__](proposed.statement, random)
