"""dV/dt < 0 at every state of an arm but the origin, for one ε₀: checked over a tree of boxes.

For fixed q, e and D = diag(h(w_i)/w_i), 0 ≤ D ⪯ L, dV/dt is minus a quadratic form in (√ε h, w). Its damping
terms are eliminated by Σ k_vi d_i (w_i² − ε h_i w_i) ≥ −¼ ε² L Σ k_vi h_i², and the block of h by its Schur
complement. What remains is

    P = B + ½ ε (S + Sᵀ) − ¼ ε (B + ε S)ᵀ K̃⁻¹ (B + ε S),   K̃ = K_p − ¼ ε₀ L K_v ≻ 0,
    S = C(q,h) + (M h) êᵀ/(1+r) − M H',   ε = ε₀/(1 + r),   r = ‖e‖,   ê = e/r,

and P ≻ 0 for all q and e is enough, whatever w is. Where r ≥ R the scalar form at ε₀/(1+R) is enough as well.

With weights, y = w − εΛh, each h and h' becomes Λh and Λh', and K_p becomes K_p Λ⁻¹; the damping ratios stay
those of h.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import prod

from lyapcheck.check.judgement import MOST_CORNERS
from lyapcheck.check.loop.field import PI_ABOVE, Box
from lyapcheck.check.loop.inertia import Inertia, inertia_of
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.numbers.harmonics import Uncertain, angles_in, is_mirrored
from lyapcheck.check.numbers.members import Member, member
from lyapcheck.check.numbers.polynomials import Enclosure, root_above
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Mass, Monomials, Proof


@dataclass(frozen=True)
class ScalarForm:
    """The four numbers of Θ': ``stiffness`` k, ``friction`` β, ``drift`` c and ``cross`` d, all rational."""

    stiffness: Fraction
    friction: Fraction
    drift: Fraction
    cross: Fraction

    def margin(self, eps: Fraction) -> Fraction:
        """det Θ'(ε)/ε = k (β − ε c) − ¼ ε (d + ε c)²."""
        return (
            self.stiffness * (self.friction - eps * self.drift)
            - eps * (self.cross + eps * self.drift) ** 2 / 4
        )


def certifies(form: ScalarForm, eps0: Fraction) -> bool:
    """Whether Θ'(ε) ≻ 0 for every ε in (0, ε₀].

    Soundness: k, β > 0 and c, d ≥ 0 make det Θ'(ε)/ε fall as ε grows, so its sign at ε₀ decides; there
    k (β − ε₀ c) > 0 follows, and θ'11 = ε k > 0: Sylvester's criterion.
    """
    signs = form.stiffness > 0 and form.friction > 0 and form.drift >= 0 and form.cross >= 0
    return signs and eps0 > 0 and form.margin(eps0) > 0


def scalar_form(
    h: Member,
    kp: Sequence[Fraction],
    kv: Sequence[Fraction],
    friction: Sequence[Ends],
    largest: Fraction,
    coriolis: Fraction,
    weights: Sequence[Fraction] = (),
) -> ScalarForm:
    """Θ' of an arm with ‖M(q)‖ ≤ ``largest`` and ‖C(q, x)y‖ ≤ ``coriolis`` ‖x‖ ‖y‖, for y = w − εΛh.

    Soundness: |dε/dt| ≤ ε ‖w‖/(1 + ‖e‖), and with λ = λmax(Λ) ‖Λh(e)‖ ≤ H = min(√n γ λ, L λ ‖e‖). So the
    rate of εΛh is at most ε (ρλ + G) ‖w‖, G the largest value of H/(1 + ‖e‖). All else is by norms.
    """
    scale = max(weights, default=Fraction(1))
    norm_h = root_above(Fraction(len(kp))) * h.gamma * scale
    rho, slope = h.rho * scale, h.L * scale
    G = norm_h * slope / (slope + norm_h)
    return ScalarForm(
        stiffness=min(p / w for p, w in zip(kp, weights or (Fraction(1),) * len(kp), strict=True)),
        friction=min(low for low, _ in friction),
        drift=largest * (rho + G) + norm_h * coriolis,
        cross=max(high for _, high in friction) + h.L * max(kv),
    )


LARGEST_RADIUS = 1 << 64
"""Radians; what takes more is no statement about an arm."""


@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """An arm under a bounded controller, at one ε₀, for all values of what is uncertain about the arm.

    Args:
        arm: M(q) and B; after the sines and cosines its terms may have exponents of parameters.
        family: name of the function h.
        m: its member, where it has members.
        kp: diagonal of K_p, N·m.
        kv: diagonal of K_v, N·m.
        eps0: ε₀ of (12).
        parameters: the range of each parameter in M.
        viscous: the range of each diagonal entry of B, N·m·s/rad; none where B is that of the arm.
        coupling: diagonal of Λ in y = w − εΛh, dimensionless; none for (13), where Λ = I.
    """

    arm: Arm
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction
    parameters: tuple[Ends, ...] = ()
    viscous: tuple[Ends, ...] = ()
    coupling: tuple[Fraction, ...] = ()

    @property
    def n(self) -> int:
        return self.arm.n

    @cached_property
    def member(self) -> Member:
        """h with its bounds; raises ``ValueError`` for a function the checker does not know."""
        return member(self.family, self.m)

    @cached_property
    def friction(self) -> tuple[Ends, ...]:
        return self.viscous or tuple((b, b) for b in self.arm.viscous)

    @cached_property
    def inertia(self) -> Inertia:
        """M(q), the same for all the ε₀ that are tried on an arm."""
        return inertia_of(self.arm.mass, self.parameters)

    @property
    def mass(self) -> list[list[Uncertain]]:
        return self.inertia.mass

    @property
    def symbols(self) -> dict[tuple[int, int, int], Uncertain]:
        """The Christoffel symbols c_ijk with k ≤ j, by powers of the parameters."""
        return self.inertia.symbols

    @cached_property
    def stiffness(self) -> tuple[Fraction, ...]:
        """Diagonal of K̃ = K_p Λ⁻¹ − ¼ ε₀ L K_v, from below."""
        rows = zip(self.kp, self.kv, self.Lambda, strict=True)
        return tuple(p / scale - self.eps0 * self.member.L * v / 4 for p, v, scale in rows)

    @property
    def Lambda(self) -> tuple[Fraction, ...]:
        return self.coupling or (Fraction(1),) * self.n

    @cached_property
    def angles(self) -> tuple[int, ...]:
        """The joints whose angle M depends on; the others may be held at 0."""
        return angles_in(self.mass)

    @cached_property
    def one_sided(self) -> tuple[int, ...]:
        """The joints whose error may be taken ≥ 0, by sign symmetry.

        If M(σq) = Σ M(q) Σ for Σ = diag(σ), then (q, e, w) → (σq, Σe, Σw) leaves dV/dt as it is. Such σ are a
        group, in which the first joint that each turns can be turned without any other of these first ones.
        """
        turns = (signs for signs in product((1, -1), repeat=self.n) if -1 in signs)
        return tuple(sorted({signs.index(-1) for signs in turns if self.symmetric_under(signs)}))

    def symmetric_under(self, signs: Sequence[int]) -> bool:
        joints = range(self.n)
        return all(
            is_mirrored(part, signs, signs[i] * signs[j])
            for i in joints
            for j in joints
            for part in self.mass[i][j].values()
        )

    @cached_property
    def tail(self) -> ScalarForm:
        """A scalar form with coarse bounds of ‖M‖ and ‖C‖, rational and from above.

        ‖M‖ is at most its largest row sum, and ‖C(q,x)y‖ ≤ (Σ c_ijk²)^½ ‖x‖ ‖y‖.
        """
        largest, coriolis = self.inertia.largest_row, root_above(self.inertia.squares_of_symbols)
        return scalar_form(self.member, self.kp, self.kv, self.friction, largest, coriolis, self.Lambda)

    @cached_property
    def radius(self) -> float:
        """A double R ≥ 0 beyond which the scalar form is enough; ``ValueError`` where there is none."""
        if not self.admissible:
            raise ValueError("a closure that is not admissible has no radius")
        radius = Fraction(1, 64)
        while not certifies(self.tail, self.eps0 / (1 + radius)):
            radius = radius * 5 / 4
            if radius > LARGEST_RADIUS:
                raise ValueError(f"beyond ‖e‖ = {LARGEST_RADIUS} the scalar form is still not enough")
        return math.nextafter(float(radius), math.inf)

    @property
    def admissible(self) -> bool:
        """Whether sizes and signs are such that the argument applies at all: B, K_p, K_v, K̃ ≻ 0, M = Mᵀ."""
        ranges = (*self.parameters, *self.friction)
        sizes = {self.n, len(self.kp), len(self.kv), len(self.friction), len(self.Lambda)}
        if len(sizes | {len(self.arm.mass), *map(len, self.arm.mass)}) != 1 or any(a > b for a, b in ranges):
            return False
        if min(*self.kp, *self.kv, self.eps0, *self.Lambda, *(low for low, _ in self.friction)) <= 0:
            return False
        powers = {len(p) for row in self.mass for entry in row for p in entry}
        return self.inertia.symmetric and powers <= {len(self.parameters)} and min(self.stiffness) > 0

    @property
    def farthest(self) -> list[float]:
        """Doubles that |e_i| need not exceed: R, for each joint."""
        return [self.radius] * self.n

    @property
    def start(self) -> Box:
        """The box of the angles that matter, the errors, in rad, the parameters and friction that range."""
        errors = [(0.0 if i in self.one_sided else -x, x) for i, x in enumerate(self.farthest)]
        ranges = (*self.parameters, *self.friction)
        uncertain = [Enclosure(low, high).side for low, high in ranges if low < high]
        return (*[(-PI_ABOVE, PI_ABOVE)] * len(self.angles), *errors, *uncertain)


@dataclass(frozen=True)
class RateProof(Proof, ABC):
    """A proof that dV/dt < 0 at every state asked about, but the origin, of an admissible loop with M ≻ 0."""

    @abstractmethod
    def require_shown(self, loop: ClosedLoop) -> None:
        """Judge it."""


# --- An arm at the corners of the ranges of M's parameters, which speak for all that lies between.
#
# At one state −dV/dt = ε hᵀK_p h + yᵀ(B + K_v D + ε S)w, and S is linear in M(q) and its rates. So where M is
# affine in each parameter, dV/dt is so too, and nowhere above the largest of its values at the corners of
# their ranges; likewise λmax of M and of what is linear in it.
#
# References: ``reyes2019family`` (11), (15).


def corners_of(parameters: Sequence[Ends]) -> Iterator[tuple[Fraction, ...]]:
    """The corners of the ranges of the parameters; one where nothing ranges."""
    return product(*([low, high] if low < high else [low] for low, high in parameters))


def at_parameters(entry: Monomials, angles: int, parameters: Sequence[Fraction]) -> Monomials:
    """The entry with numbers for the parameters; their exponents follow those of sines and cosines."""
    return tuple(
        (powers[:angles], c * prod(x**p for x, p in zip(parameters, powers[angles:], strict=True)))
        for powers, c in entry
    )


def masses_at_corners(mass: Mass, parameters: Sequence[Ends]) -> tuple[Mass, ...]:
    """M(q), affine in each parameter, at each corner of their ranges, in the order of ``corners_of``."""
    affine = all(max(p[2 * len(mass) :], default=0) <= 1 for row in mass for entry in row for p, _ in entry)
    require(affine, "M(q)", "", "must be affine in each of its parameters")
    ranging = sum(low < high for low, high in parameters)
    require(2**ranging <= MOST_CORNERS, "corners", 2**ranging, f"must not exceed {MOST_CORNERS}")
    return tuple(
        tuple(tuple(at_parameters(entry, 2 * len(mass), corner) for entry in row) for row in mass)
        for corner in corners_of(parameters)
    )
