"""Elementary functions of the numbers of the oracle, with the domain of each."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import isqrt
from typing import Any

from mpmath import mp, mpf

from tests.statement_fuzz.oracle import exact
from tests.statement_fuzz.oracle.exact import Polynomial, TooLong
from tests.statement_fuzz.oracle.numbers import Num, Undefined, Unsure, Value, lifted, made, sign

LARGEST = mpf(10) ** 1000
AT_ZERO = {"exp": 1, "cos": 1, "cosh": 1, "sin": 0, "tan": 0, "sinh": 0, "tanh": 0, "atan": 0, "asin": 0}
HALF, QUARTER = Fraction(1, 2), Fraction(1, 4)


def apply(name: str, value: Value) -> Value:
    """A function of a number.

    Raises:
        Undefined: the number is certainly outside the domain.
        Unsure: it may be, or the result is out of reach.
    """
    if value == 0 and name in AT_ZERO:
        return Fraction(AT_ZERO[name])
    return BY_NAME[name](value)


def _absolute(value: Value) -> Value:
    if isinstance(value, Num) and value.low < 0 < value.high:
        try:
            return value if sign(value) >= 0 else -value
        except Unsure:
            return made(mpf(0), max(-value.low, value.high), None)
    return value if sign(value) >= 0 else -value


def _root(value: Value) -> Value:
    try:
        negative = sign(value) < 0
    except Unsure:
        if lifted(value).low < 0:
            raise
        negative = False
    if negative:
        raise Undefined("the root of a negative number")
    if isinstance(value, Fraction):
        top, bottom = isqrt(value.numerator), isqrt(value.denominator)
        if top**2 == value.numerator and bottom**2 == value.denominator:
            return Fraction(top, bottom)
        short = exact.KEPT[0] and value.numerator < 10**9 > value.denominator
        form: Polynomial | None = exact.root(value) if short else None
        near = mp.sqrt(lifted(value).low), mp.sqrt(lifted(value).high)
        return made(*near, form)
    return made(mp.sqrt(max(value.low, 0)), mp.sqrt(value.high), form_of_root(value))


def form_of_root(value: Num) -> Polynomial | None:
    """The root of what has an exact form, as an atom with its square."""
    return None if value.form is None else exact.nested_root(value.form)


def _logarithm(value: Value) -> Value:
    if sign(value) <= 0:
        raise Undefined("the logarithm of a number that is not positive")
    if value == 1:
        return Fraction(0)
    wide = lifted(value)
    small = exact.KEPT[0] and isinstance(value, Fraction) and value.numerator < 10**9 > value.denominator
    form = exact.logarithm(value) if small else _opaque("log", wide)  # type: ignore[arg-type]
    return made(mp.log(wide.low), mp.log(wide.high), form)


def _opaque(name: str, value: Num) -> Polynomial | None:
    return None if value.form is None else exact.atom(name, exact.canonical(value.form))


def _exponential(value: Value) -> Value:
    wide = lifted(value)
    if max(abs(wide.low), abs(wide.high)) > LARGEST:
        raise Unsure
    return made(mp.exp(wide.low), mp.exp(wide.high), _exp_form(value))


def _exp_form(value: Value) -> Polynomial | None:
    if not exact.KEPT[0]:
        return None
    if isinstance(value, Fraction) and abs(value.numerator) < 1000:
        return {((("exp", str(value.denominator)), value.numerator),): Fraction(1)}
    return None if isinstance(value, Fraction) else _opaque("exp", value)


def _hyperbolic(name: str) -> Callable[[Value], Value]:
    def of(value: Value) -> Value:
        wide = lifted(value)
        if max(abs(wide.low), abs(wide.high)) > LARGEST:
            raise Unsure
        ends = sorted(getattr(mp, name)(end) for end in (wide.low, wide.high))
        if name == "cosh" and wide.low < 0 < wide.high:
            ends[0] = mpf(1)
        return made(*ends, _hyperbolic_form(name, _exp_form(value)))

    return of


def _hyperbolic_form(name: str, grow: Polynomial | None) -> Polynomial | None:
    if grow is None:
        return None
    try:
        fall = exact.inverse(grow)
        sum_ = exact.scale(exact.add(grow, fall), HALF)
        difference = exact.scale(exact.add(grow, exact.scale(fall, Fraction(-1))), HALF)
        if name == "tanh":
            return exact.mul(difference, exact.inverse(sum_))
    except TooLong:
        return None
    return sum_ if name == "cosh" else difference


def _circular(name: str) -> Callable[[Value], Value]:
    def of(value: Value) -> Value:
        wide = lifted(value)
        if max(abs(wide.low), abs(wide.high)) > LARGEST:
            raise Unsure
        known = None if wide.form is None else _at_turns(name, exact.turns(wide.form))
        if known is not None and exact.as_rational(known) is not None:
            return exact.as_rational(known)  # type: ignore[return-value]
        middle, reach = (wide.low + wide.high) / 2, (wide.high - wide.low) / 2
        at = getattr(mp, name)(middle)
        low, high = max(at - reach, mpf(-1)), min(at + reach, mpf(1))
        return made(low, high, known if known is not None else _circle_form(name, wide))

    return of


def _circle_form(name: str, value: Num) -> Polynomial | None:
    return None if value.form is None else exact.atom(name, exact.canonical(value.form))


def _at_turns(name: str, turns: Fraction | None) -> Polynomial | None:
    """The sine or cosine of a multiple of π/6 or π/4."""
    if turns is None:
        return None
    turns = (turns if name == "sin" else turns + HALF) % 2
    positive = turns <= 1
    inside = turns % 1
    inside = min(inside, 1 - inside)
    known = {Fraction(0): {}, HALF: exact.constant(Fraction(1)), Fraction(1, 6): exact.constant(HALF)}
    known[QUARTER] = exact.root(HALF)
    known[Fraction(1, 3)] = exact.root(Fraction(3, 4))
    result = known.get(inside)
    return None if result is None else exact.scale(result, Fraction(1 if positive else -1))


def _tangent(value: Value) -> Value:
    cosine = apply("cos", value)
    if sign(cosine) == 0:
        raise Undefined("the tangent where the cosine vanishes")
    wide = lifted(value)
    if wide.high - wide.low > 3:
        raise Unsure
    return made(mp.tan(wide.low), mp.tan(wide.high), _circle_form("tan", wide))


def _arc(name: str) -> Callable[[Value], Value]:
    def of(value: Value) -> Value:
        wide = lifted(value)
        if name != "atan":
            if wide.low > 1 or wide.high < -1 or (isinstance(value, Fraction) and abs(value) > 1):
                raise Undefined("an arc of a number above 1")
            if not isinstance(value, Fraction) and (wide.high > 1 or wide.low < -1):
                raise Unsure
            ends = [max(min(end, mpf(1)), mpf(-1)) for end in (wide.low, wide.high)]
        else:
            ends = [wide.low, wide.high]
        result = sorted(getattr(mp, name)(end) for end in ends)
        return made(*result, _arc_form(name, value))

    return of


def _arc_form(name: str, value: Value) -> Polynomial | None:
    known = {("atan", 1): QUARTER, ("atan", -1): -QUARTER, ("asin", 1): HALF, ("asin", -1): -HALF}
    known |= {("acos", 1): Fraction(0), ("acos", -1): Fraction(1), ("acos", 0): HALF}
    turns = known.get((name, value)) if isinstance(value, Fraction) else None
    if turns is not None and exact.KEPT[0]:
        return exact.scale(exact.atom("pi"), turns)
    return _opaque(name, lifted(value))


BY_NAME: dict[str, Callable[[Value], Value]] = {
    "abs": _absolute,
    "sqrt": _root,
    "log": _logarithm,
    "exp": _exponential,
    **{name: _hyperbolic(name) for name in ("sinh", "cosh", "tanh")},
    **{name: _circular(name) for name in ("sin", "cos")},
    "tan": _tangent,
    **{name: _arc(name) for name in ("asin", "acos", "atan")},
}


def pi() -> Value:
    """π."""
    return made(+mp.pi, +mp.pi, exact.atom("pi"))


def ends(value: Value) -> tuple[Any, Any]:
    """The ends of a number as an interval."""
    wide = lifted(value)
    return wide.low, wide.high
