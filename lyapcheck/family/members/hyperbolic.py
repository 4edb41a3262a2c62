"""The paper's family of hyperbolic functions.

References: ``reyes2019family`` (6), (7), (8), (12).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from flint import ctx, fmpq, fmpq_poly

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.balls import gamma_value, hyperbolic_constants, peak_of_h
from lyapcheck.check.numbers.polynomials import ball_of
from lyapcheck.family.base import Arithmetic, Family, FamilyConstants, SymbolicForms, require_member


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
        """See `lyapcheck.family.members.hyperbolic` for how exact they are."""
        return HyperbolicForms(self._member, of, x)

    def sympy(self, x: Any) -> SymbolicForms:
        """h_m, h_m', U_m as SymPy expressions."""
        import sympy as sp

        m, symbol = self._member, sp.Dummy("x", real=True)
        U = sp.log(1 + sp.sinh(symbol) ** (2 * m)) / (2 * m)
        h = sp.diff(U, symbol)  # U = ln(1 + sinh^(2m)x) / (2m), h = dU/dx, h' = d²U/dx²
        return SymbolicForms(*(form.subs(symbol, x) for form in (h, sp.diff(h, symbol), U)))

    def constants(self, digits: int = 30) -> FamilyConstants:
        """γ_m, ρ_m, L_m, certified."""
        known = hyperbolic_constants(self._member, digits)
        return FamilyConstants(known.gamma, known.rho, known.L, known.gamma_at, known.rho_at, known.L_at)


def create(m: int | None) -> Hyperbolic:
    """The member m of the family."""
    return Hyperbolic("hyperbolic", require_member(m))


@lru_cache(maxsize=64)
def slope_terms(m: int) -> tuple[tuple[int, int], ...]:
    """(c, k) of the terms c sinh^(2k)x of h_m' times (1 + sinh^(2m)x)², as SymPy derives them."""
    from lyapcheck.derive.family import member

    known = member(m)
    return tuple((int(c), power // 2) for (_, power), c in known.top(known.dh, 2).terms())


# --- The hyperbolic family in doubles, once, for arrays, CasADi graphs and compiled loops.
#
# With g = expm1|x| and E = 1/(1 + g): sinh|x| = ½ g (1 + E), cosh x = ½ (1 + g + E). Let r be the smaller of
# sinh|x| and its inverse 2E/(1 − E²), z = r² and p = z^m, so that no power exceeds 1. Then
#
# h = ± cosh x r z^(m−1)/(1 + p) where sinh|x| ≤ 1, and ± (1 + r E)/(1 + p) beyond, as coth|x| = 1 + r E,
# h' = Σ c_k z^k/(1 + p)²  and  Σ c_k z^(2m−k)/(1 + p)²,  of the numerator Σ c_k sinh^(2k)x in (8),
# U = ln(1 + p)/(2m) + max(0, ln sinh|x|).
#
# Each branch is the whole function there, so that automatic differentiation is right on both sides and at 0,
# and both are finite everywhere.
#
# Powers up to 2m magnify the relative error of r. At every double and for every m up to 1000 the values h, U
# and h(x)/x are within 4m + 8 units in the last place of themselves. So is h' of the size of its terms; its
# relative error has no bound near its zero. A search may use these; a verdict rests on balls.


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


# --- γ_m against a number, decided exactly however close they are.


def gamma_less_than(m: int, bound_squared: Fraction) -> bool:
    """Decide γ_m² < s exactly, for every rational s; never undecided.

    Balls of rising precision decide all but equality. Equality is algebraic: at the peak, γ² = s turns into
    the quadratic R(u) = (2m(1+u) - 1)² - 4m² s u(1+u) = 0, and γ_m² = s exactly when R shares the only
    positive root of u^m - 2m u - (2m - 1), the peak.
    """
    if m == 1:
        return bound_squared > 1
    bits = 64
    while True:
        with ctx.workprec(bits):
            gap = ball_of(bound_squared) - gamma_value(m, peak_of_h(m)) ** 2
            if gap > 0 or gap < 0:
                return bool(gap > 0)
        if bits == 256 and _gamma_squared_is(m, bound_squared):
            return False
        bits *= 2


def _gamma_squared_is(m: int, s: Fraction) -> bool:
    """Whether γ_m² equals s, by the greatest common divisor of both polynomials."""
    peak = fmpq_poly([1 - 2 * m, -2 * m, *[0] * (m - 2), 1]) if m > 2 else fmpq_poly([-3, -4, 1])
    scaled = 4 * m * m * fmpq(s.numerator, s.denominator)
    touching = fmpq_poly([2 * m - 1, 2 * m]) ** 2 - scaled * fmpq_poly([0, 1, 1])
    common = peak.gcd(touching)
    return _has_positive_root(common)


def _has_positive_root(poly: fmpq_poly) -> bool:
    """Whether a polynomial of degree 2 or less, dividing one with a single positive root, has that root.

    It then has at most one positive root, a simple one, and does not vanish at 0: it has one exactly when its
    first and last coefficients have opposite signs.
    """
    return bool(poly.degree() >= 1 and poly[0] * poly[poly.degree()] < 0)
