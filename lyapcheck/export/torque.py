"""The torque of the controller in doubles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck.control.gains import GainSet, one_gain_set
from lyapcheck.errors import argument_error
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.task import gains_for

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lyapcheck._types import Array


def torque(
    gain_set: GainSet | str | Path,
    model: RobotModel | str | Path,
    q_rad: ArrayLike,
    velocity_rad: ArrayLike,
    target_rad: ArrayLike,
) -> Array:
    """τ = K_p h(q_d − q) − K_v h(w) + g(q), N·m, without overflow at any finite q, w and q_d.

    Args:
        gain_set: the controller, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        q_rad: (..., n) angles in rad.
        velocity_rad: (..., n) velocities in rad/s.
        target_rad: (..., n) goals in rad.

    Raises:
        InputError: gains or arrays for another number of joints.

    Soundness: rounded to nearest without bounds; ``lyapcheck export`` writes the same as C with a bound.

    References: (6) of ``reyes2019family``.
    """
    arm = arm_of(model)
    gains = gains_for(one_gain_set(gain_set), arm.n)
    places = [np.asarray(x, dtype=np.float64) for x in (q_rad, velocity_rad, target_rad)]
    for name, x in zip(("q_rad", "velocity_rad", "target_rad"), places, strict=True):
        if x.shape[-1:] != (arm.n,):
            rule = f"has the shape {x.shape}, and its last axis must be the {arm.n} joints"
            raise argument_error(name, "", rule, f"give arrays of the shape (..., {arm.n})")
    at, rates, goals = np.broadcast_arrays(*places)
    kp, kv, h = np.array(gains.kp), np.array(gains.kv), gains.family.h
    return np.asarray(kp * h(goals - at) - kv * h(rates) + NumericModel(arm).gravity(at))
