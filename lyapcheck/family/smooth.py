"""The hyperbolic family in plain doubles as short CasADi expressions, for optimisers.

Both branches are evaluated on clamped arguments, so that neither overflows and automatic differentiation
never meets 0 · ∞. Rounding errors grow with 2m, and near the zero of h' its relative error is unbounded: a
search may use these, a verdict may not.
"""

from __future__ import annotations

from typing import Any

from lyapcheck.family.base import NumericForms

_SLACK = 1 + 1e-9
"""Clamps act just beyond the border between the branches, so that none is differentiated there."""


def smooth_forms(m: int, x: Any) -> NumericForms:
    """h_m, h_m', U_m, h_m(x)/x at a CasADi SX expression, stable for every finite double.

    For |x| <= 1 from s = sinh x, beyond from r = 1/sinh|x|, which e^(-|x|) gives without overflow.
    """
    import casadi as ca

    near = _near(ca, m, ca.fmin(ca.fmax(x, -_SLACK), _SLACK))
    far = _far(ca, m, x, ca.fmax(ca.fabs(x), 1 / _SLACK))
    inside = ca.fabs(x) <= 1
    return NumericForms(*(ca.if_else(inside, a, b) for a, b in zip(near, far, strict=True)))


def _near(ca: Any, m: int, x: Any) -> tuple[Any, Any, Any, Any]:
    s, c = ca.sinh(x), ca.cosh(x)
    rest = s ** (2 * m - 2)
    p = rest * s * s
    ratio = ca.if_else(x == 0, 1, s / ca.if_else(x == 0, 1, x))
    dh = rest * (2 * m - 1 + 2 * m * s * s - p) / (1 + p) ** 2
    return rest * s * c / (1 + p), dh, ca.log1p(p) / (2 * m), rest * ratio * c / (1 + p)


def _far(ca: Any, m: int, x: Any, a: Any) -> tuple[Any, Any, Any, Any]:
    t = ca.exp(-a)
    r2 = (2 * t / (1 - t * t)) ** 2
    rest = r2 ** (m - 1)
    q = rest * r2
    h = (1 + t * t) / (1 - t * t) / (1 + q)
    dh = r2 * ((2 * m - 1) * q + 2 * m * rest - 1) / (1 + q) ** 2
    log_sinh = a - 0.6931471805599453 + ca.log1p(-t * t)
    return ca.sign(x) * h, dh, log_sinh + ca.log1p(q) / (2 * m), h / a
