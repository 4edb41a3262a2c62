"""What bounds of a motion start from, as exact numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.digits import as_written, short_above

Start = tuple[tuple[Fraction, ...], tuple[Fraction, ...]]
"""Bounds of |e_i| in rad and of |w_i| in rad/s."""

LARGEST = 1e3
"""rad, as for simulations."""
FASTEST = 1e3
"""rad/s, as for simulations."""


def start_of(
    controlled: ControlledArm, e0: Sequence[float], w0: Sequence[float] | None, delta: float
) -> Start:
    """What the start is within, in few digits, or every problem with it at once."""
    if not controlled.family.bounded:
        rule = f"{controlled.gains.name} has an unbounded h, of which no margin is known"
        raise argument_error("gains", controlled.gains.name, rule, "choose gains of a bounded family")
    rates = (0.0,) * controlled.n if w0 is None else w0
    problems = [*_vector("e0", e0, controlled.n, LARGEST), *_vector("w0", rates, controlled.n, FASTEST)]
    if not 0.0 < delta <= LARGEST:
        rule = f"must be more than 0 and at most {LARGEST:g} rad"
        problems.append(Problem("argument", None, "delta", str(delta), rule, "give a small angle"))
    if problems:
        raise InputError(problems)
    return _sizes(e0), _sizes(rates)


def _sizes(values: Sequence[float]) -> tuple[Fraction, ...]:
    """Bounds of sizes, in few digits."""
    return tuple(short_above(abs(as_written(x))) for x in values)


def _vector(name: str, values: Sequence[float], n: int, most: float) -> list[Problem]:
    if len(values) == n and all(math.isfinite(x) and abs(x) <= most for x in values):
        return []
    text = ", ".join(f"{float(x):g}" for x in values)
    rule = f"must be {n} finite values of at most {most:g} in size"
    return [Problem("argument", None, name, text, rule, f"give {n} values, one a joint")]


def torques_of(
    controlled: ControlledArm, name: str, values: Sequence[Fraction | float]
) -> tuple[Fraction, ...]:
    """Torques, one a joint and none below 0."""
    if not values:
        return (Fraction(0),) * controlled.n
    if len(values) != controlled.n or not all(math.isfinite(x) and x >= 0 for x in values):
        text = ", ".join(f"{float(x):g}" for x in values)
        rule = f"must be {controlled.n} finite torques in N·m, none below 0"
        raise argument_error(name, text, rule, "give one bound a joint")
    return tuple(as_written(x) for x in values)
