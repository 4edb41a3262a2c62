"""Trigonometric polynomials as sums of harmonics a cos(k·q) + b sin(k·q), exactly.

Over a box of joint angles each harmonic has its exact range, where a product of sines and cosines of the
same angle would lose it; so this is the form that interval arithmetic wants.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.robots import trig

Harmonic = tuple[int, ...]
Gaussian = tuple[Fraction, Fraction]
Harmonics = dict[Harmonic, Gaussian]
"""Integer multiples k of the joint angles to (a, b); the first nonzero entry of each k is positive."""


def harmonics(poly: fmpq_mpoly) -> Harmonics:
    """The harmonics of a trigonometric polynomial without parameters: Σ a_k cos(k·q) + b_k sin(k·q).

    With z = exp(i k·q) each s is (z − 1/z)/(2i) and each c is (z + 1/z)/2; the coefficients stay Gaussian
    rationals, and those of k and −k are conjugate.
    """
    n = trig.joint_count(poly.context())
    total: dict[Harmonic, Gaussian] = {}
    for powers, coefficient in trig.to_terms(poly):
        for k, value in _product(powers[:n], powers[n : 2 * n]).items():
            _add(total, k, (value[0] * coefficient, value[1] * coefficient))
    return _real(total)


def derivative(terms: Mapping[Harmonic, Gaussian], i: int) -> Harmonics:
    """The derivative with respect to q_i, counted from 0."""
    return {k: (k[i] * b, -k[i] * a) for k, (a, b) in terms.items() if k[i] != 0}


def _product(sines: tuple[int, ...], cosines: tuple[int, ...]) -> dict[Harmonic, Gaussian]:
    """Π s_i^a c_i^b as coefficients of exp(i k·q)."""
    n, half = len(sines), Fraction(1, 2)
    result: dict[Harmonic, Gaussian] = {(0,) * n: (Fraction(1), Fraction(0))}
    for i in range(n):
        for up, down in [((Fraction(0), -half), (Fraction(0), half))] * sines[i]:
            result = _times(result, i, up, down)
        for up, down in [((half, Fraction(0)), (half, Fraction(0)))] * cosines[i]:
            result = _times(result, i, up, down)
    return result


def _times(terms: dict[Harmonic, Gaussian], i: int, up: Gaussian, down: Gaussian) -> dict[Harmonic, Gaussian]:
    """The product with up·z_i + down/z_i."""
    result: dict[Harmonic, Gaussian] = {}
    for k, value in terms.items():
        for step, factor in ((1, up), (-1, down)):
            place = (*k[:i], k[i] + step, *k[i + 1 :])
            _add(result, place, _complex_product(value, factor))
    return result


def _complex_product(x: Gaussian, y: Gaussian) -> Gaussian:
    return x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]


def _add(terms: dict[Harmonic, Gaussian], k: Harmonic, value: Gaussian) -> None:
    old = terms.get(k, (Fraction(0), Fraction(0)))
    terms[k] = (old[0] + value[0], old[1] + value[1])


def _real(terms: dict[Harmonic, Gaussian]) -> Harmonics:
    """Σ v_k exp(i k·q) with conjugate pairs, as cosines and sines: v e^{ix} + v̄ e^{−ix} = 2 Re v cos x − 2 Im v sin x."""
    result: Harmonics = {}
    for k, (re, im) in sorted(terms.items()):
        lead = next((x for x in k if x), 0)
        if lead >= 0 and (re or im):
            result[k] = (re, Fraction(0)) if lead == 0 else (2 * re, -2 * im)
    return result
