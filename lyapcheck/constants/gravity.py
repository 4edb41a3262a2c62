"""The length of g(q), or of some of its components, over boxes of angles.

References: property 2.8 of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lyapcheck._types import Array
from lyapcheck.constants.arm_harmonics import ArmHarmonics
from lyapcheck.constants.constant import SupremumTask
from lyapcheck.constants.torus import AffineForms, Torus


def gravity_task(arm: ArmHarmonics, name: str, joints: Sequence[int]) -> SupremumTask:
    """sup (Σ g_i(q)²)^½ over some joints, counted from 0."""
    torus = Torus([arm.gravity[i] for i in joints], arm.n)

    def value(entries: Array) -> Array:
        return np.asarray(np.sqrt(np.sum(entries**2, axis=1)) * (1 - 1e-14) - torus.lost)

    def most(affine: AffineForms) -> Array:
        squares = (np.abs(affine.corners()) + affine.radius[:, None]) ** 2
        return np.asarray(np.max(np.sqrt(np.sum(squares, axis=2)), axis=1) * (1 + 1e-14))

    return SupremumTask(name, "N·m", torus, value, most, np.ones(len(joints)))
