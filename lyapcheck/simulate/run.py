"""What a simulation hands back, whole or cut short."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck._types import Array
from lyapcheck.simulate.breach import Breach
from lyapcheck.simulate.task import Gains, Task


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


@dataclass(frozen=True, eq=False)
class Indices:
    """Performance of a run, in the units of the paper's figures; NaN where a joint has no such number."""

    L2: float
    """degrees, (20)."""
    settling: Array
    """(n,) s, 2 % of the step."""
    overshoot: Array
    """(n,) per cent of the step."""
    peak_torque: Array
    """(n,) N·m."""
    final_error: Array
    """(n,) degrees at the end of the run."""


@dataclass(frozen=True, eq=False)
class Run:
    """One simulated motion of one gain set on one arm.

    Signals are sampled at ``t`` (N,) in s: ``q`` (N, n) in rad, ``w`` = q̇ in rad/s, ``e`` = q_d − q in rad,
    ``tau`` in N·m, ``V`` (N,) in J and ``dV`` = dV/dt along (11) in W, both for ``eps0``.
    """

    gains: Gains
    robot: str
    joints: tuple[str, ...]
    kind: str
    """``reference`` (the equations) or ``experiment`` (the bench)."""
    task: Task
    eps0: float
    t: Array
    q: Array
    w: Array
    e: Array
    tau: Array
    V: Array
    dV: Array
    indices: Indices
    promises: Promises
    accuracy: float
    """The largest change of q (rad) or w (rad/s) at a ten times tighter tolerance; NaN if cut short."""
    energy_balance: float
    """The largest |E(t) + dissipated(t) − E(0)| relative to the largest of these; NaN for an experiment.

    Energies below a nanojoule are compared with a nanojoule.
    """
    torque_limit: tuple[float | None, ...]
    """N·m, what the motors can give."""
    complete: bool = True
    notes: tuple[str, ...] = ()
    """What the reader must know: assumptions and the settings of the bench."""
    breach: Breach | None = None
    """The first promise of theory that this reference run broke."""
    without_dry_friction: bool = False
    """Whether the arm file gives dry friction that the run leaves out."""

    @property
    def name(self) -> str:
        """The name of the gain set."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """The member of the hyperbolic family; none for another family."""
        return self.gains.family.m

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

    def __init__(self, reason: str, partial: Run | None = None) -> None:
        self.reason = reason
        self.partial = partial
        super().__init__(reason)


class PromiseBroken(SimulationFailed):
    """A run that was stopped at the state that broke a promise; ``partial`` ends with that state."""

    def __init__(self, reason: str, partial: Run, breach: Breach) -> None:
        self.breach = breach
        super().__init__(reason, partial)
