"""Trigonometric polynomials as sums of harmonics a cos(k·q) + b sin(k·q), exactly.

The form is unique, so two polynomials are the same function exactly when their harmonics are equal; and over
a box of joint angles each harmonic has its exact range, where a product of sines and cosines of the same
angle would lose it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import product
from math import lcm

Harmonic = tuple[int, ...]
"""Integer multiples k of the joint angles; the first that is not zero is positive."""
Gaussian = tuple[Fraction, Fraction]
Harmonics = dict[Harmonic, Gaussian]
"""k to (a, b)."""
Term = tuple[tuple[int, ...], Fraction]
"""Exponents of (s1 … sn, c1 … cn) and the coefficient of one monomial."""


def harmonics(terms: Iterable[Term], n: int) -> Harmonics:
    """The harmonics of a polynomial in n sines and n cosines.

    With z = exp(i k·q) each s is (z − 1/z)/(2i) and each c is (z + 1/z)/2; the coefficients stay Gaussian
    rationals, and those of k and −k are conjugate.
    """
    shares = [(powers, Fraction(coefficient, 2 ** sum(powers[: 2 * n]))) for powers, coefficient in terms]
    scale = lcm(*(share.denominator for _, share in shares))  # adding integers takes a tenth of the time
    total: _Integers = {}
    for powers, share in shares:
        whole = share.numerator * (scale // share.denominator)
        for k, (re, im) in _product(powers[:n], powers[n : 2 * n]).items():
            old = total.get(k, (0, 0))
            total[k] = old[0] + whole * re, old[1] + whole * im
    # conjugate pairs as cosines and sines: v e^{ix} + v̄ e^{−ix} = 2 Re v cos x − 2 Im v sin x
    result: Harmonics = {}
    for k, (re, im) in sorted(total.items()):
        lead = _lead(k)
        if lead >= 0 and (re or im):
            both = (re, 0) if lead == 0 else (2 * re, -2 * im)
            result[k] = Fraction(both[0], scale), Fraction(both[1], scale)
    return result


Uncertain = dict[tuple[int, ...], Harmonics]
"""A polynomial in uncertain parameters: their powers to a trigonometric polynomial."""


def by_parameters(terms: Sequence[Term], n: int) -> Uncertain:
    """The harmonics of a polynomial, by the powers of what it has beyond n sines and n cosines."""
    result = sorted({powers[2 * n :] for powers, _ in terms})
    parts = {p: harmonics([term for term in terms if term[0][2 * n :] == p], n) for p in result}
    return {p: part for p, part in parts.items() if part}


def derivative(terms: Mapping[Harmonic, Gaussian], i: int) -> Harmonics:
    """The derivative with respect to q_i, counted from 0."""
    return {k: (k[i] * b, -k[i] * a) for k, (a, b) in terms.items() if k[i] != 0}


def mixed(parts: Iterable[tuple[int | Fraction, Uncertain]]) -> Uncertain:
    """Σ factor · polynomial."""
    total: Uncertain = {}
    for factor, entry in parts:
        for powers, terms in entry.items():
            own = total.setdefault(powers, {})
            for k, (a, b) in terms.items():
                # a number of an arm may have thousands of harmonics, and most factors are 1
                x, y = (a, b) if factor == 1 else (factor * a, factor * b)
                old = own.get(k)
                own[k] = (x, y) if old is None else (old[0] + x, old[1] + y)
    kept = {powers: {k: ab for k, ab in terms.items() if any(ab)} for powers, terms in total.items()}
    return {powers: terms for powers, terms in kept.items() if terms}


def slope(entry: Uncertain, i: int) -> Uncertain:
    """The derivative with respect to q_i, counted from 0."""
    result = {powers: derivative(part, i) for powers, part in entry.items()}
    return {powers: part for powers, part in result.items() if part}


def is_mirrored(terms: Mapping[Harmonic, Gaussian], signs: Sequence[int], sign: int) -> bool:
    """Whether the polynomial becomes ``sign`` times itself where every q_i is replaced by σ_i q_i.

    Soundness: k ↦ σk takes different harmonics to different ones, so the polynomial has no others.
    """
    for k, (a, b) in terms.items():
        turned = tuple(s * x for s, x in zip(signs, k, strict=True))
        flip = _lead(turned) < 0  # cos and sin of −k are cos and −sin of k
        place = tuple(-x for x in turned) if flip else turned
        if terms.get(place) != (a if sign > 0 else -a, b if (sign > 0) != flip else -b):
            return False
    return True


def largest(terms: Mapping[Harmonic, Gaussian]) -> Fraction:
    """A bound of the absolute value: Σ |a| + |b|."""
    return sum((abs(a) + abs(b) for a, b in terms.values()), Fraction(0))


def christoffel(mass: Sequence[Sequence[Uncertain]]) -> dict[tuple[int, int, int], Uncertain]:
    """The c_ijk = c_ikj = ½(∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) with k ≤ j that do not vanish."""
    n, half, result = len(mass), Fraction(1, 2), {}
    for i, j, k in product(range(n), repeat=3):
        turned = ((half, mass[i][j], k), (half, mass[i][k], j), (-half, mass[j][k], i))
        if k <= j and (symbol := mixed((share, slope(entry, at)) for share, entry, at in turned)):
            result[i, j, k] = symbol
    return result


def angles_in(mass: Sequence[Sequence[Uncertain]]) -> tuple[int, ...]:
    """The joints whose angle occurs."""
    parts = (part for row in mass for entry in row for part in entry.values())
    return tuple(sorted({i for part in parts for k in part for i, factor in enumerate(k) if factor}))


_Integers = dict[Harmonic, tuple[int, int]]


@lru_cache(maxsize=4096)
def _product(sines: tuple[int, ...], cosines: tuple[int, ...]) -> _Integers:
    """Π (2s_i)^a (2c_i)^b as coefficients of exp(i k·q)."""
    result: _Integers = {(0,) * len(sines): (1, 0)}
    for i in range(len(sines)):
        for up, down in [((0, -1), (0, 1))] * sines[i] + [((1, 0), (1, 0))] * cosines[i]:
            result = _times(result, i, up, down)
    return result


def _times(terms: _Integers, i: int, up: tuple[int, int], down: tuple[int, int]) -> _Integers:
    """The product with up·z_i + down/z_i."""
    result: _Integers = {}
    for k, (re, im) in terms.items():
        for step, (x, y) in ((1, up), (-1, down)):
            place = (*k[:i], k[i] + step, *k[i + 1 :])
            old = result.get(place, (0, 0))
            result[place] = old[0] + re * x - im * y, old[1] + re * y + im * x
    return result


def _lead(k: Harmonic) -> int:
    return next((x for x in k if x), 0)
