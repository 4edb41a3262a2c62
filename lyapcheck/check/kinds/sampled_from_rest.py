"""Starts at rest on a computer with a reading every T seconds, for gains above the friction as well.

References: ``lyapcheck.check.loop.sampled_energy``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.inertia import (
    law_text,
    mass_text,
    potential_text,
    require_mass,
    require_one_a_joint,
    require_polynomials,
)
from lyapcheck.check.kinds.sampled import late_text
from lyapcheck.check.kinds.stable_arm import hessian
from lyapcheck.check.loop import masses_at_corners, storage
from lyapcheck.check.loop.chain import RigidLink, makes
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.loop.inertia import inertia_of
from lyapcheck.check.loop.sampled_energy import ArmBounds, Gains, Numbers, SampledEnergy, falls
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.polynomials import dyadic, root_above
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Mass, Monomials, Proof, Total
from lyapcheck.check.verify import Accepted, rule

MOST_DELAY = 6
FARTHEST = 3600
"""Degrees."""
CONCAVE = {("tanh", None), ("hyperbolic", 1), ("algebraic", None), ("arctan", None)}
"""h for which h' ≥ 0 and h(x)/x falls away from 0."""


@dataclass(frozen=True)
class SampledFromRest(Total):
    """At intervals of exactly ``period``, s, from every start at rest with |e_i| ≤ ``within``°, q → q_d.

    From t_k the torque (6) of reading p_{k−d} and v = (p_{k−d} − p_{k−d−1})/T is held, d = ``delay``; all
    readings before the start are that of the start. For each arm in the ranges of ``viscous`` and
    ``parameters`` with this ``mass`` and g the gradient of ``potential``, known to the controller.
    """

    family: str
    m: int | None
    kp: Numbers
    kv: Numbers
    viscous: tuple[Ends, ...]
    mass: Mass
    potential: Monomials
    parameters: tuple[Ends, ...]
    period: Fraction
    delay: int
    within: Fraction

    def require_well_formed(self) -> None:
        n = len(self.mass)
        require_one_a_joint(self, n, "kp", "kv", "viscous")
        require(min(*self.kp, *self.kv) > 0, "gains", "", "must be positive")
        require(
            all(0 <= low <= high for low, high in self.viscous), "viscous", "", "must be ranges from 0 on"
        )
        require(self.period > 0, "period", self.period, "must be positive")
        require(0 <= self.delay <= MOST_DELAY, "delay", self.delay, f"must be from 0 to {MOST_DELAY}")
        require(0 < self.within <= FARTHEST, "within", self.within, f"must be positive, to {FARTHEST}°")
        require_mass(self.mass, self.parameters)
        require_polynomials([self.potential], n, self.parameters)

    @property
    def granted(self) -> tuple[str, ...]:
        return (
            "M(q), B and the potential are those of the robot; its C is by Christoffel symbols",
            "no friction beside B acts, and (6) knows g(q) exactly",
            f"a torque goes out {late_text(self.delay)}, is held until the next, and no motor saturates",
            "readings are the angles, exact and unwrapped, at intervals of exactly T; q_d is constant",
            "before the start the arm stood where it starts, the controller running",
        )

    def text(self) -> str:
        n = len(self.mass)
        return (
            f"at intervals of T = {number_text(self.period)} s, {late_text(self.delay)}, q̇ by backward "
            f"differences: from every start at rest with |e_i| ≤ {number_text(self.within)}° the torque (6) "
            f"brings every arm to q_d: {law_text(self.viscous, self.family, self.m, self.kp, self.kv)}, "
            f"{mass_text(self.mass, self.parameters)}, "
            f"{potential_text(self.potential, n, len(self.parameters))}"
        )


@dataclass(frozen=True)
class EnergyOfLinks:
    """The links at each corner of the ranges, and the forms by which they show M ≽ diag(u); untrusted."""

    arms: tuple[tuple[RigidLink, ...], ...]
    forms: tuple[storage.Forms, ...]

    def above(self, least: Numbers, statement: SampledFromRest) -> bool:
        """Whether M ≽ diag(least).

        Soundness: −xᵀMx < −Σ u_i x_i² for x ≠ 0 at each corner, see `lyapcheck.check.loop.storage`, and M,
            affine in each parameter, is a mean of its values there.
        """
        masses = masses_at_corners(statement.mass, statement.parameters)
        shown = storage.Shown(tuple(-u for u in least), self.forms)
        made = len(self.arms) == len(masses) and all(map(makes, self.arms, masses))
        return made and shown.holds([storage.energy(links, -1) for links in self.arms], 2)


@dataclass(frozen=True)
class FallingEnergy(Proof):
    """V, with u of M ≽ diag(u), a speed that motions keep, ν and weights of rows of |M_ij|.

    ``along`` shows M ≽ diag(u) by the links; without it boxes of angles do.
    """

    rule = "falling sampled energy"
    least: Numbers
    speed: Fraction
    share: Fraction
    scale: Numbers
    energy: SampledEnergy
    along: EnergyOfLinks | None = field(default=None, metadata={"left_out": True})


@rule(SampledFromRest, FallingEnergy)
def by_falling_energy(statement: SampledFromRest, proof: FallingEnergy) -> Accepted:
    """Soundness: V falls at least as fast as some multiple of |h(e)|² + |w|² while wᵀMw ≤ speed².

    For x > 0 the slope h(1 − h'/ρ) of U − h²/2ρ is not negative: U ≥ h²/2ρ. By it and ρε_i²Σ_j|M_ij|scale_i/
    scale_j ≤ ν k̂_i, V ≥ ½(1 − ν) wᵀMw + Σ k̂_i (U − h²/2ρ)(e_i), and at the start, as U rises with |e_i|,
    V ≤ Σ k̂_i U(within) < ½(1 − ν) speed²: so wᵀMw stays below, all |w_i| below w̄_i, and so do the means of w
    that differences are. V never rises, also as steps end. The integral of |h|² + |w|² is finite, and h(e)
    and w are uniformly continuous: both tend to 0; so does e, since h stays away from 0.
    """
    known, n = member(statement.family, statement.m), len(statement.mass)
    V, d = proof.energy, statement.delay
    _require_sizes(proof, n, d)
    inertia = inertia_of(statement.mass, statement.parameters)
    require(inertia.symmetric, "M", "", "is not symmetric")
    along = proof.along
    above = inertia.above(proof.least) if along is None else along.above(proof.least, statement)
    require(above, "least", "", "is not shown to be M ≽ diag(u)")
    arm = arm_bounds(statement, proof.least)
    for i in range(n):
        row = sum(
            (x * proof.scale[i] / s for x, s in zip(arm.mass[i], proof.scale, strict=True)), Fraction(0)
        )
        small = known.rho * V.coupling[i] ** 2 * row <= proof.share * V.stiffness[i]
        require(small, "coupling", V.coupling[i], "is too large for V > 0")
        spent = sum(V.kept[i], Fraction(0)) <= V.weight * (V.reach - 1)
        require(spent, "kept", "", "is more than steps leave")
    potential = known.potential(to_arb(statement.within) * arb.pi() / 180)
    stored = to_arb(sum(V.stiffness, Fraction(0))) * potential
    require(stored * 2 < to_arb((1 - proof.share) * proof.speed**2), "speed", proof.speed, "may be exceeded")
    gains = bounded_gains(statement, proof.least, proof.speed)
    shown = falls(V, arm, proof.speed, statement.viscous, gains)
    require(shown, "energy", "", "is not shown to fall")
    return Accepted("proved", "enclosure")


def bounded_gains(statement: SampledFromRest, least: Numbers, speed: Fraction) -> Gains:
    """The controller, with the bounds of h at rates with Σ u_i w_i² ≤ speed², u = ``least``."""
    known = member(statement.family, statement.m)
    if (statement.family, statement.m) in CONCAVE:
        fastest = [to_arb(root_above(speed**2 / u)) for u in least]
        slope, sector = Fraction(0), [dyadic((known.h(w) / w).lower()) for w in fastest]
    else:  # h_m is flat at 0 and falls towards 1 in the end
        slope, sector = -known.rho, [Fraction(0)] * len(least)
    bounds = known.rho, slope, known.L, known.gamma, tuple(sector)
    return Gains(statement.kp, statement.kv, statement.period, statement.delay, *bounds)


def arm_bounds(statement: SampledFromRest, least: Numbers) -> ArmBounds:
    """Bounds for all postures and parameters by the sizes of harmonics, beside some u with M ≽ diag(u)."""
    n, ranges = len(statement.mass), statement.parameters
    inertia = inertia_of(statement.mass, ranges)
    slopes = [size_of(by_parameters(entry, n), ranges) for entry in hessian(statement.potential, n)]
    symbols = [[[Fraction(0)] * n for _ in range(n)] for _ in range(n)]
    for (i, j, k), symbol in inertia.symbols.items():
        symbols[i][j][k] = symbols[i][k][j] = size_of(symbol, ranges)
    return ArmBounds(
        least,
        tuple(tuple(size_of(entry, ranges) for entry in row) for row in inertia.mass),
        tuple(tuple(slopes[i * n : (i + 1) * n]) for i in range(n)),
        tuple(tuple(map(tuple, rows)) for rows in symbols),
    )


def _require_sizes(proof: FallingEnergy, n: int, d: int) -> None:
    V = proof.energy
    rows = [proof.least, proof.scale, V.coupling, V.stiffness, V.moved, V.mean, V.slow, V.kept, V.late]
    squares = [getattr(V.splits, name) for name in V.splits.__dataclass_fields__]
    split = [row for square in squares for row in square]
    fits = {n} == {*map(len, (*rows, *squares, *split))}
    late = {len(x) for x in V.kept} == {d + 1} and {len(x) for x in V.late} == {d}
    require(fits and late, "energy", "", f"must be of {n} joints and {d} samples")
    positive = (*proof.least, proof.speed, *proof.scale, V.weight, *chain.from_iterable(split))
    require(min(positive) > 0, "energy", min(positive), "must be positive")
    others = chain(V.coupling, V.stiffness, V.moved, V.mean, *V.kept, *V.late)
    least = min(others)
    require(least >= 0, "energy", least, "must not be negative")
    require(0 < proof.share < 1, "share", proof.share, "must be between 0 and 1")
    require(all(0 <= x <= 1 for x in V.slow), "slow", "", "must be from 0 to 1")
    require(V.reach >= 1, "reach", V.reach, "must be at least 1")
