"""What a simulated tracking motion hands back, whole or cut short."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from lyapcheck._types import Array
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots import Number
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import (
    Breach,
    Watched,
    fall_monitor,
    first_breach,
    joint_monitor,
    limit_monitor,
    rate_monitor,
)
from lyapcheck.simulate.results import noise_of
from lyapcheck.simulate.task import Gains
from lyapcheck.tracking.reference import Reference, Suprema
from lyapcheck.tracking.torque import ROUNDING, TorqueBounds, TrackingForm, form_monitor


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


# --- From the samples of a tracking motion to a run: V along the way, its bound, the indices.


def energies(
    controlled: ControlledArm, gains: Gains, eps0: float, motion: TrackingMotion
) -> tuple[Array, Array]:
    """V of (13) and dV/dt along (21) at the samples, J and W.

    With C(q, q̇) = C(q, w) + C(q, q̇_d) in (11), dV/dt is that of (11) plus −ε (w − εh)ᵀ C(q, q̇_d) h.
    """
    numeric = LyapunovNumeric(controlled.model, gains.family, gains.kp, gains.kv, eps0)
    V = numeric.V(motion.q, motion.e, motion.w)
    rate = numeric.rate(motion.q, motion.e, motion.w)
    h = gains.family.h(motion.e)
    eps = eps0 / (1.0 + np.linalg.norm(motion.e, axis=1, keepdims=True))
    turned = np.einsum("tij,tj->ti", NumericModel(controlled.model).coriolis(motion.q, motion.speed), h)
    return V, rate - np.sum(eps * (motion.w - eps * h) * turned, axis=1)


def bound_of(form: TrackingForm | None, gains: Gains, eps0: float, motion: TrackingMotion) -> Array | None:
    """−[a b] Θ' [a b]ᵀ at the samples, W."""
    if form is None:
        return None
    r, a, b = (np.linalg.norm(x, axis=1) for x in (motion.e, gains.family.h(motion.e), motion.w))
    return form.promised(eps0, r, a, b)


def broken(
    controlled: ControlledArm,
    limits: Sequence[Number | None],
    promise: Promise,
    motion: TrackingMotion,
    V: Array,
    dV: Array,
    bound: Array | None,
) -> Breach | None:
    """The first promise that the samples break, or the limit of a motor, N·m."""
    watched = Watched(
        controlled=controlled,
        eps0=promise.eps0,
        t=motion.t,
        q=motion.q,
        e=motion.e,
        w=motion.w,
        tau=motion.tau,
        V=V,
        dV=dV,
        noise=noise_of(V),
        speed=motion.speed,
        acceleration=motion.acceleration,
    )
    torque = None if promise.torque is None else tuple(map(float, promise.torque.total))
    joints = joint_monitor("its bound for (21)", torque)
    return first_breach(
        watched, (rate_monitor, fall_monitor, form_monitor(bound), joints, limit_monitor(limits))
    )


def indices_of(motion: TrackingMotion, squares: float, band: float) -> TrackingIndices:
    """The indices of the samples.

    Args:
        motion: the samples.
        squares: ∫ ‖e‖² dt, rad² s.
        band: rad.
    """
    t, e = motion.t, motion.e
    T = float(t[-1])
    size = np.abs(e)
    return TrackingIndices(
        L2=math.degrees(math.sqrt(max(squares, 0.0) / T)) if T > 0 else math.nan,
        rms=np.degrees(np.sqrt(np.trapezoid(e * e, t, axis=0) / T)) if T > 0 else np.full(e.shape[1], np.nan),
        peak_error=np.degrees(size.max(axis=0)),
        final_error=np.degrees(e[-1]),
        entered=np.array([_entered(t, column, band) for column in size.T]),
        peak_torque=np.abs(motion.tau).max(axis=0),
    )


def _entered(t: Array, size: Array, band: float) -> float:
    """The first sample from which on the size stays within the band; NaN if it does not at the end."""
    outside = np.flatnonzero(size > band)
    if not outside.size:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < t.size else math.nan
