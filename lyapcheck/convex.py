"""The one place where convex solvers are asked: an answer, almost one, or why there is none."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

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
        values: of the variables asked about, finite; where it failed the last that it came to, if any.
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

    def solve() -> None:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # what is inaccurate is told by the status
            problem.solve(solver=cp.CLARABEL)

    _, fault = _asked(solve)
    if fault:
        return _failed(fault)
    almost = problem.status == cp.OPTIMAL_INACCURATE
    if problem.status != cp.OPTIMAL and not almost:
        return _failed(f"Clarabel says {problem.status}")
    values = tuple(np.asarray(np.nan if one.value is None else one.value, dtype=float) for one in variables)
    if not all(np.isfinite(value).all() for value in values):
        return _failed("Clarabel gives no numbers")
    return Solution(Ended.ALMOST if almost else Ended.SOLVED, values, Ended.ALMOST.value if almost else "")


Block = tuple["Array", "Mapping[int, Array]"]
"""constant + Σ_i x_i slope_i ⪰ 0, slopes by i."""


def solved_cones(aim: Array, blocks: Sequence[Block], tolerance: float) -> Solution:
    """Ask Clarabel itself for the x of least aim·x for which matrices are positive semidefinite.

    The answer is the same on any number of cores.

    Args:
        aim: (N,)
        blocks: the matrices.
        tolerance: of the gap and of what is feasible.
    """
    import clarabel
    import numpy as np
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.chordal_decomposition_enable = False
    settings.direct_solve_method, settings.max_threads = "faer", 1
    settings.tol_gap_rel = settings.tol_gap_abs = settings.tol_feas = tolerance
    constants, entries, places, begin = [], [], [], 0
    for constant, slopes in blocks:
        constants.append(_stacked(constant))
        stacked = -np.array([_stacked(slope) for slope in slopes.values()])
        which, row = np.nonzero(stacked)
        entries.append(stacked[which, row])
        places.append((begin + row, np.array(list(slopes))[which]))
        begin += len(constants[-1])
    table = (np.concatenate(entries), np.hstack(places))
    rows = sparse.coo_matrix(table, shape=(begin, len(aim))).tocsc()
    cones = [clarabel.PSDTriangleConeT(len(constant)) for constant, _ in blocks]
    given = sparse.csc_matrix((len(aim), len(aim))), aim, rows, np.concatenate(constants), cones, settings
    result, fault = _asked(lambda: clarabel.DefaultSolver(*given).solve())
    if fault:
        return _failed(fault)
    x, said = np.array(result.x), str(result.status)
    if not np.isfinite(x).all():
        return _failed("Clarabel gives no numbers")
    ended = {"Solved": Ended.SOLVED, "AlmostSolved": Ended.ALMOST}.get(said, Ended.FAILED)
    return Solution(ended, (x,), "" if ended is Ended.SOLVED else f"Clarabel says {said}")


def _stacked(matrix: Array) -> Array:
    """The upper triangle by columns, off the diagonal times √2, as Clarabel wants it."""
    import numpy as np

    columns, rows = np.tril_indices(len(matrix))
    return np.asarray(matrix[rows, columns] * np.where(rows == columns, 1.0, np.sqrt(2.0)))


def _asked(solve: Callable[[], Any]) -> tuple[Any, str]:
    """What a solver gives, or in words what it raises."""
    try:
        return solve(), ""
    except BaseException as error:
        if not isinstance(error, Exception) and type(error).__name__ != PANIC:
            raise
        return None, f"{type(error).__name__}: {' '.join(str(error).split())}"


def _failed(reason: str) -> Solution:
    return Solution(Ended.FAILED, reason=reason)
