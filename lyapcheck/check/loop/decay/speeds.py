"""What bounded speeds add to the damping, and how V at one ε₀ bounds V at another.

The energy E = ½ wᵀMw + Σ k_pi U(e_i), which is V of (13) at ε₀ = 0, never rises along (11). Where M ⪰ ν_i at
place (i, i) and E ≤ E₀, each |w_i| ≤ W_i = √(2E₀/ν_i), so that D = diag(h(w_i)/w_i) is not below δ_i, the
least h(x)/x up to W_i. Then

    B + K_v D = (B + K_v δ) + (1 − δ/L) K_v D',   0 ≤ D'_i ≤ L:

a proof of dV/dt < 0 for all such D' with B + K_v δ and (1 − δ/L)K_v holds at all states that are so slow.

U' = h and |h'| ≤ ρ give h² ≤ 2ρU, so ½ hᵀMh ≤ c Σ k_pi U(e_i) with c = ρ max u_i/k_pi for M ≼ diag(u).
Between V with ε = ε₀ and with ε = ε₀', y differs by |ε₀ − ε₀'| h, so that with s = |ε₀ − ε₀'| √c

    V' ≤ (√T + s √P)² + P ≤ (s/2 + √(1 + s²/4))² V,     T = ½ yᵀMy,  P = Σ k_pi U(e_i),  T + P = V.

References: ``reyes2019family`` (11), (13).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from flint import arb

from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.numbers.members import Member

BITS = 64
DEPTH = 12
"""Halvings after which a piece of [0, W] is given up."""


def fastest(energy: Fraction, inertia: Fraction) -> Fraction:
    """W, rad/s, from above: E ≤ ``energy``, J, and wᵀMw ≥ ν w_i², ν kg·m² > 0, leave |w_i| ≤ W."""
    with precision(BITS):
        return Enclosure.from_arb((to_arb(2 * energy / inertia)).sqrt()).upper


def secant_above(member: Member, least: Fraction, end: Fraction) -> bool:
    """Whether h(x) ≥ least·x is shown for 0 ≤ x ≤ end."""
    with precision(BITS):
        stack = [(0.0, float(end) * (1 + 2.0**-50), 0)]
        while stack:
            low, high, depth = stack.pop()
            if member.secant(arb(low).union(arb(high))) >= to_arb(least):
                continue
            if depth == DEPTH:
                return False
            middle = 0.5 * (low + high)
            stack += [(low, middle, depth + 1), (middle, high, depth + 1)]
    return True


def slowed(loop: ClosedLoop, floors: Sequence[Fraction]) -> ClosedLoop:
    """The loop with B + K_v δ and (1 − δ/L)K_v, whose D' is between 0 and L wherever D ≥ δ.

    Raises:
        ValueError: δ is not from 0 to below L, one a joint.
    """
    L = loop.member.L
    if len(floors) != loop.n or not all(0 <= x < L for x in floors):
        raise ValueError("least values of h(w)/w must be from 0 to below L, one a joint")
    gained = [x * v for x, v in zip(floors, loop.kv, strict=True)]
    more = tuple(b + x for b, x in zip(loop.arm.viscous, gained, strict=True))
    less = tuple((1 - x / L) * v for x, v in zip(floors, loop.kv, strict=True))
    ranges = tuple((low + x, high + x) for (low, high), x in zip(loop.friction, gained, strict=True))
    return replace(loop, arm=Arm(loop.arm.mass, more), viscous=ranges if loop.viscous else (), kv=less)


def regraded(level: Fraction, change: Fraction, loop: ClosedLoop, heaviest: Sequence[Fraction]) -> Fraction:
    """A bound of V at one ε₀, J, from V ≤ level at another one, ``change`` away, where M ≼ diag(heaviest)."""
    c = loop.member.rho * max(u / k for u, k in zip(heaviest, loop.kp, strict=True))
    with precision(BITS):
        s = to_arb(abs(change)) * to_arb(c).sqrt()
        factor = (s / 2 + (1 + s * s / 4).sqrt()) ** 2
        return Enclosure.from_arb(to_arb(level) * factor).upper
