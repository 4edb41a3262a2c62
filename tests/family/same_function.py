"""The formulas of the paper in SymPy, and a normal form in which formulas of the family are compared."""

import sympy as sp

from lyapcheck.family.base import SymbolicForms


def hyperbolic_printed(x, m):
    """h as printed in (6), its derivative as printed in (8), and U as in (12)."""
    s, c = sp.sinh(x), sp.cosh(x)
    h = s ** (2 * m - 1) * c / (1 + s ** (2 * m))
    top = (2 * m - 1) * s ** (2 * m - 2) + 2 * m * s ** (2 * m) - s ** (4 * m - 2)
    return SymbolicForms(h, top / (1 + s ** (2 * m)) ** 2, sp.log(1 + s ** (2 * m)) / (2 * m))


def same_function(left, right, x, m):
    """Whether two formulas in sinh x, cosh x, sinh^(2m)x and m are the same function, for all m at once.

    Both are rational in S = sinh x, C = cosh x, P = sinh^(2m)x and m, with C² = 1 + S². The numerator of
    their difference is divided by C² - 1 - S²: the remainder, a normal form, is zero or it is not.

    Raises:
        ValueError: an expression that is not of this kind.

    Soundness: no polynomial relation holds between m, sinh x and sinh^(2m)x for every m, so a remainder of
    zero is sufficient and, for a symbolic m, necessary.
    """
    s, c, p = sp.Dummy("S"), sp.Dummy("C"), sp.Dummy("P")
    difference = _algebraic(left - right, x, m, (s, c, p))
    top, _ = sp.fraction(sp.together(difference))
    generators = (c, s, p, *((m,) if isinstance(m, sp.Symbol) else ()))
    if top.free_symbols - set(generators):
        raise ValueError(f"not rational in sinh x, cosh x and sinh^(2m)x: {left - right}")
    return bool(sp.Poly(top, *generators).rem(sp.Poly(c**2 - 1 - s**2, *generators)).is_zero)


def _algebraic(expression, x, m, names):
    """The expression with its powers of sinh x written as powers of S and P."""
    s, c, p = names

    def power(base, exponent):
        if base != sp.sinh(x):
            return sp.Pow(base, exponent)
        rest, pairs = exponent, sp.Integer(0)
        if isinstance(m, sp.Symbol):
            pairs = sp.Poly(exponent, m).coeff_monomial(m) / 2
            rest = sp.expand(exponent - 2 * pairs * m)
        return p**pairs * s**rest

    return sp.expand_power_base(expression).replace(sp.Pow, power).subs({sp.sinh(x): s, sp.cosh(x): c})
