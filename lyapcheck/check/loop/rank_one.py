"""How far ê(Mh)ᵀ/(1+r) can pull dV/dt up: less than its norm, as M is nearly positive and h points along e.

With y = Dh, v = D⁻¹ê, p = M̃y the largest eigenvalue of −sym(p vᵀ) is ½(‖p‖‖v‖ − vᵀp). Let −ν ≤ M̃ ≤ μ, so
that p lies in the ball around c y of radius ϱ‖y‖, with c = ½(μ − ν) and ϱ = ½(μ + ν). For any k, j > 0

    ‖p‖ ≤ ‖p‖²/(2k‖y‖) + ½ k‖y‖,      ‖p‖² ≤ 2c pᵀy + (ϱ² − c²)‖y‖²,
    pᵀu ≤ c yᵀu + ϱ‖y‖‖u‖,            ‖u‖ ≤ ½ j‖v‖ + ‖u‖²/(2j‖v‖)      for u = (c‖v‖/(k‖y‖)) y − v,

and all of it together is ½(‖p‖‖v‖ − vᵀp) ≤ α‖y‖‖v‖ − β yᵀv with

    2α = c²/k + (ϱ² − c²)/(2k) + ½k + ½ϱ (j + (1 + c²/k²)/j),      2β = c + ϱ c/(k j).

In the weights ω_i = e_i²/r², which sum to 1, and s_i = r h_i/e_i ∈ [0, s], s = S(r) r:

    yᵀv = Σ ω_i s_i,   ‖y‖‖v‖ ≤ ½ Σ ω_i (λ d_i² s_i² + 1/(λ d_i²))      for any λ > 0,

a mean of convex functions of s_i: the largest of their values at s_i = 0 and s_i = s is a bound, and it is
proportional to s for λ = t/(s max d min d).

References: term 4 of (15) and its part of Y in ``reyes2019family``; ``marshall1979inequalities``.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

CHOICES = (
    (Fraction(7, 10), Fraction(7, 10), Fraction(7, 5)),
    (Fraction(3, 4), Fraction(9, 10), Fraction(6, 5)),
    (Fraction(4, 5), Fraction(1), Fraction(11, 10)),
)
"""k/μ, j and t: any positive numbers give a bound; these are near the best for friction that differs little
or much between the joints."""


def rank_one_bound(mu: Fraction, nu: Fraction, d: Sequence[Fraction]) -> Fraction:
    """A bound of ½(‖p‖‖v‖ − vᵀp)/s over all e.

    Args:
        mu: M̃ ≤ μ, positive.
        nu: −ν ≤ M̃, from 0 to μ.
        d: the weights D, positive.

    Returns:
        rad/s, like μ: the value for s = 1.
    """
    return min(_largest_end(*_coefficients(mu, nu, k * mu, j), t, d) for k, j, t in CHOICES)


def _largest_end(alpha: Fraction, beta: Fraction, t: Fraction, d: Sequence[Fraction]) -> Fraction:
    """The largest value at s_i ∈ {0, s}, for s = 1 and u = λ d_i² = t d_i²/(max d min d)."""
    middle = max(d) * min(d)
    stretched = [t * x * x / middle for x in d]
    return max(alpha * (u * s * s + 1 / u) / 2 - beta * s for u in stretched for s in (0, 1))


def _coefficients(mu: Fraction, nu: Fraction, k: Fraction, j: Fraction) -> tuple[Fraction, Fraction]:
    """α and β."""
    c, radius = (mu - nu) / 2, (mu + nu) / 2
    steady = c * c / k + (radius * radius - c * c) / (2 * k) + k / 2
    alpha = steady + radius * (j + (1 + c * c / (k * k)) / j) / 2
    return alpha / 2, (c + radius * c / (k * j)) / 2
