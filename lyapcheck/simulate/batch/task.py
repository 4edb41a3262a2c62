"""What many runs are asked to do, checked at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.simulate.batch.integrator import FAILURES, Paths
from lyapcheck.simulate.breach import LEAST_ENERGY
from lyapcheck.simulate.results import LEAST_STEP
from lyapcheck.simulate.task import FARTHEST, FASTEST, Gains, gains_for, task_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True, eq=False)
class BatchTask:
    """R starts, goals, controllers and arms.

    Args:
        gains: one controller a run.
        q_d: (R, n) rad.
        y0: (R, 2n + 2) initial states of the integration.
        parameters: (R, p) in the order of `Loop`.
    """

    gains: tuple[Gains, ...]
    q_d: Array
    y0: Array
    parameters: Array


def batch_task(
    gain_sets: Sequence[GainSet],
    model: RobotModel,
    vectors: Mapping[str, Any],
    uncertain: Mapping[str, Any],
    *,
    T: float,
    eps0: float,
    points: int,
) -> BatchTask:
    """The task of all runs; ``vectors`` has q_d, starts and w0, each one row or one row a run.

    Raises:
        InputError: values that are not finite, too large or of the wrong shape; all at once.
    """
    n = model.n
    task_for(n, (0.0,) * n, None, None, T, eps0=eps0, points=points)
    most = {"q_d": FARTHEST, "starts": FARTHEST, "w0": FASTEST}
    rows = {name: _rows(name, value, n, most[name]) for name, value in vectors.items()}
    values = {name: _values(model, name, value) for name, value in uncertain.items()}
    runs = _length({**rows, **values, "gain sets": np.empty(len(gain_sets))})
    gains = [gains_for(gain_set, n) for gain_set in gain_sets] * (runs if len(gain_sets) == 1 else 1)
    q_d, starts, w0 = (np.broadcast_to(rows[name], (runs, n)) for name in ("q_d", "starts", "w0"))
    columns = _arm(model, values, runs)
    control = [np.array([gain.kp for gain in gains]), np.array([gain.kv for gain in gains])]
    parameters = np.hstack([q_d, *control, columns, np.full((runs, 1), eps0)])
    y0 = np.hstack([starts, w0, np.zeros((runs, 2))])
    return BatchTask(tuple(gains), q_d, y0, parameters)


def _arm(model: RobotModel, values: Mapping[str, Array], runs: int) -> Array:
    """B and the uncertain parameters, (R, n + …)."""
    friction = [float(number.value) for number in model.viscous]
    nominal = {name: np.array([float(number.value)]) for name, number in model.parameters.items()}
    chosen = [np.broadcast_to(column, runs) for column in (nominal | dict(values)).values()]
    return np.column_stack([np.tile(friction, (runs, 1)), *chosen])


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
        rule = f"gives {_listed(wrong)} rows, but there are {runs} runs"
        raise argument_error(", ".join(wrong), "", rule, "give one row for all runs, or one a run")
    if not runs or 0 in sizes.values():
        raise argument_error("starts", "", "is empty", "give at least one run")
    return runs


def _listed(sizes: Mapping[str, int]) -> str:
    return ", ".join(str(size) for size in sizes.values())


def grouped(gains: Iterable[Gains]) -> list[tuple[Any, NDArray[np.intp]]]:
    """The families in order of appearance, with the runs of each."""
    places: dict[Any, list[int]] = {}
    for i, gain in enumerate(gains):
        places.setdefault(gain.family, []).append(i)
    return [(family, np.array(indices)) for family, indices in places.items()]


# --- The results of many runs, one row a run.


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


@dataclass(frozen=True, eq=False)
class IntegratedRuns:
    """Some of the runs as they come out of the integrator."""

    T: float
    q_d: Array
    """(R, n)"""
    paths: Paths
    energy: bool
    """Whether V is the energy."""

    def rows(self) -> dict[str, Any]:
        """The numbers of these runs by their name in `Runs`."""
        n, y = self.q_d.shape[1], self.paths.y
        torque, beyond, settling, rest = np.split(self.paths.seen, (n, 2 * n, 3 * n), axis=1)
        rise, error, energy, lost = rest.T
        step, squares = np.abs(self.q_d - y[:, 0, :n]), y[:, -1, -1]
        whole = np.where(step > LEAST_STEP, step, np.nan)
        scale = np.maximum(np.maximum(energy, lost), LEAST_ENERGY)
        return {
            "L2": np.degrees(np.sqrt(np.maximum(squares, 0.0) / self.T)),
            "settling": settling,
            "overshoot": 100.0 * beyond / whole,
            "peak_torque": torque,
            "final_error": np.degrees(self.q_d - y[:, -1, :n]),
            "energy_balance": error / scale if self.energy else np.full(len(y), np.nan),
            "V_rise": rise,
            "steps": self.paths.steps,
            "status": self.paths.status,
        }


def runs_of(t: Array, rows: dict[str, Any], engine: str) -> Runs:
    """The results of all runs from their rows."""
    status = rows.pop("status")
    reasons = tuple(FAILURES[code] for code in status)
    return Runs(t=t, complete=status == 0, failure=reasons, engine=engine, **rows)
