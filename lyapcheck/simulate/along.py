"""V and dV/dt at the samples of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lyapcheck.simulate.gains import Gains

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

Array = NDArray[np.float64]


def lyapunov_along(
    gains: Gains, model: RobotModel, *, q: Array, e: Array, w: Array, eps0: float
) -> tuple[Array, Array]:
    """V of (12) in J and its derivative along (11) in W at (N, n) states, with ε = ε₀/(1 + ‖e‖).

    V = ½wᵀMw + Σ k_pi U(e_i) − ε h(e)ᵀMw.

    References: (12), (14) of ``reyes2019family``.
    """
    from lyapcheck.robots.numeric import NumericModel

    arm, kp, kv = NumericModel(model), np.array(gains.kp), np.array(gains.kv)
    h, dh, r = gains.family.h(e), gains.family.dh(e), np.linalg.norm(e, axis=1)
    momentum = np.einsum("kij,kj->ki", arm.mass(q), w)
    damping = kv * gains.family.h(w) + arm.viscous * w
    eps = eps0 / (1.0 + r)
    cross = _dot(h, momentum)
    V = _dot(w, momentum) / 2 + gains.family.potential(e) @ kp - eps * cross
    towards = np.divide(_dot(e, w), r, out=np.zeros_like(r), where=r > 0.0)
    backwards = np.einsum("kji,kj->ki", arm.coriolis(q, w), w)
    cross_rate = _dot(h, backwards + kp * h - damping) - _dot(dh * w, momentum)
    dV = -_dot(w, damping) - eps * cross_rate - eps * towards / (1.0 + r) * cross
    return V, dV


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=1))
