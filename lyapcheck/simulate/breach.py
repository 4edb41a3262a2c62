"""The first promise that a run breaks, with the state that broke it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.output.digits import at_least, at_most, shown
from lyapcheck.simulate.confirm import Sample, exceeds, rises

if TYPE_CHECKING:
    from lyapcheck.robots import Number
    from lyapcheck.search.controlled_arm import ControlledArm


RATE_NOISE = 1e-12
"""dV/dt below this share of its largest size is not worth a look in balls."""

ROUNDING = 1e-12
"""How far a torque may be above its bound, relative to it."""

CANDIDATES = 100
"""Samples that are judged in balls before a promise counts as kept."""


@dataclass(frozen=True)
class Breach:
    """A broken promise: which, when, at which state, by how much."""

    promise: str
    index: int
    """Which of the states that were looked at broke it: samples, ends of steps and extremes."""
    t: float
    at: Sample
    value: float
    limit: float
    unit: str
    confirmed: bool
    """Whether balls prove the promise broken at exactly this state; else it was seen in doubles only."""

    @property
    def sentence(self) -> str:
        """The breach in one line."""
        state = [f"q = {_row(self.at.q)} rad", f"e = {_row(self.at.e)} rad", f"w = {_row(self.at.w)} rad/s"]
        if self.at.speed:
            state.append(f"q̇_d = {_row(self.at.speed)} rad/s")
        grade = (
            "a simulated state; there it is confirmed in balls"
            if self.confirmed
            else "simulated, in floating point"
        )
        result = f"{at_least(self.value, 9)} {self.unit}, above {at_most(self.limit, 9)}"
        return f"{self.promise} is broken at t = {self.t:.6g} s: {result}; {', '.join(state)} ({grade})"

    @property
    def data(self) -> dict[str, Any]:
        """The breach as plain data: the state in full precision, rad and rad/s."""
        return {
            "promise": self.promise,
            "t": self.t,
            "q": list(self.at.q),
            "e": list(self.at.e),
            "w": list(self.at.w),
            "reference_rate": list(self.at.speed) or None,
            "reference_acceleration": list(self.at.acceleration) or None,
            "value": self.value,
            "limit": self.limit,
            "unit": self.unit,
            "grade": "enclosure" if self.confirmed else "numeric",
        }


@dataclass(frozen=True, eq=False)
class Watched:
    """The samples of a run as the monitors see them: ``t``, ``V``, ``dV`` (N,), the rest (N, n)."""

    controlled: ControlledArm
    eps0: float
    t: Array
    q: Array
    e: Array
    w: Array
    tau: Array
    V: Array
    dV: Array
    noise: float
    """J, how far V may rise by the run's own error."""
    speed: Array | None = None
    acceleration: Array | None = None

    def sample(self, i: int) -> Sample:
        """The state of one sample."""
        moving = () if self.speed is None else tuple(self.speed[i].tolist())
        accelerating = () if self.acceleration is None else tuple(self.acceleration[i].tolist())
        q, e, w = (tuple(x[i].tolist()) for x in (self.q, self.e, self.w))
        return Sample(q, e, w, moving, accelerating)

    def breach(self, promise: str, i: int, value: float, limit: float, unit: str, sure: bool) -> Breach:
        """What is said of a promise that broke at sample ``i``."""
        return Breach(promise, i, float(self.t[i]), self.sample(i), float(value), float(limit), unit, sure)


Monitor = Callable[[Watched], Breach | None]


def first_breach(run: Watched, monitors: Sequence[Monitor]) -> Breach | None:
    """The earliest breach that any monitor finds."""
    result = [breach for monitor in monitors if (breach := monitor(run)) is not None]
    return min(result, key=lambda breach: breach.index, default=None)


def rate_monitor(run: Watched) -> Breach | None:
    """dV/dt ≤ 0 at every sample, with the run's ε₀; with ε₀ = 0 it holds by (14) and nothing is looked at."""
    if run.eps0 == 0.0:
        return None
    high = np.flatnonzero(run.dV > RATE_NOISE * np.max(np.abs(run.dV)))
    for i in high[:CANDIDATES].tolist():
        if rises(run.controlled, run.eps0, run.sample(i)):
            return run.breach(f"dV/dt ≤ 0 for ε₀ = {run.eps0:g}", i, run.dV[i], 0.0, "W", True)
    return None


def fall_monitor(run: Watched) -> Breach | None:
    """V does not rise between samples by more than the run's own error."""
    up = np.flatnonzero(np.diff(run.V) > run.noise)
    if not up.size:
        return None
    i = int(up[0]) + 1
    return run.breach(f"V falls for ε₀ = {run.eps0:g}", i, run.V[i], run.V[i - 1], "J", False)


def limit_monitor(limits: Sequence[Number | None]) -> Monitor:
    """Each |τ_i| is at most what the motor can give, (n,), N·m, where that is known."""

    def monitor(run: Watched) -> Breach | None:
        known = [(i, limit) for i, limit in enumerate(limits) if limit is not None]
        result = [breach for i, limit in known for breach in _beyond_limit(run, i, limit)]
        return min(result, key=lambda breach: breach.index, default=None)

    return monitor


def _beyond_limit(run: Watched, joint: int, number: Number) -> Iterator[Breach]:
    most = float(number.value)
    size = np.abs(run.tau[:, joint])
    name = run.controlled.model.joints[joint]
    for i in np.flatnonzero(size > most)[:CANDIDATES].tolist():
        if exceeds(run.controlled, joint, number.value, run.sample(i)):
            yield run.breach(f"|τ| of {name} within the motor's limit", i, size[i], most, "N·m", True)
            return


def joint_monitor(name: str, bounds: Sequence[float] | None) -> Monitor:
    """Each |τ_i| is at most a bound, of which no more than rounding is forgiven."""

    def monitor(run: Watched) -> Breach | None:
        if bounds is None:
            return None
        beyond = np.argwhere(np.abs(run.tau) > np.array(bounds) * (1 + ROUNDING))
        if not beyond.size:
            return None
        i, joint = beyond[0].tolist()
        promise = f"|τ| of {run.controlled.model.joints[joint]} within {name}"
        return run.breach(promise, i, abs(run.tau[i, joint]), bounds[joint], "N·m", False)

    return monitor


def bound_monitor(name: str, bound: float | None) -> Monitor:
    """‖τ‖ is at most a bound, of which no more than rounding is forgiven."""
    most = math.inf if bound is None else bound * (1 + ROUNDING)

    def monitor(run: Watched) -> Breach | None:
        norm = np.linalg.norm(run.tau, axis=1)
        beyond = np.flatnonzero(norm > most)
        if not beyond.size:
            return None
        i = int(beyond[0])
        return run.breach(f"‖τ‖ within {name}", i, norm[i], most, "N·m", False)

    return monitor


def _row(values: Sequence[float]) -> str:
    return f"({', '.join(shown(x, '.6g') for x in values)})"
