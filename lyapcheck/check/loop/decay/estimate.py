"""What follows from a margin: levels of V, how fast they are passed, and which errors they allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from flint import arb

from lyapcheck.check.loop.decay.least import Well
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.numbers.members import Member

BITS = 64
HALVINGS = 30
FARTHEST = 2.0**20
"""rad: levels of V that allow larger errors are refused."""


@dataclass(frozen=True)
class Disturbance:
    """A torque d' − φ on the right of (11).

    Args:
        torque: d̄_i ≥ 0, N·m: |d'_i| ≤ d̄_i, of any sign and however it changes.
        dry: f_i ≥ 0, N·m: |φ_i| ≤ f_i and φ_i w_i ≥ 0, as dry friction is, sliding or sticking.
    """

    torque: tuple[Fraction, ...]
    dry: tuple[Fraction, ...]

    @classmethod
    def none(cls, n: int) -> Disturbance:
        """No disturbance of n joints."""
        return cls((Fraction(0),) * n, (Fraction(0),) * n)

    def fits(self, n: int) -> bool:
        """Whether there is one bound ≥ 0 of each kind a joint."""
        sizes = len(self.torque) == n and len(self.dry) == n
        return sizes and min(*self.torque, *self.dry) >= 0


class Estimate:
    """The bounds that follow from a margin under a disturbance; see ``lyapcheck.check.loop.decay``.

    Args:
        margin: what dV/dt is below 0 by.
        disturbance: what acts on the joints beside (11).

    Raises:
        ValueError: sizes or signs do not fit, or a disturbance d̄ is given and no share of damping for it.

    Soundness: all answers hold if the margin is there; whether it is, ``kinds.settling`` asks.
    """

    def __init__(self, margin: Margin, disturbance: Disturbance) -> None:
        if not margin.admissible or not disturbance.fits(margin.loop.n):
            raise ValueError(
                "the margin is not admissible, or the disturbance is of another number of joints"
            )
        if any(disturbance.torque) and margin.slack == 0:
            raise ValueError("a disturbance needs a share of the damping")
        self.margin = margin
        self.disturbance = disturbance
        loop = margin.loop
        self.member: Member = loop.member
        rest = 1 - margin.split - margin.slack
        lightest = min(b / u for b, u in zip(margin.viscous, margin.heaviest, strict=True))
        self.damping = 2 * rest * margin.friction * lightest
        self.steepest = self.damping / loop.eps0
        self.stiffness = tuple(
            margin.stiffness * k - margin.friction * b * loop.eps0 / (4 * margin.split)
            for k, b in zip(loop.kp, margin.viscous, strict=True)
        )
        if min(self.stiffness) < 0:
            raise ValueError("the share t of the damping is too small for the mixed terms")
        self.loss = sum(
            (
                d * d / (4 * margin.slack * margin.friction * b)
                for d, b in zip(disturbance.torque, margin.viscous, strict=True)
                if d
            ),
            Fraction(0),
        )

    def start_level(self, errors: Sequence[Fraction], rates: Sequence[Fraction]) -> Fraction:
        """A bound from above of V where |e_i| ≤ errors, rad, and |w_i| ≤ rates, rad/s, for all q: J.

        ½ Σ u_i (|w_i| + ε |h_i|)² + Σ k_pi U(e_i), and ε |h(e_i)| ≤ ε₀ L x/(1 + x) at |e_i| ≤ x, or ε₀ L x
        where ε = ε₀.
        """
        return self._at_start(errors, rates, self.margin.loop.eps0)

    def start_energy(self, errors: Sequence[Fraction], rates: Sequence[Fraction]) -> Fraction:
        """Likewise of ½ wᵀMw + Σ k_pi U(e_i), which is V at ε₀ = 0."""
        return self._at_start(errors, rates, Fraction(0))

    def _at_start(self, errors: Sequence[Fraction], rates: Sequence[Fraction], eps0: Fraction) -> Fraction:
        loop = self.margin.loop
        with precision(BITS):
            steepest = to_arb(eps0 * self.member.L)
            moving = stored = arb(0)
            for x, rate, u, k in zip(errors, rates, self.margin.heaviest, loop.kp, strict=True):
                near = x if loop.within else x / (1 + x)
                moving += to_arb(u) * (to_arb(rate) + steepest * to_arb(near)) ** 2
                stored += to_arb(k) * self.member.potential(to_arb(x))
            return Enclosure.from_arb(moving / 2 + stored).upper

    def keeps(self, level: Fraction, errors: Sequence[Fraction]) -> bool:
        """Whether V ≤ level is shown to keep every |e_i| ≤ errors, rad: k_pi U at them is not below it."""
        with precision(BITS):
            rows = zip(self.margin.loop.kp, errors, strict=True)
            return all(to_arb(k) * self.member.potential(to_arb(x)) >= to_arb(level) for k, x in rows)

    def reach(self, level: Fraction) -> tuple[float, ...]:
        """Bounds of |e_i|, rad, wherever V ≤ level: U⁻¹(level/k_pi) from above.

        Raises:
            ValueError: they would be larger than `FARTHEST`.
        """
        with precision(BITS):
            return tuple(reach_of(self.member, level / k) for k in self.margin.loop.kp)

    def fall(self, low: Fraction, high: Fraction, slope: Fraction) -> Fraction:
        """A bound from below of −dV/dt wherever low ≤ V ≤ high, in W; it may be negative.

        Args:
            low: J.
            high: J.
            slope: λ, at most ``steepest``; any choice is right, the best one gives the largest bound.
        """
        if not 0 <= slope <= self.steepest or not 0 <= low <= high:
            raise ValueError("λ must be from 0 to a/ε₀, and the levels in order")
        ends = self.reach(high)
        with precision(BITS):
            inside = to_arb(slope * low)
            rows = zip(self.stiffness, self.disturbance.dry, self.margin.loop.kp, ends, strict=True)
            for c, f, k, end in rows:
                inside += Well(self.member, to_arb(c), to_arb(f), to_arb(slope * k)).least(end)
            eps = to_arb(self.margin.loop.eps0)
            if inside > 0 and not self.margin.loop.within:
                eps /= 1 + sum((arb(x) ** 2 for x in ends), arb(0)).sqrt()
            return Enclosure.from_arb(eps * inside - to_arb(self.loss)).lower


@lru_cache(maxsize=4096)
def reach_of(member: Member, level: Fraction) -> float:
    """A double X with U(X) ≥ level: then U(x) ≤ level is at most X away from 0, since U rises.

    Raises:
        ValueError: X would be larger than `FARTHEST`.
    """
    goal = to_arb(level)
    low, high = 0.0, 1.0
    while not member.potential(arb(high)) >= goal:
        low, high = high, 2 * high
        if high > FARTHEST:
            raise ValueError("the level of V allows errors beyond all bounds")
    while member.potential(arb(high / 2)) >= goal and high > 2.0**-60:
        high /= 2
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if member.potential(arb(middle)) >= goal else (middle, high)
    return high
