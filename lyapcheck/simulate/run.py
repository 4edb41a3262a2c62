"""What a simulation hands back, whole or cut short."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.output.digits import NONE, at_least, at_most, shown
from lyapcheck.simulate.task import Task, torque_limits

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel

LIMIT_CYCLE, FALLS = "limit cycle", "falls"
Row = tuple[float, ...]


@dataclass(frozen=True)
class Sample:
    """A sample of a run: q and e in rad, w in rad/s, and q̇_d, q̈_d where the goal moves (empty: at rest).

    For a moving goal w = q̇ − q̇_d.
    """

    q: Row
    e: Row
    w: Row
    speed: Row = ()
    acceleration: Row = ()


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
        value, limit = _rounded(at_least, self.value), _rounded(at_most, self.limit)
        result = f"{value} {self.unit}, above {limit}"
        return f"{self.promise} is violated at t = {self.t:.6g} s: {result}; {', '.join(state)} ({grade})"

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


def _rounded(towards: Callable[[float, int], str], value: float) -> str:
    """To nine digits on the safe side; a dash for what is no number."""
    return NONE if math.isnan(value) else towards(value, 9)


def _row(values: Sequence[float]) -> str:
    return f"({', '.join(shown(x, '.6g') for x in values)})"


@dataclass(frozen=True, order=True)
class Unrest:
    """What was seen, at the joint where it is worst.

    Args:
        kind: ``limit cycle`` or ``falls``.
        joint: its name.
        angle: degrees, peak to peak in the last fifth of the run; of a load that falls the error at the end.
        torque: N·m, likewise; of a load that falls the most that it asks, there or on the way.
        most: N·m, what k_p h gives up to against that load.
        others: how many other joints do the same.
    """

    kind: str
    joint: str
    angle: float
    torque: float
    most: float = math.inf
    others: int = 0

    @property
    def sentence(self) -> str:
        """In one line."""
        also = f" (and {self.others} other{'s' if self.others > 1 else ''})" if self.others else ""
        angle, torque = (shown(x, ".3g") for x in (self.angle, self.torque))
        if self.kind == LIMIT_CYCLE:
            swings = f"{self.joint}{also} swings by {angle}° and {torque} N·m, peak to peak"
            return f"limit cycle seen: {swings} in the last fifth of the run, and does not die out"
        load = f"the unknown load asks up to {torque} N·m, k_p h gives up to {at_most(self.most, 3)}"
        return f"seen to fall: {self.joint}{also} ends {angle}° from the goal; on the way or there {load}"


@dataclass(frozen=True, eq=False)
class Indices:
    """Performance of a run, in the units of the paper's figures; NaN where a joint has no such number."""

    L2: float
    """degrees, (20)."""
    settling: Array
    """(n,) s, 2 % of the step."""
    overshoot: Array
    """(n,) per cent of the step."""
    rms: Array
    """(n,) degrees, of each joint by the trapezoidal rule."""
    peak_error: Array
    """(n,) degrees, the largest |e_i|."""
    entered: Array
    """(n,) s, from when on |e_i| stays in the band that was asked for."""
    peak_torque: Array
    """(n,) N·m."""
    final_error: Array
    """(n,) degrees at the end of the run."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Simulated:
    """A gain set on an arm, at its nominal numbers, that was given a task."""

    gains: GainSet
    model: RobotModel
    task: Task
    eps0: float
    settings: tuple[str, ...] = ()
    """How the arm was run, beside what the arm file assumes."""
    breach: Breach | None = None
    """The first promise of theory that a run by the equations broke."""

    @property
    def name(self) -> str:
        """The name of the gain set."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """The member of the hyperbolic family; none for another family."""
        return self.gains.m

    @property
    def robot(self) -> str:
        """The name of the arm."""
        return self.model.name

    @property
    def joints(self) -> tuple[str, ...]:
        """Their names."""
        return self.model.joints

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader must know: settings, then assumptions."""
        return (*self.settings, *self.model.assumptions)

    @property
    def without_dry_friction(self) -> bool:
        """Whether the arm file gives dry friction that the equations leave out."""
        return self.model.dry


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Motion(Simulated):
    """One simulated motion of one gain set on one arm.

    Signals are sampled at ``t`` (N,) in s: ``q`` (N, n) in rad, ``e`` = q_d − q in rad, ``w`` = q̇ − q̇_d in
    rad/s, ``tau`` in N·m, ``V`` (N,) in J and ``dV`` = dV/dt along the motion in W, both for ``eps0``.
    """

    kind: str
    """``reference`` (the equations), ``experiment`` (the bench) or ``tracking``."""
    t: Array
    q: Array
    e: Array
    w: Array
    tau: Array
    V: Array
    dV: Array
    speed: Array | None = None
    """(N, n) rad/s, q̇_d; none for a goal at rest."""
    acceleration: Array | None = None
    """(N, n) rad/s², q̈_d."""
    indices: Indices
    accuracy: float
    """The largest change of a position (rad) or rate (rad/s) at a tighter tolerance; NaN if cut short."""
    complete: bool = True

    def __repr__(self) -> str:
        errors = ", ".join(f"{x:.3g}" for x in self.indices.final_error)
        about = f"{self.name} on {self.robot}, {self.task.T:g} s, final error ({errors})°"
        return f"<{type(self).__name__}: {about}>"

    def plot(self) -> Any:
        """Draw the errors over time as a Matplotlib figure."""
        from lyapcheck.report.plots import draw_errors

        return draw_errors(f"{self.name} on {self.robot}", self.t, self.e, self.joints)

    @property
    def torque_limit(self) -> tuple[float | None, ...]:
        """N·m, what the motors can give."""
        return torque_limits(self.model)

    @property
    def without_dry_friction(self) -> bool:
        """Whether the arm file gives dry friction that the run leaves out."""
        return self.model.dry and self.kind != "experiment"

    def sample(self, i: int) -> Sample:
        """The state of one sample."""
        rows = (self.q, self.e, self.w, self.speed, self.acceleration)
        return Sample(*(() if x is None else tuple(x[i].tolist()) for x in rows))

    def broken(self, promise: str, i: int, value: float, limit: float, unit: str, sure: bool) -> Breach:
        """What is said of a promise that broke at sample ``i``."""
        return Breach(promise, i, float(self.t[i]), self.sample(i), float(value), float(limit), unit, sure)

    def largest(self, signal: Array) -> float:
        """The largest norm of a signal (N, n) of the samples."""
        return float(np.max(np.linalg.norm(signal, axis=1)))


@dataclass(frozen=True)
class Promises:
    """What theory says about a run beside what the run shows: observations in floating point, not proofs."""

    V_decreases: bool
    """V never rose from one time to the next, the integrator's steps among them, by more than its error."""
    V_rises_at: float | None
    """s, the first sample at which it did."""
    torque_norm: float
    """N·m, the largest ‖τ‖ seen."""
    torque_bound: float | None
    """N·m, the bound (9) on ‖τ‖; none for an unbounded controller."""
    inside_bound: bool | None
    joint_bounds: tuple[float, ...] | None
    """N·m, the bound on each |τ_i|; none for an unbounded controller."""
    inside_limits: tuple[bool | None, ...]
    """Per joint: |τ_i| stayed within the motor's limit; none where the arm has no limit."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(Motion):
    """A motion to a set point, where w = q̇."""

    promises: Promises
    energy_balance: float
    """The largest |E(t) + dissipated(t) − E(0)| relative to the largest of these; NaN for an experiment.

    Energies below a nanojoule are compared with a nanojoule.
    """
    loop: LoopRecord | None = None
    """How a computer ran it; none for a run by the equations."""
    unrest: Unrest | None = None
    """What a sampled run shows against the gains."""

    @property
    def L2(self) -> float:
        """The L2 index in degrees, (20)."""
        return self.indices.L2

    @property
    def settling(self) -> Array:
        """Settling times in s."""
        return self.indices.settling

    @property
    def overshoot(self) -> Array:
        """Overshoots in per cent of the step."""
        return self.indices.overshoot

    @property
    def peak_torque(self) -> Array:
        """Peak torques in N·m."""
        return self.indices.peak_torque


class SimulationFailed(Exception):
    """A run that could not be finished; ``partial`` holds what was reached, marked as incomplete."""

    def __init__(self, reason: str, partial: Any) -> None:
        self.reason, self.partial = reason, partial
        super().__init__(reason)


class PromiseBroken(SimulationFailed):
    """A run that was stopped at the state that broke a promise; ``partial`` ends with that state."""

    def __init__(self, reason: str, partial: Any, breach: Breach) -> None:
        self.breach = breach
        super().__init__(reason, partial)
