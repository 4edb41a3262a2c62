"""Rigid links as moving bodies: the mass matrix that they make, and why it is positive definite.

The velocity v of the origin of a link's frame and its angular velocity ω, in the coordinates of that frame,
follow from those of the link before: with T its turn, R(q_k) the rotation about its axis a and p its place,

    ω_k = (T R)ᵀ ω_{k−1} + a x_k,        v_k = (T R)ᵀ (v_{k−1} + ω_{k−1} × p),

and twice its kinetic energy is m‖v + ω × c‖² + ωᵀ J ω, with J about the centre of mass c. xᵀMx is their sum.

References: ``featherstone2008rigid``, chapter 5.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.numbers.matrices import is_positive_semidefinite
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.statement import Monomials

Vector = tuple[Fraction, ...]
Matrix = tuple[Vector, ...]
Column = list[fmpq_mpoly]


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

    axis: Vector
    origin: Vector
    mass: Fraction
    com: Vector
    inertia: Matrix
    turn: Matrix

    @property
    def fits(self) -> bool:
        """Whether all vectors have three entries, the mass is not negative and the inertia not indefinite."""
        vectors = (self.axis, self.origin, self.com, *self.inertia, *self.turn)
        sizes = {3} == {len(self.inertia), len(self.turn), *map(len, vectors)}
        return (
            sizes and self.mass >= 0 and _symmetric(self.inertia) and is_positive_semidefinite(self.inertia)
        )


def _symmetric(rows: Matrix) -> bool:
    return all(rows[i][j] == rows[j][i] for i in range(3) for j in range(i))


class Motion:
    """The links of an arm in motion, by polynomials in s_i = sin q_i and c_i = cos q_i, exactly."""

    def __init__(self, links: Sequence[RigidLink]) -> None:
        self.links, n = links, len(links)
        names = [f"{letter}{i}" for letter in "sc" for i in range(n)]
        self.ring = fmpq_mpoly_ctx.get(names, Ordering.lex)
        self.zero = self.ring.constant(0)

    def makes(self, mass: Sequence[Sequence[Monomials]]) -> bool:
        """Whether the sum of the energies is xᵀMx, the sines and cosines taken as such.

        Soundness: both sides are reduced by c² = 1 − s², after which equal functions are equal polynomials.
        """
        found = self.energies()
        joints = range(len(self.links))
        return all(
            self.reduced(self.ring.from_dict(_terms(mass[i][j])) - found[i][j]) == 0
            for i in joints
            for j in joints
        )

    def energies(self) -> list[list[fmpq_mpoly]]:
        """The matrix of twice the kinetic energy as a quadratic form of the rates."""
        n = len(self.links)
        total = [[self.zero] * n for _ in range(n)]
        for _, link, speed, spin in self.bodies():
            moved = [[rational(link.mass) * x for x in column] for column in speed]
            turned = [_times(link.inertia, column) for column in spin]
            for i in range(len(speed)):
                for j in range(len(speed)):
                    total[i][j] += _dot(speed[i], moved[j]) + _dot(spin[i], turned[j])
        return total

    def bodies(self) -> Iterable[tuple[int, RigidLink, list[Column], list[Column]]]:
        """For each link, base first, the velocity of its centre of mass and its spin at each unit rate."""
        spins: list[Column] = []
        speeds: list[Column] = []
        for k, link in enumerate(self.links):
            turn = self._turned(k, link)
            speeds = [
                _times(turn, _add(v, _cross(w, self._exact(link.origin))))
                for v, w in zip(speeds, spins, strict=True)
            ]
            spins = [_times(turn, w) for w in spins]
            speeds, spins = [*speeds, [self.zero] * 3], [*spins, self._exact(link.axis)]
            com = self._exact(link.com)
            at_com = [_add(v, _cross(w, com)) for v, w in zip(speeds, spins, strict=True)]
            yield k, link, at_com, spins

    def first_to_move(self) -> bool:
        """Whether each link has a positive energy when its joint is the first that moves, however it stands.

        Soundness: then its velocity and spin are the columns of its own joint times that rate.
        """
        for _, link, speed, spin in self.bodies():
            energy = self.reduced(
                rational(link.mass) * _dot(speed[-1], speed[-1])
                + _dot(spin[-1], _times(link.inertia, spin[-1]))
            )
            if not energy.is_constant() or not energy.leading_coefficient() > 0:
                return False
        return True

    def _exact(self, vector: Vector) -> Column:
        return [self.ring.constant(rational(x)) for x in vector]

    def _turned(self, k: int, link: RigidLink) -> list[list[fmpq_mpoly]]:
        """(T R(q_k))ᵀ, R = a aᵀ + cos q (I − a aᵀ) + sin q [a]×."""
        a, n = link.axis, len(self.links)
        sine, cosine = self.ring.gen(k), self.ring.gen(n + k)
        cross = [[Fraction(0), -a[2], a[1]], [a[2], Fraction(0), -a[0]], [-a[1], a[0], Fraction(0)]]
        rows = range(3)
        rotation = [
            [
                self.ring.constant(rational(a[i] * a[j]))
                + cosine * rational(Fraction(int(i == j)) - a[i] * a[j])
                + sine * rational(cross[i][j])
                for j in rows
            ]
            for i in rows
        ]
        # row j of the transpose is column j of T R
        return [_times(link.turn, [rotation[i][j] for i in rows]) for j in rows]

    def reduced(self, polynomial: fmpq_mpoly) -> fmpq_mpoly:
        """The polynomial with every c² replaced by 1 − s²."""
        n = len(self.links)
        for k in range(n):
            square = 1 - self.ring.gen(k) ** 2
            while polynomial.degrees()[n + k] >= 2:
                keep, lower = {}, {}
                for exponents, c in polynomial.to_dict().items():
                    if exponents[n + k] >= 2:
                        lower[(*exponents[: n + k], exponents[n + k] - 2, *exponents[n + k + 1 :])] = c
                    else:
                        keep[exponents] = c
                polynomial = self.ring.from_dict(keep) + self.ring.from_dict(lower) * square
        return polynomial


def _terms(entry: Monomials) -> dict[tuple[int, ...], fmpq]:
    found: dict[tuple[int, ...], fmpq] = {}
    for powers, c in entry:
        found[powers] = found.get(powers, fmpq(0)) + rational(c)
    return found


def _dot(x: Column, y: Column) -> fmpq_mpoly:
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def _add(x: Column, y: Column) -> Column:
    return [a + b for a, b in zip(x, y, strict=True)]


def _cross(x: Column, y: Column) -> Column:
    return [x[i - 2] * y[i - 1] - x[i - 1] * y[i - 2] for i in range(3)]


def _times(rows: Sequence[Sequence[Fraction | fmpq_mpoly]], x: Column) -> Column:
    return [
        sum((rational(a) if isinstance(a, Fraction) else a) * b for a, b in zip(row, x, strict=True))
        for row in rows
    ]
