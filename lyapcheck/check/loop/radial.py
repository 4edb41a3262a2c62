"""dV/dt < 0 everywhere, from bounds of the parts of P in r = ‖e‖ alone: for arms of many joints.

With d_i² ≤ b_i, D = diag(d), v = Dw, M̃ = D⁻¹MD⁻¹ and C̃ likewise, the three parts of S are bounded each in
the variables it lives in:

    ‖M̃ H'‖ ≤ μ ρ(r),                         μ ≥ λmax(M̃(q)) for all q, ρ(r) = sup |h'| up to r
    ‖M̃ D h‖ ‖D⁻¹ ê‖/(1+r) ≤ μ g(r),          g(r) = min(κ_D S(r) r, c √n γ)/(1+r)
    its pull upwards ≤ f(r) ≤ μ g(r),         see ``rank_one``
    |λ|(sym C̃(q,h)) = ½ ‖Σ h_j ∂_j M̃‖ ≤ κ a(r),  ‖C̃(q,h)‖ ≤ κ' a(r),   a(r) = min(S(r) r, √n γ) ≥ ‖h‖

where S(r) = sup h(x)/x up to r, c = max d/min d, and κ_D = ½ (c + 1/c) by Kantorovich's inequality. So

    wᵀPw ≥ ‖v‖² [1 − ε σ − ¼ ε τ² (β + ε s)²],   σ = μ ρ + f + κ a,   s = μ (ρ + g) + κ' a,
    τ² = max d_i²/k̃_i,   β = max b_i/d_i²,   ε = ε₀/(1+r),

and one inequality in r is left. The cost hardly grows with the number of joints.

References: ``reyes2019family`` (11), (12), (15); ``marshall1979inequalities`` for Kantorovich's inequality.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import pairwise

from flint import arb, fmpq, fmpq_mat

from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.check.loop.boxes import Box, leaves
from lyapcheck.check.loop.closed_loop import ClosedLoop, InertiaBound, RateProof, root_above
from lyapcheck.check.loop.field import PI_ABOVE, Field
from lyapcheck.check.loop.inertia import exceeds, rows_of
from lyapcheck.check.loop.rank_one import rank_one_bound
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import Harmonic, Harmonics, Uncertain
from lyapcheck.check.numbers.members import Member
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import require

BITS = 64
Table = list[list[Harmonics]]


@dataclass(frozen=True)
class RadialBounds(InertiaBound, RateProof):
    """Bounds of the parts of dV/dt in r = ‖e‖ alone, untrusted.

    Args:
        weights: d_i, with d_i² ≤ b_i.
        inertia: μ.
        lowest: ν with −ν ≤ M̃, from 0 to μ, rad/s; M is positive, but the tree need not show all of that.
        angles: the joints over whose angles the tree shows −ν ≤ M̃ ≤ μ; the other angles are bounded by the
            sizes of their harmonics.
        tree: the boxes of those angles.
        cuts: values of r, rad, rising from 0; beyond the last one the bounds at infinity are used.
    """

    rule = "bounds in ‖e‖"
    lowest: Fraction
    angles: tuple[int, ...]
    tree: str
    cuts: tuple[Fraction, ...]

    def require_shown(self, loop: ClosedLoop) -> None:
        """By :func:`proves_radially`."""
        shown = proves_radially(loop, self)
        require(shown, "bounds", "", "do not show dV/dt < 0 at every ‖e‖")

    def shows_inertia(self, arms: Sequence[ClosedLoop]) -> bool:
        """By the tree, without cuts."""
        with precision(BITS):
            return all(self.joints_fit(arm) and Parts(arm, self).inertia_shown() for arm in arms)

    def joints_fit(self, loop: ClosedLoop) -> bool:
        """Whether the chosen angles are of joints, none twice."""
        return len(set(self.angles)) == len(self.angles) and set(self.angles) <= set(range(loop.n))


def proves_radially(loop: ClosedLoop, radial: RadialBounds) -> bool:
    """Whether dV/dt < 0 is shown at every state but the origin.

    Args:
        loop: arm, controller and ε₀, for all states, without parameters and with Λ = I.
        radial: untrusted data.

    Returns:
        ``True`` only if proved; ``False`` says nothing.

    Raises:
        BrokenTree: the text is not a tree of the angles.
    """
    covered = not loop.parameters and not loop.coupling and not loop.within
    if not loop.admissible or not covered or not fits(loop, radial):
        return False
    with precision(BITS):
        parts = Parts(loop, radial)
        return parts.inertia_shown() and Inequality(loop, parts).shown()


def fits(loop: ClosedLoop, radial: RadialBounds) -> bool:
    """Whether the data have the sizes and signs that the argument needs."""
    weights = len(radial.weights) == loop.n and all(
        d > 0 and d * d <= low for d, (low, _) in zip(radial.weights, loop.friction, strict=True)
    )
    rising = len(radial.cuts) > 0 and radial.cuts[0] == 0 and all(a < b for a, b in pairwise(radial.cuts))
    return (
        weights
        and radial.joints_fit(loop)
        and rising
        and 0 <= radial.lowest <= radial.inertia
        and radial.inertia > 0
    )


class Parts:
    """The bounds of M̃ and C̃; they do not depend on ε₀."""

    def __init__(self, loop: ClosedLoop, radial: RadialBounds) -> None:
        self.loop = loop
        self.radial = radial
        self.mu = to_arb(radial.inertia)
        n, d = loop.n, radial.weights
        joints = range(n)
        self.mass = [[_scaled(loop.mass[i][j].get((), {}), d[i] * d[j]) for j in joints] for i in joints]

    @cached_property
    def kappa(self) -> arb:
        """κ = ‖(½ sup ‖∂_j M̃‖)_j‖."""
        sizes = sizes_of(self.mass)
        joints = range(self.loop.n)
        kappa = [sum((abs(k[j]) * size for k, size in sizes.items()), Fraction(0)) / 2 for j in joints]
        return to_arb(root_above(sum((x * x for x in kappa), Fraction(0))))

    @cached_property
    def coriolis(self) -> arb:
        """κ' = ‖(sup ‖C̃(q, e_j)‖)_j‖."""
        tables = (self._coriolis_of(j) for j in range(self.loop.n))
        bounds = [sum(sizes_of(table).values(), Fraction(0)) for table in tables]
        return to_arb(root_above(sum((x * x for x in bounds), Fraction(0))))

    def _coriolis_of(self, j: int) -> Table:
        """C̃(q, e_j)."""
        n, d = self.loop.n, self.radial.weights
        table: Table = [[{} for _ in range(n)] for _ in range(n)]
        for (i, a, b), symbol in self.loop.symbols.items():
            if a == j:
                table[i][b] = _scaled(symbol.get((), {}), d[i] * d[b])
            if b == j:
                table[i][a] = _scaled(symbol.get((), {}), d[i] * d[a])
        return table

    @cached_property
    def near(self) -> Table:
        """The part of M̃ that turns with the chosen angles only."""
        return [[_only(entry, self.radial.angles, True) for entry in row] for row in self.mass]

    @cached_property
    def far(self) -> Fraction:
        """The sizes of the other harmonics."""
        far: Table = [[_only(entry, self.radial.angles, False) for entry in row] for row in self.mass]
        return sum(sizes_of(far).values(), Fraction(0))

    def inertia_shown(self) -> bool:
        """Whether −ν < M̃ < μ, by the tree, for all angles."""
        start: Box = ((-PI_ABOVE, PI_ABOVE),) * len(self.radial.angles)
        return all(self.shown_over(box) for box in leaves(start, self.radial.tree))

    @cached_property
    def field(self) -> Field:
        """The entries of ``near`` on and below the diagonal."""
        n = self.loop.n
        entries: list[Uncertain] = [{(): self.near[i][j]} for i in range(n) for j in range(i + 1)]
        return Field(entries, n, (), self.radial.angles)

    def shown_over(self, box: Box) -> bool:
        """Whether −ν < M̃ < μ over a box of the chosen angles, whatever the others are."""
        M = self.field.over(box, BALLS)
        above, below = self.radial.inertia - self.far, self.radial.lowest - self.far
        return exceeds(rows_of([-x for x in M]), 1, above, BALLS) and exceeds(rows_of(M), 1, below, BALLS)


class Inequality:
    """What is left to show, in r alone, at the ε₀ of a closure."""

    def __init__(self, loop: ClosedLoop, parts: Parts) -> None:
        self.loop = loop
        self.parts = parts
        d = parts.radial.weights
        spread = max(d) / min(d)
        self.spread = to_arb(spread)
        self.kantorovich = to_arb((spread + 1 / spread) / 2)
        self.softness = to_arb(max(x * x / k for x, k in zip(d, loop.stiffness, strict=True)))
        self.friction = to_arb(max(high / (x * x) for x, (_, high) in zip(d, loop.friction, strict=True)))
        self.rank_one_bound = to_arb(rank_one_bound(parts.radial.inertia, parts.radial.lowest, d))
        self.norm_h = arb(loop.n).sqrt() * to_arb(loop.member.gamma)
        self.eps0 = to_arb(loop.eps0)

    def shown(self) -> bool:
        """Whether it holds for all r ≥ 0."""
        cuts = self.parts.radial.cuts
        return self.holds(cuts[-1], None) and all(self.holds(a, b) for a, b in pairwise(cuts))

    def holds(self, near: Fraction, far: Fraction | None) -> bool:
        """Whether it holds for near ≤ r ≤ far; ``None`` is infinity.

        Each part is bounded at the end where it is largest, so that one number decides.
        """
        low = to_arb(near)
        eps = self.eps0 / (1 + low)
        rank_one = self.spread * self.norm_h / (1 + low)
        steep, a = to_arb(self.loop.member.rho), self.norm_h
        if far is not None:
            high = to_arb(far)
            steepest, rise = _up_to(self.loop.member, far)
            steep, a = min_of(steep, steepest), min_of(a, rise)
            rank_one = min_of(rank_one, self.kantorovich * rise / (1 + high))
            up = min_of(self.parts.mu * rank_one, self.rank_one_bound * rise / (1 + high))
        else:
            up = self.parts.mu * rank_one
        steep *= self.parts.mu
        fast = steep + up + self.parts.kappa * a
        slow = self.friction + eps * (steep + self.parts.mu * rank_one + self.parts.coriolis * a)
        return bool(1 - eps * fast - eps * self.softness * slow * slow / 4 > 0)


@lru_cache(maxsize=4096)
def _up_to(member: Member, far: Fraction) -> tuple[arb, arb]:
    """sup |h'(x)| and r sup h(x)/x for |x| ≤ r, from above."""
    high = to_arb(far)
    inside = arb(0).union(high)
    secant = min_of(abs(member.secant(inside)), to_arb(member.L))
    return arb(abs(member.dh(inside)).upper()), arb((secant * high).upper())


def sizes_of(table: Table) -> dict[Harmonic, Fraction]:
    """For each harmonic A cos(k·q) + B sin(k·q) of a matrix a bound of its norm for all q.

    ‖(A cos + B sin)x‖² ≤ xᵀ(AᵀA + BᵀB)x; of that matrix the trace and the largest row sum are bounds.
    """
    used = sorted({k for row in table for entry in row for k in entry})
    return {k: root_above(_gram_bound(table, k)) for k in used}


def _gram_bound(table: Table, k: Harmonic) -> Fraction:
    """A bound of λmax(AᵀA + BᵀB)."""
    zero, n = Fraction(0), len(table)
    entries = [terms.get(k, (zero, zero)) for row in table for terms in row]
    A, B = (fmpq_mat(n, n, [rational(entry[part]) for entry in entries]) for part in (0, 1))
    rows = (A.transpose() * A + B.transpose() * B).tolist()
    trace = sum((rows[i][i] for i in range(n)), fmpq(0))
    largest = max(sum(map(abs, row), fmpq(0)) for row in rows)
    bound = min(trace, largest)
    return Fraction(int(bound.p), int(bound.q))


def min_of(a: arb, b: arb) -> arb:
    """A ball whose upper end is the smaller of both upper ends: for bounds from above."""
    return arb(a.upper()).min(arb(b.upper()))


def _scaled(terms: Harmonics, by: Fraction) -> Harmonics:
    return {k: (a / by, b / by) for k, (a, b) in terms.items()}


def _only(terms: Harmonics, joints: Sequence[int], inside: bool) -> Harmonics:
    """The harmonics that turn with the given joints only, or all the others."""
    return {k: ab for k, ab in terms.items() if all(x == 0 or i in joints for i, x in enumerate(k)) == inside}
