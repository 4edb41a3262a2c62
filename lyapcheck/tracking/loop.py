"""The loop that (21) closes as one differentiable graph, with the reference as its input."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import casadi as ca

from lyapcheck.simulate.compiled import Compiled

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.gains import Gains


@dataclass(frozen=True)
class TrackingLoop:
    """The state y = (e, w, S, W) of a run and its rate; inputs are q_d, q̇_d and q̈_d one after the other.

    e = q_d − q and w = q̇ − q̇_d = −ė. S' = ‖e‖², and W' = q̇ᵀ(τ − B q̇) is the power that reaches the arm, so
    that its energy ½ q̇ᵀM q̇ + P(q) must change by W: τ of (21) moves the arm (1) as the error system says.
    """

    n: int
    state: Any
    """(2n + 2,) SX."""
    reference: Any
    """(3n,) SX."""
    rate: Any
    """(2n + 2,) SX."""
    torque: Any
    """(n,) SX, τ of (21)."""
    energy: Any
    """SX, of the arm."""

    def compiled_rate(self) -> Compiled:
        """(y, reference) ↦ ẏ."""
        return Compiled(ca.Function("rate", self._inputs, [ca.densify(self.rate)]))

    def compiled_jacobian(self) -> Compiled:
        """(y, reference) ↦ ∂ẏ/∂y."""
        jacobian = ca.densify(ca.jacobian(self.rate, self.state))
        return Compiled(ca.Function("jacobian", self._inputs, [jacobian]))

    def signals(self) -> Any:
        """The CasADi function (y, reference) ↦ (τ, energy)."""
        return ca.Function("signals", self._inputs, [self.torque, self.energy])

    @property
    def _inputs(self) -> list[Any]:
        return [self.state, self.reference]


def tracking_loop(gains: Gains, model: RobotModel) -> TrackingLoop:
    """The graph of the error system of (21) on one arm, uncertain parameters at their nominal values.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w with q = q_d − e, q̇ = q̇_d + w, and
    τ = K_p h(e) + K_v h(ė) + M(q) q̈_d + C(q, q̇) q̇_d + g(q) + B q̇_d.

    References: (1), (21) of ``reyes2019family``.
    """
    from lyapcheck.robots import graph

    n = model.n
    state, reference = ca.SX.sym("y", 2 * n + 2), ca.SX.sym("r", 3 * n)
    e, w = state[:n], state[n : 2 * n]
    goal, speed, desired_acceleration = reference[:n], reference[n : 2 * n], reference[2 * n :]
    q, velocity = goal - e, speed + w
    mass, coriolis = graph.mass(model, q), graph.coriolis(model, q, velocity)
    friction, gravity = graph.viscous(model), graph.gravity(model, q)
    feedback = ca.DM(gains.kp) * gains.family.casadi(e).h - ca.DM(gains.kv) * gains.family.casadi(w).h
    acceleration = graph.solve(mass, feedback - friction @ w - coriolis @ w)
    torque = feedback + mass @ desired_acceleration + coriolis @ speed + gravity + friction @ speed
    power = ca.dot(velocity, torque - friction @ velocity)
    rate = ca.vertcat(-w, acceleration, ca.dot(e, e), power)
    energy = ca.dot(velocity, mass @ velocity) / 2 + graph.potential(model, q)
    return TrackingLoop(n, state, reference, rate, torque, energy)
