"""Trigonometric polynomials as sums of products with one factor 1, sin kq or cos kq a joint, exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache

Harmonic = tuple[int, ...]
"""One factor a joint: 0 is 1, 2k − 1 is sin kq, 2k is cos kq."""
Harmonics = dict[Harmonic, Fraction]
Term = tuple[tuple[int, ...], Fraction]


@lru_cache(maxsize=256)
def _expanded(sines: int, cosines: int) -> dict[int, Fraction]:
    """sinᵃ q cosᵇ q as a sum of factors."""
    if sines == cosines == 0:
        return {0: Fraction(1)}
    total: dict[int, Fraction] = {}
    before = _expanded(sines - 1, 0) if cosines == 0 else _expanded(sines, cosines - 1)
    for factor, value in before.items():
        for place, number in _times_cosine(factor) if cosines else _times_sine(factor):
            total[place] = total.get(place, Fraction(0)) + number * value
    return total


def _times_cosine(factor: int) -> list[tuple[int, Fraction]]:
    """cos q times a factor: the mean of the next frequencies."""
    half, k = Fraction(1, 2), (factor + 1) // 2
    if factor == 0:
        return [(2, Fraction(1))]
    if factor % 2:
        return [(2 * k + 1, half), *([(2 * k - 3, half)] if k > 1 else [])]
    return [(2 * k + 2, half), (2 * k - 2, half)]


def _times_sine(factor: int) -> list[tuple[int, Fraction]]:
    """sin q times a factor."""
    half, k = Fraction(1, 2), (factor + 1) // 2
    if factor == 0:
        return [(1, Fraction(1))]
    if factor % 2:
        return [(2 * k - 2, half), (2 * k + 2, -half)]
    return [(2 * k + 1, half), *([(2 * k - 3, -half)] if k > 1 else [])]


def harmonics(terms: Sequence[Term], n: int) -> Harmonics:
    """The waves of a polynomial in n sines and n cosines, exactly."""
    total: Harmonics = {}
    for powers, coefficient in terms:
        partial: list[tuple[Harmonic, Fraction]] = [((), coefficient)]
        for i in range(n):
            factors = _expanded(powers[i], powers[n + i])
            partial = [((*wave, factor), x * y) for wave, x in partial for factor, y in factors.items()]
        for wave, value in partial:
            total[wave] = total.get(wave, Fraction(0)) + value
    return {wave: value for wave, value in total.items() if value}


def derivative(polynomial: Mapping[Harmonic, Fraction], i: int) -> Harmonics:
    """The derivative with respect to q_i, counted from 0."""
    total: Harmonics = {}
    for wave, value in polynomial.items():
        k = (wave[i] + 1) // 2
        if k:
            factor, sign = (2 * k, 1) if wave[i] % 2 else (2 * k - 1, -1)
            place = (*wave[:i], factor, *wave[i + 1 :])
            total[place] = total.get(place, Fraction(0)) + sign * k * value
    return total
