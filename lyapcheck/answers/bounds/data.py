"""The bounds of one gain set as plain data."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.check.numbers.enclosure import Enclosure

if TYPE_CHECKING:
    from lyapcheck.answers.bounds.compare import BoundsComparison


def comparison_data(result: BoundsComparison) -> dict[str, Any]:
    """One gain set; angles in degrees, those that are proved rounded up."""
    task, promise = result.task, result.promise
    return {
        "name": result.gains.name,
        "robot": result.robot,
        "target": [_degrees(x) for x in task.q_d],
        "start": [_degrees(x) for x in task.q0],
        "settling": {"delta": _degrees(result.delta)},
        "disturbance": {
            "friction": [above(x) for x in result.dry],
            "rest": [None if x is None else float(x) for x in result.rest_degrees],
            "rest_statement": None if promise is None else promise.says(promise.shown.statement.text()),
            "reason": result.reason,
        },
        "simulated": {
            "duration": task.T,
            "time": result.simulated_time,
            "largest": [_degrees(x) for x in result.simulated_largest],
            "rest": [_degrees(x) for x in result.simulated_rest],
        },
        "assumptions": list(result.assumptions),
        "vary": list(result.varies),
        "unvaried": None if result.unvaried is None else comparison_data(result.unvaried),
    }


def above(value: Fraction | None) -> float | None:
    """The smallest double that is not below."""
    return None if value is None else Enclosure(value, value).float_upper + 0.0  # −0.0 is written 0.0


def _degrees(x: float) -> float:
    return round(math.degrees(x), 9)
