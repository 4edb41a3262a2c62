"""Every committed identity of M and C of links at random postures, at 60 digits, by code of its own."""

import mpmath
import numpy as np
import pytest

from tests.helpers.bounds_oracle import DIGITS, Bound
from tests.helpers.committed import certificates

STATEMENTS = {name: data["statement"] for name, data in certificates({"ChainIdentity"}, "proved").items()}
SLACK = mpmath.mpf(10) ** -30


def largest_gaps(links, seed=3):
    """How far M and C by Christoffel symbols are from each identity at a random posture, at most."""
    bound = Bound({"kind": "ChainBelow", "links": links, "parameters": [], "high": "1"})
    with mpmath.workdps(DIGITS):
        draws = np.random.default_rng(seed).uniform(-3, 3, (3, bound.n))
        q, w, x = (np.array([mpmath.mpf(t) for t in row]) for row in draws.tolist())
        step, unit = mpmath.mpf(10) ** -20, np.eye(bound.n, dtype=int)

        def mass(q):
            return bound._mass(q, [], mpmath.mpf)

        def slope(direction):
            return (mass(q + step * direction) - mass(q - step * direction)) / (2 * step)

        slopes = np.array([slope(row) for row in unit])
        turned = np.transpose(slopes, (1, 2, 0)) + np.transpose(slopes, (1, 0, 2)) - slopes
        M, rate, C, still = mass(q), slope(w), turned @ w / 2, turned @ (0 * w) / 2
        # the power of Coriolis torques is half the rate of the energy
        energy = w @ C @ w - w @ rate @ w / 2
        gaps = {
            "symmetric": M - M.T,
            "at rest": still,
            "rate": rate - C - C.T,
            "skew": np.array([x @ (rate - 2 * C) @ x, energy]),
            "false": rate - 2 * C,
        }
        return {name: max(map(abs, np.ravel(gap))) for name, gap in gaps.items()}


def test_none_is_forgotten():
    assert {one["identity"] for one in STATEMENTS.values()} == {"symmetric", "at rest", "rate", "skew"}


@pytest.mark.parametrize("name", STATEMENTS)
def test_no_posture_breaks_an_identity(name):
    gaps = largest_gaps(STATEMENTS[name]["links"])
    assert gaps[STATEMENTS[name]["identity"]] < SLACK
    assert gaps["false"] > 0.01  # Ṁ = 2C is none
