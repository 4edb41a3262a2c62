"""What a run shows about the promises of theory: V falls, the torque stays inside its bounds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array
from lyapcheck.control.arm_limits import kept_bounds
from lyapcheck.simulate.gains import Gains
from lyapcheck.simulate.run import Promises

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


def observe(
    t: Array, V: Array, tau: Array, gains: Gains, model: RobotModel, *, noise: float, saturated: bool = False
) -> Promises:
    """The promises beside the samples of a run.

    Args:
        t: (N,) s.
        V: (N,) J.
        tau: (N, n) N·m.
        gains: the controller.
        model: the arm.
        noise: J, how far V may rise by the run's own error.
        saturated: the torque was cut at the motors' limits, so reaching a limit is leaving it.

    Soundness: samples and doubles; a rise between two samples, or one below ``noise``, is not seen.
    """
    rises = np.flatnonzero(np.diff(V) > noise)
    norm = float(np.max(np.linalg.norm(tau, axis=1)))
    bound = torque_bound(gains, model)
    return Promises(
        V_decreases=rises.size == 0,
        V_rises_at=float(t[rises[0] + 1]) if rises.size else None,
        torque_norm=norm,
        torque_bound=bound,
        inside_bound=None if bound is None else norm <= bound,
        joint_bounds=joint_bounds(gains, model),
        inside_limits=tuple(
            None
            if most is None
            else bool(np.all(np.abs(tau[:, i]) < most if saturated else np.abs(tau[:, i]) <= most))
            for i, most in enumerate(torque_limits(model))
        ),
    )


def torque_limits(model: RobotModel) -> tuple[float | None, ...]:
    """What each motor can give, N·m."""
    return tuple(None if limit is None else float(limit.value) for limit in model.torque_limit)


def torque_bound(gains: Gains, model: RobotModel) -> float | None:
    """The bound √n γ (λmax(K_p) + λmax(K_v)) + k_g on ‖τ‖ in N·m; none where h is unbounded.

    References: (9) of ``reyes2019family``, with the certified γ of the family.
    """
    gamma = gains.family.constants().gamma
    if gamma is None:
        return None
    gravity = math.hypot(*map(float, kept_bounds(model)))
    return math.sqrt(model.n) * gamma.float_upper * (max(gains.kp) + max(gains.kv)) + gravity


def joint_bounds(gains: Gains, model: RobotModel) -> tuple[float, ...] | None:
    """The bound γ (k_pi + k_vi) + sup|g_i| on each |τ_i| in N·m; none where h is unbounded.

    References: (6), (9) of ``reyes2019family``, joint by joint.
    """
    gamma = gains.family.constants().gamma
    if gamma is None:
        return None
    rows = zip(gains.kp, gains.kv, kept_bounds(model), strict=True)
    return tuple(gamma.float_upper * (p + v) + float(weight) for p, v, weight in rows)
