"""The extreme eigenvalues of M(q) over boxes of angles.

References: properties 2.1 and 2.2 of reyes2019family.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from lyapcheck._types import Array
from lyapcheck.constants.arm_harmonics import ArmHarmonics
from lyapcheck.constants.constant import SupremumTask
from lyapcheck.constants.spectrum import eigenvalues, largest_eigenvalue, smallest_eigenvalue
from lyapcheck.constants.torus import AffineForms


def lambda_max_task(arm: ArmHarmonics) -> SupremumTask:
    """β_M = sup λmax(M(q)), which is convex in M."""

    def value(entries: Array) -> Array:
        values, distance, _ = eigenvalues(arm.matrix(entries))
        return np.asarray(values[:, -1] - distance - arm.mass.lost)

    def most(affine: AffineForms) -> Array:
        high = largest_eigenvalue(arm.matrix(affine.corners()), arm.matrix(affine.radius)[:, None])
        return np.asarray(np.max(high, axis=1))

    return SupremumTask("lambda_max", "kg·m²", arm.mass, value, most, np.ones(len(arm.places)))


def lambda_min_task(arm: ArmHarmonics) -> SupremumTask:
    """inf λmin(M(q)), which is concave in M; entries of light joints matter most for the splits."""
    size = arm.matrix(arm.mass.slack[None])[0].diagonal()
    weight = np.array([1 / sqrt(size[i] * size[j]) if size[i] * size[j] > 0 else 1.0 for i, j in arm.places])

    def value(entries: Array) -> Array:
        values, distance, _ = eigenvalues(arm.matrix(entries))
        return np.asarray(-values[:, 0] - distance - arm.mass.lost)

    def most(affine: AffineForms) -> Array:
        low = smallest_eigenvalue(arm.matrix(affine.corners()), arm.matrix(affine.radius)[:, None])
        return np.asarray(-np.min(low, axis=1))

    return SupremumTask("lambda_min", "kg·m²", arm.mass, value, most, weight, sign=-1)
