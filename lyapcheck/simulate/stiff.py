"""The bench experiment on a stiff arm: an implicit method between two samples."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.bench import Bench, arm_rate, controller
from lyapcheck.simulate.compiled import Compiled
from lyapcheck.simulate.integrate import MAX_STEPS
from lyapcheck.simulate.setup import Setup

if TYPE_CHECKING:
    from typing import Any


def stiff_periods(setup: Setup, bench: Bench, periods: int, tolerance: float) -> tuple[Array, Array]:
    """(periods + 1, 2n) states and (periods, n) torques; what comes after a failure is NaN.

    Each period is integrated by LSODA, which turns to backward differentiation formulas where the arm is
    stiff.

    Args:
        setup: controller, arm and task.
        bench: period and creep rate.
        periods: how many.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.

    Soundness: an error estimate per step is not a bound: compare with a run at a smaller tolerance.

    References: ``petzold1983automatic``.
    """
    from scipy.integrate import odeint

    n, task = setup.model.n, setup.task
    x, tau = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n)
    arm = arm_rate(setup.model, bench)(x, tau)
    rate = Compiled(ca.Function("rate", [x, tau], [arm]))
    slope = Compiled(ca.Function("slope", [x, tau], [ca.densify(ca.jacobian(arm, x))]))
    control, goal = controller(setup.gains, setup.model, bench), np.array(task.q_d)
    states, torques = np.full((periods + 1, 2 * n), np.nan), np.full((periods, n), np.nan)
    states[0] = *task.q0, *task.w0
    reading: Any = np.array(task.q0) - bench.period * np.array(task.w0)
    options = {"rtol": tolerance, "atol": tolerance / 100, "mxstep": MAX_STEPS, "full_output": True}
    for k in range(periods):
        held, reading = control(states[k, :n], reading, goal)
        torques[k] = np.array(held).ravel()
        ends, info = odeint(
            lambda y, _, tau: rate(y, tau),
            states[k],
            [0.0, bench.period],
            (torques[k],),
            lambda y, _, tau: slope(y, tau),
            **options,
        )
        if info["message"] != "Integration successful.":
            break
        states[k + 1] = ends[1]
    return states, torques
