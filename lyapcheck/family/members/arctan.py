"""The inverse tangent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flint import arb

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import base

_SERIES_TERMS = 13
_SERIES_END = 0.25
_HUGE = 2.0**27
"""Beyond it 1 + x² rounds to x²."""


@dataclass(frozen=True)
class Arctan(base.Family):
    """h = arctan x, h' = 1/(1 + x²), U = x arctan x - ln(1 + x²)/2; γ = π/2 in the limit, ρ = L = 1 at 0."""

    @property
    def gamma(self) -> Tree:
        """π/2."""
        return "div", ("pi",), ("num", "2")

    def numeric(self, of: base.Arithmetic, x: Any) -> base.NumericForms:
        """From 1/x where x² may overflow; U near 0 by its series, where its parts cancel."""
        a = of.fabs(x)
        angle, far, bounded = of.arctan(x), a > _HUGE, of.smaller(a, _HUGE)
        inverse, z = 1 / of.larger(a, 1.0), bounded * bounded
        w = 1 + z
        # ln(1 + z) by the logarithm alone: the rounding of 1 + z is put back to first order
        log1p = of.log(w) + (z - (w - 1)) / w
        log = of.where(far, of.log(of.smaller(of.larger(a, 1.0), 1e308)), 0.5 * log1p)
        near = of.smaller(a, 2 * _SERIES_END)
        square, series = near * near, 0.0
        # Σ (-x²)^k / ((2k+1)(2k+2)), which is U/x² for |x| <= 1/4
        for k in reversed(range(_SERIES_TERMS)):
            series = 1 / ((2 * k + 1) * (2 * k + 2)) - square * series
        return base.NumericForms(
            h=angle,
            dh=of.where(far, inverse * inverse, 1 / w),
            potential=of.where(a <= _SERIES_END, square * series, a * of.fabs(angle) - log),
            secant=of.where(a > 0, of.fabs(angle) / of.where(a > 0, a, 1.0), 1.0),
        )

    def sympy(self, x: Any) -> base.SymbolicForms:
        """h, h', U as SymPy expressions."""
        import sympy as sp

        return base.SymbolicForms(sp.atan(x), 1 / (1 + x**2), x * sp.atan(x) - sp.log(1 + x**2) / 2)

    def constants(self, digits: int = 30) -> base.FamilyConstants:
        """γ = π/2 in the limit, ρ = L = 1 at 0."""
        one, zero = Enclosure.exact(1), Enclosure.exact(0)
        with precision(4 * digits + 16):
            gamma = Enclosure.from_arb(arb.pi() / 2)
        return base.FamilyConstants(gamma, one, one, None, zero, zero)


def create(m: int | None) -> Arctan:
    """The one member."""
    base.require_none("arctan", m)
    return Arctan("arctan")
