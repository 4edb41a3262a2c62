"""From the samples of a motion to a `Motion`: indices, V along the way, promises."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.control.limits import model_limits
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import LEAST_ENERGY
from lyapcheck.simulate.run import Indices, Promises, Run
from lyapcheck.simulate.task import PAPER_TASK, Setup, torque_limits

# --- What a run shows about the promises of theory: V falls, the torque stays inside its bounds.


def observe(
    t: Array, V: Array, tau: Array, controlled: ControlledArm, *, noise: float, saturated: bool = False
) -> Promises:
    """The promises beside the samples of a run.

    ‖τ‖ is at most √n γ (λmax(K_p) + λmax(K_v)) + k_g, and each |τ_i| at most γ (k_pi + k_vi) + sup|g_i|, with
    the certified γ of the family.

    Args:
        t: (N,) s.
        V: (N,) J.
        tau: (N, n) N·m.
        controlled: controller and arm.
        noise: J, how far V may rise by the run's own error.
        saturated: the torque was cut at the motors' limits, so reaching a limit is leaving it.

    Soundness: samples and doubles; a rise between two samples, or one below ``noise``, is not seen.

    References: (6), (9) of ``reyes2019family``.
    """
    rises = np.flatnonzero(np.diff(V) > noise)
    norm = float(np.max(np.linalg.norm(tau, axis=1)))
    known, joints, bound = controlled.family.constants().gamma, None, None
    if known is not None:
        gamma, gravity = known.float_upper, list(map(float, model_limits(controlled.model).gravity))
        kp, kv = controlled.kp.tolist(), controlled.kv.tolist()
        bound = math.sqrt(controlled.n) * gamma * (max(kp) + max(kv)) + math.hypot(*gravity)
        rows = zip(kp, kv, gravity, strict=True)
        joints = tuple(gamma * (p + v) + weight for p, v, weight in rows)
    return Promises(
        V_decreases=rises.size == 0,
        V_rises_at=float(t[rises[0] + 1]) if rises.size else None,
        torque_norm=norm,
        torque_bound=bound,
        inside_bound=None if bound is None else norm <= bound,
        joint_bounds=joints,
        inside_limits=tuple(
            None
            if most is None
            else bool(np.all(np.abs(tau[:, i]) < most if saturated else np.abs(tau[:, i]) <= most))
            for i, most in enumerate(torque_limits(controlled.model))
        ),
    )


# --- Performance indices of a run: L2 norm, settling time, overshoot, peak torque, final error.


SETTLING_BAND = 0.02
"""Settled means within 2 % of the step; the paper prints settling times but not its band."""
BAND = math.radians(1.0)
"""rad: close enough to a reference."""
LEAST_STEP = 1e-9
"""rad: a smaller initial error is no step, and nothing is measured by it."""


def l2_index(t: Array, e: Array) -> float:
    """The root-mean-square position error L2 = √((1/T) ∫₀ᵀ ‖e‖² dt) in degrees, by the trapezoidal rule.

    Args:
        t: (N,) times in s, increasing.
        e: (N, n) position errors in rad.

    References: (20) of ``reyes2019family``.
    """
    return l2_of(float(np.trapezoid(np.sum(e * e, axis=1), t)), float(t[-1] - t[0]))


def settling_times(t: Array, e: Array) -> Array:
    """Per joint the time after which |e_i| stays within 2 % of its step; NaN if that is not reached.

    The step is |e_i(0)|; a joint that starts at its goal is measured by the largest step of the others. The
    crossing between two samples is interpolated linearly.

    Args:
        t: (N,) times in s.
        e: (N, n) position errors in rad.

    Returns:
        (n,) times in s.
    """
    size, width, joints = np.abs(e), bands(e[0]), np.arange(e.shape[1])
    outside = size > width
    last = t.size - 1 - np.argmax(outside[::-1], axis=0)
    before = np.minimum(last, t.size - 2)
    a, b = size[before, joints], size[before + 1, joints]
    fall = np.where(a > b, a - b, 1.0)
    crossing = t[before] + (a - width) / fall * (t[before + 1] - t[before])
    settled = np.where(outside.any(axis=0), np.where(last == t.size - 1, np.nan, crossing), t[0])
    return np.asarray(np.where(np.isnan(e[-1]), np.nan, settled))


def bands(step: Array, band: float = SETTLING_BAND) -> Array:
    """The half-width of the band of each joint, rad, from the steps (…, n) in rad; see `settling_times`."""
    size = np.abs(step)
    return np.asarray(band * np.where(size > LEAST_STEP, size, np.max(size, axis=-1, keepdims=True)))


def overshoots(e: Array) -> Array:
    """Per joint how far it runs past its goal, in per cent of its step |e_i(0)|; NaN without a step.

    Args:
        e: (N, n) position errors in rad.
    """
    start = e[0]
    beyond = np.maximum(np.max(-np.sign(start) * e, axis=0), 0.0)
    size = np.abs(start)
    share = np.divide(beyond, size, out=np.full_like(size, np.nan), where=size > LEAST_STEP)
    return np.asarray(100.0 * share)


def energies(
    controlled: ControlledArm, eps0: float, q: Array, e: Array, w: Array, speed: Array | None = None
) -> tuple[Array, Array]:
    """V of (12) or (13) and dV/dt along the motion at the samples, J and W.

    The goal moves at ``speed``, or is at rest.
    """
    numeric = controlled.watched(eps0)
    V, rate = numeric.V(q, e, w), numeric.rate(q, e, w)
    if speed is not None:
        rate += replace(numeric.at_columns(q, e, w), speed=list(speed.T)).rate_of_moving_goal(eps0)
    return V, rate


def motion_of(
    setup: Setup,
    kind: str,
    t: Array,
    e: Array,
    q: Array,
    w: Array,
    tau: Array,
    *,
    L2: float,
    complete: bool,
    band: float = BAND,
    speed: Array | None = None,
    settings: tuple[str, ...] = (),
) -> dict[str, Any]:
    """The fields of a `Motion` but its accuracy: what can be computed from its samples."""
    V, dV = energies(setup.controlled, setup.eps0, q, e, w, speed)
    return {
        "gains": setup.controlled.gains,
        "model": setup.model,
        "kind": kind,
        "task": setup.task,
        "eps0": setup.eps0,
        **{"t": t, "q": q, "e": e, "w": w, "tau": tau, "V": V, "dV": dV, "speed": speed},
        "indices": _indices(t, e, tau, L2, band),
        "complete": complete,
        "settings": settings,
    }


def l2_of(squares: float, T: float) -> float:
    """The L2 index in degrees from ∫ ‖e‖² dt in rad² s over T seconds; NaN of no time.

    References: (20) of ``reyes2019family``.
    """
    return math.degrees(math.sqrt(max(squares, 0.0) / T)) if T > 0 else math.nan


def _indices(t: Array, e: Array, tau: Array, L2: float, band: float) -> Indices:
    size, T = np.abs(e), float(t[-1])
    rms = np.sqrt(np.trapezoid(e * e, t, axis=0) / T) if T > 0 else np.full(e.shape[1], np.nan)
    outside = size > band
    last = np.where(outside.any(axis=0), t.size - 1 - np.argmax(outside[::-1], axis=0), -1)
    return Indices(
        L2=L2,
        settling=settling_times(t, e),
        overshoot=overshoots(e),
        rms=np.degrees(rms),
        peak_error=np.degrees(size.max(axis=0)),
        entered=np.where(last == t.size - 1, np.nan, t[np.minimum(last + 1, t.size - 1)]),
        peak_torque=np.max(np.abs(tau), axis=0),
        final_error=np.degrees(e[-1]),
    )


def imbalance(error: Array, *sizes: Array) -> float:
    """The largest error of an account of energy, relative to the largest of what was counted."""
    return float(np.max(np.abs(error))) / max(*(float(np.max(np.abs(x))) for x in sizes), LEAST_ENERGY)


# --- What the paper measured, to be put beside what the model does; nothing here is used to compute anything.


PAPER_ARM = "buap3"


@dataclass(frozen=True)
class PrintedIndices:
    """The printed performance of one controller of the experiment.

    References: ``reyes2019family``, Section 4, Table 2 and Fig. 11.
    """

    m: int | None
    """``None`` for PD."""
    kp: tuple[float, ...]
    """N·m (PD: N·m/°)."""
    kv: tuple[float, ...]
    L2: float
    """degrees, (20)."""
    settling: tuple[float, ...] | None
    """s per joint; the band is not printed. For m = 1 the paper says only: below 1.4 s."""
    final_error: tuple[float, ...]
    """degrees."""


PRINTED = (
    PrintedIndices(1, (28, 60, 5), (0.233,) * 3, 25.4006, None, (-0.5774, 0.1272, -0.051)),
    PrintedIndices(2, (27, 50, 5), (0.223,) * 3, 24.6892, (0.994, 0.997, 0.929), (-0.1849, 0.4876, 0.1867)),
    PrintedIndices(3, (25, 50, 5), (0.223,) * 3, 23.4006, (0.892, 0.923, 0.867), (-0.3717, 0.3009, 0.2024)),
    PrintedIndices(
        None, (0.8, 2.5, 0.133), (0.4, 0.75, 0.01), 27.8546, (1.14, 0.959, 0.952), (-0.2566, -0.7238, -0.8646)
    ),
)


def printed_for(run: Run) -> PrintedIndices | None:
    """The printed numbers of the same gains, arm and task; none for anything the paper did not run."""
    if run.robot != PAPER_ARM or run.task != PAPER_TASK:
        return None
    known = {("linear" if x.m is None else "hyperbolic", x.m, x.kp, x.kv): x for x in PRINTED}
    kp, kv = (tuple(map(float, row)) for row in (run.gains.kp, run.gains.kv))
    return known.get((run.gains.family, run.m, kp, kv))
