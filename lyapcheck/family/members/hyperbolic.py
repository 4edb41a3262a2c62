"""The paper's family of hyperbolic functions.

References: ``reyes2019family`` (6), (7), (8), (12).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flint import arb

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.balls import hyperbolic_constants, peak_of_h, peaks_of_dh
from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.base import Family, FamilyConstants, SymbolicForms
from lyapcheck.family.hyperbolic_numeric import HyperbolicForms
from lyapcheck.family.registry import require_member


@dataclass(frozen=True)
class Hyperbolic(Family):
    """h_m = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), U_m = ln(1 + sinh^(2m)x) / (2m)."""

    @property
    def gamma(self) -> Tree:
        """γ_m."""
        return "gamma", self._member

    @property
    def _member(self) -> int:
        assert self.m is not None
        return self.m

    def numeric(self, of: Arithmetic, x: Any) -> HyperbolicForms:
        """See `lyapcheck.family.hyperbolic_numeric` for how exact they are."""
        return HyperbolicForms(self._member, of, x)

    def sympy(self, x: Any) -> SymbolicForms:
        """h_m, h_m', U_m as SymPy expressions."""
        from lyapcheck.family.symbolic import hyperbolic_symbolic

        return hyperbolic_symbolic(x, self._member)

    def turning_points(self) -> tuple[tuple[arb, ...], tuple[arb, ...]]:
        """The peak of h and those of h'; tanh has none."""
        if self._member == 1:
            return (), ()
        peaks = (peak_of_h(self._member),), peaks_of_dh(self._member)
        h, dh = (tuple(u.sqrt().asinh() for u in places) for places in peaks)
        return h, dh

    def constants(self, digits: int = 30) -> FamilyConstants:
        """γ_m, ρ_m, L_m, certified."""
        known = hyperbolic_constants(self._member, digits)
        return FamilyConstants(known.gamma, known.rho, known.L, known.gamma_at, known.rho_at, known.L_at)


def create(m: int | None) -> Hyperbolic:
    """The member m of the family."""
    return Hyperbolic("hyperbolic", require_member(m))
