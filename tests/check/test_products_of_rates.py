"""Bounds of ‖C(q, x)x‖ at control points, held against symbols from differences of M and sampled rates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction as F
from itertools import product

import numpy as np
import pytest
from flint import arb_mat, fmpq
from hypothesis import given, settings
from hypothesis import strategies as st

from lyapcheck.check.kinds.coriolis_below import CoriolisBelow, ProductsOfRates
from lyapcheck.check.kinds.inertia import Mass
from lyapcheck.check.loop.head import relation, splits
from lyapcheck.check.loop.inertia import Inertia, inertia_of
from lyapcheck.check.loop.symbols import Symbols
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.constants.products import products_below

JOINTS = st.integers(2, 3)
SEEDS = st.integers(0, 10**6)


def drawn(seed: int, n: int) -> Mass:
    """A symmetric matrix of polynomials in the angles of all joints but the first, of degree two at most."""
    random = np.random.default_rng(seed)
    entries: dict[tuple[int, int], tuple[tuple[tuple[int, ...], F], ...]] = {}
    for i in range(n):
        for j in range(i + 1):
            terms: dict[tuple[int, ...], F] = {}
            for _ in range(3):
                powers = [0] * (2 * n)
                for _ in range(random.integers(0, 3)):
                    powers[random.integers(1, n) + n * random.integers(0, 2)] += 1
                terms[tuple(powers)] = F(int(random.integers(-8, 9)), 4)
            entries[i, j] = tuple((p, c) for p, c in terms.items() if c)
    return tuple(tuple(entries[max(i, j), min(i, j)] for j in range(n)) for i in range(n))


def mass_at(mass: Mass) -> Callable[[np.ndarray], np.ndarray]:
    """M at many postures, (count, n, n), by another way than the checker's harmonics."""
    n = len(mass)

    def at(q: np.ndarray) -> np.ndarray:
        circle = np.hstack([np.sin(q), np.cos(q)])
        result = np.zeros((len(q), n, n))
        for i, j in product(range(n), repeat=2):
            for powers, c in mass[i][j]:
                result[:, i, j] += float(c) * np.prod(circle ** np.array(powers), axis=1)
        return result

    return at


def symbols_at(mass: Mass, q: np.ndarray) -> np.ndarray:
    """c_ijk by differences, (count, n, n, n)."""
    n, at, step = len(mass), mass_at(mass), 1e-6
    rates = np.stack(
        [(at(q + step * unit) - at(q - step * unit)) / (2 * step) for unit in np.eye(n)], axis=-1
    )
    return np.asarray((rates + np.swapaxes(rates, 2, 3) - np.moveaxis(rates, 3, 1)) / 2)


def reached(mass: Mass, count: int = 400) -> float:
    """The largest ‖C(q, x)x‖ of many unit vectors x at many postures."""
    random, n = np.random.default_rng(0), len(mass)
    q, x = random.uniform(-np.pi, np.pi, (count, n)), random.normal(size=(count, n))
    x /= np.linalg.norm(x, axis=1)[:, None]
    torques = np.einsum("bijk,cj,ck->bci", symbols_at(mass, q), x, x)
    return float(np.linalg.norm(torques, axis=2).max())


def accepted(statement: CoriolisBelow, proof: ProductsOfRates) -> bool:
    try:
        return verify(statement, proof).verdict == "proved"
    except Refused:
        return False


@given(SEEDS, JOINTS)
def test_the_matrix_is_what_a_bound_asks_for(seed: int, n: int) -> None:
    mass, random = drawn(seed, n), np.random.default_rng(seed)
    symbols = Symbols(Inertia(mass, ()))
    turns = [fmpq(int(k), 7) for k in random.integers(-7, 8, len(symbols.angles))]
    q = np.zeros(n)
    q[list(symbols.angles)] = [np.pi * int(t.p) / int(t.q) for t in turns]
    z, x = random.normal(size=(2, n))
    products = np.array([x[i] * x[j] for i, j in symbols.products])
    power = np.array(symbols.power(turns).tolist(), dtype=float)
    expected = z @ np.einsum("ijk,j,k->i", symbols_at(mass, q[None])[0], x, x)
    assert z @ power @ products == pytest.approx(expected, rel=1e-6, abs=1e-7)
    square = np.array(symbols.square.tolist(), dtype=float)[0]
    assert square @ np.concatenate([z, products]) == pytest.approx(x @ x)


@given(SEEDS, JOINTS)
def test_no_bound_below_what_is_reached_is_shown(seed: int, n: int) -> None:
    mass = drawn(seed, n)
    most = reached(mass)
    for share in (F(9, 10), F(999, 1000)):
        bound = F(most) * share
        assert bound <= 0 or products_below(inertia_of(mass, ()), bound) is None
    loose = CoriolisBelow(mass, (), F(most) * F(11, 10))
    proof = products_below(inertia_of(mass, ()), loose.high)
    if proof is not None:
        assert accepted(loose, proof)
        assert not accepted(replace(loose, high=F(most) * F(999, 1000)), proof)


@pytest.mark.slow
@settings(max_examples=60)
@given(SEEDS)
def test_of_two_joints_the_least_bounds_are_nearly_shown(seed: int) -> None:
    """A matrix in one angle, where sampling comes near the largest value."""
    mass = drawn(seed, 2)
    most = reached(mass, 1000)
    bound = F(most) * F(21, 20)
    if most:
        proof = products_below(inertia_of(mass, ()), bound)
        assert proof is not None
        assert accepted(CoriolisBelow(mass, (), bound), proof)


@pytest.mark.slow
@settings(max_examples=60)
@given(SEEDS, st.data())
def test_altered_relations_show_no_false_bound(seed: int, data: st.DataObject) -> None:
    """Relations vanish on products, so that no choice of them can help a bound that is not true."""
    mass = drawn(seed, 3)
    most, symbols = reached(mass), Symbols(Inertia(mass, ()))
    rows = (2 * symbols.degree + 1) ** len(symbols.angles)
    if not most or not symbols.angles:
        return
    drawn_row = st.tuples(*[st.fractions(-4, 4, max_denominator=8)] * len(splits(3)))
    proof = ProductsOfRates((data.draw(drawn_row),) * rows, (16,) * len(symbols.angles), (0,) * 3)
    assert not accepted(CoriolisBelow(mass, (), F(most) * F(99, 100)), proof)


@given(SEEDS, st.integers(2, 4))
def test_relations_vanish_on_products(seed: int, n: int) -> None:
    random = np.random.default_rng(seed)
    coefficients = [F(int(c), 3) for c in random.integers(-9, 10, len(splits(n)))]
    x = [F(int(c), 5) for c in random.integers(-9, 10, n)]
    products = [x[i] * x[j] for i in range(n) for j in range(i, n)]
    v = arb_mat([[0] * n + [fmpq(p.numerator, p.denominator) for p in products]])
    assert (v * relation(coefficients, n) * v.transpose())[0, 0].contains(0)
