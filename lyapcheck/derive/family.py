"""h_m and h_m' from U_m, and the polynomials whose roots are where h_m and h_m' are largest.

With s = sinh x and cosh²x = 1 + s² all of it is rational. Equalities are decided by polynomials over ℚ alone.

References: ``reyes2019family`` (6), (8), (12).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

import sympy as sp

from lyapcheck.check.numbers.polynomials import fraction
from lyapcheck.family.base import hyperbolic

X = sp.Symbol("x", real=True)
S, C, U = sp.symbols("s c u")
_CIRCLE = sp.Poly(C**2 - 1 - S**2, C, S, domain="QQ")


@dataclass(frozen=True, eq=False)
class Member:
    """One member of the hyperbolic family, derived from its potential; `member` makes one.

    Args:
        m: of the member.
        potential: U_m(x) = ln(1 + sinh^(2m)x)/(2m).
    """

    m: int
    potential: Any

    @cached_property
    def h(self) -> Any:
        """h_m = U_m' as (6) prints it."""
        return self._printed(sp.diff(self.potential, X), 1)

    @cached_property
    def dh(self) -> Any:
        """h_m' = U_m'' as (8) prints it."""
        return self._printed(sp.diff(self.potential, X, 2), 2)

    @cached_property
    def gamma_polynomial(self) -> Any:
        """The polynomial in u = sinh²x that is 0 where h_m' is, at x > 0."""
        return self._in_u(self.dh, 2)

    @cached_property
    def rho_polynomial(self) -> Any:
        """The polynomial in u = sinh²x that is 0 where h_m'' is, at x > 0."""
        return self._in_u(sp.diff(self.dh, X), 3)

    @property
    def limit_squared(self) -> int:
        """lim h_m² as x → ∞, from the leading coefficients."""
        squared = (self.top(self.h, 1) ** 2).rem(_CIRCLE).as_expr()
        above, below = sp.Poly(squared, S), sp.Poly((1 + S ** (2 * self.m)) ** 2, S)
        assert above.degree() == below.degree()
        return int(above.LC() / below.LC())

    def top(self, form: Any, power: int) -> Any:
        """The numerator of a form over (1 + s^(2m))^power, a polynomial in s and c of degree 1 in c.

        Raises:
            sp.PolynomialError: the form is none over that.
        """
        rational = form.subs({sp.sinh(X): S, sp.cosh(X): C})
        whole = sp.cancel(rational * (1 + S ** (2 * self.m)) ** power)
        return sp.Poly(whole, C, S, domain="QQ").rem(_CIRCLE)

    def _printed(self, form: Any, power: int) -> Any:
        """The form over (1 + sinh^(2m)x)^power, each power of sinh x by itself above."""
        above = self.top(form, power).as_expr().subs({S: sp.sinh(X), C: sp.cosh(X)})
        return above / (1 + sp.sinh(X) ** (2 * self.m)) ** power

    def _in_u(self, form: Any, power: int) -> Any:
        """What of the numerator decides its sign at x > 0: without c, powers of s and a number, in u = s²."""
        terms = self.top(form, power).terms()
        least = min(in_s for (_, in_s), _ in terms)
        in_u = {((in_s - least) // 2,): value for (_, in_s), value in terms}
        return sp.Poly(in_u, U, domain="QQ").monic()


@lru_cache(maxsize=64)
def member(m: int) -> Member:
    """The member m of the hyperbolic family."""
    return Member(m, hyperbolic(m).sympy(X).potential)


def positive_roots(polynomial: Any) -> list[tuple[Fraction, Fraction]]:
    """Intervals of ℚ, each with one of the positive roots of a polynomial, in their order.

    Soundness: SymPy isolates the roots by exact arithmetic (continued fractions).
    """
    width = sp.Rational(1, 10**40)
    found = [ends for ends, _ in polynomial.sqf_part().intervals(eps=width) if ends[1] > 0]
    return [(fraction(low), fraction(high)) for low, high in found]
