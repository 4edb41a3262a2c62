"""V and dV/dt as functions of their letters in any arithmetic: floats, arrays, graphs, or code being written.

    dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀²

With C(q, w) h = C(q, h) w, which holds for Christoffel symbols, a₁ is wᵀ F w and parts without M and C, and
a₂ is linear in w. F and the gradient of a₂ are the same terms with the unit matrix in place of w.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import sympy as sp
from sympy.printing.str import StrPrinter

from lyapcheck.derive.lyapunov import (
    DEGREES,
    EPS0,
    NEAR,
    Letters,
    column,
    entries,
    force,
    symmetric,
    terms_15,
    value_13,
)

Named = Callable[[Sequence[Any]], list[Any]]
QUADRATIC = slice(2, 5)
"""Terms 3 to 5: all of a₁ that M and C enter."""


@lru_cache(maxsize=32)
def function(n: int, name: str) -> Callable[..., list[Any]]:
    """A function of values for the letters, as keywords: vectors and matrices under the names of `values_of`.

    Args:
        n: joints.
        name: ``value``: V; ``rate``: a₀, a₁, a₂; ``fast``: F by rows; ``slope``: ∂a₂/∂w;
            ``force``: Mẇ.
    """
    x = letters(n)
    outputs = OUTPUTS[name](x)
    return _compiled(outputs, x)


def letters(n: int, w: Any = None) -> Letters:
    """Entries in which C h is C(q, h) w, with letters for e/r and for C(q, h)."""
    x = entries(n, symmetric("M", n))
    Gw = sp.Matrix(n, n, _names("G")) * (x.w if w is None else w)
    return replace(x, w=x.w if w is None else w, Ch=Gw, hCh=2 * x.h.T * Gw, unit=column("n", n))


def _names(letter: str) -> Callable[[int, int], Any]:
    return lambda i, j: sp.Symbol(f"{letter}{i}_{j}")


def coefficients(x: Letters) -> list[Any]:
    """a₀, a₁, a₂."""
    terms = [term[0] for term in terms_15(replace(x, eps=NEAR))]
    sums = [sum(t for t, degree in zip(terms, DEGREES, strict=True) if degree == k) for k in range(3)]
    return [-sums[0], *sums[1:]]


def _fast(x: Letters) -> list[Any]:
    return list(sum(_per_rate(x)[QUADRATIC], sp.zeros(x.n, x.n)))


def _slope(x: Letters) -> list[Any]:
    parts = [list(term) for term, degree in zip(_per_rate(x), DEGREES, strict=True) if degree == 2]
    return [sum(each) for each in zip(*parts, strict=True)]


def _per_rate(x: Letters) -> list[Any]:
    """The terms without ε₀ and with the unit matrix in place of w."""
    return terms_15(replace(letters(x.n, sp.eye(x.n)), eps=NEAR))


OUTPUTS: dict[str, Callable[[Letters], list[Any]]] = {
    "value": lambda x: [value_13(x)[0]],
    "rate": coefficients,
    "force": lambda x: list(force(replace(x, C=sp.Matrix(x.n, x.n, _names("C"))))),
    "fast": _fast,
    "slope": _slope,
}


class _Products(StrPrinter):  # type: ignore[misc]
    """Small powers as products: a power takes longer than a product, and no other arithmetic need have it."""

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        base = self.parenthesize(expr.base, 100)
        return "*".join([base] * int(expr.exp))

    def _print_Rational(self, expr: Any) -> str:
        return repr(float(expr))


def _compiled(outputs: Sequence[Any], x: Letters) -> Callable[..., list[Any]]:
    known = sorted(set().union(*(one.free_symbols for one in outputs)), key=str)
    parts, results = sp.cse(outputs, symbols=sp.numbered_symbols("t"))
    write = _Products().doprint
    lines = [f"{name} = names([{write(value)}])[0]" for name, value in parts]
    lines += [f"return [{', '.join(map(write, results))}]"]
    body = "\n    ".join(lines)
    text = f"def formula(names, {', '.join(map(str, known))}, **_):\n    {body}\n"
    made: dict[str, Any] = {}
    exec(text, made)  # text that SymPy printed # nosec B102
    result: Callable[..., list[Any]] = made["formula"]
    return result


def values_of(name: str, values: Sequence[Any]) -> dict[str, Any]:
    """The entries of a vector or, row by row, of a matrix under their letters."""
    if values and isinstance(values[0], (list, tuple)):
        return {f"{name}{i}_{j}": v for i, row in enumerate(values) for j, v in enumerate(row)}
    return {f"{name}{i}": v for i, v in enumerate(values)}


EPS_NAME, NEAR_NAME = str(EPS0), str(NEAR)
