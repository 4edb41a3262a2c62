"""V and dV/dt at many states at once, in float64: for sampling and simulation, never for a verdict."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import Any, Literal

import numpy as np

from lyapcheck import store
from lyapcheck._types import Array
from lyapcheck.family import Family
from lyapcheck.family.base import Arithmetic, arrays
from lyapcheck.lyapunov.along import AtState, FormsAt
from lyapcheck.lyapunov.loop import Loop, loop
from lyapcheck.robots.plant import RobotModel

BLOCK = 8192
"""States evaluated together by NumPy: all intermediate columns of a small arm then stay in the cache."""
LARGE = 32_768
"""From here on a compiled loop is worth its compilation of about a second, which happens once a computer."""
OUTPUTS: dict[str, tuple[int, Callable[[AtState, Any], list[Any]]]] = {
    "value": (1, lambda at, eps0: [at.value(eps0)]),
    "rate": (1, lambda at, eps0: [at.rate(eps0)]),
    "coefficients": (3, lambda at, eps0: at.coefficients()),
}


def forms_in(family: Family, of: Arithmetic) -> FormsAt:
    """The forms of a family in an arithmetic."""
    return partial(family.numeric, of)


class LyapunovNumeric:
    """V of (12) and its derivative along (11) for one controller on one arm.

    If a C compiler is found, compiled loops evaluate batches of `LARGE` states and more. NumPy evaluates all
    others by the same expressions. The two agree to 1e-12 of the sum of the absolute terms.

    Args:
        model: the arm; uncertain parameters at their nominal values.
        family: the bounded function h (or the linear one).
        kp: diagonal of K_p, N·m (per rad where h is linear), n.
        kv: diagonal of K_v, N·m (per rad/s where h is linear), n.
        eps0: ε₀ ≥ 0; with 0, V is the energy.

    Soundness: rounded to nearest without bounds. A negative dV/dt here proves nothing.

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
        (values,) = self._at("value", q, e, w)
        return np.asarray(values)

    def rate(self, q: Array, e: Array, w: Array) -> Array:
        """dV/dt along (11) at q, e = q_d − q and w = q̇, W; states (..., n) in rad and rad/s."""
        (values,) = self._at("rate", q, e, w)
        return np.asarray(values)

    def coefficients(self, q: Array, e: Array, w: Array, large: int = LARGE) -> Array:
        """a₀, a₁, a₂ of dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀², (3, ...), W; compiled from so many states on."""
        return self._at("coefficients", q, e, w, large)

    def at_columns(self, q: Array, e: Array, w: Array) -> AtState:
        """What else is known at states (count, n), as columns of NumPy."""
        forms, columns = forms_in(self.family, arrays()), [list(np.ascontiguousarray(x.T)) for x in (q, e, w)]
        gains = self.kp, self.kv, self.viscous
        return AtState(self.model, arrays(), forms, columns[0], columns[1], columns[2], *gains)

    def engine(self, count: int = LARGE) -> Literal["compiled", "numpy"]:
        """What serves a batch of ``count`` states; asking about a large one compiles what it needs."""
        loops = (_compiled(self.model, self.family, name) for name in ("value", "rate"))
        return "compiled" if count >= LARGE and all(one is not None for one in loops) else "numpy"

    def _at(self, name: str, q: Array, e: Array, w: Array, large: int | None = None) -> Array:
        states = [np.asarray(x, dtype=np.float64) for x in np.broadcast_arrays(q, e, w)]
        shape = states[0].shape[:-1]
        columns = [x.reshape(-1, self.model.n).T for x in states]
        count = columns[0].shape[1]
        many = count >= (LARGE if large is None else large)
        known = _compiled(self.model, self.family, name) if many else None
        numbers = np.array([*self.kp, *self.kv, *self.viscous, self.eps0])[:, None]
        if known is not None:
            values = known(*columns, np.broadcast_to(numbers, (len(numbers), count)))
        else:
            values = np.empty((OUTPUTS[name][0], count))
            for start in range(0, count, BLOCK):
                block = slice(start, start + BLOCK)
                with np.errstate(all="ignore"):
                    at = self.at_columns(*(x[:, block].T for x in columns))
                    values[:, block] = np.stack(OUTPUTS[name][1](at, self.eps0))
        return values.reshape(-1, *shape)


def _compiled(model: RobotModel, family: Family, name: str) -> Loop | None:
    """The loop over states; gains, B and ε₀ are its parameters."""
    n, write = model.n, partial(formula, model, family, name)
    return loop(question(name, model, family), (n, n, n, 3 * n + 1), OUTPUTS[name][0], write)


def formula(model: RobotModel, family: Family, name: str, writer: Any, inputs: Sequence[Any]) -> list[Any]:
    """What the loop does with (q, e, w, parameters)."""
    (q, e, w, p), of, n = inputs, writer.arithmetic, model.n
    at = AtState(model, of, forms_in(family, of), q, e, w, p[:n], p[n : 2 * n], p[2 * n : 3 * n])
    return OUTPUTS[name][1](at, p[3 * n])


def question(name: str, model: RobotModel, family: Family) -> tuple[str, ...]:
    """What the loops of an arm and a family depend on, a family of a user's own with its source."""
    return name, arm_digest(model), repr(family), _source_of(type(family))


@cache
def _source_of(kind: type) -> str:
    return Path(inspect.getfile(kind)).read_text(encoding="utf-8")


@lru_cache(maxsize=256)
def arm_digest(model: RobotModel) -> str:
    """Of all that M, C, g of an arm depend on."""
    known = model.dynamics
    state = known.__getstate__() if hasattr(type(known), "__setstate__") else known
    return store.exact(state, model.parameters)
