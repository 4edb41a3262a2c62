"""M(q), C(q, x), g(q) and the potential of a chain of links in any arithmetic, in O(n²) steps.

Bodies are composed from the tip to the base. With J = ∫ p̂p̂ᵀ dm, p̂ = (p, 1), of all bodies that joint m moves,
X_i the twist of joint i as a 4 × 4 matrix, V_l = Σ_{k≤l} x_k X_k and K = Σ_l J_l V_lᵀ of the same bodies,

    M_im = tr(X_i J X_mᵀ),      C_ij = tr(X_i K X_jᵀ) + tr(X_i J Ẋ_jᵀ),      Ẋ_j = V_{j−1} X_j − X_j V_{j−1},

J and K of the bodies behind both i and j. As c_ijk = ∫ ∂p/∂q_i · ∂²p/∂q_j∂q_k dm, this C is that of the
Christoffel symbols of M. All is in the frame of a joint: what joints before it do never enters M.

References: composite rigid bodies, ``featherstone2008rigid`` chapter 6; ``echeandia2021numerical`` for C.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from lyapcheck.check.numbers.matrices import is_positive_semidefinite
from lyapcheck.check.numbers.vectors import ZERO, Algebra, Entry, Matrix, Vector, transposed

Values = list[Any]
Rows = list[list[Any]]
Twist = tuple[Vector, Vector]
"""ω, and the velocity of the origin of the frame."""
UNIT = tuple(tuple(Fraction(int(i == k)) for k in range(3)) for i in range(3))


@dataclass(frozen=True)
class RigidLink:
    """One joint and the body that it moves, in the frame of the joint.

    Args:
        axis: of the joint, its length 1.
        origin: place of the joint in the frame of the link before, m.
        mass: kg.
        com: centre of mass from the joint, m.
        inertia: about the centre of mass, kg·m².
        turn: rotation from the frame of the joint at q = 0 to that of the link before.
    """

    axis: tuple[Fraction, ...]
    origin: tuple[Fraction, ...]
    mass: Fraction
    com: tuple[Fraction, ...]
    inertia: tuple[tuple[Fraction, ...], ...]
    turn: tuple[tuple[Fraction, ...], ...]

    @property
    def fits(self) -> bool:
        """Whether this is a joint and a body: ‖axis‖ = 1, a rotation, m ≥ 0, inertia ⪰ 0."""
        vectors = (self.axis, self.origin, self.com, *self.inertia, *self.turn)
        if {3} != {len(self.inertia), len(self.turn), *map(len, vectors)}:
            return False
        symmetric = all(self.inertia[i][j] == self.inertia[j][i] for i in range(3) for j in range(i))
        of = Algebra(Fraction)
        square = of.product(self.turn, transposed(self.turn))
        proper = of.dot(self.turn[0], of.cross(self.turn[1], self.turn[2])) == 1
        rigid = proper and [tuple(row) for row in square] == list(UNIT) and of.dot(self.axis, self.axis) == 1
        return rigid and self.mass >= 0 and symmetric and is_positive_semidefinite(self.inertia)

    @property
    def about_axis(self) -> Fraction:
        """The moment of inertia of this body alone about the axis of its joint, kg·m²."""
        of = Algebra(Fraction)
        arm = of.cross(self.axis, self.com)
        own = of.dot(self.axis, of.apply(self.inertia, self.axis))
        return Fraction(self.mass * of.dot(arm, arm) + own)


@dataclass(frozen=True)
class _Body:
    """m, ∫ p dm and ∫ p pᵀ dm about the origin of a frame."""

    mass: Entry
    moment: Vector
    second: Matrix


@dataclass(frozen=True)
class _Moving:
    """K of a body: ∫ p ṗᵀ dm and the momentum ∫ ṗ dm."""

    second: Matrix
    momentum: Vector


@dataclass(frozen=True)
class _Wrench:
    """A torque about the origin of a frame, and a force."""

    torque: Vector
    force: Vector


class Posture:
    """A chain with its joints at some angles.

    Args:
        links: base first; their numbers are exact, or values of the arithmetic.
        fall: acceleration of free fall in the base frame, (3,), m/s²; likewise.
        sines: of the angles, (n,), in the arithmetic.
        cosines: (n,).
        of: the arithmetic.
    """

    def __init__(
        self, links: Sequence[RigidLink], fall: Vector, sines: Vector, cosines: Vector, of: Algebra
    ) -> None:
        self.links, self.fall, self.n, self.of = links, fall, len(links), of
        self._turns = [_rotation(of, *joint) for joint in zip(links, sines, cosines, strict=True)]

    def mass(self) -> Rows:
        """M(q), (n, n), kg·m²."""
        of, n = self.of, self.n
        rows: Rows = [[ZERO] * n for _ in range(n)]
        for m in range(n):
            momentum = self._momentum(m)
            for i in range(m, -1, -1):
                rows[i][m] = rows[m][i] = of.value(of.dot(self.links[i].axis, momentum.torque))
                momentum = momentum if i == 0 else self._carried(i, momentum)
        return rows

    def coriolis(self, x: Vector) -> Rows:
        """C(q, x) of the Christoffel symbols, (n, n), kg·m²/s, for rates x (n,), rad/s."""
        of, n = self.of, self.n
        rows: Rows = [[ZERO] * n for _ in range(n)]
        twists, slopes = self._twists(x)
        moving = self._moving(twists)
        for m in range(n):
            axis, body, flow = self.links[m].axis, self._bodies[m], moving[m]
            spin, speed = slopes[m]
            momentum = self._momentum(m)
            second = [
                of.add(of.cross(axis, flow.second[i]), of.cross(spin, body.second[i]), of.scaled(s, speed))
                for i, s in enumerate(body.moment)
            ]
            force = of.add(
                of.cross(axis, flow.momentum), of.cross(spin, body.moment), of.scaled(body.mass, speed)
            )
            right = _Wrench(of.axial(second), force)
            left = _Wrench(
                of.axial([of.cross(axis, column) for column in transposed(flow.second)]), [ZERO] * 3
            )
            rows[m][m] = of.value(of.dot(axis, right.torque))
            for i in range(m - 1, -1, -1):
                momentum, right, left = (self._carried(i + 1, w) for w in (momentum, right, left))
                rows[i][m] = of.value(of.dot(self.links[i].axis, right.torque))
                moved = of.plus(of.dot(slopes[i][0], momentum.torque), of.dot(slopes[i][1], momentum.force))
                rows[m][i] = of.value(of.plus(of.dot(self.links[i].axis, left.torque), moved))
        return rows

    def gravity(self) -> Values:
        """g(q), (n,), N·m."""
        of, fall = self.of, self.fall
        found = []
        for k, link in enumerate(self.links):
            fall = of.apply(transposed(self._turns[k]), fall)
            found.append(of.value(of.dot(of.cross(link.axis, fall), self._bodies[k].moment)))
        return found

    def potential(self) -> Any:
        """The potential energy −Σ m_k γᵀp_k, J."""
        of, first = self.of, self._bodies[0]
        place = of.add(of.apply(self._turns[0], first.moment), of.scaled(first.mass, self.links[0].origin))
        return of.value(of.dot(of.scaled(Fraction(-1), self.fall), place))

    @cached_property
    def _bodies(self) -> list[_Body]:
        """Of each joint all that it moves, in its frame."""
        found: list[_Body] = []
        for k in reversed(range(self.n)):
            own = _own(self.of, self.links[k])
            found.insert(0, own if not found else self._with(own, k + 1, found[0]))
        return found

    def _with(self, own: _Body, k: int, body: _Body) -> _Body:
        """A body and that of the next joint k."""
        of, p = self.of, self.links[k].origin
        moment = of.apply(self._turns[k], body.moment)
        place = of.scaled(body.mass, p)
        shift = of.sum(of.outer(moment, p), of.outer(p, moment), of.outer(p, place))
        second = of.sum(own.second, of.congruent(self._turns[k], body.second), shift)
        return _Body(of.plus(own.mass, body.mass), of.add(own.moment, moment, place), second)

    def _twists(self, x: Vector) -> tuple[list[Twist], list[Twist]]:
        """V_k, and Ẋ_k, of each joint in its frame."""
        of = self.of
        twists: list[Twist] = []
        slopes: list[Twist] = []
        spin: Vector = [ZERO] * 3
        speed: Vector = [ZERO] * 3
        for k, link in enumerate(self.links):
            back = transposed(self._turns[k])
            speed = of.apply(back, of.add(speed, of.cross(spin, link.origin)))
            spin = of.apply(back, spin)
            slopes.append((of.cross(spin, link.axis), of.cross(speed, link.axis)))
            spin = of.add(spin, of.scaled(x[k], link.axis))
            twists.append((spin, speed))
        return twists, slopes

    def _moving(self, twists: Sequence[Twist]) -> list[_Moving]:
        """K of each joint."""
        of = self.of
        found: list[_Moving] = []
        for k in reversed(range(self.n)):
            body, (spin, speed) = _own(of, self.links[k]), twists[k]
            second = [
                of.add(of.cross(spin, row), of.scaled(s, speed))
                for row, s in zip(body.second, body.moment, strict=True)
            ]
            momentum = of.add(of.cross(spin, body.moment), of.scaled(body.mass, speed))
            if found:
                turned = of.apply(self._turns[k + 1], found[0].momentum)
                carried = of.congruent(self._turns[k + 1], found[0].second)
                second = of.sum(second, carried, of.outer(self.links[k + 1].origin, turned))
                momentum = of.add(momentum, turned)
            found.insert(0, _Moving(second, momentum))
        return found

    def _momentum(self, m: int) -> _Wrench:
        """J X_mᵀ: what moves with joint m at unit rate."""
        of, axis, body = self.of, self.links[m].axis, self._bodies[m]
        return _Wrench(of.axial([of.cross(axis, row) for row in body.second]), of.cross(axis, body.moment))

    def _carried(self, k: int, wrench: _Wrench) -> _Wrench:
        """From the frame of joint k to that before."""
        of = self.of
        force = of.apply(self._turns[k], wrench.force)
        torque = of.apply(self._turns[k], wrench.torque)
        return _Wrench(of.add(torque, of.cross(self.links[k].origin, force)), force)


def _own(of: Algebra, link: RigidLink) -> _Body:
    """The body of one link: ∫ p pᵀ dm = ½ tr(I) − I + m c cᵀ."""
    moment = of.scaled(link.mass, link.com)
    half = of.times(
        Fraction(1, 2), of.plus(of.plus(link.inertia[0][0], link.inertia[1][1]), link.inertia[2][2])
    )
    second = [[of.minus(half if i == k else ZERO, link.inertia[i][k]) for k in range(3)] for i in range(3)]
    return _Body(link.mass, moment, of.sum(second, of.outer(link.com, moment)))


def _rotation(of: Algebra, link: RigidLink, sine: Entry, cosine: Entry) -> Matrix:
    """T (a aᵀ + cos q (1 − a aᵀ) + sin q [a]×), from the frame of a joint to that before."""
    a = link.axis
    along = of.outer(a, a)
    across = [[of.minus(UNIT[i][k], along[i][k]) for k in range(3)] for i in range(3)]
    skew = [[ZERO, -a[2], a[1]], [a[2], ZERO, -a[0]], [-a[1], a[0], ZERO]]
    fixed, even, odd = (of.product(link.turn, part) for part in (along, across, skew))
    return [
        [
            of.plus(fixed[i][k], of.plus(of.times(even[i][k], cosine), of.times(odd[i][k], sine)))
            for k in range(3)
        ]
        for i in range(3)
    ]
