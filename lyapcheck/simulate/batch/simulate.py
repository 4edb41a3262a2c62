"""Thousands of runs of the closed loop (11) at once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress, silent
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.simulate.batch.integrator import FAILURES, InitialValueProblems, Paths, integrated
from lyapcheck.simulate.batch.right_side import RightSide
from lyapcheck.simulate.breach import LEAST_ENERGY
from lyapcheck.simulate.integrate import MAX_STEPS
from lyapcheck.simulate.results import LEAST_STEP, bands
from lyapcheck.simulate.task import FARTHEST, FASTEST, gains_for, task_for

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
    energy_balance: Array
    """(R,) the largest |E(t) + dissipated(t) − E(0)| relative to the largest of these; NaN unless ε₀ = 0."""
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
    n, squared = model.n, 0.0 if eps0 is None else eps0
    task_for(n, (0.0,) * n, None, None, T, eps0=squared, points=points)
    rates = np.full(n, w0) if np.ndim(w0) == 0 else w0
    asked = {"q_d": (q_d, FARTHEST), "starts": (starts, FARTHEST), "w0": (rates, FASTEST)}
    rows = {name: _rows(name, value, n, most) for name, (value, most) in asked.items()}
    uncertain = {name: _values(model, name, value) for name, value in (parameters or {}).items()}
    count = _length({**rows, **uncertain, "gain sets": np.empty(len(sets))})
    goals, first, speeds = (np.broadcast_to(rows[name], (count, n)) for name in rows)
    gains = [gains_for(one, n) for one in sets] * (count if len(sets) == 1 else 1)
    nominal = {name: np.array([float(number.value)]) for name, number in model.parameters.items()}
    arm = [np.broadcast_to(column, count) for column in (nominal | uncertain).values()]
    friction = np.tile([float(number.value) for number in model.viscous], (count, 1))
    control = [np.array([gain.kp for gain in gains]), np.array([gain.kv for gain in gains])]
    numbers = np.column_stack([goals, *control, friction, *arm, np.full(count, squared)])
    y0 = np.hstack([first, speeds, np.zeros((count, 2))])

    families: dict[Any, list[int]] = {}
    for i, gain in enumerate(gains):
        families.setdefault(gain.family, []).append(i)
    most = min(max(1, _NUMBERS_AT_ONCE // (points * y0.shape[1])), _RUNS_AT_ONCE)
    columns: dict[str, Any] = {}
    engines: list[str] = []
    done = 0
    for family, places in families.items():
        side = RightSide(model, family)
        engines.append(side.engine)
        for start in range(0, len(places), most):
            chosen = places[start : start + most]
            goal, own, begin = (np.ascontiguousarray(x[chosen]) for x in (goals, numbers, y0))
            settling = bands(goal - begin[:, :n])
            problems = InitialValueProblems(begin, own, settling, T, points, tolerance, max_steps)
            paths = integrated(side, problems)
            part = _indices(T, goal, paths, energy=not eps0) | (_motions(side, paths, own) if motions else {})
            for name, column in part.items():
                columns.setdefault(name, np.empty((count, *column.shape[1:]), column.dtype))[chosen] = column
            done += len(chosen)
            (on_progress or silent)(done / count, "")
    status = columns.pop("status")
    reasons = tuple(FAILURES[code] for code in status)
    engine = " and ".join(dict.fromkeys(engines))
    t = np.linspace(0.0, T, points)
    return Runs(t=t, complete=status == 0, failure=reasons, engine=engine, **columns)


def _indices(T: float, goal: Array, paths: Paths, energy: bool) -> dict[str, Any]:
    """The numbers of some runs by their name in `Runs`; ``energy``: whether V is the energy."""
    n, y = goal.shape[1], paths.y
    torque, beyond, settling, rest = np.split(paths.seen, (n, 2 * n, 3 * n), axis=1)
    rise, error, stored, lost = rest.T
    step = np.abs(goal - y[:, 0, :n])
    scale = np.maximum(np.maximum(stored, lost), LEAST_ENERGY)
    return {
        "L2": np.degrees(np.sqrt(np.maximum(y[:, -1, -1], 0.0) / T)),
        "settling": settling,
        "overshoot": 100.0 * beyond / np.where(step > LEAST_STEP, step, np.nan),
        "peak_torque": torque,
        "final_error": np.degrees(goal - y[:, -1, :n]),
        "energy_balance": error / scale if energy else np.full(len(y), np.nan),
        "V_rise": rise,
        "steps": paths.steps,
        "status": paths.status,
    }


def _motions(side: RightSide, paths: Paths, parameters: Array) -> dict[str, Array]:
    """q, w and V at all samples; NaN where a run failed."""
    n, y, columns = side.model.n, paths.y, np.ascontiguousarray(parameters.T)
    V = np.stack([side.watched(y[:, k].T, columns)[n] for k in range(y.shape[1])], axis=1)
    return {"q": y[:, :, :n], "w": y[:, :, n : 2 * n], "V": V}


# --- What is wrong with a request, said at once.


def _rows(name: str, value: Any, n: int, most: float) -> Array:
    try:
        rows = np.atleast_2d(np.asarray(value, dtype=np.float64))
    except (TypeError, ValueError):
        raise argument_error(name, value, "is no table of numbers", f"give rows of {n} numbers") from None
    if rows.ndim != 2 or rows.shape[1] != n:
        rule = f"has shape {rows.shape}, but the arm has {n} joints"
        raise argument_error(name, "", rule, f"give one row of {n} values, or one such row a run")
    _finite(name, rows, most)
    return rows


def _values(model: RobotModel, name: str, value: Any) -> Array:
    if name not in model.parameters:
        known = ", ".join(model.parameters) or "none"
        raise argument_error("parameter", name, f"{model.name} has no such parameter", f"use one of: {known}")
    column = np.atleast_1d(np.asarray(value, dtype=np.float64))
    _finite(name, column, math.inf)
    return column


def _finite(name: str, values: Array, most: float) -> None:
    bad = ~(np.isfinite(values) & (np.abs(values) <= most))
    if not bad.any():
        return
    problems = [
        Problem(
            "argument", None, f"{name}[{', '.join(map(str, place))}]", f"{values[tuple(place)]:g}", *_RULE
        )
        for place in np.argwhere(bad)[:_SHOWN]
    ]
    raise InputError(problems)


_SHOWN = 20
"""Bad values named in one message."""

_RULE = (
    "every value must be finite and of a size that an arm can have",
    f"give angles in rad up to {FARTHEST:g} and rates in rad/s up to {FASTEST:g}",
)


def _length(columns: Mapping[str, Array]) -> int:
    """How many runs there are: every column has one row, or this many."""
    sizes = {name: len(column) for name, column in columns.items()}
    runs = max(sizes.values())
    wrong = {name: size for name, size in sizes.items() if size not in (1, runs)}
    if wrong:
        rule = f"gives {', '.join(map(str, wrong.values()))} rows, but there are {runs} runs"
        raise argument_error(", ".join(wrong), "", rule, "give one row for all runs, or one a run")
    if not runs or 0 in sizes.values():
        raise argument_error("starts", "", "is empty", "give at least one run")
    return runs
