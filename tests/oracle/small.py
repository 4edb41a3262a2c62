"""Relations for every small enough ε: points at which they fail for ε = 10^-200, 10^-400 and 10^-800.

To be sure that this is what happens in the limit, every part without ε must be 0 or of moderate size there.
"""

from fractions import Fraction
from itertools import islice

from mpmath import mp, mpf

from tests import oracle
from tests.oracle.boxes import Axis, Region, axes_of, numbered, relation
from tests.oracle.numbers import DIGITS, Undefined, Unsure, ends
from tests.oracle.points import candidates
from tests.oracle.trees import Evaluation, names, nodes

EXPONENTS = (200, 400, 800)
MODERATE = mpf(10) ** 35
POINTS = 60
SHAPES = (lambda eps: Fraction(1), lambda eps: eps, lambda eps: eps**2, lambda eps: Fraction(1, 10**9))
"""How the bounded variables depend on ε."""


@oracle.objections_to("ForSmall")
def _for_small(statement, random):
    axes, given = axes_of(statement.variables), tuple(map(relation, statement.hypotheses))
    claim, moving = relation(statement.conclusion), {statement.small, *statement.bounded}
    zero = ("num", "0")
    fixed = Region(axes, ((zero, "<=", zero),), tuple(r for r in given if not names(r[0], r[2]) & moving))
    sides = (side for left, _, right in (claim, *given) for side in (left, right))
    still = [node for node in nodes(*sides) if not names(node) & moving]
    with mp.workdps(DIGITS):
        for point in islice(candidates(fixed, random), POINTS):
            if not _moderate(still, point):
                continue
            for shape in SHAPES if statement.bounded else SHAPES[:1]:
                found = []
                for exponent in EXPONENTS:
                    whole = Region((*axes, *(Axis(name) for name in moving)), (claim,), given)
                    eps = Fraction(1, 10**exponent)
                    at = {**point, statement.small: eps, **dict.fromkeys(statement.bounded, shape(eps))}
                    found.append(whole.objection(at, (DIGITS,)))
                if found[0] is not None and len({one.what if one else "" for one in found}) == 1:
                    return found[0]
    return None


def _moderate(trees, point):
    """Whether the parts without ε are undefined, 0 or between 10⁻³⁵ and 10³⁵ in size."""
    evaluation = Evaluation({name: numbered(value) for name, value in point.items()})
    for tree in trees:
        try:
            low, high = map(abs, ends(evaluation.of(tree)))
        except Undefined:
            continue
        except Unsure:
            return False
        if max(low, high) and not (min(low, high) * MODERATE > 1 and max(low, high) < MODERATE):
            return False
    return True
