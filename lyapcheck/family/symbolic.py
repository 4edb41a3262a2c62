"""The hyperbolic family in SymPy for a symbol or a whole number m.

References: ``reyes2019family`` (6), (8), (12).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from lyapcheck.family.base import SymbolicForms


def hyperbolic_symbolic(x: Any, m: Any) -> SymbolicForms:
    """U = ln(1 + sinh^(2m)x) / (2m), and h = dU/dx and h' = d²U/dx² derived from it.

    Args:
        x: any SymPy expression.
        m: a positive SymPy symbol, or a whole number.
    """
    import sympy as sp

    symbol = sp.Dummy("x", real=True)
    potential = sp.log(1 + sp.sinh(symbol) ** (2 * m)) / (2 * m)
    h = sp.diff(potential, symbol)
    dh = sp.diff(h, symbol)
    return SymbolicForms(*(form.subs(symbol, x) for form in (h, dh, potential)))


@lru_cache(maxsize=64)
def slope_terms(m: int) -> tuple[tuple[int, int], ...]:
    """(c, k) of the terms c sinh^(2k)x of h_m' times (1 + sinh^(2m)x)², as SymPy derives them."""
    from lyapcheck.derive.family import member

    known = member(m)
    return tuple((int(c), power // 2) for (_, power), c in known.top(known.dh, 2).terms())
