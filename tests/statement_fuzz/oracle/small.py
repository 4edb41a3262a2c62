"""Relations for every small enough ε: points at which they fail for ε = 10^-40 and for ever smaller ones."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.evaluate import names
from tests.statement_fuzz.oracle.numbers import Value
from tests.statement_fuzz.oracle.points import candidates
from tests.statement_fuzz.oracle.region import Axis, Objection, Region, Relation

EXPONENTS = (40, 80, 160, 320)
DIGITS = 700
POINTS = 60


@kinds.objections_to("ForSmall")
def for_small(statement: Any, random: Random) -> Objection | None:
    """Four ever smaller ε at which the relation fails, or is undefined, in the same way."""
    axes = tuple(Axis(v.name, v.low, open_low=v.low is not None and v.strict) for v in statement.variables)
    given = tuple(Relation(r.left, r.operator, r.right) for r in statement.hypotheses)
    wanted = statement.conclusion
    claim = Relation(wanted.left, wanted.operator, wanted.right)
    moving = {statement.small, *statement.bounded}
    if any(names(r.left, r.right) & moving for r in given):
        return None
    fixed = Region(axes, (Relation(("num", "0"), "<=", ("num", "0")),), given)
    with mp.workdps(DIGITS):
        for index, point in enumerate(candidates(fixed, random)):
            if index == POINTS:
                break
            shape = random.randrange(4)
            whole = Region((*axes, *(Axis(name) for name in moving)), (claim,), given)
            found = [_at(whole, point, statement, e, shape) for e in EXPONENTS]
            kinds_found = {objection.what if objection else "" for objection in found}
            if len(kinds_found) == 1 and found[0] is not None:
                return found[0]
    return None


def _at(
    region: Region, point: dict[str, Value], statement: Any, exponent: int, shape: int
) -> Objection | None:
    """The objection at one ε, where the bounded variables are 1, ε, ε² or 1/10⁹."""
    region.signs.clear()
    eps = Fraction(1, 10**exponent)
    t = (Fraction(1), eps, eps**2, Fraction(1, 10**9))[shape]
    with exact.kept(False):
        return region.objection({**point, statement.small: eps, **dict.fromkeys(statement.bounded, t)})
