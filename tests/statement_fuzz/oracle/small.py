"""Relations for every small enough ε: points at which they fail for ε = 10^-200, 10^-400 and 10^-800.

To be sure that this is what happens in the limit, every part without ε must be 0 or of moderate size there.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp, mpf

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.evaluate import Evaluation, Tree, names, nodes
from tests.statement_fuzz.oracle.functions import ends
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure, Value
from tests.statement_fuzz.oracle.points import candidates
from tests.statement_fuzz.oracle.region import Axis, Objection, Region, Relation

EXPONENTS = (200, 400, 800)
MODERATE = mpf(10) ** 35
POINTS = 60

Shape = Callable[[Fraction], Fraction]
SHAPES: tuple[Shape, ...] = (
    lambda eps: Fraction(1),
    lambda eps: eps,
    lambda eps: eps**2,
    lambda eps: Fraction(1, 10**9),
)
"""How the bounded variables depend on ε."""


@kinds.objections_to("ForSmall")
def for_small(statement: Any, random: Random) -> Objection | None:
    """Ever smaller ε at which the relation fails, or is undefined, in the same way."""
    axes = tuple(Axis(v.name, v.low, open_low=v.low is not None and v.strict) for v in statement.variables)
    given = tuple(Relation(r.left, r.operator, r.right) for r in statement.hypotheses)
    wanted = statement.conclusion
    claim = Relation(wanted.left, wanted.operator, wanted.right)
    moving = {statement.small, *statement.bounded}
    if any(names(r.left, r.right) & moving for r in given):
        return None
    fixed = Region(axes, (Relation(("num", "0"), "<=", ("num", "0")),), given)
    still = [node for node in nodes(claim.left, claim.right) if not names(node) & moving]
    with mp.workdps(DIGITS):
        for index, point in enumerate(candidates(fixed, random)):
            if index == POINTS:
                break
            if not _moderate(still, point):
                continue
            whole = Region((*axes, *(Axis(name) for name in moving)), (claim,), given)
            for shape in SHAPES if statement.bounded else SHAPES[:1]:
                result = [_at(whole, point, statement, e, shape) for e in EXPONENTS]
                if result[0] is not None and len({one.what if one else "" for one in result}) == 1:
                    return result[0]
    return None


def _moderate(trees: list[Tree], point: dict[str, Value]) -> bool:
    """Whether the parts without ε are undefined, 0 or between 10⁻³⁵ and 10³⁵ in size."""
    evaluation = Evaluation(point)
    for tree in trees:
        try:
            low, high = ends(evaluation.of(tree))
        except Undefined:
            continue
        except Unsure:
            return False
        size = max(abs(low), abs(high))
        if size and not (min(abs(low), abs(high)) * MODERATE > 1 and size < MODERATE):
            return False
    return True


def _at(
    region: Region, point: dict[str, Value], statement: Any, exponent: int, shape: Shape
) -> Objection | None:
    """The objection at one ε, with the bounded variables as a function of it."""
    region.signs.clear()
    eps = Fraction(1, 10**exponent)
    t = shape(eps)
    with exact.kept(False):
        return region.objection({**point, statement.small: eps, **dict.fromkeys(statement.bounded, t)})
