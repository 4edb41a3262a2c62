"""The ε₀ of the V that ``lyapcheck simulate`` watches: a number, or what is certified for each gain set."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.errors import argument_error

if TYPE_CHECKING:
    from lyapcheck._types import Progress
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

CERTIFIED = "certified"
MAX_BOXES = 100_000
"""Budget of branch and bound for one gain set; ``lyapcheck epsilon`` goes further."""


@dataclass(frozen=True)
class Eps0:
    """What was asked for."""

    number: float | None
    """None where nothing was asked for, and where it is to be certified."""
    certified: bool = False

    def of(self, gain_set: GainSet, model: RobotModel, advance: Progress) -> float | None:
        """The ε₀ of one gain set, rounded down; 0 if nothing was asked for, ``None`` if none is certified."""
        if not self.certified:
            return self.number or 0.0
        from lyapcheck.answers.epsilon import epsilon
        from lyapcheck.check.numbers.enclosure import Enclosure

        advance(0.0, f"{gain_set.name}: what ε₀ is certified")
        result = epsilon(gain_set, model, max_boxes=MAX_BOXES, weights=False).certified
        return None if result is None else Enclosure(result, result).float_lower


def eps0_of(text: str | None) -> Eps0:
    """What ``--eps0`` asks for.

    Raises:
        InputError: neither a number nor ``certified``; a number out of range is refused with its task.
    """
    if text is None or text == CERTIFIED:
        return Eps0(None, text is not None)
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if math.isnan(number):
        rule = f"must be a number or {CERTIFIED}"
        raise argument_error("--eps0", text, rule, f"write --eps0 0.01, or --eps0 {CERTIFIED}")
    return Eps0(number)
