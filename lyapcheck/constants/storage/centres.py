"""Matrices of some spaces that are far from where they stop to be definite, in doubles."""

from __future__ import annotations

import numpy as np

from lyapcheck._types import Array

_FALL, _STEPS, _LAST, _CLOSE = 4.0, 4, 30, 0.1
"""Of μ at a time, Newton's steps for each, for the last one, and the decrement that is small enough."""


def centres(matrices: Array, directions: Array, width: float) -> Array:
    """For each H the c for which t/μ − log det(H + Σ c_i D_i + tI) is least over c and t; analytic centres.

    That c depends smoothly on H, and the smaller μ, the nearer λ_min(H + Σ c_i D_i) is to the largest one.

    Args:
        matrices: symmetric H, (count, size, size).
        directions: the D_i, (number, size, size); with I they are independent.
        width: μ.

    References: ``boyd2004convex``, section 9.6.
    """
    count, size = matrices.shape[:2]
    basis = np.concatenate([directions, np.eye(size)[None]])
    flat = basis.reshape(len(basis), -1).T
    lacks = np.maximum(-np.linalg.eigvalsh(matrices)[:, 0], 0)
    mu = max(lacks.max(initial=0.0), width)
    c = np.zeros((count, len(basis)))
    c[:, -1] = lacks + mu * size
    while True:
        for _ in range(_LAST if mu == width else _STEPS):
            inverse = np.linalg.inv(matrices + np.tensordot(c, basis, 1))
            gradient = -inverse.reshape(count, -1) @ flat
            gradient[:, -1] += 1 / mu
            hessian = (inverse[:, None] @ basis @ inverse[:, None]).reshape(count, len(basis), -1) @ flat
            step = -np.linalg.solve(hessian, gradient[..., None])[..., 0]
            decrement = np.sqrt(np.maximum(-(gradient * step).sum(1), 0))
            c += step * np.where(decrement < 0.25, 1, 1 / (1 + decrement))[:, None]
            if decrement.max(initial=0.0) < _CLOSE:
                break
        if mu == width:
            return np.asarray(c[:, :-1])
        mu = max(width, mu / _FALL)
