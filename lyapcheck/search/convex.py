"""The one place where a convex solver is asked: an answer, almost one, or why there is none."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck._types import Array


PANIC = "PanicException"
"""What Clarabel, which is written in Rust, raises where it gives up; it is no ``Exception``."""


class Ended(Enum):
    """How a solver has ended."""

    SOLVED = "solved"
    ALMOST = "almost solved"
    """Within wider tolerances than were asked for."""
    FAILED = "failed"


@dataclass(frozen=True)
class Solution:
    """What a solver has found.

    Args:
        ended: how it has ended.
        values: of the variables asked about, finite; empty where it failed.
        reason: in words, where it is not solved.
    """

    ended: Ended
    values: tuple[Array, ...] = ()
    reason: str = ""


def solved(aim: Any, constraints: Sequence[Any], variables: Sequence[Any]) -> Solution:
    """Ask Clarabel for variables of CVXPY; whatever it does, something is said.

    Args:
        aim: what is to be maximised.
        constraints: under which.
        variables: whose values are wanted.
    """
    import cvxpy as cp
    import numpy as np

    problem = cp.Problem(cp.Maximize(aim), list(constraints))
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # what is inaccurate is told by the status
            problem.solve(solver=cp.CLARABEL)
    except BaseException as error:
        if not isinstance(error, Exception) and type(error).__name__ != PANIC:
            raise
        return _failed(f"{type(error).__name__}: {' '.join(str(error).split())}")
    almost = problem.status == cp.OPTIMAL_INACCURATE
    if problem.status != cp.OPTIMAL and not almost:
        return _failed(f"Clarabel says {problem.status}")
    values = tuple(np.asarray(np.nan if one.value is None else one.value, dtype=float) for one in variables)
    if not all(np.isfinite(value).all() for value in values):
        return _failed("Clarabel gives no numbers")
    return Solution(Ended.ALMOST if almost else Ended.SOLVED, values, Ended.ALMOST.value if almost else "")


def _failed(reason: str) -> Solution:
    return Solution(Ended.FAILED, reason=reason)
