"""V and dV/dt at many states at once, in float64: for sampling and simulation, never for a verdict."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.family import Family
from lyapcheck.lyapunov import quadratic
from lyapcheck.robots import RobotModel

Array = NDArray[np.float64]
Columns = list[Array]

BLOCK = 8192
"""States evaluated together: all intermediate columns of a small arm then stay in the cache."""


_LIFT: Any = float
"""Coefficients stay scalars: arrays of states broadcast over them."""


class LyapunovNumeric:
    """V of (12) and its derivative along (11) for one controller on one arm.

    Args:
        model: the arm; uncertain parameters at their nominal values.
        family: the bounded function h (or the linear one).
        kp: diagonal of K_p, N·m (per rad where h is linear), n.
        kv: diagonal of K_v, N·m (per rad/s where h is linear), n.
        eps0: ε₀ ≥ 0; with 0, V is the energy.

    Soundness: rounded to nearest without bounds; a negative dV/dt here proves nothing.

    References: (12), (15) of reyes2019family.
    """

    def __init__(
        self, model: RobotModel, family: Family, kp: Sequence[float], kv: Sequence[float], eps0: float = 0.0
    ) -> None:
        self.model = model.fixed()
        self.family = family
        self.kp, self.kv = [float(k) for k in kp], [float(k) for k in kv]
        self.viscous = [float(number.value) for number in model.viscous]
        self.eps0 = float(eps0)

    def V(self, q: Array, e: Array, w: Array) -> Array:
        """V = ½ (w − ε h)ᵀ M (w − ε h) + Σ k_pi U(e_i), J; states (..., n) in rad and rad/s."""
        return self._blocks(self._value, q, e, w)

    def rate(self, q: Array, e: Array, w: Array) -> Array:
        """dV/dt along (11) at q, e = q_d − q and w = q̇, W; states (..., n) in rad and rad/s."""
        return self._blocks(self._rate, q, e, w)

    def _value(self, q: Columns, e: Columns, w: Columns) -> Array:
        h = [self.family.h(x) for x in e]
        eps = self.eps0 * self._shrink(e)[1]
        M = self.model.mass_at([np.sin(x) for x in q], [np.cos(x) for x in q], _LIFT)
        y = [a - eps * b for a, b in zip(w, h, strict=True)]
        kinetic = quadratic.dot(y, [quadratic.dot(row, y) for row in M])
        return np.asarray(0.5 * kinetic + quadratic.dot(self.kp, [self.family.potential(x) for x in e]))

    def _rate(self, q: Columns, e: Columns, w: Columns) -> Array:
        sin, cos = [np.sin(x) for x in q], [np.cos(x) for x in q]
        h, dh = [self.family.h(x) for x in e], [self.family.dh(x) for x in e]
        D = [self.family.secant(x) for x in w]
        r, shrink = self._shrink(e)
        e_hat = [np.divide(x, r, out=np.zeros_like(r), where=r > 0.0) for x in e]
        M, Ch = self.model.mass_at(sin, cos, _LIFT), self.model.coriolis_at(sin, cos, h, _LIFT)
        S = quadratic.coupling(M, Ch, h, dh, e_hat, shrink)
        eps = self.eps0 * shrink
        X = quadratic.x_matrix(quadratic.damping(self.viscous, self.kv, D), S, eps)
        return np.asarray(quadratic.rate(self.kp, X, h, w, eps))

    def _shrink(self, e: Columns) -> tuple[Array, Array]:
        """r = ‖e‖ and 1/(1 + r)."""
        r = np.sqrt(quadratic.dot(e, e))
        return r, 1.0 / (1.0 + r)

    def _blocks(
        self, value: Callable[[Columns, Columns, Columns], Array], q: Array, e: Array, w: Array
    ) -> Array:
        states = [np.asarray(x, dtype=np.float64) for x in np.broadcast_arrays(q, e, w)]
        columns = [np.ascontiguousarray(x.reshape(-1, self.model.n).T) for x in states]
        count = columns[0].shape[1]
        result = np.empty(count)
        for start in range(0, count, BLOCK):
            block = slice(start, start + BLOCK)
            result[block] = value(*[list(x[:, block]) for x in columns])
        return result.reshape(states[0].shape[:-1])
