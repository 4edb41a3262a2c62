"""The hyperbolic family in doubles, the same expressions for NumPy arrays and CasADi graphs.

With s = sinh x where |sinh x| ≤ 1, and beyond with r = 1/sinh|x|, which e^(−|x|) gives without overflow: no
power of either exceeds 1. Both branches are evaluated, each at its argument clamped to just beyond its use.
So neither overflows, and automatic differentiation meets neither 0 · ∞ nor the derivative of a clamp.

Powers up to 2m magnify the relative error of s or r. At every double and for every m up to 1000 the values
h, U and h(x)/x are within 4m + 8 units in the last place of themselves. So is h' of the size of its terms;
its relative error has no bound near its zero. A search may use these; a verdict rests on balls.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

from lyapcheck.family.base import NumericForms

BORDER = 0.8813735870195430
"""The double nearest to asinh 1, where the branches meet."""
_SLACK = 1 + 1e-9
_LN2 = 0.6931471805599453


def hyperbolic_forms(of: ModuleType, m: int, x: Any) -> NumericForms:
    """h_m, h_m', U_m, h_m(x)/x at every finite x.

    Args:
        of: ``numpy`` or ``casadi``.
        m: the member.
        x: an array of doubles, or an SX expression.
    """
    choose = of.where if hasattr(of, "where") else of.if_else
    near = _near(of, choose, m, of.fmin(of.fmax(x, -_SLACK * BORDER), _SLACK * BORDER))
    far = _far(of, m, x, of.fmax(of.fabs(x), BORDER / _SLACK))
    inside = of.fabs(x) <= BORDER
    return NumericForms(*(choose(inside, a, b) for a, b in zip(near, far, strict=True)))


def _near(of: ModuleType, choose: Any, m: int, x: Any) -> tuple[Any, ...]:
    s, c = of.sinh(x), of.cosh(x)
    rest = s ** (2 * m - 2)
    p = rest * s * s
    ratio = choose(x == 0, 1.0, s / choose(x == 0, 1.0, x))
    dh = rest * ((2 * m - 1) + 2 * m * s * s - p) / (1 + p) ** 2
    return rest * s * c / (1 + p), dh, of.log1p(p) / (2 * m), rest * ratio * c / (1 + p)


def _far(of: ModuleType, m: int, x: Any, a: Any) -> tuple[Any, ...]:
    t = of.exp(-a)
    r2 = (2 * t / (1 - t * t)) ** 2
    rest = r2 ** (m - 1)
    q = rest * r2
    h = (1 + t * t) / (1 - t * t) / (1 + q)
    dh = r2 * ((2 * m - 1) * q + 2 * m * rest - 1) / (1 + q) ** 2
    log_sinh = a - _LN2 + of.log1p(-t * t)
    return of.sign(x) * h, dh, log_sinh + of.log1p(q) / (2 * m), h / a
