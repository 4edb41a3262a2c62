"""The bench written once for compiled loops and for graphs: the controller, and the arm with dry friction.

References: (1), (6) and Section 4 of ``reyes2019family``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.lyapunov.along import total
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import ArmAtAngles

Vector = Sequence[Any]


@dataclass(frozen=True, eq=False)
class BenchStep:
    """One run's controller and arm.

    Dry friction is the set-valued law of Coulomb: f_c sign(w) while a joint moves, and whatever holds it, up
    to f_c, while it does not. A joint that should stick sticks, and no step has to be small because of it.

    Args:
        model: the arm.
        of: the arithmetic.
        h: of the family, in it.
        parameters: q_d, K_p, K_v, B, f_c (n each), and the uncertain parameters; see `parameter_count`.
        period: s between two readings.
        sweeps: how often `_with_friction` goes over the joints.
    """

    model: RobotModel
    of: Arithmetic
    h: Callable[[Any], Any]
    parameters: Vector
    period: float
    sweeps: int

    @property
    def n(self) -> int:
        """Joints."""
        return self.model.n

    def controller(self, q: Vector, last: Vector) -> tuple[list[Any], list[Any]]:
        """(torque held, readings): τ = K_p h(e) − K_v h(Δq/T) + g of what is read, cut at the limits."""
        readings = [self._read(q[i], self.model.encoder[i]) for i in range(self.n)]
        gravity = self._at(readings).gravity()
        torques = []
        for i, reading in enumerate(readings):
            spring = self._part(1)[i] * self.h(self._part(0)[i] - reading)
            damper = self._part(2)[i] * self.h((reading - last[i]) * (1.0 / self.period))
            torques.append(self._cut(spring - damper + gravity[i], i))
        return torques, readings

    def move(self, q: Vector, w: Vector, torque: Vector, h: float) -> tuple[list[Any], list[Any]]:
        """(q, w) a time h later: the midpoint rule with implicit friction, so that a joint at rest can stay.

        Soundness: of second order in h while no joint starts or stops, of first order where one does.
        """
        middle = self._rates(q, w, w, torque, h / 2)
        half = self.of.names([x + (h / 4) * (a + b) for x, a, b in zip(q, w, middle, strict=True)])
        end = self._rates(half, w, middle, torque, h)
        return [x + (h / 2) * (a + b) for x, a, b in zip(q, w, end, strict=True)], end

    def _rates(self, q: Vector, before: Vector, during: Vector, torque: Vector, h: float) -> list[Any]:
        """w with M w + h f_c sign(w) ∋ M w_before + h (τ − C w − g − B w), forces at (q, w_during)."""
        at = self._at(q)
        mass = [self.of.names(row) for row in at.mass()]
        swing = [_dot(row, during) for row in at.coriolis(during)]
        rows = zip(torque, swing, at.gravity(), self._part(3), during, strict=True)
        force = self.of.names([t - c - g - b * x for t, c, g, b, x in rows])
        momentum = [_dot(row, before) + h * f for row, f in zip(mass, force, strict=True)]
        return self._with_friction(mass, self.of.names(momentum), during, h)

    def _with_friction(self, mass: list[list[Any]], momentum: Vector, guess: Vector, h: float) -> list[Any]:
        """The w that minimises ½wᵀMw − momentumᵀw + h Σ f_ci |w_i|, one joint after the other."""
        w = list(guess)
        most = [h * f for f in self._part(4)]
        inverse = self.of.names([1.0 / mass[i][i] for i in range(self.n)])
        for _ in range(self.sweeps):
            for i in range(self.n):
                rest = momentum[i]
                for j in range(self.n):
                    rest = rest if i == j else rest - mass[i][j] * w[j]
                w[i] = self.of.name(self._shrunk(rest, most[i]) * inverse[i])
        return w

    def _shrunk(self, x: Any, by: Any) -> Any:
        """x moved towards 0 by at most ``by``."""
        return self.of.copysign(self.of.larger(self.of.fabs(x) - by, 0.0), x)

    def _read(self, angle: Any, counts: int | None) -> Any:
        """The nearest encoder line; the angle itself where the encoder is unknown."""
        if not counts:
            return angle
        line = 2.0 * math.pi / counts
        return line * self.of.nearest(angle * (1.0 / line))

    def _cut(self, torque: Any, joint: int) -> Any:
        limit = self.model.torque_limit[joint]
        if limit is None:
            return torque
        most = float(limit.value)
        return self.of.smaller(self.of.larger(torque, -most), most)

    @cached_property
    def uncertain(self) -> dict[str, Any]:
        """The uncertain parameters by name."""
        return dict(zip(self.model.parameters, self.parameters[5 * self.n :], strict=True))

    def _at(self, q: Vector) -> ArmAtAngles:
        """The arm at angles q."""
        of = self.of
        turns = [of.sin(x) for x in q], [of.cos(x) for x in q]
        return self.model.at(*turns, of.lift, self.uncertain, of.name)

    def _part(self, i: int) -> Vector:
        return self.parameters[i * self.n : (i + 1) * self.n]


def parameter_count(model: RobotModel) -> int:
    """How many numbers a run has besides its state: q_d, K_p, K_v, B, f_c (n each), uncertain ones."""
    return 5 * model.n + len(model.parameters)


def _dot(x: Vector, y: Vector) -> Any:
    return total(a * b for a, b in zip(x, y, strict=True))
