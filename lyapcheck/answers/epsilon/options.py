"""What is asked beside the gains and the arm: for which arm, how hard to search."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck._types import SEED
from lyapcheck.search.certified import MAX_BOXES
from lyapcheck.search.falsify import STARTS


@dataclass(frozen=True)
class Options:
    """See :func:`lyapcheck.epsilon`, of which these are the keywords."""

    max_boxes: int = MAX_BOXES
    jobs: int = 1
    ranges: bool = False
    weights: bool | None = None
    seconds: float | None = None
    starts: int = STARTS
    seed: int = SEED
