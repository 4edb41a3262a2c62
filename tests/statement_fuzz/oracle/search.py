"""The search for an objection to a statement over a box."""

from __future__ import annotations

from random import Random

from mpmath import mp

from tests.statement_fuzz.oracle.numbers import DIGITS
from tests.statement_fuzz.oracle.points import candidates
from tests.statement_fuzz.oracle.region import Objection, Region


def objection_to(region: Region, random: Random) -> Objection | None:
    """The first objection that a point gives; ``None`` says nothing."""
    with mp.workdps(DIGITS):
        for point in candidates(region, random):
            result = region.objection(point)
            if result is not None:
                return result
    return None
