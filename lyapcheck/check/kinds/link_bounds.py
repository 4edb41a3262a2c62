"""dV/dt < 0 by bounds along the links: with boxes of e where M(q) is written out, else by norms.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import sqrt

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.judgement import TORQUE
from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainCoriolisBelow, OfLinks
from lyapcheck.check.kinds.inertia import DECREASING, law_text
from lyapcheck.check.loop import (
    ClosedLoop,
    RateProof,
    ScalarForm,
    certifies,
    masses_at_corners,
    scalar_form,
    storage,
)
from lyapcheck.check.loop.chain import RigidLink, makes
from lyapcheck.check.loop.field import BALLS, Box, Side, ball, leaves
from lyapcheck.check.loop.schur import inverse_one_plus_root, square, unit_vector
from lyapcheck.check.loop.storage import Shown
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Proof
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

# --- dV/dt < 0 everywhere over boxes of e alone, from bounds of M(q) and its rates: for arms of many joints.
#
# Let 0 ≼ M ≼ U and ±½ ∂M/∂q_j ≼ Q_j for all q, with diagonal U and Q_j. In p = M N w the arm's own part of
# S is
#
#     S = C(q,h) − M N,   N = H' − h êᵀ/(1+r),   pᵀU⁻¹p ≤ pᵀN w,
#
# and N does not depend on q. What C(q,h) does is symmetric, or cubic in h:
#
#     |wᵀC(q,h)w| ≤ Σ_j |h_j| wᵀQ_j w,      |hᵀC(q,h)w| = |½ Σ_j w_j hᵀ(∂M/∂q_j)h| ≤ Σ_j |w_j| hᵀQ_j h.
#
# After σ = h and the damping are eliminated as in ``lyapcheck.check.loop``, with h_i² ≤ H_i |σ_i| and
# |σ_i w_j| ≤ ½(t σ_i² + w_j²/t), t = t_ij, one form in (w, p) is left for each e, with a multiplier l:
#
#     wᵀWw − 2ε pᵀG w + ε pᵀZ p ≻ 0,      G = ½(I + l N) − ¼ ε B κ⁻¹,      Z = l U⁻¹ − ¼ ε² κ⁻¹,
#     W = B − ε Σ_j |h_j| Q_j − ½ ε² Σ_i Q_ji H_i/t − ¼ ε B κ⁻¹ B,      κ_i = k̃_i − ½ ε Σ_j Q_ji H_i t,
#     k̃_i = k_pi − ¼ ε (L k_vi + b_i' − b_i),
#
# W, Z and κ diagonal. B ≥ b stands at its lower ends b: the rest costs at most ¼ ε² (b' − b) h².
# With a = εσ and π = εp held, each term of
#
#     wᵀ(W + ¼ ε B κ⁻¹ B)w − aᵀBw + aᵀκa/ε + πᵀa − πᵀ(I + l N)w + l πᵀU⁻¹π/ε
#
# falls as ε grows, for any t_ij > 0, so that a box is judged at its largest ε. Over a box
# N = N₀ ± Δ, and |p_i Δ_ij w_j| ≤ ½ Δ_ij (x p_i² + w_j²/x) for any x > 0. Signs of e go over to w and p, so
# that e ≥ 0 is enough.
#
# M is affine in each uncertain parameter, hence a mean of its values at the corners of their ranges; a bound
# that holds at the corners holds in between.
#
# References: ``reyes2019family`` (11), (12), (15).


FIRST, SCALES = ord("0"), 64
"""The signs for scales: from "0" on, each √2 times the one before, 1 in the middle."""
SCALE = {chr(FIRST + k): sqrt(2.0) ** (k - SCALES // 2) for k in range(SCALES)}
_KEPT = 1 << 16
Row = tuple[Fraction, ...]


class BoxForm:
    """The form in (w, p) over boxes of e ≥ 0.

    Args:
        loop: arm, controller and ε₀.
        inertia: diagonal of U.
        rates: diagonals of Q_2, …, Q_n; M does not depend on q_1.
    """

    def __init__(self, loop: ClosedLoop, inertia: Row, rates: Sequence[Row]) -> None:
        self.loop, self.n = loop, loop.n
        self.eps0 = to_arb(loop.eps0)
        self.U = [to_arb(x) for x in inertia]
        self.Q = [[arb(0)] * loop.n, *([to_arb(x) for x in row] for row in rates)]
        self.b = [to_arb(low) for low, _ in loop.friction]
        self.kp = [to_arb(k) for k in loop.kp]
        rows = zip(loop.kv, loop.friction, strict=True)
        self.fast = [to_arb((loop.member.L * k + high - low) / 4) for k, (low, high) in rows]
        self.radius_squared = arb(loop.radius) ** 2
        kept: Callable[[Callable[[Side], arb]], Callable[[Side], arb]] = lru_cache(maxsize=_KEPT)
        self.h = kept(lambda side: _ends(loop.member.h(ball(side))))
        self.dh = kept(lambda side: loop.member.dh(ball(side)))
        self.square = kept(square)
        self.root = [arb(float(b.sqrt())) for b in self.b]

    def proves(self, box: Box, scales: str) -> bool:
        """Whether the form is positive definite at every point of the box, or all of it lies beyond R."""
        r_squared = sum((self.square(side) for side in box), arb(0))
        if r_squared >= self.radius_squared:
            return True
        l, *sizes = (arb(SCALE[sign]) for sign in scales)
        rows = self.rows(box, inverse_one_plus_root(r_squared), l, sizes[: self.n], sizes[self.n :])
        return rows is not None and BALLS.positive_definite(rows)

    def rows(
        self, box: Box, shrink: arb, l: arb, w: Sequence[arb], p: Sequence[arb]
    ) -> list[list[arb]] | None:
        """W − ε GᵀZ⁻¹G, the entries on and below the diagonal; ``None`` where κ or Z may not be positive."""
        joints, b, Q = range(self.n), self.b, self.Q
        eps = (self.eps0 * shrink).upper()
        h = [self.h(side) for side in box]
        H = [high for _, high in h]
        k = [kp - eps * fast for kp, fast in zip(self.kp, self.fast, strict=True)]
        if not all(x > 0 for x in k):
            return None
        # t_ij = stiff_i/root_j, any positive numbers: k̃_i and b_j lose the same share
        stiff = [arb(float((eps * x).sqrt())) for x in k]
        kappa = [
            k[i] - eps / 2 * H[i] * stiff[i] * _sum(Q[j][i] / self.root[j] for j in joints) for i in joints
        ]
        if not all(x > 0 for x in kappa):
            return None
        N, spread = self._between(box, h, shrink)
        Z = [
            l / self.U[i] - eps**2 / (4 * kappa[i]) - l / 2 * _sum(spread[i][j] * w[j] for j in joints) / p[i]
            for i in joints
        ]
        if not all(x > 0 for x in Z):
            return None
        cubic = [H[i] / stiff[i] for i in joints]
        W = [
            b[j]
            - eps * _sum(H[i] * Q[i][j] for i in joints)
            - eps**2 / 2 * _sum(Q[j][i] * cubic[i] for i in joints) * self.root[j]
            - eps * b[j] ** 2 / (4 * kappa[j])
            - eps * l / 2 * _sum(spread[i][j] * p[i] for i in joints) / w[j]
            for j in joints
        ]
        G = [[l / 2 * x for x in row] for row in N]
        for i in joints:
            G[i][i] += arb(1) / 2 - eps * b[i] / (4 * kappa[i])
        scaled = [[eps / Z[i] * x for x in G[i]] for i in joints]
        rows = [[-_sum(scaled[i][j] * G[i][k] for i in joints) for k in range(j + 1)] for j in joints]
        for j in joints:
            rows[j][j] += W[j]
        return rows

    def _between(
        self, box: Box, h: Sequence[tuple[arb, arb]], shrink: arb
    ) -> tuple[list[list[arb]], list[list[arb]]]:
        """The middle and the spread of N = H' − h êᵀ/(1+r); h and ê are not negative."""
        pull = [_ends(unit * shrink) for unit in unit_vector(box, self.square)]
        N = [[-(low * x).union(high * y) for x, y in pull] for low, high in h]
        for i, side in enumerate(box):
            N[i][i] += self.dh(side)
        return [[entry.mid() for entry in row] for row in N], [[entry.rad() for entry in row] for row in N]


def _ends(x: arb) -> tuple[arb, arb]:
    """Both ends of a ball of something that is not negative."""
    return x.lower().max(arb(0)), x.upper()


def _sum(parts: Iterator[arb]) -> arb:
    return sum(parts, arb(0))


BITS = 64


@dataclass(frozen=True)
class LinkBounds(RateProof):
    """Bounds of M and its rates along the links, and boxes of e, untrusted.

    Args:
        arms: the links at each corner of the ranges of the parameters, in the order of ``corners_of``.
        inertia: M ≼ U, kg·m².
        rising: ½ ∂M/∂q_j ≼ Q_j for the second and each further joint, kg·m².
        falling: −½ ∂M/∂q_j ≼ Q_j, with the same Q_j.
        tree: boxes of |e_1|, …, |e_n|, each from 0 to ``farthest`` of the closed loop.
        scales: for each box in turn the multiplier l and the expected sizes of w and of p, as signs.
    """

    rule = "bounds along the links"
    arms: tuple[tuple[RigidLink, ...], ...]
    inertia: Shown
    rising: tuple[Shown, ...]
    falling: tuple[Shown, ...]
    tree: str
    scales: str

    def require_shown(self, loop: ClosedLoop) -> None:
        n = loop.n
        require(not loop.coupling, "weights", loop.coupling, "must be none")
        require(loop.admissible, "gains, friction or ε₀", "", "must be positive, M = Mᵀ")
        masses = masses_at_corners(loop.arm.mass, loop.parameters)
        made = len(self.arms) == len(masses) and all(map(makes, self.arms, masses))
        require(made, "links", len(self.arms), "do not make M(q) at the corners of its ranges")
        sizes = {len(self.rising), len(self.falling)}
        require(sizes == {n - 1}, "rates", sizes, f"must be bounded for {n - 1} joints")
        same = all(up.prices == down.prices for up, down in zip(self.rising, self.falling, strict=True))
        energy = [storage.energy(links, 1) for links in self.arms]
        shown = (
            same
            and self.inertia.holds(energy, 2)
            and all(
                bound.holds([storage.rate_of_mass(links, 1 + k, sign) for links in self.arms], 4)
                for sign, bounds in ((1, self.rising), (-1, self.falling))
                for k, bound in enumerate(bounds)
            )
        )
        require(shown, "forms", "", "do not show the bounds of M and its rates")
        require(self._boxes_shown(loop), "boxes", self.tree.count("."), "do not show dV/dt < 0 at every e")

    def _boxes_shown(self, loop: ClosedLoop) -> bool:
        size, count = 1 + 2 * loop.n, self.tree.count(".")
        if len(self.scales) != size * count or not set(self.scales) <= set(SCALE):
            return False
        start: Box = tuple((0.0, far) for far in loop.farthest)
        rows = (self.scales[k * size : (k + 1) * size] for k in range(count))
        with precision(BITS):
            form = BoxForm(loop, self.inertia.prices, [bound.prices for bound in self.rising])
            return all(form.proves(box, row) for box, row in zip(leaves(start, self.tree), rows, strict=True))


# --- The same for an arm given by its links, from three bounds.
#
# ``Decreasing`` asks for M(q) written out, which some arms of seven joints have too many terms for.


@dataclass(frozen=True)
class ChainDecreasing(OfLinks):
    """M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin, for every friction in the ranges.

    V of (13) is then positive definite and radially unbounded, so that the origin is globally asymptotically
    stable by Lyapunov's direct method (``kelly2005control``, chapter 2).

    ``viscous`` is the range of each diagonal entry of B, N·m·s/rad; ``family`` and ``m`` name h; ``kp`` and
    ``kv`` are in N·m; ``eps0`` is ε₀.
    """

    viscous: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction

    def require_well_formed(self) -> None:
        super().require_well_formed()
        n = len(self.links)
        for subject in ("viscous", "kp", "kv"):
            size = len(getattr(self, subject))
            require(size == n, subject, size, f"must be {n}, one a joint")
        for low, high in self.viscous:
            require(low <= high, "range", f"[{low}, {high}]", "is empty")

    @property
    def granted(self) -> tuple[str, ...]:
        arm = "the links of the statement, C by Christoffel symbols, and B within its ranges"
        return f"the robot is (1) with {arm}, constant in time", TORQUE

    def text(self) -> str:
        law = law_text(self.viscous, self.family, self.m, self.kp, self.kv)
        return f"{DECREASING}: {law}, ε₀ = {number_text(self.eps0)}, {self.over}"

    def form(self, largest: Fraction, coriolis: Fraction) -> ScalarForm:
        """Θ' of the arm with ‖M(q)‖ ≤ largest and ‖C(q, x)y‖ ≤ coriolis ‖x‖ ‖y‖."""
        known = member(self.family, self.m)
        return scalar_form(known, self.kp, self.kv, self.viscous, largest, coriolis)


@dataclass(frozen=True)
class ChainNorms(Proof):
    """Proofs of M(q) ≻ 0, of ‖M(q)‖ ≤ ``largest`` and of ‖C(q, x)y‖ ≤ ``coriolis`` ‖x‖ ‖y‖, kg·m²."""

    rule = "norms along the links"
    positive: Proof
    largest: Fraction
    below: Proof
    coriolis: Fraction
    rates: Proof


@rule(ChainDecreasing, ChainNorms)
def by_norms(statement: ChainDecreasing, proof: ChainNorms) -> Accepted:
    """Soundness: three statements about the links by proofs of their own; then `scalar_form`."""
    links = statement.links
    gains = min(*statement.kp, *statement.kv)
    require(gains > 0, "gains", gains, "must be positive")
    grades = [
        require_proved(ChainAbove(links, Fraction(0)), proof.positive, "M ≻ 0"),
        require_proved(ChainBelow(links, proof.largest), proof.below, "the bound of ‖M‖"),
        require_proved(ChainCoriolisBelow(links, proof.coriolis), proof.rates, "the bound of ‖C‖"),
    ]
    form = statement.form(proof.largest, proof.coriolis)
    require(certifies(form, statement.eps0), "ε₀", statement.eps0, "is not shown by these bounds")
    return Accepted("proved", weakest(grades))
