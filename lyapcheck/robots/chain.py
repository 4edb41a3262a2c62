"""C(q, x), g(q) and the potential of a chain of links in any arithmetic, in O(n²) steps, beside M(q).

With J = ∫ p̂p̂ᵀ dm, p̂ = (p, 1), of all bodies that joint m moves, X_i the twist of joint i as a 4 × 4 matrix,
V_l = Σ_{k≤l} x_k X_k and K = Σ_l J_l V_lᵀ of the same bodies,

    C_ij = tr(X_i K X_jᵀ) + tr(X_i J Ẋ_jᵀ),      Ẋ_j = V_{j−1} X_j − X_j V_{j−1},

J and K of the bodies behind both i and j. As c_ijk = ∫ ∂p/∂q_i · ∂²p/∂q_j∂q_k dm, this C is that of the
Christoffel symbols of M.

References: composite rigid bodies, ``featherstone2008rigid`` chapter 6; ``echeandia2021numerical`` for C.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from lyapcheck.check.loop.chain import Posture, RigidLink, Rows, Wrench, own_body
from lyapcheck.check.numbers.vectors import ZERO, Algebra, Matrix, transposed
from lyapcheck.check.numbers.vectors import Vector as VectorsVector

Values = list[Any]
Twist = tuple[VectorsVector, VectorsVector]
"""ω, and the velocity of the origin of the frame."""


@dataclass(frozen=True)
class _Moving:
    """K of a body: ∫ p ṗᵀ dm and the momentum ∫ ṗ dm."""

    second: Matrix
    momentum: VectorsVector


class ChainInMotion(Posture):
    """A chain with its joints at some angles, and in motion.

    Args:
        links: base first; their numbers are exact, or values of the arithmetic.
        fall: acceleration of free fall in the base frame, (3,), m/s²; likewise.
        sines: of the angles, (n,), in the arithmetic.
        cosines: (n,).
        of: the arithmetic.
    """

    def __init__(
        self,
        links: Sequence[RigidLink],
        fall: VectorsVector,
        sines: VectorsVector,
        cosines: VectorsVector,
        of: Algebra,
    ) -> None:
        super().__init__(links, sines, cosines, of)
        self.fall = fall

    def coriolis(self, x: VectorsVector) -> Rows:
        """C(q, x) of the Christoffel symbols, (n, n), kg·m²/s, for rates x (n,), rad/s."""
        of, n = self.of, self.n
        rows: Rows = [[ZERO] * n for _ in range(n)]
        twists, slopes = self._twists(x)
        moving = self._moving(twists)
        for m in range(n):
            axis, body, flow = self.links[m].axis, self.bodies[m], moving[m]
            spin, speed = slopes[m]
            momentum = self.momentum(m)
            second = [
                of.add(of.cross(axis, flow.second[i]), of.cross(spin, body.second[i]), of.scaled(s, speed))
                for i, s in enumerate(body.moment)
            ]
            force = of.add(
                of.cross(axis, flow.momentum), of.cross(spin, body.moment), of.scaled(body.mass, speed)
            )
            right = Wrench(of.axial(second), force)
            left = Wrench(
                of.axial([of.cross(axis, column) for column in transposed(flow.second)]), [ZERO] * 3
            )
            rows[m][m] = of.value(of.dot(axis, right.torque))
            for i in range(m - 1, -1, -1):
                momentum, right, left = (self.carried(i + 1, w) for w in (momentum, right, left))
                rows[i][m] = of.value(of.dot(self.links[i].axis, right.torque))
                moved = of.plus(of.dot(slopes[i][0], momentum.torque), of.dot(slopes[i][1], momentum.force))
                rows[m][i] = of.value(of.plus(of.dot(self.links[i].axis, left.torque), moved))
        return rows

    def gravity(self) -> Values:
        return self.torques(self.fall)

    def potential(self) -> Any:
        """The potential energy −Σ m_k γᵀp_k, J."""
        of, first = self.of, self.bodies[0]
        place = of.add(of.apply(self.turns[0], first.moment), of.scaled(first.mass, self.links[0].origin))
        return of.value(of.dot(of.scaled(Fraction(-1), self.fall), place))

    def _twists(self, x: VectorsVector) -> tuple[list[Twist], list[Twist]]:
        of = self.of
        twists: list[Twist] = []
        slopes: list[Twist] = []
        spin: VectorsVector = [ZERO] * 3
        speed: VectorsVector = [ZERO] * 3
        for k, link in enumerate(self.links):
            back = transposed(self.turns[k])
            speed = of.apply(back, of.add(speed, of.cross(spin, link.origin)))
            spin = of.apply(back, spin)
            slopes.append((of.cross(spin, link.axis), of.cross(speed, link.axis)))
            spin = of.add(spin, of.scaled(x[k], link.axis))
            twists.append((spin, speed))
        return twists, slopes

    def _moving(self, twists: Sequence[Twist]) -> list[_Moving]:
        of = self.of
        result: list[_Moving] = []
        for k in reversed(range(self.n)):
            body, (spin, speed) = own_body(of, self.links[k]), twists[k]
            second = [
                of.add(of.cross(spin, row), of.scaled(s, speed))
                for row, s in zip(body.second, body.moment, strict=True)
            ]
            momentum = of.add(of.cross(spin, body.moment), of.scaled(body.mass, speed))
            if result:
                turned = of.apply(self.turns[k + 1], result[0].momentum)
                carried = of.congruent(self.turns[k + 1], result[0].second)
                second = of.sum(second, carried, of.outer(self.links[k + 1].origin, turned))
                momentum = of.add(momentum, turned)
            result.insert(0, _Moving(second, momentum))
        return result


# --- Linear equations with a symmetric positive definite matrix, in any arithmetic.


Vector = Sequence[Any]
Named = Callable[[Vector], list[Any]]


def solve_definite(matrix: Sequence[Vector], right: Vector, names: Named = list) -> list[Any]:
    """x with matrix · x = right, by LDLᵀ without square roots, in any arithmetic.

    Args:
        matrix: (n, n).
        right: (n,).
        names: of values that are used more than once.

    Soundness: with M not definite the pivots vanish or change sign; property 2.1 is decided elsewhere.
    """
    lower, pivots = _ldl(matrix, names)
    x = list(right)
    n = len(x)
    for i in range(n):
        for k in range(i):
            x[i] = x[i] - lower[i][k] * x[k]
        (x[i],) = names([x[i]])
    x = [a / d for a, d in zip(x, pivots, strict=True)]
    for i in reversed(range(n)):
        for k in range(i + 1, n):
            x[i] = x[i] - lower[k][i] * x[k]
        (x[i],) = names([x[i]])
    return x


def _ldl(matrix: Sequence[Vector], names: Named) -> tuple[list[list[Any]], list[Any]]:
    """Rows of L left of its diagonal, and the pivots."""
    lower: list[list[Any]] = []
    pivots: list[Any] = []
    for i, row in enumerate(matrix):
        scaled: list[Any] = []  # L_ik d_k
        for k in range(i):
            rest = row[k]
            for j in range(k):
                rest = rest - scaled[j] * lower[k][j]
            scaled += names([rest])
        lower.append([names([a / d])[0] for a, d in zip(scaled, pivots, strict=False)])
        pivot = row[i]
        for a, b in zip(scaled, lower[i], strict=True):
            pivot = pivot - a * b
        pivots += names([pivot])
    return lower, pivots
