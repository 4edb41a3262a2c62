"""V and dV/dt at many states at once, in float64: for sampling and simulation, never for a verdict."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from typing import Any, Literal

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.columns import ColumnForms
from lyapcheck.compiled.forms import PlainForms, has_plain_forms
from lyapcheck.compiled.state_map import StateMap, state_map
from lyapcheck.compiled.straight_line import StraightLine, Term
from lyapcheck.family import Family
from lyapcheck.lyapunov.along import LyapunovFunction
from lyapcheck.robots.plant import Plant

Columns = list[Array]
Name = Literal["value", "rate"]

BLOCK = 8192
"""States evaluated together by NumPy: all intermediate columns of a small arm then stay in the cache."""

LARGE = 32_768
"""From here on a compiled loop is worth its compilation of about a second, which happens once a computer."""


class LyapunovNumeric:
    """V of (12) and its derivative along (11) for one controller on one arm.

    Batches of `LARGE` states and more go through compiled loops where a C compiler is found, all others
    through NumPy; the two agree to 1e-12 of the sum of the absolute terms. See `engine`.

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
        self, model: Plant, family: Family, kp: Sequence[float], kv: Sequence[float], eps0: float = 0.0
    ) -> None:
        self.model = model.fixed()
        self.family = family
        self.kp, self.kv = [float(k) for k in kp], [float(k) for k in kv]
        self.viscous = [float(number.value) for number in model.viscous]
        self.eps0 = float(eps0)

    def V(self, q: Array, e: Array, w: Array) -> Array:
        """V = ½ (w − ε h)ᵀ M (w − ε h) + Σ k_pi U(e_i), J; states (..., n) in rad and rad/s."""
        return self._at("value", q, e, w)

    def rate(self, q: Array, e: Array, w: Array) -> Array:
        """dV/dt along (11) at q, e = q_d − q and w = q̇, W; states (..., n) in rad and rad/s."""
        return self._at("rate", q, e, w)

    def engine(self, count: int = LARGE) -> Literal["compiled", "numpy"]:
        """What serves a batch of ``count`` states; asking about a large one compiles what it needs."""
        value, rate = self._kernel("value", count), self._kernel("rate", count)
        return "numpy" if value is None or rate is None else "compiled"

    def _at(self, name: Name, q: Array, e: Array, w: Array) -> Array:
        states = [np.asarray(x, dtype=np.float64) for x in np.broadcast_arrays(q, e, w)]
        shape = states[0].shape[:-1]
        flat = [np.ascontiguousarray(x).reshape(-1, self.model.n) for x in states]
        values = self._by_kernel(name, flat)
        if values is None:
            values = _blocks(getattr(self._columns, name), flat)
        return values.reshape(shape)

    def _by_kernel(self, name: Name, flat: list[Array]) -> Array | None:
        """None where there is no kernel, or a state is beyond what it can do."""
        kernel = self._kernel(name, len(flat[0]))
        q, e, w = (x[None] for x in flat)
        return None if kernel is None else kernel(q, e, w, self._parameters)

    def _kernel(self, name: Name, count: int) -> StateMap | None:
        if count < LARGE or not has_plain_forms(self.family):
            return None
        return _compiled(self.model, self.family, name)

    @property
    def _parameters(self) -> Array:
        return np.array([[*self.kp, *self.kv, *self.viscous, self.eps0]])

    @cached_property
    def _columns(self) -> LyapunovFunction:
        return LyapunovFunction(
            self.model, ColumnForms(self.family), self.kp, self.kv, self.viscous, self.eps0
        )


def _blocks(value: Callable[[Columns, Columns, Columns], Array], states: list[Array]) -> Array:
    columns = [np.ascontiguousarray(x.T) for x in states]
    count = len(states[0])
    result = np.empty(count)
    for start in range(0, count, BLOCK):
        block = slice(start, start + BLOCK)
        result[block] = value(*[list(x[:, block]) for x in columns])
    return result


@lru_cache(maxsize=32)
def _compiled(model: Plant, family: Family, name: Name) -> StateMap | None:
    """The loop over states; gains, B and ε₀ are its parameters."""
    n = model.n

    def formula(code: StraightLine, q: list[Term], e: list[Term], w: list[Term], p: list[Term]) -> list[Any]:
        forms = PlainForms(code, family)
        certificate = LyapunovFunction(model, forms, p[:n], p[n : 2 * n], p[2 * n : 3 * n], p[3 * n])
        return [getattr(certificate, name)(q, e, w)]

    return state_map(formula, n, 3 * n + 1, 1)
