"""Branch and bound for dV/dt < 0 at every state of an arm, origin and infinity included.

P(q, e) of ``lyapcheck.check.loop`` must be positive definite for all q on the torus, all e, and all
values of what is uncertain about the arm. Boxes are enclosed in intervals, kept if P ≻ 0, else halved.

- **Infinity.** For ‖e‖ ≥ R the scalar form proves dV/dt < 0; boxes outside that ball are not looked at.
- **Origin.** ê = e/‖e‖ has no value at e = 0; its enclosure [−1, 1]ⁿ covers every direction, so boxes that
  touch e = 0 are proved for all of them, e = 0 (where ê counts as 0) included.
- **Symmetry.** Errors that a change of signs turns into others are looked at once, and angles that M does not
  depend on are held at 0.
"""

from __future__ import annotations

import math

import numpy as np

from lyapcheck._types import Progress
from lyapcheck.check.loop.closed_loop import certifies
from lyapcheck.search.centred import judge_of
from lyapcheck.search.cover import CoverOutcome, cover
from lyapcheck.search.schur import SchurProblem


def certify(
    problem: SchurProblem,
    max_boxes: int,
    on_progress: Progress | None = None,
    deadline: float = math.inf,
) -> CoverOutcome:
    """Look for a tree of boxes that proves dV/dt < 0 everywhere for one ε₀, or say why there is none.

    Args:
        problem: what must be positive definite.
        deadline: by the computing time of `lyapcheck.computing`, s.

    Soundness: the tree of the outcome is a proposal for ``lyapcheck.check.loop.proves``.
    """
    loop = problem.loop
    if certifies(loop.tail, loop.eps0):
        return CoverOutcome(True, 0, tree=".")
    start = np.array(loop.start).T[None]
    prove, sides = judge_of(problem)
    return cover(start, prove, sides, max_boxes, on_progress, deadline)
