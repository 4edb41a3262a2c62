"""How errors die out near the goal: exponentially for m = 1, like a power of time where h is flat at 0.

With ε = ε₀ and nothing that disturbs, −dV/dt ≥ a T + ε₀ Σ c_i h_i² (see ``lyapcheck.check.loop.decay``), with
T the kinetic part of V. For u = sinh² x and |x| ≤ x̄

    h_m² = u^(2m−1) (1 + u)/(1 + u^m)²,   u^m/(1 + u^m) ≤ 2m U_m = ln(1 + u^m) ≤ u^m,

so that with p = 2 − 1/m and z = 1 + sinh^(2m) x̄: h_m² ≥ (2m)^p U_m^p/z² and U_m ≥ x^(2m)/(2m z). As V^p is at
most (n + 1)^(p−1) (T^p + Σ (k_pi U_i)^p), wherever V ≤ v

    −dV/dt ≥ c V^p,   c = (n + 1)^(1−p) min(a v^(1−p), min ε₀ c_i (2m)^p/(z_i² k_pi^p)).

From V = v at time 0 on therefore V ≤ v exp(−c t) for m = 1, else V ≤ v (1 + (p − 1) c v^(p−1) t)^(−m/(m−1)),
and |e_i| ≤ (2m z_i V/k_pi)^(1/(2m)).

References: ``reyes2019family`` (6), (7), (11), (13).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import arb

from lyapcheck.check.loop.decay.estimate import Estimate
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure

BITS = 128


def degree(family: str, m: int | None) -> int | None:
    """m of the functions that this is about; ``None`` for others."""
    return {"hyperbolic": m, "tanh": 1}.get(family)


def shortest(estimate: Estimate, level: Fraction, errors: Sequence[Fraction]) -> Fraction | None:
    """The least s, s, from above: |e_i| fall like exp(−t/s), or for m ≥ 2 like (1 + t/s)^(−1/(2m − 2)).

    Args:
        estimate: of a phase with ε = ε₀, under no disturbance.
        level: v, J.
        errors: rad; V ≤ v keeps every |e_i| below them.

    Returns:
        ``None`` where no such s is known.
    """
    loop = estimate.margin.loop
    m = degree(loop.family, loop.m)
    if m is None or not loop.within or any(estimate.disturbance.dry) or any(estimate.disturbance.torque):
        return None
    with precision(BITS):
        p, v = 2 - arb(1) / m, to_arb(level)
        slopes = [to_arb(estimate.damping) * v ** (1 - p)]
        rows = zip(estimate.stiffness, loop.kp, errors, strict=True)
        for c, k, far in rows:
            slopes.append(to_arb(loop.eps0 * c) * (2 * m / to_arb(k)) ** p / _z(far, m) ** 2)
        least = slopes[0]
        for slope in slopes[1:]:
            least = least.min(slope)
        c = arb(loop.n + 1) ** (1 - p) * least
        speed = c / 2 if m == 1 else (p - 1) * c * v ** (p - 1)
        return Enclosure.from_arb(1 / speed).upper if speed > 0 else None


def covers(
    estimate: Estimate, level: Fraction, errors: Sequence[Fraction], sizes: Sequence[Fraction]
) -> bool:
    """Whether sizes are shown to be at least (2m z v/k_pi)^(1/(2m)), so that |e_i| starts below them."""
    loop = estimate.margin.loop
    m = degree(loop.family, loop.m)
    if m is None:
        return False
    with precision(BITS):
        rows = zip(loop.kp, errors, sizes, strict=True)
        return all(
            to_arb(k) * to_arb(size) ** (2 * m) >= 2 * m * _z(far, m) * to_arb(level) for k, far, size in rows
        )


def _z(far: Fraction, m: int) -> arb:
    """1 + sinh^(2m) x̄."""
    return 1 + to_arb(far).sinh() ** (2 * m)
