"""The algebraic saturation x/√(1 + x²)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import base


@dataclass(frozen=True)
class Algebraic(base.Family):
    """h = x/√(1 + x²), h' = (1 + x²)^(-3/2), U = √(1 + x²) - 1; γ = 1 in the limit, ρ = L = 1 at 0."""

    @property
    def gamma(self) -> Tree:
        """1."""
        return "num", "1"

    def numeric(self, of: base.Arithmetic, x: Any) -> base.NumericForms:
        """Beyond |x| = 2^27 adding 1 to x² changes nothing, so x² is never needed where it would overflow."""
        a = of.fabs(x)
        b = of.smaller(a, 2.0**27)
        root = of.sqrt(1 + b * b)
        far = a > 2.0**27
        inverse = 1 / of.larger(a, 1.0)
        return base.NumericForms(
            h=of.where(far, of.where(x > 0, 1.0, -1.0), x / root),
            dh=of.where(far, inverse / of.larger(a, 1.0) * inverse, 1 / (root * (1 + b * b))),
            potential=of.where(far, a - 1, b * b / (root + 1)),
            secant=of.where(far, inverse, 1 / root),
        )

    def sympy(self, x: Any) -> base.SymbolicForms:
        """h, h', U as SymPy expressions."""
        import sympy as sp

        root = sp.sqrt(1 + x**2)
        return base.SymbolicForms(x / root, root**-3, root - 1)

    def constants(self, digits: int = 30) -> base.FamilyConstants:
        """γ = ρ = L = 1; h reaches γ only in the limit."""
        one, zero = Enclosure.exact(1), Enclosure.exact(0)
        return base.FamilyConstants(one, one, one, None, zero, zero)


def create(m: int | None) -> Algebraic:
    """The one member."""
    base.require_none("algebraic", m)
    return Algebraic("algebraic")
