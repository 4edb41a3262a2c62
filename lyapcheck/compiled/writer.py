"""Formulas written down as C: run a formula on SymPy symbols, and out come its statements in their order.

A formula that is written once for any arithmetic thus serves arrays and compiled loops alike. What is used
more than once gets a name (``Arithmetic.names``), functions always do; equal expressions are written once.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import sympy as sp
from sympy.printing.c import C99CodePrinter

from lyapcheck.family.arithmetic import Arithmetic

MOST_STATEMENTS = 6000
"""Longer loops are left to arrays: a compiler would take too long over them."""


class TooLong(Exception):
    """A formula needs more statements than are worth compiling."""


class Writer:
    """The statements so far, for one loop."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._known: dict[Any, Any] = {}
        self._print = _Printer().doprint

    def read(self, place: str) -> Any:
        """The name of what stands in a place."""
        name = sp.Symbol(f"in{len(self.lines)}")
        self.lines.append(f"const double {name} = {place};")
        return name

    def let(self, value: Any) -> Any:
        """The name of a value, which is computed once; a name or a number stays as it is.

        Raises:
            TooLong: after `MOST_STATEMENTS`.
        """
        value = sp.sympify(value)
        if value.is_Symbol or value.is_Number:
            return value
        if value not in self._known:
            if len(self.lines) >= MOST_STATEMENTS:
                raise TooLong
            self._known[value] = sp.Symbol(f"t{len(self.lines)}")
            self.lines.append(f"const double {self._known[value]} = {self._print(value)};")
        return self._known[value]

    def names(self, values: Sequence[Any]) -> list[Any]:
        """Names for several values, what they have in common taken out first."""
        if len(values) == 1:
            return [self.let(values[0])]
        fresh = sp.numbered_symbols("part")
        parts, rest = sp.cse([sp.sympify(value) for value in values], symbols=fresh)
        put: dict[Any, Any] = {}
        for symbol, part in parts:
            put[symbol] = self.let(part.xreplace(put))
        return [self.let(value.xreplace(put)) for value in rest]

    def call(self, function: str, *arguments: Any) -> Any:
        """A C function of doubles."""
        return self.let(sp.Function(function)(*map(sp.sympify, arguments)))

    def where(self, condition: Any, yes: Any, no: Any) -> Any:
        """``yes`` where a comparison of values holds, else ``no``; both are computed."""
        return self.let(sp.Piecewise((self.let(yes), condition), (self.let(no), True), evaluate=False))

    @property
    def arithmetic(self) -> Arithmetic:
        """What formulas ask of it."""

        def of(name: str) -> Any:
            return lambda *x: self.call(name, *x)

        return Arithmetic(
            where=self.where,
            fabs=of("fabs"),
            smaller=of("smaller"),
            larger=of("larger"),
            sqrt=of("sqrt"),
            log=of("v_log"),
            arctan=of("v_atan"),
            nearest=of("rint"),
            sin=of("v_sin"),
            cos=of("v_cos"),
            expm1=of("v_expm1"),
            log1p=of("v_log1p"),
            copysign=of("copysign"),
            lift=number,
            names=self.names,
        )

    def body(self, places: Sequence[str], values: Sequence[Any]) -> str:
        """The C text that computes the values and puts them into the places."""
        stores = [f"{place} = {self._print(self.let(v))};" for place, v in zip(places, values, strict=True)]
        return "\n".join([*self.lines, *stores])


def number(value: Fraction | int | float) -> Any:
    """A number: whole ones exactly, others as the nearest double."""
    return sp.Integer(int(value)) if value == int(value) else sp.Float(float(value), precision=53)


class _Printer(C99CodePrinter):  # type: ignore[misc]
    """Doubles exactly, and whole powers as products: one call of ``pow``, and no loop is a vector."""

    def _print_Pow(self, expr: Any) -> str:
        power = int(expr.exp)
        whole = "*".join([self.parenthesize(expr.base, 50)] * abs(power))
        return f"1.0/({whole})" if power < 0 else f"({whole})"

    def _print_Float(self, expr: Any) -> str:
        return float(expr).hex()

    def _print_Integer(self, expr: Any) -> str:
        return f"{int(expr)}.0"

    def _print_Rational(self, expr: Any) -> str:
        return f"{int(expr.p)}.0/{int(expr.q)}.0"

    def _print_Function(self, expr: Any) -> str:
        return f"{expr.func.__name__}({', '.join(map(self._print, expr.args))})"
