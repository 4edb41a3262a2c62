"""The bounds of one gain set as plain data."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.check.kinds.phases import FallingPhases, StaysWithin
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.answers.bounds.compare import BoundsComparison
    from lyapcheck.check.statement import Statement
    from lyapcheck.search.decay.results import DisturbanceBound, Provenance, SettlingBound


def comparison_data(result: BoundsComparison) -> dict[str, Any]:
    """One gain set; angles in degrees, rounded up."""
    task = result.task
    return {
        "name": result.settling.name,
        "robot": result.settling.robot,
        "target": [_degrees(x) for x in task.q_d],
        "start": [_degrees(x) for x in task.q0],
        "settling": _settling(result.settling),
        "disturbance": _disturbance(result.disturbance),
        "simulated": {
            "duration": task.T,
            "time": result.simulated_time,
            "time_limit": result.simulated_for,
            "errors": [_degrees(x) for x in result.simulated_errors],
            "rest": [_degrees(x) for x in result.simulated_rest],
        },
        "assumptions": list(result.assumptions),
        "vary": list(result.varies),
        "unvaried": None if result.unvaried is None else comparison_data(result.unvaried),
    }


def _settling(bound: SettlingBound) -> dict[str, Any]:
    return {
        "delta": _degrees(float(bound.delta)),
        "time": above(bound.time),
        "start_level": above(bound.start_level),
        "end_level": below(bound.level),
        "envelope": [{"time": above(t), "level": above(v)} for t, v in bound.envelope],
        "errors": [_degrees_above(x) for x in bound.largest_errors],
        "exponential": bound.exponential,
        "after": _after(bound),
        "phases": _phases(bound),
        "rests_on": _provenance(bound.rests_on),
        "statement": _text(None if bound.shown is None else bound.shown.statement),
        "reason": bound.reason,
    }


def _phases(bound: SettlingBound) -> list[dict[str, Any]]:
    """ε₀ of each phase, from when on, within which errors in degrees and least h(w)/w."""
    proof = None if bound.shown is None else bound.shown.proof
    if not isinstance(proof, FallingPhases):
        return []
    return [
        {
            "time": above(phase.envelope[0][0]),
            "eps0": decimal_text(phase.eps0),
            "errors": [_degrees_above(x) for x in phase.within],
            "floors": [below(x) for x in phase.floors],
        }
        for phase in proof.phases
    ]


def _after(bound: SettlingBound) -> dict[str, Any] | None:
    """How errors die out from the certified time on: sizes in degrees and a scale in s."""
    statement = None if bound.shown is None else bound.shown.statement
    if not isinstance(statement, StaysWithin) or statement.after is None:
        return None
    sizes = [_degrees_above(x) for x in statement.after.sizes]
    return {"sizes": sizes, "scale": above(statement.after.scale)}


def _disturbance(bound: DisturbanceBound) -> dict[str, Any]:
    return {
        "torque": [above(x) for x in bound.torque],
        "friction": [above(x) for x in bound.dry],
        "time": above(bound.time),
        "level": above(bound.level),
        "errors": [_degrees_above(x) for x in bound.errors],
        "comes_to_rest": bound.comes_to_rest,
        "rest": [None if x is None else _degrees_above(x) for x in bound.rest],
        "rests_on": _provenance(bound.rests_on),
        "statement": _text(None if bound.shown is None else bound.shown.statement),
        "rest_statement": _text(None if bound.resting is None else bound.resting.statement),
        "reason": bound.reason,
    }


def _text(statement: Statement | None) -> str | None:
    """What the checker accepted, in words."""
    return None if statement is None else statement.text()


def _provenance(result: Provenance | None) -> dict[str, Any] | None:
    if result is None:
        return None
    shares = {"friction_share": result.friction, "stiffness_share": result.stiffness}
    numbers = {"eps0": result.eps0, **shares}
    return {
        "by": result.by,
        "phases": result.phases,
        "boxes": result.boxes,
        **{name: decimal_text(value) for name, value in numbers.items()},
    }


def above(value: Fraction | None) -> float | None:
    """The smallest double that is not below."""
    return None if value is None else Enclosure(value, value).float_upper + 0.0  # −0.0 is written 0.0


def below(value: Fraction | None) -> float | None:
    """The largest double that is not above."""
    return None if value is None else Enclosure(value, value).float_lower


def _degrees(x: float) -> float:
    return round(math.degrees(x), 9)


def _degrees_above(x: Fraction) -> float:
    """Degrees, rounded up by more than the conversion can err."""
    return math.ceil(math.degrees(x) * 1e6 * (1 + 1e-14)) / 1e6
