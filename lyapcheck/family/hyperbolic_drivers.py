"""The numeric hyperbolic family over NumPy arrays and CasADi graphs."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import copysign, isnan
from typing import TYPE_CHECKING, Any

from lyapcheck.family.arithmetic import FLOATS, arrays, graphs
from lyapcheck.family.base import NumericForms
from lyapcheck.family.double_double import Pair, exact_graph
from lyapcheck.family.hyperbolic_numeric import BORDER, Far, Near

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lyapcheck.family.base import Doubles

Form = Callable[[Any], Pair]
"""One of the four forms, asked of a ``Near`` or a ``Far``."""

_HANDFUL = 24
"""Up to here a loop over floats is faster than array operations."""

_SLACK = 1 + 1e-9

_BLOCK = 4096
"""Elements worked on at a time: the intermediate results stay in the cache."""


def on_array(m: int, x: ArrayLike, form: Form, odd: bool) -> Doubles:
    """One form of h_m at every element of an array; NaN stays NaN, an infinity gives the limit."""
    import numpy as np

    x = np.asarray(x, dtype=float)
    flat = x.reshape(-1)
    if flat.size <= _HANDFUL:
        values = np.array([_on_float(m, value, form, odd) for value in flat.tolist()], dtype=float)
        return values.reshape(x.shape)
    result = np.empty_like(flat)
    with np.errstate(all="ignore"):
        for start in range(0, flat.size, _BLOCK):
            block = slice(start, start + _BLOCK)
            result[block] = _on_block(m, np.abs(flat[block]), form)
    return (np.copysign(result, flat) if odd else result).reshape(x.shape)


def _on_float(m: int, x: float, form: Form, odd: bool) -> float:
    if isnan(x):
        return x
    a = abs(x)
    value = form(Near(FLOATS, m, a) if a <= BORDER else Far(FLOATS, m, a))[0]
    return copysign(value, x) if odd else value


def _on_block(m: int, a: Doubles, form: Form) -> Doubles:
    import numpy as np

    result = a.copy()
    near, far = np.flatnonzero(a <= BORDER), np.flatnonzero(a > BORDER)
    if near.size:
        result[near] = form(Near(arrays(), m, a[near]))[0]
    if far.size:
        result[far] = form(Far(arrays(), m, a[far]))[0]
    return result


def as_graph(m: int, x: Any) -> NumericForms:
    """The four forms, elementwise, at a CasADi SX expression of any shape."""
    import casadi as ca

    with exact_graph():
        elements = [_scalar_graph(m)(element) for element in ca.vertsplit(ca.vec(x))]
        columns = zip(*elements, strict=True)
        return NumericForms(*(ca.reshape(ca.vertcat(*column), *x.shape) for column in columns))


@lru_cache(maxsize=64)
def _scalar_graph(m: int) -> Any:
    """The four forms of one number as a CasADi function, which is quicker to copy than to build.

    Each branch sees its argument clamped to just beyond where it is used, so that the derivative of a branch
    in use is never that of a clamp.
    """
    import casadi as ca

    of, x = graphs(), ca.SX.sym("x")
    with exact_graph():
        near = Near(of, m, of.smaller(of.larger(x, -_SLACK * BORDER), _SLACK * BORDER))
        far = Far(of, m, of.larger(of.fabs(x), BORDER / _SLACK))
        inside = of.fabs(x) <= BORDER
        pairs = (
            (near.h(), (ca.sign(x) * far.h()[0],)),
            (near.dh(), far.dh()),
            (near.potential(), far.potential()),
            (near.secant(), far.secant()),
        )
        return ca.Function("hyperbolic", [x], [of.where(inside, a[0], b[0]) for a, b in pairs])
