"""The bench as a discrete map: encoders, controller, hold, motors, and the arm between two samples."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck.simulate.gains import Gains
from lyapcheck.simulate.monitor import torque_limits

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class Bench:
    """How the experiment was run.

    The controller reads the encoders every ``period`` seconds, takes the backward difference of two
    readings for the velocity, and holds its torque, cut at the motors' limits, until the next reading.
    Dry friction is f_c tanh(w/creep): a joint that should stick creeps at about ``creep`` rad/s instead.

    References: ``reyes2019family``, Section 4 and Table 1.
    """

    period: float = 2.5e-3
    creep: float = 1e-3


def period_map(gains: Gains, model: RobotModel, bench: Bench, substeps: int) -> Any:
    """The CasADi function ((q, w, last reading), q_d) ↦ (the same one period later, the torque held).

    The arm moves by ``substeps`` steps of the classical Runge–Kutta method.
    """
    n = model.n
    state, goal = ca.MX.sym("state", 3 * n), ca.MX.sym("q_d", n)
    torque, reading = controller(gains, model, bench)(state[:n], state[2 * n :], goal)
    arm = _runge_kutta(model, bench, bench.period / substeps).mapaccum(substeps)
    moved = arm(state[: 2 * n], ca.repmat(torque, 1, substeps))[:, -1]
    return ca.Function("period", [state, goal], [ca.vertcat(moved, reading), torque])


def controller(gains: Gains, model: RobotModel, bench: Bench) -> Any:
    """The CasADi function (q, last reading, q_d) ↦ (torque after the motors' limits, new reading)."""
    from lyapcheck.robots import graph

    n = model.n
    q, last, goal = (ca.SX.sym(name, n) for name in ("q", "last", "q_d"))
    reading = read_encoders(q, model.encoder)
    spring = ca.DM(gains.kp) * gains.family.casadi(goal - reading).h
    damper = ca.DM(gains.kv) * gains.family.casadi((reading - last) / bench.period).h
    most = ca.DM([math.inf if limit is None else limit for limit in torque_limits(model)])
    wanted = spring - damper + graph.gravity(model, reading)
    return ca.Function("controller", [q, last, goal], [ca.fmin(ca.fmax(wanted, -most), most), reading])


def read_encoders(q: Any, counts: Sequence[int | None]) -> Any:
    """The nearest encoder line to each angle in rad; the angle itself where the encoder is unknown."""
    line = [2.0 * math.pi / number if number else None for number in counts]
    return ca.vertcat(*(q[i] if a is None else a * ca.floor(q[i] / a + 0.5) for i, a in enumerate(line)))


def arm_rate(model: RobotModel, bench: Bench) -> Any:
    """The CasADi function (x, τ) ↦ ẋ of the arm with dry friction, x = (q, w)."""
    n = model.n
    x, torque = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n)
    rate = ca.vertcat(x[n:], _acceleration(model, bench, x[:n], x[n:], torque))
    return ca.Function("rate", [x, torque], [ca.densify(rate)])


def _runge_kutta(model: RobotModel, bench: Bench, h: float) -> Any:
    x, torque = ca.SX.sym("x", 2 * model.n), ca.SX.sym("tau", model.n)
    rate = arm_rate(model, bench)
    k1 = rate(x, torque)
    k2 = rate(x + h / 2 * k1, torque)
    k3 = rate(x + h / 2 * k2, torque)
    k4 = rate(x + h * k3, torque)
    return ca.Function("arm", [x, torque], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])


def _acceleration(model: RobotModel, bench: Bench, q: Any, w: Any, torque: Any) -> Any:
    """M⁻¹(τ − C w − g − B w − f_c tanh(w/creep)), that is (1) with dry friction added."""
    from lyapcheck.robots import graph

    dry = ca.DM(dry_friction(model)) * ca.tanh(w / bench.creep)
    drift = graph.coriolis(model, q, w) @ w + graph.gravity(model, q) + graph.viscous(model) @ w
    return graph.solve(graph.mass(model, q), torque - drift - dry)


def dry_friction(model: RobotModel) -> list[float]:
    """Coulomb torques in N·m, 0 where nothing is known."""
    return [0.0 if number is None else float(number.value) for number in model.coulomb]


def enough_substeps(model: RobotModel, bench: Bench) -> int:
    """Runge–Kutta steps in a period with which the steep part of the dry friction is integrated stably.

    The fastest rate is λmax(M⁻¹ (F_c/creep + B)), taken over a fixed set of postures with half as much again
    for the postures between; the method is stable up to 2.78 of it and is asked for 1.5.
    """
    from lyapcheck.robots import graph

    q = ca.SX.sym("q", model.n)
    mass = ca.Function("mass", [q], [graph.mass(model, q)])
    friction = np.diag(np.array(dry_friction(model)) / bench.creep + [float(b.value) for b in model.viscous])
    postures = np.random.default_rng(0).uniform(-math.pi, math.pi, size=(64, model.n))
    fastest = max(
        float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(np.array(mass(p)), friction)))))
        for p in postures
    )
    return max(5, math.ceil(1.5 * fastest * bench.period / 1.5))
