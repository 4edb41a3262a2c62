"""The dynamics of a chain of links, in any arithmetic.

Up to three joints polynomials are the shortest form. With more they grow tenfold a joint where axes are skew,
and a chain is evaluated along its links, C(q, x), g(q) and the potential in O(n²) steps beside M(q).

With J = ∫ p̂p̂ᵀ dm, p̂ = (p, 1), of all bodies that joint m moves, X_i the twist of joint i as a 4 × 4 matrix,
V_l = Σ_{k≤l} x_k X_k and K = Σ_l J_l V_lᵀ of the same bodies,

    C_ij = tr(X_i K X_jᵀ) + tr(X_i J Ẋ_jᵀ),      Ẋ_j = V_{j−1} X_j − X_j V_{j−1},

J and K of the bodies behind both i and j. As c_ijk = ∫ ∂p/∂q_i · ∂²p/∂q_j∂q_k dm, this C is that of the
Christoffel symbols of M.

References: composite rigid bodies, ``featherstone2008rigid`` chapter 6; ``echeandia2021numerical`` for C.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import fmpq_mpoly

from lyapcheck.check.loop.chain import Posture, RigidLink, Wrench, own_body
from lyapcheck.check.numbers.vectors import ZERO, Algebra, Entry, Matrix, Vector, transposed
from lyapcheck.errors import InputError, Problem
from lyapcheck.robots import trig
from lyapcheck.robots.trig import ArmAtAngles, Dynamics, Lift, Polynomials, Rows, T, Tidy, Values

Twist = tuple[Vector, Vector]
"""ω, and the velocity of the origin of the frame."""
FEW_JOINTS = 3
"""Up to so many joints all angles are gone through: M(q) by its polynomials, bounds and proofs by boxes.

With more, what is known of the links takes their place.
"""
MOST_TERMS = 2_500
"""Terms of one polynomial beyond which M(q) is not written out; a Panda has 805, a skew chain 5ⁿ⁻¹."""


class TooManyTerms(InputError):
    """M(q) has more terms than are worth writing out."""


@dataclass(frozen=True)
class ParameterShare:
    """A number of a link that is ``factor`` times a parameter."""

    name: str
    factor: Fraction = Fraction(1)


@dataclass(frozen=True, eq=False)
class Chain(Dynamics):
    """A serial chain of links.

    Args:
        links: base first; a number is exact, or a ``ParameterShare`` of a parameter.
        fall: acceleration of free fall in the base frame, (3,), m/s²; likewise.
        names: of the parameters.
    """

    links: tuple[RigidLink, ...]
    fall: tuple[Any, ...]
    names: tuple[str, ...] = ()

    @property
    def n(self) -> int:  # type: ignore[override]
        return len(self.links)

    @cached_property
    def polynomials(self) -> Polynomials:
        """The recursion in polynomials, each brought to normal form as it comes."""
        ring = trig.trig_ring(self.n, self.names)

        def tidy(poly: fmpq_mpoly) -> fmpq_mpoly:
            if len(poly) > MOST_TERMS:
                rule = f"has more than {MOST_TERMS} terms for these {self.n} links, too many to write out"
                repair = "give an arm of fewer joints, or with axes along or across each other"
                repair += "; in a URDF file write a right angle as 1.57079632679"
                raise TooManyTerms(Problem("arm", None, "M(q)", "", rule, repair))
            return trig.normal_form(poly)

        gens, n = ring.gens(), self.n
        of = Algebra(lambda x: trig.constant(ring, x), tidy)
        values = dict(zip(self.names, gens[2 * n :], strict=True))
        posture = self._posture(gens[:n], gens[n : 2 * n], values, of)
        mass = tuple(tuple(map(trig.normal_form, row)) for row in posture.mass())
        return Polynomials(mass, trig.normal_form(posture.potential()), self.names)

    def at(
        self, sin: Sequence[T], cos: Sequence[T], values: Values, lift: Lift[T], tidy: Tidy = None
    ) -> ArmAtAngles:
        """The polynomials of few joints, else the chain."""
        if self.n <= FEW_JOINTS:
            return self.polynomials.at(sin, cos, values, lift)
        return self._posture(sin, cos, values, Algebra(lift, tidy))

    def fixed(self, values: Mapping[str, Fraction]) -> Chain:
        return Chain(*self._with(values, Algebra(Fraction)))

    def _posture(self, sin: Sequence[Any], cos: Sequence[Any], values: Values, of: Algebra) -> ChainInMotion:
        return ChainInMotion(*self._with(values, of), sin, cos, of)

    def _with(self, values: Values, of: Algebra) -> tuple[tuple[RigidLink, ...], tuple[Entry, ...]]:
        if not self.names:
            return self.links, self.fall
        parts = [
            {part.name: _filled(getattr(link, part.name), values, of) for part in fields(link)}
            for link in self.links
        ]
        links = tuple(replace(link, **part) for link, part in zip(self.links, parts, strict=True))
        return links, _filled(self.fall, values, of)


def _filled(part: Any, values: Values, of: Algebra) -> Any:
    """A number, vector or matrix with the values of the parameters in it."""
    if isinstance(part, tuple):
        return tuple(_filled(x, values, of) for x in part)
    return of.times(part.factor, values[part.name]) if isinstance(part, ParameterShare) else part


@dataclass(frozen=True)
class _Moving:
    """K of a body: ∫ p ṗᵀ dm and the momentum ∫ ṗ dm."""

    second: Matrix
    momentum: Vector


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
        fall: Vector,
        sines: Vector,
        cosines: Vector,
        of: Algebra,
    ) -> None:
        super().__init__(links, sines, cosines, of)
        self.fall = fall

    def coriolis(self, x: Vector) -> Rows:
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

    def gravity(self) -> list[Any]:
        return self.torques(self.fall)

    def potential(self) -> Any:
        """The potential energy −Σ m_k γᵀp_k, J."""
        of, first = self.of, self.bodies[0]
        place = of.add(of.apply(self.turns[0], first.moment), of.scaled(first.mass, self.links[0].origin))
        return of.value(of.dot(of.scaled(Fraction(-1), self.fall), place))

    def _twists(self, x: Vector) -> tuple[list[Twist], list[Twist]]:
        of = self.of
        twists: list[Twist] = []
        slopes: list[Twist] = []
        spin: Vector = [ZERO] * 3
        speed: Vector = [ZERO] * 3
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
