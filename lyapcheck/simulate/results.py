"""From the samples of a motion to a Run: indices, V along the way, promises."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck.simulate import indices
from lyapcheck.simulate.along import lyapunov_along
from lyapcheck.simulate.monitor import observe, torque_limits
from lyapcheck.simulate.run import Indices, Run
from lyapcheck.simulate.setup import Setup

Array = NDArray[np.float64]

V_NOISE = 1e-9
"""How far V may rise between samples, relative to its largest value, before it counts as a rise."""


@dataclass(frozen=True)
class Motion:
    """The bare samples of a run."""

    kind: str
    t: Array
    q: Array
    w: Array
    tau: Array


def run_of(
    setup: Setup,
    motion: Motion,
    *,
    accuracy: float,
    energy_balance: float,
    L2: float,
    complete: bool,
    saturated: bool = False,
    notes: tuple[str, ...] = (),
) -> Run:
    """The run of a motion: everything that can be computed from its samples."""
    gains, model = setup.gains, setup.model
    e = np.array(setup.task.q_d) - motion.q
    V, dV = lyapunov_along(gains, model, q=motion.q, e=e, w=motion.w, eps0=setup.eps0)
    return Run(
        name=gains.name,
        m=gains.family.m,
        robot=model.name,
        joints=model.joints,
        kind=motion.kind,
        task=setup.task,
        eps0=setup.eps0,
        t=motion.t,
        q=motion.q,
        w=motion.w,
        e=e,
        tau=motion.tau,
        V=V,
        dV=dV,
        indices=_indices(motion, e, L2),
        promises=observe(motion.t, V, motion.tau, gains, model, noise=V_NOISE, saturated=saturated),
        accuracy=accuracy,
        energy_balance=energy_balance,
        torque_limit=torque_limits(model),
        complete=complete,
        notes=(*notes, *model.assumptions),
    )


def _indices(motion: Motion, e: Array, L2: float) -> Indices:
    return Indices(
        L2=L2,
        settling=indices.settling_times(motion.t, e),
        overshoot=indices.overshoots(e),
        peak_torque=indices.peak_torques(motion.tau),
        final_error=indices.final_errors(e),
    )
