"""Where an arm may rest beside its goal: an error beyond its bound that a torque within its own holds."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import CERTAIN, DIGITS, many
from tests.statement_fuzz.oracle.loop import many_digits
from tests.statement_fuzz.oracle.region import Objection

BEYOND = (Fraction(1, 10**20), Fraction(1, 10**6), Fraction(1, 100), Fraction(1), Fraction(100))


@kinds.objections_to("Resting")
def resting(statement: Any, random: Random) -> Objection | None:
    """A joint and an error somewhat or far beyond its bound, at which it may rest."""
    known = statement.family in ("tanh", "arctan", "algebraic") and statement.m is None
    if not known and (statement.family != "hyperbolic" or statement.m is None):
        return Objection("undefined", f"h, as there is no {statement.family} with m = {statement.m}")
    for joint, bound in enumerate(statement.errors):
        if bound is None:
            continue
        for step in (*BEYOND, Fraction(random.randint(1, 999), 10 ** random.randint(1, 9))):
            if _held(statement, joint, bound + step):
                return Objection("false", f"e{joint + 1} = {float(bound + step)}")
    return None


def _held(statement: Any, joint: int, error: Fraction) -> bool:
    """Whether |k h(error)| is certainly at most the torque."""
    with mp.workdps(DIGITS):
        h = many_digits().h(statement.family, statement.m, many(error))
        ratio = many(statement.torque[joint]) / many(statement.kp[joint])
        return bool(abs(h) <= ratio * (1 - CERTAIN))


@kinds.judges("Resting")
def rests_there(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether the error of the witness is beyond its bound, and held."""
    ((name, text),) = witness["point"].items()
    joint, error = int(name[1:]) - 1, Fraction(text)
    bound = statement.errors[joint]
    return bound is not None and error > bound and _held(statement, joint, error)
