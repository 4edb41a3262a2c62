"""M(q) and g(q) of a chain of links in any arithmetic, in O(n²) steps.

Bodies are composed from the tip to the base. With J = ∫ p̂p̂ᵀ dm, p̂ = (p, 1), of all bodies that joint m moves,
and X_i the twist of joint i as a 4 × 4 matrix, M_im = tr(X_i J X_mᵀ). All is in the frame of a joint: what
joints before it do never enters M. C(q, x) and the potential are in ``lyapcheck.robots.dynamics``.

References: composite rigid bodies, ``featherstone2008rigid`` chapter 6.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from flint import Ordering, arb, arb_poly, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.numbers.polynomials import ball_of, rational, root_above
from lyapcheck.check.numbers.vectors import (
    ZERO,
    Algebra,
    Entry,
    Matrix,
    Vector,
    is_positive_semidefinite,
    transposed,
)
from lyapcheck.check.statement import Monomials

Values = list[Any]
Rows = list[list[Any]]
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
        rotor: inertia of what turns with the motor, gear² times its own, kg·m²: M(q) + diag(rotor).
    """

    axis: tuple[Fraction, ...]
    origin: tuple[Fraction, ...]
    mass: Fraction
    com: tuple[Fraction, ...]
    inertia: tuple[tuple[Fraction, ...], ...]
    turn: tuple[tuple[Fraction, ...], ...]
    rotor: Fraction = field(default=Fraction(0), metadata={"left_out": True})

    def __repr__(self) -> str:
        """What statements make a digest of; without rotors it is that of older ones."""
        given = {name: value for name, value in vars(self).items() if name != "rotor" or value}
        return f"RigidLink({', '.join(f'{name}={value!r}' for name, value in given.items())})"

    @property
    def fits(self) -> bool:
        """Whether this is a joint and a body: ‖axis‖ = 1, a rotation, m ≥ 0, inertia ⪰ 0, rotor ≥ 0."""
        vectors = (self.axis, self.origin, self.com, *self.inertia, *self.turn)
        if {3} != {len(self.inertia), len(self.turn), *map(len, vectors)}:
            return False
        symmetric = all(self.inertia[i][j] == self.inertia[j][i] for i in range(3) for j in range(i))
        of = Algebra(Fraction)
        square = of.product(self.turn, transposed(self.turn))
        proper = of.dot(self.turn[0], of.cross(self.turn[1], self.turn[2])) == 1
        rigid = proper and [tuple(row) for row in square] == list(UNIT) and of.dot(self.axis, self.axis) == 1
        positive = self.mass >= 0 and self.rotor >= 0
        return rigid and positive and symmetric and is_positive_semidefinite(self.inertia)

    @property
    def about_axis(self) -> Fraction:
        """The moment of inertia of this body alone and of its rotor about the axis of its joint, kg·m²."""
        of = Algebra(Fraction)
        arm = of.cross(self.axis, self.com)
        own = of.dot(self.axis, of.apply(self.inertia, self.axis))
        return Fraction(self.mass * of.dot(arm, arm) + own + self.rotor)


@dataclass(frozen=True)
class Body:
    """m, ∫ p dm and ∫ p pᵀ dm about the origin of a frame."""

    mass: Entry
    moment: Vector
    second: Matrix


@dataclass(frozen=True)
class Wrench:
    """A torque about the origin of a frame, and a force."""

    torque: Vector
    force: Vector


class Posture:
    """A chain, base first, with joints at some angles; its numbers may be values of the arithmetic."""

    def __init__(self, links: Sequence[RigidLink], sines: Vector, cosines: Vector, of: Algebra) -> None:
        self.links, self.n, self.of = links, len(links), of
        joints = zip(links, sines, cosines, strict=True)
        self.turns = [rotation(of, link.axis, link.turn, sine, cosine) for link, sine, cosine in joints]

    def mass(self) -> Rows:
        of, n = self.of, self.n
        rows: Rows = [[ZERO] * n for _ in range(n)]
        for m in range(n):
            momentum = self.momentum(m)
            for i in range(m, -1, -1):
                rows[i][m] = rows[m][i] = of.value(of.dot(self.links[i].axis, momentum.torque))
                momentum = momentum if i == 0 else self.carried(i, momentum)
            rows[m][m] = of.value(of.plus(rows[m][m], self.links[m].rotor))
        return rows

    def torques(self, fall: Vector) -> Values:
        """g(q), (n,), N·m, for an acceleration of free fall in the base frame, (3,), m/s²."""
        of, result = self.of, []
        for k, link in enumerate(self.links):
            fall = of.apply(transposed(self.turns[k]), fall)
            result.append(of.value(of.dot(of.cross(link.axis, fall), self.bodies[k].moment)))
        return result

    @cached_property
    def bodies(self) -> list[Body]:
        """Of each joint all that it moves, in its frame."""
        of = self.of
        result: list[Body] = []
        for k in reversed(range(self.n)):
            own = own_body(of, self.links[k])
            if result:
                body, turn, p = result[0], self.turns[k + 1], self.links[k + 1].origin
                moment, place = of.apply(turn, body.moment), of.scaled(body.mass, p)
                shift = of.sum(of.outer(moment, p), of.outer(p, moment), of.outer(p, place))
                second = of.sum(own.second, of.congruent(turn, body.second), shift)
                own = Body(of.plus(own.mass, body.mass), of.add(own.moment, moment, place), second)
            result.insert(0, own)
        return result

    def momentum(self, m: int) -> Wrench:
        """J X_mᵀ: what moves with joint m at unit rate."""
        of, axis, body = self.of, self.links[m].axis, self.bodies[m]
        return Wrench(of.axial([of.cross(axis, row) for row in body.second]), of.cross(axis, body.moment))

    def carried(self, k: int, wrench: Wrench) -> Wrench:
        """From the frame of joint k to that before."""
        of = self.of
        force = of.apply(self.turns[k], wrench.force)
        torque = of.apply(self.turns[k], wrench.torque)
        return Wrench(of.add(torque, of.cross(self.links[k].origin, force)), force)


def turning(links: Sequence[RigidLink], q: Sequence[arb], k: int) -> Posture:
    """The chain as polynomials in a small turn of joint k: coefficients of its first power are slopes.

    Soundness: sines and cosines are exact up to that power, and no product takes it from others.
    """
    turns = [(x.sin(), x.cos(), int(i == k)) for i, x in enumerate(q)]
    sines, cosines = (
        [arb_poly([s, c * own]) for s, c, own in turns],
        [arb_poly([c, -s * own]) for s, c, own in turns],
    )
    return Posture(links, sines, cosines, Algebra(lambda x: arb_poly([ball_of(x)])))


def own_body(of: Algebra, link: RigidLink) -> Body:
    """The body of one link: ∫ p pᵀ dm = ½ tr(I) − I + m c cᵀ."""
    moment = of.scaled(link.mass, link.com)
    half = of.times(
        Fraction(1, 2), of.plus(of.plus(link.inertia[0][0], link.inertia[1][1]), link.inertia[2][2])
    )
    second = [[of.minus(half if i == k else ZERO, link.inertia[i][k]) for k in range(3)] for i in range(3)]
    return Body(link.mass, moment, of.sum(second, of.outer(link.com, moment)))


def rotation(of: Algebra, a: Vector, turn: Matrix, sine: Entry, cosine: Entry) -> Matrix:
    """T (a aᵀ + cos q (1 − a aᵀ) + sin q [a]×), from the frame of a joint to that before."""
    along = of.outer(a, a)
    across = [[of.minus(UNIT[i][k], along[i][k]) for k in range(3)] for i in range(3)]
    skew = [[ZERO, -a[2], a[1]], [a[2], ZERO, -a[0]], [-a[1], a[0], ZERO]]
    fixed, even, odd = (of.product(turn, part) for part in (along, across, skew))
    return [
        [
            of.plus(fixed[i][k], of.plus(of.times(even[i][k], cosine), of.times(odd[i][k], sine)))
            for k in range(3)
        ]
        for i in range(3)
    ]


# --- What links say of polynomials: whether they make a given M(q) or g_i(q), and how large a g_i is at most.


Same = Callable[[fmpq_mpoly, Monomials], bool]
"""Whether a polynomial in the sines and then the cosines is the function of these terms."""


def makes(links: Sequence[RigidLink], mass: Sequence[Sequence[Monomials]]) -> bool:
    """Whether these are real links whose M(q) has these entries, polynomials in sin q_1 …, cos q_1 … cos q_n.

    Soundness: both sides are reduced by s² = 1 − c², after which equal functions are equal polynomials.
    """
    if len(links) != len(mass) or not all(link.fits for link in links):
        return False
    posture, same = _symbolic(links)
    pairs = zip(posture.mass(), mass, strict=True)
    return all(same(x, entry) for own, row in pairs for x, entry in zip(own, row, strict=True))


def pulls(links: tuple[RigidLink, ...], fall: tuple[Fraction, ...], i: int, torque: Monomials) -> bool:
    """Whether this is g_i(q) for all q, i counted from 0; as polynomials, like `makes`."""
    torques, same = _torques(links, fall)
    return same(torques[i], torque)


@lru_cache(maxsize=64)
def _torques(links: tuple[RigidLink, ...], fall: tuple[Fraction, ...]) -> tuple[list[fmpq_mpoly], Same]:
    posture, same = _symbolic(links)
    return posture.torques(fall), same


def lever_bound(
    links: Sequence[RigidLink],
    fall: Sequence[Fraction],
    i: int,
    along: Collection[int],
    root: Callable[[Any], Any] = root_above,
) -> Fraction:
    """A bound of |g_i(q)| for all q, i counted from 0, of links with unit axes and rotations.

    Soundness: g_i = (a_i × fall)·v_i in the frame of joint i, where v_k = c_k + R_{k+1} v_{k+1} with constant
        c_k, so |v_k| ≤ Σ |c|. R_k turns about a_k: what c_k has along it can be counted at the link before
        instead (k in ``along``), and at joint i itself exerts no torque. |a_i × fall| is at most |fall|, and
        for the first joint, whose axis does not move, it is what it is.
    """
    of = Algebra(Fraction)
    total, mass, carried = ZERO, ZERO, [ZERO] * 3
    for k in range(len(links) - 1, i - 1, -1):
        link = links[k]
        moment = of.add(of.scaled(link.mass, link.com), carried)
        mass, carried = mass + link.mass, [ZERO] * 3
        if k == i or k in along:
            carried = of.apply(link.turn, of.scaled(of.dot(link.axis, moment), link.axis))
            moment = of.cross(link.axis, moment)  # as long as what is left
        carried = of.add(carried, of.scaled(mass, link.origin))
        total += root(of.dot(moment, moment))
    across = of.cross(of.apply(links[0].turn, links[0].axis), fall) if i == 0 else fall
    return Fraction(total * root(of.dot(across, across)))


def _symbolic(links: Sequence[RigidLink]) -> tuple[Posture, Same]:
    """The chain with sines and cosines for generators; normal forms are without squares of sines."""
    n = len(links)
    ring = fmpq_mpoly_ctx.get([f"{letter}{i}" for letter in "sc" for i in range(n)], Ordering.lex)
    gens = ring.gens()

    def reduced(polynomial: fmpq_mpoly) -> fmpq_mpoly:
        degrees = polynomial.degrees()
        for i in range(n):
            if degrees[i] >= 2:
                _, polynomial = divmod(polynomial, gens[i] ** 2 + gens[n + i] ** 2 - 1)
        return polynomial

    def same(polynomial: fmpq_mpoly, entry: Monomials) -> bool:
        terms: dict[tuple[int, ...], fmpq] = {}
        for powers, c in entry:
            terms[powers] = terms.get(powers, fmpq(0)) + rational(c)
        return bool(reduced(ring.from_dict(terms) - polynomial) == 0)

    of = Algebra(lambda x: ring.constant(rational(x)), reduced)
    return Posture(links, gens[:n], gens[n:], of), same
