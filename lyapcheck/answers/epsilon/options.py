"""What is asked beside the gains and the arm: within which limits, for which arm, how hard to search."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck._types import SEED
from lyapcheck.errors import argument_error
from lyapcheck.search.certified import MAX_BOXES
from lyapcheck.search.falsify import STARTS

LARGEST = 10**6
"""rad and rad/s: limits beyond it limit nothing."""


@dataclass(frozen=True)
class StateLimits:
    """Of |w_i|, rad/s, and of |e_i|, rad, one a joint each; none where there is no limit.

    Raises:
        InputError: there are none at all, or one is not above 0, or not finite.
    """

    speeds: tuple[Fraction, ...] = ()
    errors: tuple[Fraction, ...] = ()

    def __post_init__(self) -> None:
        if not self.speeds and not self.errors:
            raise argument_error("limits", "", "must be of speed, of error or of both", "give one of them")
        for name in ("speeds", "errors"):
            for value in getattr(self, name):
                if not 0 < value <= LARGEST:
                    rule = f"must be above 0 and at most {LARGEST}"
                    raise argument_error(name, value, rule, "give a limit that a motion can reach")


@dataclass(frozen=True)
class Options:
    """See :func:`lyapcheck.epsilon`, of which these are the keywords."""

    max_boxes: int = MAX_BOXES
    jobs: int = 1
    ranges: bool = False
    weights: bool = False
    seconds: float | None = None
    starts: int = STARTS
    seed: int = SEED
    limits: StateLimits | None = None
