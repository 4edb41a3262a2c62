"""The closed loop (11) with dry friction added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.closed_loop import closed_loop
from lyapcheck.simulate.integrate import integrate
from lyapcheck.simulate.task import set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

CREEP = 1e-3
"""rad/s: dry friction is f tanh(w/creep), so that a joint that should stick creeps."""
TOLERANCE = 1e-8


def disturbed(
    gain_set: GainSet,
    model: RobotModel,
    q_d: Sequence[float],
    q0: Sequence[float] | None = None,
    w0: Sequence[float] | None = None,
    T: float = 5.0,
    *,
    dry: Sequence[float] = (),
    points: int = 1001,
) -> tuple[Array, Array]:
    """Move an arm under its controller against dry friction.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w − f tanh(w/creep).

    Args:
        gain_set: the controller.
        model: the arm, uncertain parameters at their nominal values.
        q_d: (n,) goal in rad.
        q0: (n,) start in rad; home if missing.
        w0: (n,) initial rates in rad/s; rest if missing.
        T: seconds.
        dry: (n,) dry friction f in N·m; none if empty.
        points: samples handed back.

    Returns:
        ``t`` (N,) in s and ``e`` (N, n) in rad, as far as the motion came.

    Raises:
        InputError: a task the arm cannot be given.

    Soundness: floating point throughout: evidence, never a proof.

    References: (11) of ``reyes2019family``.
    """
    from lyapcheck.robots import graph

    setup = set_up(gain_set, model, q_d, q0, w0, T=T, eps0=None, points=points)
    loop, n = closed_loop(setup.gains, model), model.n
    w = loop.state[n : 2 * n]
    added = -ca.DM(list(dry) or [0.0] * n) * ca.tanh(w / CREEP)
    acceleration = graph.solve(graph.mass(model, loop.state[:n]), added)
    whole = loop.rate + ca.vertcat(ca.SX.zeros(n), acceleration, 0, 0)
    loop = replace(loop, rate=whole)
    rate, slope = loop.compiled_rate(), loop.compiled_jacobian()
    goal, t = np.array(setup.task.q_d), np.linspace(0.0, setup.task.T, points)
    start = np.array([*setup.task.q0, *setup.task.w0, 0.0, 0.0])
    path = integrate(lambda _, y: rate(y, goal), lambda _, y: slope(y, goal), start, t, TOLERANCE)
    return path.t, goal - path.y[:, :n]
