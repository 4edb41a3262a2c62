"""The closed loop (11) of many runs: their rates, torques and V, compiled where possible, else by NumPy.

References: (6), (11), (12) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.loop import Loop, loop
from lyapcheck.family import Family
from lyapcheck.family.arithmetic import Arithmetic, arrays
from lyapcheck.lyapunov.along import AtState, FormsAt, total
from lyapcheck.lyapunov.numeric import forms_in, question
from lyapcheck.robots import RobotModel

Columns = Sequence[Any]


@dataclass(frozen=True, eq=False)
class RightSide:
    """One arm under one family; states y = (q, w, D, S) and parameters as columns, see `parameter_count`.

    D is the energy that damping has taken, and S = ∫‖e‖².
    """

    model: RobotModel
    family: Family

    @property
    def engine(self) -> str:
        """``compiled`` or ``numpy``."""
        return "numpy" if self._loops is None else "compiled"

    def rate(self, y: Array, parameters: Array, out: Array) -> Array:
        """ẏ (2n + 2, R): w, ẇ, wᵀBw + wᵀK_v h(w), ‖e‖²."""
        return self._filled(0, y, parameters, out)

    def watched(self, y: Array, parameters: Array) -> Array:
        """(n + 1, R) |τ_i| and V."""
        return self._filled(1, y, parameters, np.empty((self.model.n + 1, y.shape[1])))

    def _filled(self, place: int, y: Array, parameters: Array, out: Array) -> Array:
        if self._loops is not None:
            return self._loops[place](y, parameters, out=out)
        at = _at(self.model, arrays(), forms_in(self.family, arrays()), list(y), list(parameters))
        with np.errstate(all="ignore"):
            for row, value in zip(out, _FORMULAS[place](at, parameters[-1]), strict=True):
                row[:] = value
        return out

    @cached_property
    def _loops(self) -> tuple[Loop, Loop] | None:
        n, sizes = self.model.n, (2 * self.model.n + 2, parameter_count(self.model))
        made = []
        for place, (name, outputs) in enumerate((("motion", sizes[0]), ("watched", n + 1))):
            asked = question(name, self.model, self.family)
            one = loop(asked, sizes, outputs, partial(_written, self.model, self.family, place))
            if one is None:
                return None
            made.append(one)
        return made[0], made[1]


def _written(model: RobotModel, family: Family, place: int, writer: Any, inputs: Sequence[Columns]) -> Any:
    of, (y, parameters) = writer.arithmetic, inputs
    return _FORMULAS[place](_at(model, of, forms_in(family, of), y, parameters), parameters[-1])


def _at(model: RobotModel, of: Arithmetic, forms: FormsAt, y: Columns, parameters: Columns) -> AtState:
    n = model.n
    q, w = list(y[:n]), list(y[n : 2 * n])
    goal, kp, kv, viscous = (parameters[i * n : (i + 1) * n] for i in range(4))
    e = of.names([d - x for d, x in zip(goal, q, strict=True)])
    uncertain = dict(zip(model.parameters, parameters[4 * n : -1], strict=True))
    return AtState(model, of, forms, q, e, w, kp, kv, viscous, uncertain)


def _rate(at: AtState, _: Any) -> list[Any]:
    return [*at.w, *at.acceleration(), at.damping(), total(x * x for x in at.e)]


def _watched(at: AtState, eps0: Any) -> list[Any]:
    return [*map(at.of.fabs, at.torque()), at.value(eps0)]


_FORMULAS: tuple[Callable[[AtState, Any], list[Any]], ...] = (_rate, _watched)


def parameter_count(model: RobotModel) -> int:
    """How many numbers a run has besides its state: q_d, K_p, K_v, B (n each), uncertain ones, ε₀."""
    return 4 * model.n + len(model.parameters) + 1
