"""The linear function of the PD baseline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flint import arb

from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import base


@dataclass(frozen=True)
class Linear(base.Family):
    """h = x, h' = 1, U = x²/2: unbounded, so γ does not exist; ρ = L = 1 everywhere."""

    @property
    def gamma(self) -> None:
        """None: h is unbounded."""
        return None

    def numeric(self, of: base.Arithmetic, x: Any) -> base.NumericForms:
        """x, 1, x²/2, infinite where that is beyond the largest double, and 1."""
        return base.NumericForms(h=x, dh=of.lift(1), potential=0.5 * x * x, secant=of.lift(1))

    def sympy(self, x: Any) -> base.SymbolicForms:
        """x, 1, x²/2."""
        import sympy as sp

        return base.SymbolicForms(x, sp.Integer(1), x**2 / 2)

    def casadi(self, x: Any) -> base.NumericForms:
        """x, 1, x²/2, 1."""
        import casadi as ca

        one = ca.SX.ones(*x.shape)
        return base.NumericForms(x, one, 0.5 * x * x, one)

    def ball_h(self, x: arb) -> arb:
        """x itself."""
        return x

    def ball_dh(self, x: arb) -> arb:
        """1."""
        return arb(1)

    def ball_potential(self, x: arb) -> arb:
        """x²/2."""
        return x * x / 2

    def constants(self, digits: int = 30) -> base.FamilyConstants:
        """No γ; ρ = L = 1, reached everywhere and named at 0."""
        one, zero = Enclosure.exact(1), Enclosure.exact(0)
        return base.FamilyConstants(None, one, one, None, zero, zero)


def create(m: int | None) -> Linear:
    """The one member."""
    base.require_none("linear", m)
    return Linear("linear", bounded=False)
