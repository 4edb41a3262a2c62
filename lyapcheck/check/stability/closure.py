"""The arm under its controller at one ε₀, and what must be shown about it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import isqrt

from lyapcheck.check.harmonics import Harmonics, christoffel, harmonics, largest, mirrored
from lyapcheck.check.members import Member, member
from lyapcheck.check.scalar import ScalarForm, certifies
from lyapcheck.check.stability.boxes import Box
from lyapcheck.check.states import Arm

PI_ABOVE = 3.1415926535897936
"""A double above π."""


@dataclass(frozen=True, eq=False)
class Closure:
    """An arm under a bounded controller, at one ε₀.

    Args:
        arm: M(q) and B, exact.
        family: name of the function h.
        m: its member, where it has members.
        kp: diagonal of K_p, N·m.
        kv: diagonal of K_v, N·m.
        eps0: ε₀ of (12).
    """

    arm: Arm
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.arm.n

    @cached_property
    def member(self) -> Member:
        """h with its bounds; raises ``ValueError`` for a function the checker does not know."""
        return member(self.family, self.m)

    @cached_property
    def mass(self) -> list[list[Harmonics]]:
        """M as harmonics."""
        return [[harmonics(entry, self.n) for entry in row] for row in self.arm.mass]

    @cached_property
    def symbols(self) -> dict[tuple[int, int, int], Harmonics]:
        """The Christoffel symbols as harmonics."""
        return christoffel(self.mass)

    @cached_property
    def stiffness(self) -> tuple[Fraction, ...]:
        """Diagonal of K̃, from below."""
        return tuple(p - self.eps0 * self.member.L * v / 4 for p, v in zip(self.kp, self.kv, strict=True))

    @cached_property
    def angles(self) -> tuple[int, ...]:
        """The joints whose angle M depends on; the others may be held at 0."""
        used = {
            i for row in self.mass for entry in row for k in entry for i, factor in enumerate(k) if factor
        }
        return tuple(sorted(used))

    @cached_property
    def one_sided(self) -> tuple[int, ...]:
        """The joints whose error may be taken ≥ 0, by sign symmetry.

        If M(σq) = Σ M(q) Σ for Σ = diag(σ), then (q, e, w) → (σq, Σe, Σw) leaves dV/dt as it is. In reduced
        echelon form over GF(2) each basis symmetry flips its own pivot and no other one.
        """
        basis: list[tuple[int, ...]] = []
        for signs in product((1, -1), repeat=self.n):
            row = tuple(int(sign < 0) for sign in signs)
            if not self._symmetric(signs):
                continue
            for kept in basis:
                if row[kept.index(1)]:
                    row = _xor(row, kept)
            if any(row):
                basis = [_xor(kept, row) if kept[row.index(1)] else kept for kept in basis] + [row]
        return tuple(sorted(row.index(1) for row in basis))

    def _symmetric(self, signs: Sequence[int]) -> bool:
        joints = range(self.n)
        return all(
            mirrored(self.mass[i][j], signs) == {k: (s * a, s * b) for k, (a, b) in self.mass[i][j].items()}
            for i in joints
            for j in joints
            for s in (signs[i] * signs[j],)
        )

    @cached_property
    def tail(self) -> ScalarForm:
        """A scalar form with coarse bounds of ‖M‖ and ‖C‖, rational and from above.

        ‖M‖ is at most its largest row sum, and ‖C(q,x)y‖ ≤ (Σ c_ijk²)^½ ‖x‖ ‖y‖.
        """
        rows = [sum((largest(entry) for entry in row), Fraction(0)) for row in self.mass]
        squares = sum(
            ((1 if j == k else 2) * largest(c) ** 2 for (_, j, k), c in self.symbols.items()), Fraction(0)
        )
        reach, L = root_above(Fraction(self.n)) * self.member.gamma, self.member.L
        G = reach * L / (L + reach)
        return ScalarForm(
            stiffness=min(self.kp),
            friction=min(self.arm.viscous),
            drift=max(rows) * (self.member.rho + G) + reach * root_above(squares),
            cross=max(self.arm.viscous) + L * max(self.kv),
        )

    @cached_property
    def radius(self) -> float:
        """A double R ≥ 0 beyond which the scalar form is enough."""
        radius = Fraction(1, 64)
        while not certifies(self.tail, self.eps0 / (1 + radius)):
            radius = radius * 5 / 4
        return math.nextafter(float(radius), math.inf)

    @property
    def admissible(self) -> bool:
        """Whether sizes and signs are such that the argument applies at all: B, K_p, K_v, K̃ ≻ 0, M = Mᵀ."""
        sizes = {self.n, len(self.kp), len(self.kv), len(self.arm.mass), *map(len, self.arm.mass)}
        if len(sizes) != 1 or min(*self.kp, *self.kv, *self.arm.viscous, self.eps0) <= 0:
            return False
        symmetric = all(self.mass[i][j] == self.mass[j][i] for i in range(self.n) for j in range(i))
        return symmetric and min(self.stiffness) > 0

    @property
    def start(self) -> Box:
        """The box of the angles that matter and of the errors, in rad."""
        errors = [(0.0 if i in self.one_sided else -self.radius, self.radius) for i in range(self.n)]
        return (*[(-PI_ABOVE, PI_ABOVE)] * len(self.angles), *errors)


def root_above(value: Fraction) -> Fraction:
    """A rational not below the square root, within 10⁻¹² of it."""
    scale = 10**24
    scaled = -((-value.numerator * scale) // value.denominator)
    root = isqrt(scaled)
    return Fraction(root if root * root == scaled else root + 1, 10**12)


def _xor(a: tuple[int, ...], b: tuple[int, ...]) -> tuple[int, ...]:
    return tuple((x + y) % 2 for x, y in zip(a, b, strict=True))
