"""Straight-line programs: each step is one operation that rounds, printed as C and run in any arithmetic.

What is printed and what is analysed is the same list of steps, in the same order.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import arb

from lyapcheck.check.numbers.balls import to_arb

SIGNS = {"add": "+", "sub": "-", "mul": "*", "div": "/"}
APPLIED: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
}


class Program:
    """Steps so far; equal steps are one."""

    def __init__(self) -> None:
        self.steps: list[tuple[Any, ...]] = []
        self._known: dict[tuple[Any, ...], int] = {}

    def step(self, *what: Any) -> Step:
        """The value of an operation on the numbers of earlier steps."""
        if what not in self._known:
            self._known[what] = len(self.steps)
            self.steps.append(what)
        return Step(self, self._known[what])

    def read(self, name: str) -> Step:
        return self.step("read", name)

    def number(self, value: Fraction | int) -> Step:
        """An exact number, which C has as the nearest double."""
        return self.step("number", Fraction(value))

    def _needed(self, outputs: Sequence[Step]) -> list[int]:
        wanted = {output.index for output in outputs}
        for index in range(len(self.steps) - 1, -1, -1):
            if index in wanted and self.steps[index][0] in APPLIED:
                wanted |= set(self.steps[index][1:])
        return sorted(wanted)

    def run(
        self, outputs: Sequence[Step], given: Mapping[str, Any], lift: Callable[[Fraction], Any]
    ) -> list[Any]:
        """The outputs in the arithmetic of what is given; ``lift`` makes its values of exact numbers."""
        values: dict[int, Any] = {}
        for index in self._needed(outputs):
            kind, *rest = self.steps[index]
            if kind == "read":
                values[index] = given[rest[0]]
            elif kind == "number":
                values[index] = lift(rest[0])
            else:
                values[index] = APPLIED[kind](*(values[part] for part in rest))
        return [values[output.index] for output in outputs]

    def text(self, outputs: Mapping[str, Step], indent: str = "    ", letter: str = "t") -> str:
        """The C statements that put the outputs into their places, one operation a line.

        Names of steps begin with a letter: those of nested blocks with different ones.
        """
        names, lines = {}, []
        for index in self._needed(list(outputs.values())):
            kind, *rest = self.steps[index]
            if kind == "read":
                names[index] = rest[0]
                continue
            if kind == "number":
                names[index] = constant(rest[0])
                continue
            first, *second = (names[part] for part in rest)
            names[index] = f"{letter}{index}"
            formula = f"{first} {SIGNS[kind]} {second[0]}" if kind in SIGNS else f"-{first}"
            lines.append(f"const double {names[index]} = {formula};")
        lines += [f"{place} = {names[step.index]};" for place, step in outputs.items()]
        return "\n".join(indent + line for line in lines)


def constant(value: Fraction | float) -> str:
    """The nearest double as C99 has it exactly; in brackets below 0, so that it can follow a sign."""
    text = float(value).hex()
    return f"({text})" if text.startswith("-") else text


def _binary(kind: str) -> tuple[Callable[[Step, Any], Step], Callable[[Step, Any], Step]]:
    """An operation with a step or a number on its right, and on its left."""

    def value(one: Step, other: Any) -> Step:
        return other if isinstance(other, Step) else one.of.number(other)

    return (
        lambda one, other: one.of.step(kind, one.index, value(one, other).index),
        lambda one, other: one.of.step(kind, value(one, other).index, one.index),
    )


@dataclass(frozen=True)
class Step:
    """The value of a step, for formulas that are written once for any arithmetic."""

    of: Program
    index: int

    def __neg__(self) -> Step:
        return self.of.step("neg", self.index)

    __add__, __radd__ = _binary("add")
    __sub__, __rsub__ = _binary("sub")
    __mul__, __rmul__ = _binary("mul")
    __truediv__, __rtruediv__ = _binary("div")


# --- Running errors: how far a program in doubles is from the same program in real numbers, in balls.
#
# A value is a ball that holds the exact number, and a bound of |computed − exact|. With u = 2⁻⁵³ and
# η = 2⁻¹⁰⁷⁴ one operation of IEEE 754, to nearest, gives x̂ ∘ ŷ up to u |x̂ ∘ ŷ| + η. The bounds hold as well
# where a compiler fuses a product with a sum: that leaves out a rounding that is counted here.
#
# References: running error analysis, ``higham2002accuracy`` section 3.3.


BITS = 160
U = arb(2) ** -53
TINY = arb(2) ** -1074
LARGEST = arb(2) ** 1000
"""No value may come near the largest double, so that nothing overflows."""


class Unbounded(ArithmeticError):
    """An operation whose error has no bound over these balls: a divisor that may be 0, or an overflow."""


@dataclass(frozen=True)
class Rounded:
    """A number and its computed double.

    Args:
        exact: a ball that holds the number.
        error: at least |computed − exact|.
    """

    exact: arb
    error: arb

    @classmethod
    def constant(cls, value: Fraction) -> Rounded:
        """An exact number, which C has as the nearest double."""
        return cls(to_arb(value), upper(to_arb(abs(Fraction(float(value)) - value))))

    @property
    def size(self) -> arb:
        """At least |computed| and |exact|."""
        return upper(self.exact.abs_upper() + self.error)

    def __add__(self, other: Rounded) -> Rounded:
        return _rounded(self.exact + other.exact, self.error + other.error)

    def __sub__(self, other: Rounded) -> Rounded:
        return _rounded(self.exact - other.exact, self.error + other.error)

    def __mul__(self, other: Rounded) -> Rounded:
        # x̂ŷ − xy = (x̂ − x) ŷ + x (ŷ − y)
        error = self.error * other.size + self.exact.abs_upper() * other.error
        return _rounded(self.exact * other.exact, error)

    def __truediv__(self, other: Rounded) -> Rounded:
        # x̂/ŷ − x/y = ((x̂ − x) − (x/y) (ŷ − y))/ŷ
        least = (other.exact.abs_lower() - other.error).lower()
        if not least > 0:
            raise Unbounded("a divisor may be 0")
        exact = self.exact / other.exact
        return _rounded(exact, (self.error + exact.abs_upper() * other.error) / least)

    def __neg__(self) -> Rounded:
        return Rounded(-self.exact, self.error)


def _rounded(exact: arb, error: arb) -> Rounded:
    """After one rounding of a computed result within ``error`` of ``exact``."""
    size = upper(exact.abs_upper() + error)
    if not size < LARGEST:
        raise Unbounded("a value may overflow")
    return Rounded(exact, upper(error + U * size + TINY))


def upper(x: arb) -> arb:
    """The upper end of a ball, exactly."""
    return x.upper()
