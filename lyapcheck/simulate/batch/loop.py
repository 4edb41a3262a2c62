"""The closed loop (11) written once for arrays of runs and for recorded code.

References: (6), (11), (12) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lyapcheck.lyapunov import quadratic
from lyapcheck.lyapunov.along import Forms
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import ArmAtAngles
from lyapcheck.robots.elimination import solve_definite

Vector = Sequence[Any]
Lift = Callable[[Any], Any]


@dataclass(frozen=True, eq=False)
class LoopColumns:
    """One run's controller and arm, or many of them as columns; see `parameter_count` for their order.

    Args:
        model: the arm, with its uncertain parameters.
        forms: the arithmetic and the family.
        parameters: q_d, K_p, K_v, B, the uncertain parameters, and ε₀.
    """

    model: RobotModel
    forms: Forms
    parameters: Vector

    @property
    def n(self) -> int:
        """Joints."""
        return self.model.n

    def rate(self, y: Vector) -> list[Any]:
        """ẏ of y = (q, w, D, S): w, M⁻¹(K_p h(e) − K_v h(w) − B w − C w), wᵀBw + wᵀK_v h(w), ‖e‖²."""
        n, of = self.n, self.forms
        q, w = y[:n], y[n : 2 * n]
        e = [d - x for d, x in zip(self._part(0), q, strict=True)]
        damping = [b * x + k * of.h(x) for b, k, x in zip(self._part(3), self._part(2), w, strict=True)]
        at = self._at(q)
        swing = [quadratic.dot(row, w) for row in at.coriolis(w)]
        spring = [k * of.h(x) for k, x in zip(self._part(1), e, strict=True)]
        force = [s - d - c for s, d, c in zip(spring, damping, swing, strict=True)]
        return [*w, *solve_definite(at.mass(), force), quadratic.dot(w, damping), quadratic.dot(e, e)]

    def torque(self, q: Vector, e: Vector, w: Vector) -> list[Any]:
        """τ = K_p h(e) − K_v h(w) + g(q)."""
        of, gravity = self.forms, self._at(q).gravity()
        rows = zip(self._part(1), e, self._part(2), w, gravity, strict=True)
        return [kp * of.h(x) - kv * of.h(v) + g for kp, x, kv, v, g in rows]

    def watched(self, y: Vector) -> list[Any]:
        """|τ_i| and V of a state y as in `rate`."""
        n = self.n
        q, w = y[:n], y[n : 2 * n]
        e = [d - x for d, x in zip(self._part(0), q, strict=True)]
        return [*(abs(tau) for tau in self.torque(q, e, w)), self.value(q, e, w)]

    def value(self, q: Vector, e: Vector, w: Vector) -> Any:
        """V of (12) for the ε₀ among the parameters."""
        of = self.forms
        eps = self.parameters[-1] / (1.0 + of.sqrt(quadratic.dot(e, e)))
        y = [v - eps * of.h(x) for v, x in zip(w, e, strict=True)]
        kinetic = quadratic.dot(y, [quadratic.dot(row, y) for row in self._at(q).mass()])
        return 0.5 * kinetic + quadratic.dot(self._part(1), [of.potential(x) for x in e])

    @cached_property
    def uncertain(self) -> dict[str, Any]:
        """The uncertain parameters by name."""
        return dict(zip(self.model.parameters, self.parameters[4 * self.n : -1], strict=True))

    def _at(self, q: Vector) -> ArmAtAngles:
        """The arm at angles q."""
        of = self.forms
        return self.model.at([of.sin(x) for x in q], [of.cos(x) for x in q], float, self.uncertain)

    def _part(self, i: int) -> Vector:
        return self.parameters[i * self.n : (i + 1) * self.n]


def parameter_count(model: RobotModel) -> int:
    """How many numbers a run has besides its state: q_d, K_p, K_v, B (n each), uncertain ones, ε₀."""
    return 4 * model.n + len(model.parameters) + 1
