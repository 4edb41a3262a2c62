"""The table of the integration method against its own order conditions."""

from __future__ import annotations

import numpy as np
import pytest

from lyapcheck.simulate.batch import dop853


def row(weights: dict[int, float], size: int = 16) -> np.ndarray:
    return np.array([weights.get(j, 0.0) for j in range(size)])


A = np.vstack([np.zeros(16), *map(row, dop853.STAGES), row(dop853.STEP), *map(row, dop853.EXTRA)])
NODES = A.sum(axis=1)


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
