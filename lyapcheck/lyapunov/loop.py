"""Formulas of many lanes as one C loop, printed by SymPy and kept under the digest of the question."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp
from sympy.printing.c import C99CodePrinter

from lyapcheck import store
from lyapcheck._types import Array
from lyapcheck.family.base import Arithmetic
from lyapcheck.lyapunov.compiler import compiler, library, machine, over_shares, prelude

LANES = 64
"""Lanes worked on together."""
SHARE = 4096
"""Lanes from which a second processor is worth waking."""
Formula = Callable[[Any, Sequence[Sequence[Any]]], Sequence[Any]]
"""(writer, the entries of each array) ↦ the outputs."""


class Loop:
    """A compiled function of arrays; `loop` makes one.

    Soundness: plain doubles, rounded to nearest, without bounds. A lane does not depend on its company.
    """

    def __init__(self, run: Any, outputs: int) -> None:
        self._run, self.outputs = run, outputs

    def __call__(self, *arrays: Array, out: Array | None = None) -> Array:
        """The outputs (outputs, lanes) of arrays (entries, lanes) with any strides, in ``out`` if given."""
        lanes = arrays[0].shape[1]
        out = np.empty((self.outputs, lanes)) if out is None else out
        every = (*arrays, out)
        at = (ctypes.c_void_p * len(every))(*(x.__array_interface__["data"][0] for x in every))
        steps = (ctypes.c_long * (2 * len(every)))(*(s // 8 for x in every for s in x.strides))

        def share(start: int, stop: int) -> None:
            self._run(start, stop, at, steps)

        if lanes < 2 * SHARE:
            share(0, lanes)
        else:
            over_shares(share, lanes, LANES)
        return out


def loop(question: Sequence[object], sizes: Sequence[int], outputs: int, formula: Formula) -> Loop | None:
    """The loop that answers a question; none where there is no compiler, or the formula is too long.

    Args:
        question: all that the formula depends on, such as an arm and a family; equal questions share a loop.
        sizes: entries a lane of each array.
        outputs: how many numbers come out a lane.
        formula: writes the statements; asked only where the loop is not kept already.
    """
    made: list[Loop | None] = _made(_key(question, sizes), str(store.home()), compiler())
    if not made:
        known = compiled((*question, *sizes), lambda: source(sizes, outputs, formula))
        if known is not None:
            known.run.restype = None
            known.run.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
        made.append(None if known is None else Loop(known.run, outputs))
    return made[0]


def compiled(question: Sequence[object], write: Callable[[], str | None]) -> ctypes.CDLL | None:
    """The library of the C text that answers a question; none where there is no compiler or no text.

    Args:
        question: all that the text depends on besides the source of lyapcheck.
        write: the text; asked only where nothing is kept under the question.
    """
    command = compiler()
    if command is None:
        return None
    return library(store.exact(_key(question), machine(command)), command, write)


def _key(*question: object) -> str:
    return store.exact(*question, store.source_digest())


@lru_cache(maxsize=64)
def _made(key: str, home: str, command: str | None) -> list[Loop | None]:
    """A place for the loop of a question, cache and compiler; empty until it is made."""
    return []


def source(sizes: Sequence[int], outputs: int, formula: Formula) -> str | None:
    """The C text; none where it is too long."""

    writer, ends = Writer(), [sum(sizes[:k]) for k in range(len(sizes) + 1)]
    try:
        inputs = [writer.read(f"x[{i}][l]") for i in range(ends[-1])]
        values = formula(writer, [inputs[a:b] for a, b in pairwise(ends)])
        body = writer.body([f"y[{k}][l]" for k in range(outputs)], values)
    except TooLong:
        return None
    numbers = {"GROUPS": len(sizes), "INPUTS": ends[-1], "OUTPUTS": outputs, "LANES": LANES}
    defines = [f"#define {name} {value}" for name, value in numbers.items()]
    defines.append(f"static const int SIZES[] = {{{', '.join(map(str, sizes))}}};")
    text = files("lyapcheck.lyapunov").joinpath("loop.c").read_text(encoding="utf-8")
    return "\n".join([prelude(), *defines, text.replace("BODY", body)])


# --- Formulas written down as C: run a formula on SymPy symbols, and out come its statements in their order.
#
# A formula that is written once for any arithmetic thus serves arrays and compiled loops alike. What is used
# more than once gets a name (``Arithmetic.names``), functions always do; equal expressions are written once.


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
