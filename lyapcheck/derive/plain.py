"""h, h' and U of a family in plain doubles, short and without branches, in any arithmetic.

With g = expm1|x|, E = 1/(1 + g) = e^(−|x|), D = gE(1 + E) = 1 − E², F = 1 + E², A = D² and Q = 4E²

    sinh|x| = D/2E,   cosh x = F/2E,   sinh²x = A/Q,

so that what SymPy has derived over 1 + sinh^(2m)x = 1/(Q^m R), R = 1/(A^m + Q^m), becomes polynomials in A
and Q times powers of R, none of which overflows:

    h = ± D F A^(m−1) R,   h' = R² Σ c_k A^k Q^(2m−k) of the numerator Σ c_k sinh^(2k)x in (8),
    U = ln(1 + p^(2m))/(2m) + max(0, ln sinh|x|),   p the smaller of sinh|x| and its inverse.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import Any, Protocol

from lyapcheck.family import Family
from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.base import NumericForms
from lyapcheck.family.elementary import ElementaryFamily

LARGEST_MEMBER = 64
"""Powers up to 2m magnify a relative error 2m times; from here on a family's own forms are needed."""
FARTHEST = 700.0
"""|x| from which h is 1 and h' is 0 in doubles."""
LN2 = 0.6931471805599453


class Forms(Protocol):
    """h(x), h'(x) and U(x) in one arithmetic; each is worked out when it is asked for."""

    @property
    def h(self) -> Any:
        """h(x)."""

    @property
    def dh(self) -> Any:
        """h'(x)."""

    @property
    def potential(self) -> Any:
        """U(x)."""


def has_plain_forms(family: Family) -> bool:
    """Whether a family can be written in plain doubles."""
    known = family.name in ("linear", "hyperbolic", "tanh") or isinstance(family, ElementaryFamily)
    return known and (family.m or 1) <= LARGEST_MEMBER


def plain_forms(family: Family, of: Arithmetic, x: Any) -> Forms:
    """The forms of one of the families that have them."""
    if family.name in ("hyperbolic", "tanh"):
        return Hyperbolic(family.m or 1, of, x)
    if isinstance(family, ElementaryFamily):
        return family.numeric(of, x)
    return NumericForms(h=x, dh=of.lift(1), potential=0.5 * x * x, secant=of.lift(1))


@lru_cache(maxsize=64)
def slope_terms(m: int) -> tuple[tuple[int, int, int], ...]:
    """(c, j, k) of the terms c A^j Q^k of h'/R² from (8), as SymPy derives it.

    Where (8) is in lower terms, as for m = 1, both sides are multiplied by 1 + sinh^(2m)x again.
    """
    from lyapcheck.derive.family import member

    known = member(m)
    return tuple((int(c), power // 2, 2 * m - power // 2) for (_, power), c in known.top(known.dh, 2).terms())


class Hyperbolic:
    """The hyperbolic family, member m.

    Soundness: some 4m units in the last place, near the zero of h' of its largest term. NaN stays NaN.
    """

    def __init__(self, m: int, of: Arithmetic, x: Any) -> None:
        self.m, self.of, self.x = m, of, x
        self.a = of.name(of.fabs(x))
        g = of.name(of.expm1(of.smaller(self.a, FARTHEST)))
        self.E = of.name(1.0 / (1.0 + g))
        self.D = of.name(g * self.E * (1.0 + self.E))
        self._powers: dict[tuple[str, int], Any] = {}

    @cached_property
    def R(self) -> Any:
        """1/(A^m + Q^m)."""
        return self.of.name(1.0 / (self.power("A", self.m) + self.power("Q", self.m)))

    @cached_property
    def h(self) -> Any:
        """h(x)."""
        size = self.D * self.of.name(1.0 + self.E * self.E)
        if self.m > 1:
            size = size * self.power("A", self.m - 1)
        return self.of.name(self.of.copysign(size * self.R, self.x))

    @cached_property
    def dh(self) -> Any:
        """h'(x)."""
        terms = slope_terms(self.m)
        low_a, low_q = (min(row[k] for row in terms) for k in (1, 2))
        inner = [c * self._product(j - low_a, k - low_q) for c, j, k in terms]
        total = inner[0]
        for term in inner[1:]:
            total = total + term
        return self.of.name(total * self._product(low_a, low_q) * (self.R * self.R))

    @cached_property
    def potential(self) -> Any:
        """U(x)."""
        of, twice = self.of, 2.0 * self.E
        self._powers["p", 1] = of.name(of.smaller(self.D, twice) / of.larger(self.D, twice))
        log_sinh = (self.a - LN2) + of.log(of.larger(self.D, 1e-300))
        rest = of.log1p(self.power("p", 2 * self.m)) * (1.0 / (2 * self.m))
        return of.name(rest + of.larger(log_sinh, 0.0))

    def power(self, name: str, k: int) -> Any:
        """A power of A, Q or p by squaring."""
        if (name, k) not in self._powers:
            if k == 1:
                value = self.D * self.D if name == "A" else 4.0 * (self.E * self.E)
            else:
                value = self.power(name, k // 2) * self.power(name, k - k // 2)
            self._powers[name, k] = self.of.name(value)
        return self._powers[name, k]

    def _product(self, j: int, k: int) -> Any:
        """A^j Q^k."""
        parts = [self.power(name, power) for name, power in (("A", j), ("Q", k)) if power]
        return parts[0] if len(parts) == 1 else parts[0] * parts[1] if parts else 1
