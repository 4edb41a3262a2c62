"""V and dV/dt at many states at once, in float64: for sampling and simulation, never for a verdict."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, partial
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


@dataclass(frozen=True, eq=False)
class Formula:
    """A formula of one arm and family over arrays of lanes: compiled where that is asked, else by NumPy.

    Args:
        name: the formula's own, of those of an arm and a family.
        model: the arm.
        family: the function h.
        sizes: entries a lane of each array.
        outputs: how many numbers come out a lane.
        write: (model, arithmetic, forms of the family, the entries of each array) ↦ the outputs.
    """

    name: str
    model: RobotModel
    family: Family
    sizes: tuple[int, ...]
    outputs: int
    write: Callable[..., Sequence[Any]]

    @cached_property
    def loop(self) -> Loop | None:
        """The compiled loop; none where there is no compiler."""
        question = (self.name, arm_digest(self.model), repr(self.family), _source_of(type(self.family)))
        return loop(question, self.sizes, self.outputs, lambda writer, x: self._at(writer.arithmetic, *x))

    def __call__(self, *arrays_of: Array, out: Array | None = None, compiled: bool = True) -> Array:
        """The outputs (outputs, lanes) of arrays (entries, lanes), in ``out`` if given."""
        if compiled and self.loop is not None:
            return self.loop(*arrays_of, out=out)
        lanes = arrays_of[0].shape[1]
        out = np.empty((self.outputs, lanes)) if out is None else out
        for start in range(0, lanes, BLOCK):
            block = slice(start, start + BLOCK)
            with np.errstate(all="ignore"):
                values = self._at(arrays(), *(list(np.ascontiguousarray(x[:, block])) for x in arrays_of))
                for row, value in zip(out, values, strict=True):
                    row[block] = value
        return out

    def _at(self, of: Arithmetic, *inputs: Sequence[Any]) -> Sequence[Any]:
        return self.write(self.model, of, partial(self.family.numeric, of), *inputs)


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
        columns = [list(np.ascontiguousarray(x.T)) for x in (q, e, w)]
        forms, gains = partial(self.family.numeric, arrays()), (self.kp, self.kv, self.viscous)
        return AtState(self.model, arrays(), forms, columns[0], columns[1], columns[2], *gains)

    def engine(self, count: int = LARGE) -> Literal["compiled", "numpy"]:
        """What serves a batch of ``count`` states; asking about a large one compiles what it needs."""
        ready = count >= LARGE and all(self._formula(name).loop is not None for name in ("value", "rate"))
        return "compiled" if ready else "numpy"

    def _formula(self, name: str) -> Formula:
        n, (outputs, value) = self.model.n, OUTPUTS[name]

        def write(model: RobotModel, of: Arithmetic, forms: FormsAt, *x: Sequence[Any]) -> list[Any]:
            q, e, w, p = x
            return value(AtState(model, of, forms, q, e, w, p[:n], p[n : 2 * n], p[2 * n : 3 * n]), p[3 * n])

        return Formula(name, self.model, self.family, (n, n, n, 3 * n + 1), outputs, write)

    def _at(self, name: str, q: Array, e: Array, w: Array, large: int | None = None) -> Array:
        states = [np.asarray(x, dtype=np.float64) for x in np.broadcast_arrays(q, e, w)]
        columns = [x.reshape(-1, self.model.n).T for x in states]
        count, numbers = columns[0].shape[1], np.array([*self.kp, *self.kv, *self.viscous, self.eps0])
        parameters = np.broadcast_to(numbers[:, None], (len(numbers), count))
        compiled = count >= (LARGE if large is None else large)
        values = self._formula(name)(*columns, parameters, compiled=compiled)
        return values.reshape(-1, *states[0].shape[:-1])


@cache
def _source_of(kind: type) -> str:
    return Path(inspect.getfile(kind)).read_text(encoding="utf-8")


@lru_cache(maxsize=256)
def arm_digest(model: RobotModel) -> str:
    """Of all that M, C, g of an arm depend on."""
    known = model.dynamics
    state = known.__getstate__() if hasattr(type(known), "__setstate__") else known
    return store.exact(state, model.parameters)
