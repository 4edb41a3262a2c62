"""Statements that come with a proof: what is known against them is known of the statement alone."""

from __future__ import annotations

from collections.abc import Mapping
from random import Random
from typing import Any

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.region import Objection


@kinds.objections_to("ByLinks")
@kinds.objections_to("ByLargerKv")
@kinds.objections_to("ByMassAtCorners")
@kinds.objections_to("ByRates")
@kinds.objections_to("Altered")
def inner(proposed: Any, random: Random) -> Objection | None:
    """Of the statement."""
    objections = kinds.OBJECTIONS.get(type(proposed.statement).__name__)
    return None if objections is None else objections(proposed.statement, random)


@kinds.judges("Altered")
def at_its_point(proposed: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether a point, where there is one, is a counterexample to the statement."""
    judge = kinds.JUDGEMENTS.get(type(proposed.statement).__name__)
    return None if judge is None or not witness else judge(proposed.statement, witness)
