"""Real numbers as polynomials over ℚ in named irrational numbers; a zero polynomial is the number 0.

An atom is a name with a canonical argument: √p for a prime p, π, γ_m, exp(1/q), ln p, sin r, … . The
relations used are √p² = p, cos² = 1 − sin², the addition of exponents of exp, and no others.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

Atom = tuple[Any, ...]
Monomial = tuple[tuple[Atom, int], ...]
Polynomial = dict[Monomial, Fraction]

ONE: Monomial = ()
MAX_TERMS = 60
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47)


KEPT = [True]
"""Whether exact forms are kept at all; without them the arithmetic is fast."""


@contextmanager
def kept(forms: bool) -> Iterator[None]:
    """Arithmetic with exact forms or without."""
    before, KEPT[0] = KEPT[0], forms
    try:
        yield
    finally:
        KEPT[0] = before


class TooLong(Exception):
    """An exact form is given up."""


def constant(value: Fraction) -> Polynomial:
    """A rational number."""
    return {ONE: value} if value else {}


def atom(*name: Any) -> Polynomial:
    """An atom as a polynomial."""
    return {((tuple(name), 1),): Fraction(1)}


def add(a: Polynomial, b: Polynomial) -> Polynomial:
    """The sum."""
    result = dict(a)
    for key, c in b.items():
        total = result.get(key, Fraction(0)) + c
        if total:
            result[key] = total
        else:
            result.pop(key, None)
    return _short(result)


def scale(a: Polynomial, c: Fraction) -> Polynomial:
    """A rational multiple."""
    return {key: c * value for key, value in a.items()} if c else {}


def mul(a: Polynomial, b: Polynomial) -> Polynomial:
    """The product, with the relations put in."""
    result: Polynomial = {}
    for key, c in a.items():
        for other, d in b.items():
            result = add(result, scale(_product(key, other), c * d))
    return result


def _product(key: Monomial, other: Monomial) -> Polynomial:
    powers: dict[Atom, int] = dict(key)
    for name, k in other:
        powers[name] = powers.get(name, 0) + k
    factor, squares = Fraction(1), []
    insides: list[Polynomial] = []
    for name, k in list(powers.items()):
        if name[0] == "sqrt" and k not in (0, 1):
            factor *= Fraction(name[1]) ** (k // 2)
            powers[name] = k % 2
        elif name[0] == "nested" and k >= 2:
            insides += [dict(name[1])] * (k // 2)
            powers[name] = k % 2
        elif name[0] == "cos" and k >= 2:
            squares += [name] * (k // 2)
            powers[name] = k % 2
    result = {_key(powers): factor}
    for name in squares:
        sine = ("sin", name[1])
        result = mul(result, {ONE: Fraction(1), ((sine, 2),): Fraction(-1)})
    for inside in insides:
        result = mul(result, inside)
    return result


def _key(powers: dict[Atom, int]) -> Monomial:
    return tuple(sorted(((name, k) for name, k in powers.items() if k), key=repr))


def inverse(a: Polynomial) -> Polynomial:
    """1/a for a polynomial that is not zero."""
    if len(a) == 1:
        ((key, c),) = a.items()
        if all(name[0] in ("sqrt", "exp") for name, _ in key):
            result: Polynomial = {ONE: 1 / c}
            for name, k in key:
                if name[0] == "sqrt":
                    result = mul(result, {((name, 1),): Fraction(1, name[1])})
                else:
                    result = mul(result, {((name, -k),): Fraction(1)})
            return result
    if set(a) == {ONE}:
        return {ONE: 1 / a[ONE]}
    return atom("inverse", canonical(a))


def canonical(a: Polynomial) -> tuple[Any, ...]:
    """The polynomial as something to compare and hash."""
    return tuple(sorted(((repr(key), str(c)) for key, c in a.items())))


def root(value: Fraction) -> Polynomial:
    """√value for a rational value >= 0."""
    inside, outside, result = (
        value.numerator * value.denominator,
        Fraction(1, value.denominator),
        constant(Fraction(1)),
    )
    for p in PRIMES:
        while inside and inside % (p * p) == 0:
            inside //= p * p
            outside *= p
        if inside and inside % p == 0:
            inside //= p
            result = mul(result, atom("sqrt", p))
    if inside == 0:
        return {}
    if inside > 1:
        result = mul(result, atom("sqrt", inside))
    return scale(result, outside)


def nested_root(inside: Polynomial) -> Polynomial:
    """The root of a number that is not rational."""
    return atom("nested", tuple(sorted(inside.items(), key=repr)))


def logarithm(value: Fraction) -> Polynomial:
    """The natural logarithm of a rational value > 0."""
    result: Polynomial = {}
    for number, sign in ((value.numerator, 1), (value.denominator, -1)):
        rest = number
        for p in PRIMES:
            while rest % p == 0:
                rest //= p
                result = add(result, scale(atom("log", p), Fraction(sign)))
        if rest > 1:
            result = add(result, scale(atom("log", rest), Fraction(sign)))
    return result


def as_rational(a: Polynomial) -> Fraction | None:
    """The value, if it is rational by this form."""
    if not a:
        return Fraction(0)
    return a[ONE] if set(a) == {ONE} else None


def turns(a: Polynomial) -> Fraction | None:
    """The multiple of π that a number is; ``None`` if it is none by this form."""
    if not a:
        return Fraction(0)
    key = ((("pi",), 1),)
    return a[key] if set(a) == {key} else None


def _short(a: Polynomial) -> Polynomial:
    if len(a) > MAX_TERMS:
        raise TooLong
    return a
