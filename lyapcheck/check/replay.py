"""Points at which a statement fails, replayed in balls.

References: ``johansson2017arb``.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from lyapcheck.check.expressions.defined import require_defined_at
from lyapcheck.check.expressions.witness import Comparison, refutation
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Point, Variable

MAX_BITS = 16_384


def require_bits(bits: int) -> int:
    """A precision that is meaningful and within reach.

    Raises:
        Refused: it is neither.
    """
    require(32 <= bits <= MAX_BITS, "bits", bits, f"must be from 32 to {MAX_BITS}")
    return bits


def coordinates(point: Point, names: Iterable[str]) -> dict[str, Fraction]:
    """The coordinates of a point by name.

    Raises:
        Refused: a name of the statement is missing, a coordinate is given twice or is of no variable.
    """
    found = dict(point)
    wanted = set(names)
    shown = ", ".join(name for name, _ in point)
    require(len(found) == len(point), "point", shown, "gives one coordinate twice")
    require(set(found) == wanted, "point", shown, f"must give {', '.join(sorted(wanted)) or 'nothing'}")
    return found


def require_inside(variables: Iterable[Variable], point: dict[str, Fraction]) -> None:
    """Refuse a point that lies outside the ranges of the variables.

    Raises:
        Refused: a coordinate is at or below what bounds it.
    """
    for v in variables:
        x = point[v.name]
        inside = v.low is None or x > v.low or (x == v.low and not v.strict)
        require(inside, v.name, x, f"must be {'above' if v.strict else 'at least'} {v.low}")


def require_failure(
    conclusion: Comparison, point: dict[str, Fraction], bits: int, hypotheses: tuple[Comparison, ...] = ()
) -> None:
    """Refuse a point at which it is not shown that the hypotheses hold and the conclusion fails.

    Raises:
        Undefined: a term has no value there.
        Refused: the balls do not tell, or tell the contrary.
    """
    for left, _, right in (conclusion, *hypotheses):
        require_defined_at(left, point)
        require_defined_at(right, point)
    if refutation(conclusion, point, hypotheses, require_bits(bits)) is None:
        shown = ", ".join(f"{name} = {value}" for name, value in point.items())
        raise Refused("point", shown, "is not shown to break the statement")
