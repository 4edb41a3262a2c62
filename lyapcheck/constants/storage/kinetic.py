"""The extreme eigenvalues of M(q) as problems of storage forms: w is the twist of a link.

q̇ᵀMq̇ = Σ_k V_kᵀG_kV_k ≤ κ Σ_k q̇_k²,        V_k = D(q_k) X_k V_{k−1} + (0, 0, 1, 0, 0, 0) q̇_k.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lyapcheck.constants.storage.exact import exact, unit, zeros
from lyapcheck.constants.storage.hinges import Hinge
from lyapcheck.constants.storage.problem import Problem, Step, turning_forms

_TWIST = 6


def kinetic(hinges: Sequence[Hinge], sign: int) -> Problem:
    """λmax(M) with sign 1, λmin(M) with sign −1."""
    spin = exact([[0], [0], [1], [0], [0], [0]])
    push = np.hstack([unit(_TWIST), spin])
    price = zeros(_TWIST + 1, _TWIST + 1)
    price[_TWIST, _TWIST] += 1
    every = tuple(range(_TWIST + 1))
    steps = [
        Step(hinge.carry, push, sign * hinge.body, price, every if k else (_TWIST,))
        for k, hinge in enumerate(hinges)
    ]
    return Problem(steps, zeros(1, _TWIST)[0], turning_forms(2), sign)
