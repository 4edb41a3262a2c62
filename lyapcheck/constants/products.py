"""One bound of ‖C(q, x)x‖ for many postures: products of rates measured by one quadratic form.

With W as in `lyapcheck.constants.quartic` and X the scaled products x_i x_j, C(q, x)x = W X. For every
positive definite Q = I + N with N in the span of the relations XᵀQX = ‖x‖⁴, so that

    ‖C(q, x)x‖² ≤ λmax(W Q⁻¹ Wᵀ) ‖x‖⁴ = ‖W L‖² ‖x‖⁴,     L Lᵀ = Q⁻¹.

One Q serves postures that are alike; the best one is the solution of a convex program.
"""

from __future__ import annotations

import numpy as np

from lyapcheck._types import Array
from lyapcheck.constants.quartic import quartic

_POWERS = (8, 40, 150)
"""Of the traces that stand for the largest eigenvalue, one after the other."""
_STEPS = 60
_LEAST = 1e-2
"""Eigenvalue of Q below which it is not used: a factor then multiplies errors by ten at most."""


def common_factor(stacks: Array, n: int) -> Array:
    """L of a Q for which the largest ‖W L‖ is small, (pairs, pairs).

    Args:
        stacks: W at some postures, (count, n, pairs).
        n: number of joints.
    """
    from scipy.optimize import minimize

    relations = quartic(n).relations
    pairs = stacks.shape[-1]
    flat = relations.reshape(len(relations), pairs**2)
    weights = np.zeros(len(flat))
    for power in _POWERS:
        if len(flat):
            start, steps = (stacks, flat, power), {"maxiter": _STEPS, "maxcor": 30}
            weights = minimize(_size, weights, start, method="L-BFGS-B", jac=True, options=steps).x
    form = np.eye(pairs) + (weights @ flat).reshape(pairs, pairs)
    values, vectors = np.linalg.eigh(form)
    return np.asarray(vectors / np.sqrt(values)) if values[0] >= _LEAST else np.eye(pairs)


def _size(weights: Array, stacks: Array, flat: Array, power: int) -> tuple[float, Array]:
    """log (Σ tr (W Q⁻¹ Wᵀ)^power)^(1/power) and its gradient."""
    pairs = stacks.shape[-1]
    form = np.eye(pairs) + (weights @ flat).reshape(pairs, pairs)
    if np.linalg.eigvalsh(form)[0] < _LEAST:
        return 1e10, np.zeros(len(weights))
    moved = stacks @ np.linalg.inv(form)
    values, vectors = np.linalg.eigh(moved @ np.swapaxes(stacks, 1, 2))
    largest = float(values.max())
    share = np.maximum(values / largest, 0.0)
    total = float(np.sum(share**power))
    slope = share ** (power - 1) / (total * largest)
    spread = (vectors * slope[:, None]) @ np.swapaxes(vectors, 1, 2)
    inner = np.tensordot(moved, spread @ moved, ((0, 1), (0, 1)))
    return float(np.log(largest) + np.log(total) / power), np.asarray(-flat @ inner.ravel())
