"""What a bound by storage forms along a chain asks for."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from flint import fmpq_mat

from lyapcheck._types import Array
from lyapcheck.check.loop.storage import FALL, Stage, energy, rate_of_mass, weight
from lyapcheck.robots.dynamics import Chain


@dataclass(frozen=True, eq=False)
class StorageProblem:
    """A bound κ of the sum of some costs.

    Args:
        stages: one a joint, base first.
        vectors: of three components each in w.
        fall: of w_0, (3,), m/s²; zeros where w_0 = 0.
        sign: −1 where the constant is an infimum: −κ then is its bound.
    """

    stages: Sequence[Stage]
    vectors: int
    fall: Sequence[Fraction] = (Fraction(0),) * FALL
    sign: int = 1

    @property
    def count(self) -> int:
        """Coefficients of a form."""
        return self.vectors * (3 * self.vectors + 1) // 2


def energy_problem(chain: Chain, sign: int) -> StorageProblem:
    """λmax(M) with sign 1, λmin(M) with sign −1."""
    return StorageProblem(energy(chain.links, sign), 2, sign=sign)


def weight_problem(chain: Chain, joints: Collection[int]) -> StorageProblem:
    """sup (Σ g_i²)^½ over some joints, counted from 0."""
    return StorageProblem(weight(chain.links, joints), 3, chain.fall)


def rate_problem(chain: Chain, joint: int, sign: int) -> StorageProblem:
    """The form ± ½ ∂M/∂q_j from above, joints counted from 0."""
    return StorageProblem(rate_of_mass(chain.links, joint, sign), 4)


def unit_rows(count: int) -> list[list[Fraction]]:
    """The rows of the unit matrix."""
    return [[Fraction(int(i == k)) for k in range(count)] for i in range(count)]


def doubles(matrix: fmpq_mat) -> Array:
    """The nearest doubles."""
    rows, columns = matrix.nrows(), matrix.ncols()
    return np.array(
        [[int(matrix[i, j].p) / int(matrix[i, j].q) for j in range(columns)] for i in range(rows)],
        dtype=np.float64,
    )
