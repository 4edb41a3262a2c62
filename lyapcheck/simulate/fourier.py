"""Polynomials in sines and cosines as finite Fourier sums, which bound them from both sides, exactly.

f(q) = Σ_k c_k exp(i k·q) with c_{−k} the conjugate of c_k: f lies within Σ_{k≠0} |c_k| of its mean c_0.

References: ``katznelson2004harmonic``, chapter I.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import isqrt

from flint import fmpq

Frequency = tuple[tuple[str, int], ...]
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
        terms: dict[Frequency, tuple[fmpq, fmpq]] = {}
        for k, (a, b) in self.terms.items():
            _add(terms, {_sum(k, j): (a * c - b * d, a * d + b * c) for j, (c, d) in other.terms.items()})
        return Fourier(terms)

    @property
    def mean(self) -> Fraction:
        """The coefficient of frequency 0."""
        return _fraction(self.terms.get((), (ZERO, ZERO))[0])

    @property
    def swing(self) -> Fraction:
        """An upper bound of Σ_{k≠0} |c_k|, exact where every c_k is real or imaginary."""
        return sum((_modulus(*map(_fraction, ab)) for k, ab in self.terms.items() if k), Fraction(0))


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
