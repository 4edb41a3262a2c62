"""Definiteness: exact over ℚ against an independent criterion, and never claimed in balls without proof."""

from fractions import Fraction
from itertools import combinations

import pytest
from flint import arb, fmpq, fmpq_mat
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.loop.field import BALLS, SPANS
from lyapcheck.check.numbers.vectors import is_positive_semidefinite

numbers = st.fractions(min_value=-4, max_value=4, max_denominator=6)
HILBERT = [[Fraction(1, i + j + 1) for j in range(8)] for i in range(8)]


@st.composite
def symmetric(draw, size=4):
    n = draw(st.integers(1, size))
    upper = {(i, j): draw(numbers) for i in range(n) for j in range(i, n)}
    return [[upper[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]


@st.composite
def gram(draw):
    """GᵀG with its rank: positive semidefinite, often singular."""
    n, k = draw(st.integers(1, 4)), draw(st.integers(0, 4))
    G = [[draw(numbers) for _ in range(n)] for _ in range(k)]
    product = [[sum((G[t][i] * G[t][j] for t in range(k)), Fraction(0)) for j in range(n)] for i in range(n)]
    return product, _exact(product).rank()


def _exact(rows):
    n = len(rows)
    return fmpq_mat(n, n, [fmpq(x.numerator, x.denominator) for row in rows for x in row])


def _minor(rows, chosen):
    return _exact([[rows[i][j] for j in chosen] for i in chosen]).det()


def _definite(rows):
    """By leading minors."""
    return all(_minor(rows, tuple(range(k + 1))) > 0 for k in range(len(rows)))


def _balls(rows):
    return [[arb(fmpq(x.numerator, x.denominator)) for x in row] for row in rows]


@given(symmetric())
def test_semidefinite_exactly_when_all_principal_minors_are_nonnegative(rows):
    n = len(rows)
    chosen = [c for k in range(1, n + 1) for c in combinations(range(n), k)]
    assert is_positive_semidefinite(rows) == all(_minor(rows, c) >= 0 for c in chosen)


@given(gram())
def test_gram_matrices_are_semidefinite(case):
    rows, rank = case
    assert is_positive_semidefinite(rows)
    assert _definite(rows) == (rank == len(rows))


@given(symmetric())
@pytest.mark.parametrize("of", [BALLS, SPANS])
def test_enclosures_never_prove_what_is_false(of, rows):
    result = of.positive_definite([[of.value(x) for x in row] for row in _balls(rows)])
    assert not result or _definite(rows)


def test_a_barely_semidefinite_matrix_is_decided_exactly():
    one, tiny = Fraction(1), Fraction(1, 10**40)
    assert is_positive_semidefinite([[one, one], [one, one]])
    assert not is_positive_semidefinite([[one, one], [one, one - tiny]])


def test_hilbert_matrices_are_definite_both_ways():
    assert is_positive_semidefinite(HILBERT)
    assert BALLS.positive_definite(_balls(HILBERT))


def test_wide_or_undefined_balls_prove_nothing():
    nan, wide = arb("nan"), arb(1, 2)
    assert not BALLS.positive_definite([[nan]])
    assert not BALLS.positive_definite([[wide]])
    assert not BALLS.positive_definite([[arb(1), arb(0)], [nan, arb(1)]])
    assert not BALLS.positive_definite([[arb(1), arb(0)], [arb(0, 1.1), arb(1)]])
