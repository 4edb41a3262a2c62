"""Torques and V along many runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.forms import PlainForms, has_plain_forms
from lyapcheck.compiled.state_map import StateMap, state_map
from lyapcheck.compiled.straight_line import Code, Term
from lyapcheck.family import Family
from lyapcheck.robots import RobotModel
from lyapcheck.simulate.batch_numpy import array_forms
from lyapcheck.simulate.batch_rates import Loop, parameter_count


class Signals:
    """(τ, V) at the samples of many runs, for one arm and one family.

    Args:
        model: the arm, with its uncertain parameters.
        family: the function h.
        kernel: the compiled formulas; none for NumPy.
    """

    def __init__(self, model: RobotModel, family: Family, kernel: StateMap | None) -> None:
        self._model, self._forms, self._kernel = model, array_forms(family), kernel

    def __call__(self, q: Array, e: Array, w: Array, parameters: Array) -> Array:
        """(R, points, n + 1) from states (R, points, n) and parameters (R, p); NaN where the state is."""
        missing = np.isnan(q[:, :, 0])
        if missing.any():
            q, e, w = (np.where(missing[:, :, None], 0.0, x) for x in (q, e, w))
        values = None if self._kernel is None else self._kernel(q, e, w, parameters)
        if values is None:
            values = self._by_arrays(q, e, w, parameters)
        values[missing] = np.nan
        return values

    def _by_arrays(self, q: Array, e: Array, w: Array, parameters: Array) -> Array:
        loop = Loop(self._model, self._forms, list(parameters.T[:, :, None]))
        columns = [list(np.moveaxis(x, 2, 0)) for x in (q, e, w)]
        values = _both(loop, columns[0], columns[1], columns[2])
        return np.stack([np.broadcast_to(x, q.shape[:2]) for x in values], axis=2)


@lru_cache(maxsize=32)
def compiled_signals(model: RobotModel, family: Family) -> StateMap | None:
    """The formulas of τ and V compiled; none where that is not possible."""

    def formula(code: Code, q: list[Term], e: list[Term], w: list[Term], p: list[Term]) -> list[Any]:
        return _both(Loop(model, PlainForms(code, family), p), q, e, w)

    if not has_plain_forms(family):
        return None
    return state_map(formula, model.n, parameter_count(model), model.n + 1)


def _both(loop: Loop, q: Sequence[Any], e: Sequence[Any], w: Sequence[Any]) -> list[Any]:
    return [*loop.torque(q, e, w), loop.value(q, e, w)]
