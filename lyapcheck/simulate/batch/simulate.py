"""Thousands of runs of the closed loop (11) at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress, silent
from lyapcheck.family import Family
from lyapcheck.simulate.batch.integrator import InitialValueProblems, integrated
from lyapcheck.simulate.batch.right_side import RightSide
from lyapcheck.simulate.batch.task import BatchTask, IntegratedRuns, Runs, batch_task, grouped, runs_of
from lyapcheck.simulate.integrate import MAX_STEPS
from lyapcheck.simulate.results import bands

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


TOLERANCE = 1e-12
"""Relative tolerance per step; the paper's runs then err by less than 1e-8."""

POINTS = 501
"""Samples of a run: every 10 ms of the paper's five seconds."""

_NUMBERS_AT_ONCE, _RUNS_AT_ONCE = 8_000_000, 1000
"""Numbers of paths held at once (64 MB), and runs: more do not stay in the cache, fewer waste calls."""


def simulate_many(
    gain_set: GainSet | Sequence[GainSet],
    model: RobotModel,
    q_d: Any,
    starts: Any,
    T: float = 5.0,
    *,
    w0: Any = 0.0,
    parameters: Mapping[str, Any] | None = None,
    eps0: float | None = None,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    motions: bool = False,
    on_progress: Progress | None = None,
) -> Runs:
    """Move an arm along (11) from many starts, with many gains, or with many values of its parameters.

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w for R runs, each with its own steps of the method
    DOP853. Their right side is compiled where there is a C compiler, else evaluated by NumPy from the same
    expressions. Whatever is given once holds for all runs.

    Args:
        gain_set: the controller, or R of them, of any families.
        model: the arm.
        q_d: goals in rad, (n,) or (R, n).
        starts: initial positions in rad, (n,) or (R, n).
        T: seconds.
        w0: initial rates in rad/s, a number, (n,) or (R, n).
        parameters: values of uncertain parameters by name, a number or (R,); nominal where not given.
        eps0: the ε₀ of V; 0 if missing, and then V is the energy.
        points: samples of each run, evenly spaced, both ends included; indices do not depend on them.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.
        max_steps: a budget for each run.
        motions: keep q, w and V at all samples.
        on_progress: receives the fraction done.

    Returns:
        Arrays with one row a run. A run that could not be finished is marked, and does not stop the others.

    Raises:
        InputError: a task the arm cannot be given.

    Soundness: floating point throughout: evidence, never a proof, and never part of a verdict. The error
    of a path is estimated by running again at a smaller tolerance; a peak that begins and ends within a
    quarter of one step is not seen.

    References: (6), (11), (12), (20) of ``reyes2019family``; ``hairer1993solving``.
    """
    sets = list(gain_set) if isinstance(gain_set, Sequence) else [gain_set]
    rates = np.full(model.n, w0) if np.ndim(w0) == 0 else w0
    vectors = {"q_d": q_d, "starts": starts, "w0": rates}
    task = batch_task(
        sets, model, vectors, parameters or {}, T=T, eps0=0.0 if eps0 is None else eps0, points=points
    )
    runs = len(task.gains)
    rows: dict[str, Any] = {}
    engines: list[str] = []
    done = 0
    for family, chosen in _shares(task, points):
        side = RightSide(model, family)
        q_d, y0, own = (np.ascontiguousarray(x[chosen]) for x in (task.q_d, task.y0, task.parameters))
        settling = bands(q_d - y0[:, : model.n])
        problems = InitialValueProblems(y0, own, settling, T, points, tolerance, max_steps)
        paths = integrated(side, problems)
        part = IntegratedRuns(T, q_d, paths, energy=not eps0)
        columns = part.rows() | (_motions(side, part, own) if motions else {})
        for name, column in columns.items():
            rows.setdefault(name, np.empty((runs, *column.shape[1:]), column.dtype))[chosen] = column
        engines.append(side.engine)
        done += chosen.size
        (on_progress or silent)(done / runs, "")
    return runs_of(np.linspace(0.0, T, points), rows, " and ".join(dict.fromkeys(engines)))


def _shares(task: BatchTask, points: int) -> Iterator[tuple[Family, NDArray[np.intp]]]:
    """The runs of one family after the other, as many at once as memory is meant for."""
    size = min(max(1, _NUMBERS_AT_ONCE // (points * task.y0.shape[1])), _RUNS_AT_ONCE)
    for family, chosen in grouped(task.gains):
        for start in range(0, chosen.size, size):
            yield family, chosen[start : start + size]


def _motions(side: RightSide, part: IntegratedRuns, parameters: Array) -> dict[str, Array]:
    """q, w and V at all samples; NaN where a run failed."""
    n, y, columns = side.model.n, part.paths.y, np.ascontiguousarray(parameters.T)
    V = np.stack([side.watched(y[:, k].T, columns)[n] for k in range(y.shape[1])], axis=1)
    return {"q": y[:, :, :n], "w": y[:, :, n : 2 * n], "V": V}
