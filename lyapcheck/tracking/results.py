"""From the samples of a tracking motion to a run: V along the way, its bound, the indices."""

from __future__ import annotations

import math
from collections.abc import Sequence

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
from lyapcheck.simulate.gains import Gains
from lyapcheck.simulate.results import noise_of
from lyapcheck.tracking.form import TrackingForm
from lyapcheck.tracking.monitors import form_monitor
from lyapcheck.tracking.run import Promise, TrackingIndices, TrackingMotion


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
