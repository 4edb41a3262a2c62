"""Looking for counterexamples, and writing down the ones that balls confirm."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.check.certificates import proofs
from lyapcheck.check.functions import Unsupported
from lyapcheck.check.witness import Comparison, Sides, refutation

BITS = 192

Point = dict[str, Fraction]
Failure = tuple[Comparison, Point, Sides]


def first_refutation(
    claim: Comparison, points: Iterable[Point], hypotheses: Sequence[Comparison] = ()
) -> Failure | None:
    """The first point at which balls show that the relation fails while every hypothesis holds."""
    for point in points:
        try:
            sides = refutation(claim, point, tuple(hypotheses), BITS)
        except (Unsupported, ValueError, ZeroDivisionError):
            continue
        if sides is not None:
            return claim, point, sides
    return None


def witness_of(failure: Failure) -> proofs.Witness:
    """The failure as the checker replays it."""
    return proofs.Witness(point_of(failure[1]), BITS)


def point_of(point: Point) -> proofs.Point:
    """A point as certificates write it."""
    return tuple(sorted(point.items()))


def witness_data(failure: Failure, **more: Any) -> dict[str, Any]:
    """A witness as plain data: the exact point, and both sides between decimals."""
    claim, point, sides = failure
    return {
        "point": {name: str(value) for name, value in sorted(point.items())},
        "left": list(sides.left.decimals(12)),
        "operator": claim[1],
        "right": list(sides.right.decimals(12)),
        **more,
    }
