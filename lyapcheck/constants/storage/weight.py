"""The length of g(q), or of some of its components, as a problem of storage forms.

w is the twist that rates z of the joints give a link, with the free fall γ in its frame. As g is the gradient
of −Σ m_k γᵀp_k,

    2 zᵀg = −2 Σ_k γ_kᵀ(m_k v_k + ω_k × m_k c_k) ≤ κ (Σ_i z_i² + 1),

for all z and so for that along g, which says ‖g‖ ≤ κ. Rates of joints that do not count are left at zero.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from lyapcheck.constants.storage.exact import Exact, cross, exact, unit, zeros
from lyapcheck.constants.storage.hinges import Hinge
from lyapcheck.constants.storage.problem import Problem, Step, turning_forms

_D = 9
_FALL = (6, 7, 8)


def weight(hinges: Sequence[Hinge], fall: Exact, joints: Collection[int]) -> Problem:
    """sup (Σ g_i²)^½ over some joints, counted from 0; ``fall`` is the free fall in the base frame."""
    steps = [_step(hinge, k in joints, first=k == 0) for k, hinge in enumerate(hinges)]
    start = np.concatenate([zeros(1, 6)[0], fall])
    return Problem(steps, start, turning_forms(3))


def _step(hinge: Hinge, moves: bool, first: bool) -> Step:
    carry = zeros(_D, _D)
    carry[:6, :6] = hinge.carry
    carry[6:, 6:] = hinge.turn
    push, price = unit(_D), zeros(_D + moves, _D + moves)
    if moves:
        push = np.hstack([push, exact([[int(i == 2)] for i in range(_D)])])
        price[_D, _D] += 1
    cost = zeros(_D, _D)
    # γᵀ(ω × c) = ωᵀ(c × γ)
    cost[:3, 6:], cost[6:, :3] = -cross(hinge.moment), cross(hinge.moment)
    cost[3:6, 6:] = cost[6:, 3:6] = -hinge.mass * unit(3)
    met = (*_FALL, *range(_D, _D + moves)) if first else tuple(range(_D + moves))
    return Step(carry, push, cost, price, met)
