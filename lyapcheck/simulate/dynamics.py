"""The closed loop (11) as one differentiable graph, and as compiled functions of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import casadi as ca

from lyapcheck.lyapunov.graph import at_symbols
from lyapcheck.simulate.compiled import Compiled
from lyapcheck.simulate.gains import Gains

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class LoopDynamics:
    """The state y = (q, w, D, S) of a run and its rate, with q_d as a parameter.

    D is the energy that damping has taken, D' = wᵀBw + wᵀK_v h(w), and S' = ‖e‖²: both ride along so that
    the energy balance and the L2 index are as accurate as the motion itself.
    """

    n: int
    state: Any
    """(2n + 2,) SX."""
    goal: Any
    """(n,) SX, q_d."""
    rate: Any
    """(2n + 2,) SX, ẏ along (11)."""
    torque: Any
    """(n,) SX, τ of (6)."""
    energy: Any
    """SX, E = ½wᵀMw + Σ k_pi U(e_i), so that E' = −D'."""

    def compiled_rate(self) -> Compiled:
        """(y, q_d) ↦ ẏ."""
        return Compiled(ca.Function("rate", [self.state, self.goal], [ca.densify(self.rate)]))

    def compiled_jacobian(self) -> Compiled:
        """(y, q_d) ↦ ∂ẏ/∂y."""
        jacobian = ca.densify(ca.jacobian(self.rate, self.state))
        return Compiled(ca.Function("jacobian", [self.state, self.goal], [jacobian]))

    def signals(self) -> Any:
        """The CasADi function (y, q_d) ↦ (τ, E)."""
        return ca.Function("signals", [self.state, self.goal], [self.torque, self.energy])


def closed_loop(gains: Gains, model: RobotModel) -> LoopDynamics:
    """The graph of (11) for one controller on one arm, uncertain parameters at their nominal values.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w, with e = q_d − q.

    References: (6), (11) of ``reyes2019family``.
    """
    n = model.n
    state, goal = ca.SX.sym("y", 2 * n + 2), ca.SX.sym("q_d", n)
    q, w = state[:n], state[n : 2 * n]
    e, gain = goal - q, (ca.DM(gains.kp), ca.DM(gains.kv))
    at = at_symbols(model, q, e, w, *gain, gains.family.casadi)
    rate = ca.vertcat(w, *at.acceleration(), at.damping(), ca.dot(e, e))
    return LoopDynamics(n, state, goal, rate, ca.vertcat(*at.torque()), at.value(0.0))
