"""Constants of an arm enclosed before, from the store.

The enclosures are of floating point and decide nothing; what is certified of them, the bounds along the links
of a chain among it, the checker judges each time.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from lyapcheck import store
from lyapcheck._types import Progress
from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.constants import ConstantResult, arm_constants
from lyapcheck.constants.storage.bounds import BoundWithProof, bound_of
from lyapcheck.robots import RobotModel

PLAIN = ("name", "unit", "state", "boxes")


def kept_constants(
    model: RobotModel, budget: int, on_progress: Progress | None
) -> tuple[ConstantResult, ...]:
    """What :func:`arm_constants` finds with a budget of boxes, from the store where it is there."""
    asked = {"constants": store.exact(model), "boxes": budget}
    return store.remembered(
        asked,
        lambda kept: _read(kept, model),
        lambda: arm_constants(model, budget, on_progress=on_progress),
        lambda result: [_written(one) for one in result],
    )


def _written(one: ConstantResult) -> dict[str, Any]:
    ends = [str(one.enclosure.lower), str(one.enclosure.upper)]
    proof = None if one.shown is None else [str(one.shown.bound), to_json(one.shown.proof)]
    return {**{key: getattr(one, key) for key in PLAIN}, "ends": ends, "shown": proof}


def _read(kept: Any, model: RobotModel) -> tuple[ConstantResult, ...] | None:
    """What was written; its bounds are made anew of the links of this arm."""
    try:
        return tuple(_constant(row, model) for row in kept)
    except (Refused, KeyError, TypeError, ValueError, ZeroDivisionError):
        return None


def _constant(row: dict[str, Any], model: RobotModel) -> ConstantResult:
    low, high = map(Fraction, row["ends"])
    state: Sequence[float] = row["state"]
    enclosure = Enclosure(low, high)
    shown = None if row["shown"] is None else _shown(row["name"], row["shown"], model)
    return ConstantResult(row["name"], row["unit"], enclosure, tuple(map(float, state)), row["boxes"], shown)


def _shown(name: str, written: Sequence[Any], model: RobotModel) -> BoundWithProof:
    chain = model.fixed().chain
    if chain is None:
        raise ValueError("the arm has no chain of links")
    bound, proof = written
    return BoundWithProof(bound_of(chain, name, Fraction(bound)), from_json(Proof, proof, "proof"))  # type: ignore[arg-type]
