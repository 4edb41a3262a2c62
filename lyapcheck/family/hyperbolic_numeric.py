"""The hyperbolic family in doubles, once, for arrays, CasADi graphs and compiled loops.

With g = expm1|x| and E = 1/(1 + g): sinh|x| = ½ g (1 + E), cosh x = ½ (1 + g + E). Let r be the smaller of
sinh|x| and its inverse 2E/(1 − E²), z = r² and p = z^m, so that no power exceeds 1. Then

    h = ± cosh x r z^(m−1)/(1 + p) where sinh|x| ≤ 1, and ± (1 + r E)/(1 + p) beyond, as coth|x| = 1 + r E,
    h' = Σ c_k z^k/(1 + p)²  and  Σ c_k z^(2m−k)/(1 + p)²,  of the numerator Σ c_k sinh^(2k)x in (8),
    U = ln(1 + p)/(2m) + max(0, ln sinh|x|).

Each branch is the whole function there, so that automatic differentiation is right on both sides and at 0,
and both are finite everywhere.

Powers up to 2m magnify the relative error of r. At every double and for every m up to 1000 the values h, U
and h(x)/x are within 4m + 8 units in the last place of themselves. So is h' of the size of its terms; its
relative error has no bound near its zero. A search may use these; a verdict rests on balls.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.symbolic import slope_terms

FARTHEST = 700.0
"""|x| from which h is 1 and h' is 0 in doubles."""
LN2 = 0.6931471805599453


class HyperbolicForms:
    """h_m, h_m', U_m and h_m(x)/x; each is worked out when it is asked for. NaN stays NaN.

    Args:
        m: the member.
        of: the arithmetic.
        x: a value of it.
    """

    def __init__(self, m: int, of: Arithmetic, x: Any) -> None:
        self.m, self.of, self.x = m, of, x
        # no fabs or copysign: their derivatives are 0 at 0
        self.a = of.name(of.where(x < 0, -x, x))
        g = of.name(of.expm1(of.smaller(self.a, FARTHEST)))
        self.E = of.name(1.0 / (1.0 + g))
        sinh = of.name(0.5 * (g * (1.0 + self.E)))
        self.cosh = of.name(0.5 * ((1.0 + g) + self.E))
        self.near = sinh <= 1.0
        self.far = of.name(of.larger(1.0 - self.E * self.E, 0.5))
        self.r = of.name(of.where(self.near, sinh, 2.0 * self.E / self.far))
        self._powers = {1: of.name(self.r * self.r)}

    def power(self, k: int) -> Any:
        """z^k by squaring."""
        if k not in self._powers:
            self._powers[k] = self.of.name(self.power(k // 2) * self.power(k - k // 2))
        return self._powers[k]

    @cached_property
    def inverse(self) -> Any:
        """1/(1 + p)."""
        return self.of.name(1.0 / (1.0 + self.power(self.m)))

    def _size(self, low: Any, high: Any) -> Any:
        """cosh x z^(m−1)/(1 + p) times ``low`` near 0, and beyond coth|x|/(1 + p) times ``high``."""
        near = self.cosh * low * (self.power(self.m - 1) if self.m > 1 else 1.0)
        return self.of.where(self.near, near, (1.0 + self.r * self.E) * high) * self.inverse

    @cached_property
    def h(self) -> Any:
        """h(x)."""
        size = self.of.name(self._size(self.r, 1.0))
        return self.of.name(self.of.where(self.x < 0, -size, size))

    @cached_property
    def dh(self) -> Any:
        """h'(x)."""
        terms = slope_terms(self.m)
        near = self._sum(terms)
        far = self._sum([(c, 2 * self.m - k) for c, k in terms])
        return self.of.name(self.of.where(self.near, near, far) * (self.inverse * self.inverse))

    @cached_property
    def potential(self) -> Any:
        """U(x)."""
        of = self.of
        # the logarithm in no branch: compilers make no vectors of calls in branches
        log_sinh = of.where(self.near, 0.0, self.a - LN2) + of.log(of.where(self.near, 1.0, self.far))
        return of.name(of.log1p(self.power(self.m)) * (1.0 / (2 * self.m)) + log_sinh)

    @cached_property
    def secant(self) -> Any:
        """h(x)/x, and h'(0) at 0."""
        some, of = self.a > 0, self.of
        a = of.where(some, self.a, 1.0)
        return self._size(of.where(some, self.r / a, 1.0), 1.0 / a)

    def _sum(self, terms: Any) -> Any:
        """Σ c z^k, its smallest power last."""
        low = min(k for _, k in terms)
        total = sum(c * self.power(k - low) if k > low else c for c, k in terms)
        return total * self.power(low) if low else total
