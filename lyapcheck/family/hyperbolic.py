"""The paper's family of hyperbolic functions.

References: ``reyes2019family`` (6), (7), (8), (12).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flint import arb

from lyapcheck.check import balls
from lyapcheck.check.constants import hyperbolic_constants
from lyapcheck.family.base import CasadiForms, Family, FamilyConstants, SymbolicForms
from lyapcheck.family.registry import require_member

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lyapcheck.family.base import Doubles


@dataclass(frozen=True)
class Hyperbolic(Family):
    """h_m = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), U_m = ln(1 + sinh^(2m)x) / (2m)."""

    @property
    def _member(self) -> int:
        assert self.m is not None
        return self.m

    def h(self, x: ArrayLike) -> Doubles:
        """h_m(x)."""
        return _plain(self._member, x, 0)

    def dh(self, x: ArrayLike) -> Doubles:
        """h_m'(x)."""
        return _plain(self._member, x, 1)

    def potential(self, x: ArrayLike) -> Doubles:
        """U_m(x)."""
        return _plain(self._member, x, 2)

    def secant(self, x: ArrayLike) -> Doubles:
        """h_m(x)/x."""
        return _plain(self._member, x, 3)

    def sympy(self, x: Any) -> SymbolicForms:
        """h_m, h_m', U_m as SymPy expressions."""
        from lyapcheck.family.symbolic import hyperbolic_symbolic

        return hyperbolic_symbolic(x, self._member)

    def casadi(self, x: Any) -> CasadiForms:
        """The forms as CasADi SX."""
        return self.casadi_smooth(x)

    def casadi_smooth(self, x: Any) -> CasadiForms:
        """Short plain-double expressions for optimisers."""
        from lyapcheck.family.smooth import smooth_forms

        return smooth_forms(self._member, x)

    def ball_h(self, x: arb) -> arb:
        """h_m over a ball."""
        return balls.h(self._member, x)

    def ball_dh(self, x: arb) -> arb:
        """h_m' over a ball."""
        return balls.dh(self._member, x)

    def ball_potential(self, x: arb) -> arb:
        """U_m over a ball."""
        return balls.potential(self._member, x)

    def ball_secant(self, x: arb) -> arb:
        """h_m(x)/x over a ball."""
        return balls.secant(self._member, x)

    def constants(self, digits: int = 30) -> FamilyConstants:
        """γ_m, ρ_m, L_m, certified."""
        known = hyperbolic_constants(self._member, digits)
        return FamilyConstants(known.gamma, known.rho, known.L, known.gamma_at, known.rho_at, known.L_at)


def create(m: int | None) -> Hyperbolic:
    """The member m of the family."""
    return Hyperbolic("hyperbolic", require_member(m))


def _plain(m: int, x: ArrayLike, which: int) -> Doubles:
    import numpy as np

    x = np.asarray(x, dtype=float)
    n = np.clip(x, -1, 1)
    s, c = np.sinh(n), np.cosh(n)
    with np.errstate(all="ignore"):
        rest = s ** (2 * m - 2)
        p = rest * s * s
        ratio = np.where(n == 0, 1, s / np.where(n == 0, 1, n))
        near = (
            rest * s * c / (1 + p),
            rest * (2 * m - 1 + 2 * m * s * s - p) / (1 + p) ** 2,
            np.log1p(p) / (2 * m),
            rest * ratio * c / (1 + p),
        )
        a = np.maximum(np.abs(x), 1)
        t = np.exp(-a)
        r2 = (2 * t / (1 - t * t)) ** 2
        rest = r2 ** (m - 1)
        q = rest * r2
        h = (1 + t * t) / (1 - t * t) / (1 + q)
        far = (
            np.sign(x) * h,
            r2 * ((2 * m - 1) * q + 2 * m * rest - 1) / (1 + q) ** 2,
            a - 0.6931471805599453 + np.log1p(-t * t) + np.log1p(q) / (2 * m),
            h / a,
        )
    return np.where(np.abs(x) <= 1, near[which], far[which])
