"""Many bench runs of one gain set on arms that differ in their assumed numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.results import settling_times
from lyapcheck.simulate.task import Gains, gains_for
from studies.printed_experiment.assumptions import BAND, Assumption, numbers
from studies.printed_experiment.bench_compiled import compiled_bench

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Task


PERIOD = 2.5e-3
"""s between two readings, as in Section 4 of ``reyes2019family``."""

SUBSTEPS = 2
"""Steps of the arm in a period: with them L2 is within 0.001° of its limit on the paper's arm."""

RUNAWAY = 1e3
"""rad, rad/s or N·m beyond which, at the end of a run, the sampled loop counts as unstable."""

_AT_ONCE = 256
"""Runs whose samples are held at once: 40 MB."""


@dataclass(frozen=True, eq=False)
class Outcomes:
    """What came of R runs; NaN for a run that ran away.

    Args:
        L2: (R,) degrees, (20).
        settling: (R, n) s; ∞ where the joint did not settle within the run.
        final_error: (R, n) degrees.
        start_torque: (R, n) N·m, held over the first period.
    """

    L2: Array
    settling: Array
    final_error: Array
    start_torque: Array


@dataclass(frozen=True)
class BenchRuns:
    """The bench with one controller: readings of the encoders every period, velocity by their difference,
    torque cut at the motors' limits and held; joints with dry friction that stick.

    Args:
        gain_set: the controller.
        model: the arm.
        task: start, goal and duration.
        assumed: the numbers that vary, in the order of the columns given.
        substeps: steps of the arm in a period.
        kp: gains per rad in place of those of the gain set.

    Soundness: floating point. Gravity is compensated with the numbers of the run.

    References: Section 4 of ``reyes2019family``.
    """

    gain_set: GainSet
    model: RobotModel
    task: Task
    assumed: tuple[Assumption, ...]
    substeps: int = SUBSTEPS
    kp: tuple[float, ...] | None = None

    def __call__(self, values: Array) -> Outcomes:
        """The outcomes for values (R, d) of the assumed numbers."""
        parts = [self._part(values[i : i + _AT_ONCE]) for i in range(0, len(values), _AT_ONCE)]
        columns = zip(*parts, strict=True)
        return Outcomes(*(np.concatenate(column) for column in columns))

    def paths(self, values: Array) -> Array:
        """(R, samples, 3n) q, w, τ once a period."""
        gains = gains_for(self.gain_set, self.model.n)
        family, sweeps = gains.family, enough_sweeps(self.model)
        run: Any = compiled_bench(self.model, family, PERIOD, self.substeps, sweeps)
        if run is None:
            from studies.printed_experiment.bench_graph import graph_bench

            run = graph_bench(self.model, family, PERIOD, self.substeps, sweeps)
        starts = np.tile([*self.task.q0, *self.task.w0], (len(values), 1))
        return np.asarray(run(starts, self._parameters(gains, values), self.periods))

    @property
    def periods(self) -> int:
        """Whole periods in the run."""
        return math.floor(self.task.T / PERIOD * (1 + 1e-12))

    def _part(self, values: Array) -> tuple[Array, ...]:
        n, paths = self.model.n, self.paths(values)
        t = PERIOD * np.arange(self.periods + 1)
        e: Array = np.array(self.task.q_d, dtype=np.float64) - paths[:, :, :n]
        e[~np.all(np.abs(paths[:, -1]) < RUNAWAY, axis=1)] = np.nan
        lost = np.isnan(e[:, -1])
        L2 = np.degrees(np.sqrt(np.trapezoid(np.einsum("rti,rti->rt", e, e), t, axis=1) / t[-1]))
        settled = settling_times(np.asarray(t, dtype=np.float64), e, self._band(values))
        settling = np.where(np.isnan(settled) & ~lost, np.inf, settled)
        return L2, settling, np.degrees(e[:, -1]), np.where(lost, np.nan, paths[:, 0, 2 * n :])

    def _band(self, values: Array) -> Any:
        """The settling band of each run, as a column."""
        return values[:, [one.name for one in self.assumed].index(BAND)][:, None]

    def _parameters(self, gains: Gains, values: Array) -> Array:
        """(R, p) in the order of `BenchStep`."""
        model, varied = self.model, {one.name: values[:, i] for i, one in enumerate(self.assumed)}
        known = {name: np.full(len(values), float(number.value)) for name, number in numbers(model)} | varied
        zeros = np.zeros(len(values))
        friction = [known.get(f"{j}_{kind}", zeros) for kind in ("viscous", "coulomb") for j in model.joints]
        control = np.tile([*self.task.q_d, *(self.kp or gains.kp), *gains.kv], (len(values), 1))
        return np.ascontiguousarray(np.column_stack([control, *friction, *_chosen(known, model.parameters)]))


def _chosen(known: dict[str, Array], names: Any) -> list[Array]:
    return [known[name] for name in names]


@lru_cache(maxsize=32)
def enough_sweeps(model: RobotModel) -> int:
    """Rounds over the joints after which dry friction is solved to a millionth, over fixed random postures.

    Gauss and Seidel's iteration on M shrinks an error by the spectral radius of (D + L)⁻¹Lᵀ each time.
    """
    from lyapcheck.robots.numeric import NumericModel

    postures = np.random.default_rng(0).uniform(-math.pi, math.pi, size=(64, model.n))
    mass = NumericModel(model).mass(postures)
    lower = np.tril(mass)
    radius = float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(lower, mass - lower)))))
    return 2 if radius < 1e-3 else min(60, math.ceil(math.log(1e-6) / math.log(radius)))
