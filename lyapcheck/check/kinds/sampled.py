"""The loop on a computer: held torque, late readings, velocities by differences; stable for every inertia.

With F = Σ|f_j|, r = ``stretch`` and Γ_i = Σ_j min(k_gi, k_gj) it suffices that

    (S)  b_i > r L k_vi F + (½ + d) r T (ρ k_pi + Γ_i)   for every joint.

A held torque does the work τᵀδ over an interval, δ the change of q: the potentials rise by at most
½ (ρ k_pi + Γ_i) δ_i² above it, readings d apart cost the same d times, the velocity L k_vi |f_j| δ_i²/T, and
friction takes b_i δ_i²/(r T). Each g_i of a serial revolute arm is a + b cos q_j + c sin q_j in each q_j:
hence ∂g_i/∂q_j = ½ [g_i(q + ½π e_j) − g_i(q − ½π e_j)] is no larger than k_gi, and it is ∂g_j/∂q_i.

References: ``colgate1997passivity`` for one linear joint, ``stramigioli2005sampled`` for τᵀδ; for n joints
``formal/Sampled.v`` to ``formal/Period.v``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.text import diagonal_text, list_text, number_text
from lyapcheck.check.kinds.chain import ChainAbove, ChainGravityBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import (
    MassAbove,
    mass_text,
    potential_text,
    require_mass,
    require_one_a_joint,
    require_polynomials,
)
from lyapcheck.check.kinds.stable_arm import slope
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.numbers.members import member, member_text
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Mass, Monomials, Proof, Statement, Total
from lyapcheck.check.verify import Accepted, require_proved, rule

MOST_DELAY = 1000
MOST_TAPS = 1000
GOAL, REST = "goal", "rest"


def late_text(delay: int) -> str:
    """When a torque goes out after its reading."""
    return f"{delay} samples late" if delay > 1 else "1 sample late" if delay else "at once"


@dataclass(frozen=True)
class SampledStable(Total):
    """For each T in (0, ``period``], s, and all intervals between readings of at most ``stretch``·T.

    τ_k = K_p h(q_d − p_{k−d}) − K_v h(v_k) + ĝ(p_{k−d}) from reading k to the next, with p_k = q(t_k),
    d = ``delay`` and v_k = Σ_j f_j (p_{k−d−j} − p_{k−d−j−1})/T, f = ``taps``. The arm is serial, its joints
    revolute, b_i ≥ ``viscous_min``, N·m·s/rad, and one of these:

    - any with |ĝ_i(q)| ≤ ``k_g``, N·m;
    - the chain ``links`` with free fall ``fall``;
    - any in the ranges of ``parameters`` with this ``mass``, where positive definite, and ``potential``.

    The ``conclusion`` *goal* means g = ĝ, and the goal is globally asymptotically stable. *rest* means that
    w → 0 in every motion. Any serial revolute arm then moves under ĝ of the arm above, any bounded g with a
    potential, and any dissipative friction in addition to B.
    """

    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    viscous_min: tuple[Fraction, ...]
    k_g: tuple[Fraction, ...]
    links: tuple[RigidLink, ...]
    fall: tuple[Fraction, ...]
    mass: Mass
    potential: Monomials
    parameters: tuple[Ends, ...]
    period: Fraction
    stretch: Fraction
    delay: int
    taps: tuple[Fraction, ...]
    conclusion: str

    def require_well_formed(self) -> None:
        """One number a joint, one arm, whole samples, a filter of finitely many taps."""
        n = self.n
        require_one_a_joint(self, n, "kv", "viscous_min")
        require(min(*self.kp, *self.kv) > 0, "gains", "", "must be positive")
        require(min(self.viscous_min) >= 0, "viscous_min", min(self.viscous_min), "must not be negative")
        require(self.period > 0, "period", self.period, "must be positive")
        require(self.stretch >= 1, "stretch", self.stretch, "must be at least 1")
        require(0 <= self.delay <= MOST_DELAY, "delay", self.delay, f"must be from 0 to {MOST_DELAY} samples")
        require(1 <= len(self.taps) <= MOST_TAPS, "taps", len(self.taps), f"must be 1 to {MOST_TAPS}")
        require(self.conclusion in (GOAL, REST), "conclusion", self.conclusion, f"must be {GOAL} or {REST}")
        arms = [len(self.k_g), len(self.links), len(self.mass)]
        require(sorted(arms) == [0, 0, n], "arm", arms, f"must be given once, by {n} k_g, links or rows of M")
        rest = (self.fall and not self.links) or ((self.potential or self.parameters) and not self.mass)
        require(not rest, "arm", "", "has data without its links or M")
        require(min(self.k_g, default=0) >= 0, "k_g", "", "must not be negative")
        if self.mass:
            require_mass(self.mass, self.parameters)
            require_polynomials([self.potential], n, self.parameters)
            turns = (k for part in by_parameters(self.potential, n).values() for k in part)
            require(
                all(max(map(abs, k)) <= 1 for k in turns),
                "potential",
                "",
                "has an angle twice in a term, unlike that of a serial revolute arm",
            )
        for bound in self.bounds([Fraction(0)] * n):
            bound.require_well_formed()

    @property
    def n(self) -> int:
        return len(self.kp)

    @property
    def unused(self) -> set[str]:
        """Fields of the ways in which the arm is not given."""
        used = (
            {"links", "fall"} if self.links else {"mass", "potential", "parameters"} if self.mass else set()
        )
        return {"links", "fall", "mass", "potential", "parameters"} - used

    @property
    def mass_positive(self) -> Statement | None:
        """M(q) ≻ 0, where M is given: without it the statement is about no arm."""
        if self.links:
            return ChainAbove(self.links, Fraction(0))
        return MassAbove(self.mass, self.parameters, Fraction(0)) if self.mass else None

    def bounds(self, k_g: Sequence[Fraction]) -> list[Statement]:
        """|ĝ_i(q)| ≤ k_gi for all q and parameters, of an arm that is given."""
        if self.links:
            return [ChainGravityBelow(self.links, self.fall, (i,), k) for i, k in enumerate(k_g, 1)]
        if not self.mass:
            return []
        torques = [slope(self.potential, i, self.n) for i in range(self.n)]
        pairs = zip(torques, k_g, strict=True)
        return [GravityBelow(self.n, (torque,), self.parameters, k) for torque, k in pairs]

    def needed(self, k_g: Sequence[Fraction], period: Fraction | None = None) -> list[Fraction]:
        """What each b_i must exceed by (S), N·m·s/rad, at this period or another one in s.

        Soundness: ρ and L are from above, and it grows with each of them, k_g and T.
        """
        known, T = member(self.family, self.m), self.period if period is None else period
        spread, late = sum(map(abs, self.taps)), Fraction(1, 2) + self.delay
        gamma = [sum(min(k, other) for other in k_g) for k in k_g]
        return [
            self.stretch * (known.L * v * spread + late * T * (known.rho * p + steep))
            for p, v, steep in zip(self.kp, self.kv, gamma, strict=True)
        ]

    @property
    def granted(self) -> tuple[str, ...]:
        arm = "M(q) ≻ 0, C by Christoffel symbols and B diagonal"
        goal, late = self.conclusion == GOAL, late_text(self.delay)
        beside = "and no friction beside B acts" if goal else "and other friction only brakes"
        known = "is that of the arm" if goal else "need not be that of the arm"
        premise = f"|g_i(q)| ≤ k_gi with k_g = {list_text(self.k_g)} N·m at all postures; no g is given"
        return (
            f"the arm is serial, its joints are revolute: (1) with {arm}",
            f"b_i ≥ {list_text(self.viscous_min)} N·m·s/rad, {beside}",
            f"a torque goes out {late}, is held until the next and applied as it is: no motor saturates",
            f"no interval between readings is longer than {self._longest}, and readings go on for ever",
            "readings are the angles, exact and unwrapped; q_d is constant",
            f"the g(q) of the controller {known}, a gradient computed exactly",
            *((premise,) if self.k_g else ()),
        )

    @property
    def _longest(self) -> str:
        return "T" if self.stretch == 1 else f"{number_text(self.stretch)}·T"

    def text(self) -> str:
        what = (
            "the goal is globally asymptotically stable"
            if self.conclusion == GOAL
            else "all motions come to rest, whatever bounded gravity of a serial revolute arm acts,"
        )
        if self.links:
            over = ChainGravityBelow(self.links, self.fall, (1,), Fraction(0)).over
            arm = f"the arm with free fall {list_text(self.fall)}, {over}"
        elif self.mass:
            energy = potential_text(self.potential, self.n, len(self.parameters))
            arm = f"any arm with {mass_text(self.mass, self.parameters)} ≻ 0, {energy}"
        else:
            arm = f"any serial revolute arm with |g_i(q)| ≤ {list_text(self.k_g)}"
        return (
            f"for every T ≤ {number_text(self.period)} s {what} with torques (6) held between readings up to "
            f"{self._longest} apart, {late_text(self.delay)}, q̇ from differences/T weighted "
            f"{list_text(self.taps)}: h = {member_text(self.family, self.m)}, "
            f"K_p = {diagonal_text(self.kp)}, K_v = {diagonal_text(self.kv)}, "
            f"b_i ≥ {list_text(self.viscous_min)}, {arm}"
        )


@dataclass(frozen=True)
class ShortPeriod(Proof):
    """Bounds k_gi of the torques of gravity, N·m, each with its proof; none where they are a premise."""

    rule = "friction above held torque"
    k_g: tuple[Fraction, ...]
    gravity: tuple[Proof, ...]


@rule(SampledStable, ShortPeriod)
def by_friction(statement: SampledStable, proof: ShortPeriod) -> Accepted:
    """Soundness: (S) above; a bounded h that stays away from 0 has a proper U, and torques are bounded."""
    own, n = (0 if statement.k_g else statement.n), statement.n
    require(len(proof.k_g) == len(proof.gravity) == own, "k_g", len(proof.k_g), f"must be {own}, each proved")
    k_g = statement.k_g or proof.k_g
    for bound, shown in zip(statement.bounds(k_g), proof.gravity, strict=True):
        require_proved(bound, shown, type(bound).__name__)
    for i, (have, want) in enumerate(zip(statement.viscous_min, statement.needed(k_g), strict=True)):
        require(have > want, f"b_{i + 1} of {n}", have, f"must exceed {float(want):.6g} N·m·s/rad by (S)")
    return Accepted("proved", "enclosure")
