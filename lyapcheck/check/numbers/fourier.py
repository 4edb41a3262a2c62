"""Polynomials in sines and cosines as finite Fourier sums, which bound them from both sides, exactly.

f(q) = Σ_k c_k exp(i k·q) with c_{−k} the conjugate of c_k: f lies within Σ_{k≠0} |c_k| of its mean c_0.

References: ``katznelson2004harmonic``, chapter I.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import isqrt
from typing import Any

from flint import fmpq

from lyapcheck.check.expressions.expression import Algebra, Tree, Unsupported, evaluate, variables

Frequency = tuple[tuple[str, int], ...]
MAX_STEPS = 1_000_000
"""Products of two terms each that the product of two sums may take."""
ZERO, HALF = fmpq(0), fmpq(1, 2)


@dataclass(frozen=True)
class Fourier:
    """A Fourier sum: frequency (angle, multiple ≠ 0) … to the real and imaginary parts of its coefficient."""

    terms: dict[Frequency, tuple[fmpq, fmpq]]

    def __add__(self, other: Fourier) -> Fourier:
        terms = dict(self.terms)
        _add(terms, other.terms)
        return Fourier(terms)

    def __neg__(self) -> Fourier:
        return Fourier({k: (-re, -im) for k, (re, im) in self.terms.items()})

    def __mul__(self, other: Fourier) -> Fourier:
        if len(self.terms) * len(other.terms) > MAX_STEPS:
            raise Unsupported(f"a product of sums of {len(self.terms)} and {len(other.terms)} frequencies")
        terms: dict[Frequency, tuple[fmpq, fmpq]] = {}
        for k, (a, b) in self.terms.items():
            _add(terms, {_sum(k, j): (a * c - b * d, a * d + b * c) for j, (c, d) in other.terms.items()})
        return Fourier(terms)

    def __truediv__(self, other: Fourier) -> Fourier:
        if set(other.terms) != {()} or other.terms[()][0] == 0:
            raise Unsupported("division by something else than a number")
        scale = 1 / other.terms[()][0]
        return Fourier({k: (re * scale, im * scale) for k, (re, im) in self.terms.items()})

    @property
    def mean(self) -> Fraction:
        """The coefficient of frequency 0."""
        return _fraction(self.terms.get((), (ZERO, ZERO))[0])

    @property
    def swing(self) -> Fraction:
        """An upper bound of Σ_{k≠0} |c_k|, exact where every c_k is real or imaginary."""
        return sum((_modulus(*map(_fraction, ab)) for k, ab in self.terms.items() if k), Fraction(0))


@dataclass(frozen=True)
class _Angle:
    """An angle by its name; it has no arithmetic, so that sums of angles are refused."""

    name: str


class _FourierAlgebra(Algebra):
    """Angles are names; only sin and cos of an angle are functions."""

    def number(self, value: Fraction) -> Fourier:
        return constant(value)

    def constant(self, name: str, m: int) -> Fourier:
        raise Unsupported(f"{name} is not rational")

    def pi(self) -> Fourier:
        raise Unsupported("pi is not rational")

    def function(self, name: str, value: Any) -> Fourier:
        if name not in ("sin", "cos") or not isinstance(value, _Angle):
            raise Unsupported("not a polynomial in sines and cosines of single angles")
        return sine(value.name) if name == "sin" else cosine(value.name)


def constant(value: Fraction) -> Fourier:
    """A number."""
    return Fourier({(): (fmpq(value.numerator, value.denominator), ZERO)})


def sine(angle: str) -> Fourier:
    """The sine of an angle."""
    return Fourier({((angle, 1),): (ZERO, -HALF), ((angle, -1),): (ZERO, HALF)})


def cosine(angle: str) -> Fourier:
    """The cosine of an angle."""
    return Fourier({((angle, 1),): (HALF, ZERO), ((angle, -1),): (HALF, ZERO)})


def size(value: Fourier) -> Fraction:
    """An upper bound of |f|."""
    return abs(value.mean) + value.swing


def fourier_sum(tree: Tree) -> Fourier:
    """The Fourier sum of an expression in sin q_i and cos q_i.

    Raises:
        Unsupported: the expression is anything else.
    """
    try:
        result = evaluate(tree, {name: _Angle(name) for name in variables(tree)}, _FourierAlgebra())
    except (TypeError, AttributeError) as error:
        raise Unsupported("a variable outside sin and cos has no bound") from error
    if not isinstance(result, Fourier):
        raise Unsupported("a variable outside sin and cos has no bound")
    return result


def is_bounded(tree: Tree) -> bool:
    """Whether an expression is plainly a polynomial in sines and cosines of angles: then it is bounded."""
    kind, *rest = tree
    if kind in ("add", "mul", "neg"):
        return all(map(is_bounded, rest))
    if kind == "pow":
        return int(rest[1]) >= 0 and is_bounded(rest[0])
    if kind == "div":
        return is_bounded(rest[0]) and rest[1][0] == "num" and Fraction(rest[1][1]) != 0
    return kind == "num" or (kind in ("sin", "cos") and rest[0][0] == "var")


@lru_cache(maxsize=65536)
def _sum(k: Frequency, j: Frequency) -> Frequency:
    total = dict(k)
    for angle, multiple in j:
        total[angle] = total.get(angle, 0) + multiple
    return tuple(sorted((angle, multiple) for angle, multiple in total.items() if multiple))


def _add(terms: dict[Frequency, tuple[fmpq, fmpq]], more: dict[Frequency, tuple[fmpq, fmpq]]) -> None:
    for k, (re, im) in more.items():
        a, b = terms.get(k, (ZERO, ZERO))
        terms[k] = (a + re, b + im)


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def _modulus(re: Fraction, im: Fraction) -> Fraction:
    """√(re² + im²), rounded up where it is not rational in a plain way."""
    if re == 0 or im == 0:
        return abs(re) + abs(im)
    scale = 10**30
    square = re * re + im * im
    return Fraction(isqrt(square.numerator * scale * scale // square.denominator) + 1, scale)
