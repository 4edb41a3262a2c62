"""From the samples of a motion to a Run: indices, V along the way, promises."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lyapcheck._types import Array
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.simulate import indices
from lyapcheck.simulate.monitor import observe, torque_limits
from lyapcheck.simulate.run import Indices, Run
from lyapcheck.simulate.setup import Setup

V_NOISE = 1e-9
"""How far V may rise between samples, relative to its largest value, before it counts as a rise."""

LEAST_ENERGY = 1e-9
"""J: below this, energies are the integrator's absolute tolerance and not the arm's."""


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
    certificate = LyapunovNumeric(model, gains.family, gains.kp, gains.kv, setup.eps0)
    V, dV = certificate.V(motion.q, e, motion.w), certificate.rate(motion.q, e, motion.w)
    return Run(
        gains=gains,
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
        promises=observe(motion.t, V, motion.tau, gains, model, noise=noise_of(V), saturated=saturated),
        accuracy=accuracy,
        energy_balance=energy_balance,
        torque_limit=torque_limits(model),
        complete=complete,
        notes=(*notes, *model.assumptions),
        without_dry_friction=model.dry and motion.kind == "reference",
    )


def noise_of(V: Array) -> float:
    """J, how far V may rise between two samples before it counts as a rise."""
    return V_NOISE * max(float(np.max(np.abs(V))), LEAST_ENERGY)


def _indices(motion: Motion, e: Array, L2: float) -> Indices:
    return Indices(
        L2=L2,
        settling=indices.settling_times(motion.t, e),
        overshoot=indices.overshoots(e),
        peak_torque=indices.peak_torques(motion.tau),
        final_error=indices.final_errors(e),
    )
