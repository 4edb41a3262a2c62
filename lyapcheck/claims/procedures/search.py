"""Looking for counterexamples, and writing down the ones that balls confirm."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.check.functions import Unsupported
from lyapcheck.check.witness import Comparison, Sides, refutation
from lyapcheck.claims.expressions import Relation

Point = dict[str, Fraction]


def comparison(relation: Relation) -> Comparison:
    """The relation as the trusted checker reads it."""
    return relation.left, relation.operator, relation.right


def first_refutation(
    relation: Relation, points: Iterable[Point], hypotheses: Sequence[Relation] = (), bits: int = 192
) -> tuple[Relation, Point, Sides] | None:
    """The first point at which balls show that the relation fails while every hypothesis holds."""
    given = tuple(map(comparison, hypotheses))
    for point in points:
        try:
            sides = refutation(comparison(relation), point, given, bits)
        except (Unsupported, ValueError, ZeroDivisionError):
            continue
        if sides is not None:
            return relation, point, sides
    return None


def witness_data(relation: Relation, point: Point, sides: Sides, **more: Any) -> dict[str, Any]:
    """A witness as plain data: the exact point, and both sides between decimals."""
    return {
        "point": {name: str(value) for name, value in sorted(point.items())},
        "left": list(sides.left.decimals(12)),
        "operator": relation.operator,
        "right": list(sides.right.decimals(12)),
        **more,
    }
