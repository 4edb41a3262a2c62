"""Thousands of runs of the closed loop (11) at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress, silent
from lyapcheck.lyapunov.numeric import arm_digest
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import LEAST_ENERGY, V_NOISE
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.integrate import MAX_STEPS
from lyapcheck.simulate.march import FAILURES, March
from lyapcheck.simulate.results import LEAST_STEP, bands
from lyapcheck.simulate.run import Simulated
from lyapcheck.simulate.seen import RightSide
from lyapcheck.simulate.task import Task, motor_limits

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

TOLERANCE = 1e-12
"""Relative tolerance per step; the paper's runs then err by less than 1e-8."""
POINTS = 501
"""Samples of a run: every 10 ms of the paper's five seconds."""
_NUMBERS_AT_ONCE, _RUNS_AT_ONCE = 8_000_000, 1000
"""Numbers of paths held at once (64 MB), and runs: more do not stay in the cache, fewer waste calls."""


@dataclass(frozen=True, eq=False)
class Runs:
    """R motions of one arm; rows in the order of the starts, NaN where a run did not reach its end.

    Indices are those of a single `Run`: of the polynomials between the ends of the integrator's steps.
    """

    t: Array
    """(points,) s, of the samples."""
    L2: Array
    """(R,) degrees, (20)."""
    settling: Array
    """(R, n) s, 2 % of the step."""
    overshoot: Array
    """(R, n) per cent of the step."""
    peak_torque: Array
    """(R, n) N·m."""
    final_error: Array
    """(R, n) degrees."""
    V_rise: Array
    """(R,) J, the most V was above what it had been, looked at four times a step; negative if it fell."""
    complete: NDArray[np.bool_]
    """(R,) whether the run reached T."""
    failure: tuple[str, ...]
    """Why it did not; empty if it did."""
    steps: NDArray[np.int32]
    """(R,) steps tried by the integrator."""
    engine: str
    """``compiled``, ``numpy``, or both if families differ in what they can use."""
    q: Array | None = None
    """(R, points, n) rad, where motions were asked for."""
    w: Array | None = None
    """(R, points, n) rad/s, where motions were asked for."""
    V: Array | None = None
    """(R, points) J for the ε₀ given, where motions were asked for."""


def simulate_many(
    gain_set: GainSet | Sequence[GainSet],
    model: RobotModel | Sequence[RobotModel],
    q_d: Any,
    starts: Any,
    T: float = 5.0,
    *,
    w0: Any = 0.0,
    eps0: float = 0.0,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    motions: bool = False,
    on_progress: Progress | None = None,
) -> Runs:
    """Move an arm along (11) from many starts, or with many gains.

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w for R runs, each with its own steps of the method
    DOP853. Their right side is compiled where there is a C compiler, else evaluated by NumPy from the same
    expressions. Whatever is given once holds for all runs.

    Args:
        gain_set: the controller, or R of them, of any families.
        model: the arm, at its nominal numbers, or R arms of n joints; those that differ in friction alone
            move together.
        q_d: goals in rad, (n,) or (R, n).
        starts: initial positions in rad, (n,) or (R, n).
        T: seconds.
        w0: initial rates in rad/s, a number, (n,) or (R, n).
        eps0: the ε₀ of V; with 0 V is the energy.
        points: samples of each run, evenly spaced, both ends included; indices do not depend on them.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.
        max_steps: a budget for each run.
        motions: keep q, w and V at all samples.
        on_progress: receives the fraction done.

    Returns:
        Arrays with one row a run. A run that could not be finished is marked, and does not stop the others.

    Raises:
        InputError: gains for another number of joints.

    Soundness: floating point throughout: evidence, never a proof, and never part of a verdict. The error
    of a path is estimated by running again at a smaller tolerance; a peak that begins and ends within a
    quarter of one step is not seen.

    References: (6), (11), (12), (20) of ``reyes2019family``; ``hairer1993solving``.
    """
    sets = list(gain_set) if isinstance(gain_set, Sequence) else [gain_set]
    models = list(model) if isinstance(model, Sequence) else [model]
    n = models[0].n
    count = max(len(sets), len(models), *(len(np.atleast_2d(x)) for x in (q_d, starts, w0)))
    goals, first, speeds = (np.broadcast_to(np.asarray(x, float), (count, n)) for x in (q_d, starts, w0))
    gains = [ControlledArm(one, models[0]) for one in sets] * (count if len(sets) == 1 else 1)
    control = [np.array([gain.kp for gain in gains]), np.array([gain.kv for gain in gains])]
    arms = models * (count if len(models) == 1 else 1)
    y0 = np.hstack([first, speeds, np.zeros((count, 2))])

    digests, numbers = {}, {}
    for arm in {id(arm): arm for arm in models}.values():
        digests[id(arm)] = arm_digest(arm)
        of_arm = (*arm.viscous, *arm.parameters.values())
        numbers[id(arm)] = [*(float(number.value) for number in of_arm), eps0]
    alike: dict[Any, list[int]] = {}
    for i, (gain, arm) in enumerate(zip(gains, arms, strict=True)):
        alike.setdefault((gain.family, digests[id(arm)]), []).append(i)
    most = min(max(1, _NUMBERS_AT_ONCE // (points * y0.shape[1])), _RUNS_AT_ONCE)
    columns: dict[str, Any] = {}
    engines: list[str] = []
    done = 0
    for (family, _), places in alike.items():
        side = RightSide(arms[places[0]], family)
        engines.append(side.engine)
        for start in range(0, len(places), most):
            chosen = places[start : start + most]
            goal, begin = (np.ascontiguousarray(x[chosen]) for x in (goals, y0))
            known = [numbers[id(arms[i])] for i in chosen]
            own = np.column_stack([goal, *(x[chosen] for x in control), known])
            settling = bands(goal - begin[:, :n])
            march = March(side, begin, own, settling, T, points, tolerance, max_steps)
            part = _indices(T, goal, march)
            if motions:
                y, p = march.path, np.ascontiguousarray(own.T)
                V = np.stack([side.watched(y[:, k].T, p)[n] for k in range(points)], axis=1)
                part |= {"q": y[:, :, :n], "w": y[:, :, n : 2 * n], "V": V}
            for name, column in part.items():
                columns.setdefault(name, np.empty((count, *column.shape[1:]), column.dtype))[chosen] = column
            done += len(chosen)
            (on_progress or silent)(done / count, "")
    status = columns.pop("status")
    reasons = tuple(FAILURES[code] for code in status)
    engine = " and ".join(dict.fromkeys(engines))
    t = np.linspace(0.0, T, points)
    return Runs(t=t, complete=status == 0, failure=reasons, engine=engine, **columns)


def _indices(T: float, goal: Array, march: March) -> dict[str, Any]:
    """The numbers of some runs by their name in `Runs`."""
    n, y = goal.shape[1], march.path
    torque, beyond, settling, rise = np.split(march.found, (n, 2 * n, 3 * n), axis=1)
    step = np.abs(goal - y[:, 0, :n])
    return {
        "L2": np.degrees(np.sqrt(np.maximum(y[:, -1, -1], 0.0) / T)),
        "settling": settling,
        "overshoot": 100.0 * beyond / np.where(step > LEAST_STEP, step, np.nan),
        "peak_torque": torque,
        "final_error": np.degrees(goal - y[:, -1, :n]),
        "V_rise": rise[:, 0],
        "steps": march.steps,
        "status": march.status,
    }


# --- Many runs from random starts: how the indices of one controller are distributed.


MOST_RUNS = 100_000
"""Runs of one gain set; so many of the paper's arm take about ten seconds."""
SHARES = (0.0, 0.05, 0.5, 0.95, 1.0)
"""The quantiles that are shown."""


@dataclass(frozen=True)
class Starts:
    """Starts drawn evenly from a box of joint angles."""

    count: int
    spread: float
    """rad, half the side of the box."""
    seed: int

    def around(self, q0: Sequence[float]) -> Array:
        """(count, n) angles in rad about a posture; the same for the same seed."""
        rng = np.random.default_rng(self.seed)
        return np.array(q0) + rng.uniform(-self.spread, self.spread, (self.count, len(q0)))

    def motions(self, q0: Sequence[float]) -> tuple[Array, Array]:
        """(count, n) starts as `around`, and goals a quarter to all of the spread towards the middle."""
        starts, rng = self.around(q0), np.random.default_rng([self.seed, 1])
        step = self.spread * rng.uniform(0.25, 1.0, starts.shape)
        return starts, starts - np.copysign(step, starts - np.array(q0))


@dataclass(frozen=True, eq=False, kw_only=True)
class Sweep(Simulated):
    """The runs of one gain set from random starts, whose middle is q0 of the task.

    ``breach`` is what the first run that broke a promise says when it is run alone.
    """

    starts: Starts
    q0: Array
    """(R, n) rad"""
    runs: Runs
    risen: NDArray[np.bool_]
    """(R,) whether V rose by more than the run's own error."""
    beyond: NDArray[np.bool_]
    """(R,) whether a torque left its motor's limit."""

    @property
    def finished(self) -> int:
        """How many runs reached their end."""
        return int(np.count_nonzero(self.runs.complete))


def sweep(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    starts: Starts,
    *,
    eps0: float = 0.0,
    on_progress: Progress | None = None,
) -> Sweep:
    """Run one controller from random starts.

    Args:
        gain_set: the controller.
        model: the arm; uncertain parameters at their nominal values.
        task: goal, initial rates and duration; the starts lie about its q0.
        starts: how many, how far, and the seed.
        eps0: the ε₀ of V.
        on_progress: receives the fraction done.

    Soundness: floating point throughout; a finite number of runs says nothing of the others.
    """
    q0 = starts.around(task.q0)
    rates = np.array(task.w0)
    runs = simulate_many(
        gain_set, model, task.q_d, q0, task.T, w0=rates, eps0=eps0, points=2, on_progress=on_progress
    )
    first = ControlledArm(gain_set, model).watched(eps0).V(q0, np.array(task.q_d) - q0, np.array(task.w0))
    limits = np.array(motor_limits(model))
    result = Sweep(
        gains=gain_set,
        model=model,
        task=task,
        eps0=eps0,
        starts=starts,
        q0=q0,
        runs=runs,
        risen=runs.V_rise > V_NOISE * np.maximum(first, LEAST_ENERGY),
        beyond=np.any(runs.peak_torque > limits, axis=1),
    )
    broken = np.flatnonzero((result.risen | result.beyond) & runs.complete)
    if not broken.size:
        return result
    start = q0[broken[0]].tolist()  # alone, the first run that broke a promise says which
    run = simulate(gain_set, model, task.q_d, start, task.w0, task.T, eps0=eps0, stop=False)
    return replace(result, breach=run.breach)


def quantiles(values: Array) -> list[float]:
    """The `SHARES` of the numbers that are there; NaN where there are none."""
    known = values[np.isfinite(values)]
    return [float(x) for x in np.quantile(known, SHARES)] if known.size else [float("nan")] * len(SHARES)
