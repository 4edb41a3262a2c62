"""What a simulated tracking motion hands back, whole or cut short."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.breach import Breach
from lyapcheck.simulate.gains import Gains
from lyapcheck.tracking.monitors import ROUNDING
from lyapcheck.tracking.reference import Reference, Suprema
from lyapcheck.tracking.torque import TorqueBounds


@dataclass(frozen=True)
class Promise:
    """What theory says of a run before it begins, at nominal numbers, by bounds without certificates."""

    suprema: Suprema
    eps0: float
    """The ε₀ of V that is watched."""
    largest: Fraction | None
    """The largest ε₀ for which Θ' is positive definite at v_d; none where there is none."""
    falls: bool
    """Whether Θ' is positive definite at ``eps0``, so that dV/dt < 0 away from e = ė = 0."""
    torque: TorqueBounds | None
    """Bounds of each |τ_i|; none for an unbounded controller."""
    reason: str = ""
    """Why there is no ε₀."""


@dataclass(frozen=True, eq=False)
class TrackingMotion:
    """Samples at ``t`` (N,) in s, each (N, n): ``q`` and ``e`` = q_d − q in rad, ``w`` = q̇ − q̇_d in rad/s,
    ``tau`` of (21) in N·m, and of the reference ``goal`` in rad, ``speed``, ``acceleration`` in rad/s²."""

    t: Array
    q: Array
    e: Array
    w: Array
    tau: Array
    goal: Array
    speed: Array
    acceleration: Array

    @property
    def velocity(self) -> Array:
        """q̇, rad/s."""
        return self.speed + self.w


@dataclass(frozen=True)
class TrackingIndices:
    """How well a run tracks: degrees, s and N·m; NaN where there is no such number."""

    L2: float
    """√((1/T) ∫ ‖e‖² dt), (20)."""
    rms: Array
    """(n,) of each joint, by the trapezoidal rule."""
    peak_error: Array
    """(n,) largest |e_i|."""
    final_error: Array
    """(n,) e_i at the end."""
    entered: Array
    """(n,) s, from when on |e_i| stays in the band."""
    peak_torque: Array
    """(n,)"""


@dataclass(frozen=True, eq=False)
class TrackingRun:
    """One simulated motion of one gain set on one arm along a reference."""

    gains: Gains
    robot: str
    joints: tuple[str, ...]
    reference: Reference
    T: float
    motion: TrackingMotion
    V: Array
    """(N,) J, for ``promise.eps0``."""
    dV: Array
    """(N,) W, along the run."""
    bound: Array | None
    """(N,) W, −[a b] Θ' [a b]ᵀ, which dV/dt must not exceed; none for an unbounded controller."""
    promise: Promise
    indices: TrackingIndices
    band: float
    """rad, of ``indices.entered``."""
    accuracy: float
    """The largest change of e (rad) or w (rad/s) at a ten times tighter tolerance; NaN if cut short."""
    work_balance: float
    """The largest difference of the arm's energy and the work done on it, relative to the larger of both."""
    torque_limit: tuple[float | None, ...]
    """N·m"""
    complete: bool = True
    notes: tuple[str, ...] = ()
    breach: Breach | None = None
    without_dry_friction: bool = False
    """Whether the arm file gives dry friction that the run leaves out."""

    @property
    def name(self) -> str:
        """The name of the gain set."""
        return self.gains.name

    @property
    def seen_speed(self) -> float:
        """rad/s, the largest ‖q̇_d‖ of the samples, to be held against v_d."""
        return float(np.max(np.linalg.norm(self.motion.speed, axis=1)))

    @property
    def tightness(self) -> float:
        """The largest share of the seen fall of V that was promised: 1 where the form is met exactly.

        NaN where nothing falls, or nothing was promised.
        """
        if self.bound is None:
            return float("nan")
        inside = self.dV < -ROUNDING * np.max(np.abs(self.dV))
        return float(np.max(self.bound[inside] / self.dV[inside])) if inside.any() else float("nan")


class TrackingFailed(Exception):
    """A run that could not be finished, or that broke a promise; ``partial`` is what was reached."""

    def __init__(self, reason: str, partial: TrackingRun) -> None:
        self.reason, self.partial = reason, partial
        super().__init__(reason)
