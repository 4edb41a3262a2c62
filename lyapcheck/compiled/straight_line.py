"""Formulas recorded as straight-line C: run a formula on `Term`s, and out come its statements.

A formula that is written once for any arithmetic thus serves arrays and compiled loops alike. Equal
subexpressions are recorded once; what a result does not need, the C compiler drops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

Scalar = int | float | Fraction


MOST_STATEMENTS = 4000
"""Longer lines are left to arrays: a compiler would take too long over them."""


class TooLong(Exception):
    """A formula needs more statements than are worth compiling."""


@dataclass(frozen=True, eq=False)
class Term:
    """A double in recorded code: ``text`` is a C name or literal, ``value`` is known for literals only."""

    code: StraightLine
    text: str
    value: float | None = None

    def __add__(self, other: Term | Scalar) -> Term:
        return self.code.sum(self, self.code.term(other))

    def __radd__(self, other: Scalar) -> Term:
        return self.code.sum(self.code.term(other), self)

    def __sub__(self, other: Term | Scalar) -> Term:
        return self.code.difference(self, self.code.term(other))

    def __rsub__(self, other: Scalar) -> Term:
        return self.code.difference(self.code.term(other), self)

    def __mul__(self, other: Term | Scalar) -> Term:
        return self.code.product(self, self.code.term(other))

    def __rmul__(self, other: Scalar) -> Term:
        return self.code.product(self.code.term(other), self)

    def __truediv__(self, other: Term | Scalar) -> Term:
        return self.code.quotient(self, self.code.term(other))

    def __rtruediv__(self, other: Scalar) -> Term:
        return self.code.quotient(self.code.term(other), self)

    def __neg__(self) -> Term:
        return self.code.term(-self.value) if self.value is not None else self.code.record(f"-{self.text}")

    def __abs__(self) -> Term:
        return self.code.call("fabs", self)

    def __lt__(self, other: Term | Scalar) -> str:
        return f"{self.text} < {self.code.term(other).text}"

    def __le__(self, other: Term | Scalar) -> str:
        return f"{self.text} <= {self.code.term(other).text}"

    def __gt__(self, other: Term | Scalar) -> str:
        return f"{self.text} > {self.code.term(other).text}"

    __hash__ = None  # type: ignore[assignment]  # a term is no key: compare its text


@dataclass(eq=False)
class StraightLine:
    """The statements recorded so far."""

    lines: list[str] = field(default_factory=list)
    known: dict[str, Term] = field(default_factory=dict)

    def term(self, value: Term | Scalar) -> Term:
        """A term as it is; a number as the nearest double, written exactly."""
        if isinstance(value, Term):
            return value
        number = float(value)
        return Term(self, f"({number.hex()})" if number < 0 else number.hex(), number)

    def name(self, text: str) -> Term:
        """A C expression without side effects that the surrounding code provides."""
        return Term(self, text)

    def record(self, expression: str) -> Term:
        """The value of a C expression, computed once.

        Raises:
            TooLong: after `MOST_STATEMENTS`.
        """
        if expression not in self.known:
            if len(self.lines) >= MOST_STATEMENTS:
                raise TooLong
            known = self.known[expression] = Term(self, f"t{len(self.known)}")
            self.lines.append(f"const double {known.text} = {expression};")
        return self.known[expression]

    def call(self, function: str, *arguments: Term | Scalar) -> Term:
        """A C function of doubles."""
        return self.record(f"{function}({', '.join(self.term(x).text for x in arguments)})")

    def where(self, condition: str, yes: Term | Scalar, no: Term | Scalar) -> Term:
        """``yes`` where the condition (a comparison of terms) holds, else ``no``; both are computed."""
        return self.record(f"{condition} ? {self.term(yes).text} : {self.term(no).text}")

    def sum(self, a: Term, b: Term) -> Term:
        """a + b."""
        if a.value == 0 or b.value == 0:
            return b if a.value == 0 else a
        return self.record(f"{a.text} + {b.text}")

    def difference(self, a: Term, b: Term) -> Term:
        """a − b."""
        if a.value == 0 or b.value == 0:
            return -b if a.value == 0 else a
        return self.record(f"{a.text} - {b.text}")

    def product(self, a: Term, b: Term) -> Term:
        """a · b; 0 times anything is 0: recorded factors are finite wherever a kernel is used."""
        if a.value == 0 or b.value == 0:
            return self.term(0)
        if a.value == 1 or b.value == 1:
            return b if a.value == 1 else a
        return self.record(f"{a.text} * {b.text}")

    def quotient(self, a: Term, b: Term) -> Term:
        """a / b."""
        return a if b.value == 1 else self.record(f"{a.text} / {b.text}")

    def store(self, places: Sequence[str], values: Sequence[Any]) -> str:
        """The C text that computes the values and puts them into the places."""
        stores = [f"{place} = {self.term(value).text};" for place, value in zip(places, values, strict=True)]
        return "\n".join([*self.lines, *stores])
