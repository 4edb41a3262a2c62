"""The table of the integration method against its own order conditions and another print of it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import DOP853

from lyapcheck.simulate import dop853


def row(weights: dict[int, float], size: int = 16) -> np.ndarray:
    return np.array([weights.get(j, 0.0) for j in range(size)])


A = np.vstack([np.zeros(16), *map(row, dop853.STAGES), row(dop853.STEP), *map(row, dop853.EXTRA)])
NODES = A.sum(axis=1)


def test_the_table_is_the_one_scipy_has():
    assert np.array_equal(A[:12, :12], DOP853.A)
    assert np.array_equal(row(dop853.STEP)[:12], DOP853.B)
    assert np.array_equal(A[13:, :16], DOP853.A_EXTRA)
    assert np.array_equal(row(dop853.ERROR_5, 13), DOP853.E5)
    assert np.array_equal(row(dop853.ERROR_3, 13), DOP853.E3)
    assert np.array_equal(np.array([row(weights) for weights in dop853.DENSE]), DOP853.D)


@pytest.mark.parametrize("k", range(8))
def test_the_step_integrates_powers_up_to_the_seventh(k):
    assert row(dop853.STEP) @ NODES**k == pytest.approx(1 / (k + 1), abs=1e-14)


@pytest.mark.parametrize("k", range(1, 7))
def test_the_step_has_the_conditions_of_tall_trees(k):
    """Σ b_i a_ij c_j^(k−1) = 1/(k(k+1)): order k + 1."""
    assert row(dop853.STEP) @ (A @ NODES ** (k - 1)) == pytest.approx(1 / (k * (k + 1)), abs=1e-14)


@pytest.mark.parametrize("weights", [dop853.ERROR_5, dop853.ERROR_3])
def test_error_estimates_vanish_for_constant_rates(weights):
    assert sum(weights.values()) == pytest.approx(0, abs=1e-14)


def test_the_quadrature_fails_beyond_its_order():
    assert abs(row(dop853.STEP) @ NODES**8 - 1 / 9) > 1e-6
