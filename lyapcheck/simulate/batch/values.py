"""V along many runs."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.forms import PlainForms, has_plain_forms
from lyapcheck.compiled.state_map import StateMap, state_map
from lyapcheck.compiled.straight_line import StraightLine, Term
from lyapcheck.family import Family
from lyapcheck.robots import RobotModel
from lyapcheck.simulate.batch.loop import LoopColumns, parameter_count
from lyapcheck.simulate.batch.numpy_integrator import array_forms


def values_of(model: RobotModel, family: Family, q: Array, e: Array, w: Array, parameters: Array) -> Array:
    """V (R, points) of states (R, points, n) with parameters (R, p), by compiled code where there is any."""
    missing = np.isnan(q[:, :, 0])
    if missing.any():
        q, e, w = (np.where(missing[:, :, None], 0.0, x) for x in (q, e, w))
    kernel = compiled_value(model, family)
    known = None if kernel is None else kernel(*map(np.ascontiguousarray, (q, e, w, parameters)))
    if known is None:
        loop = LoopColumns(model, array_forms(family), list(parameters.T[:, :, None]))
        values = np.array(loop.value(*(list(np.moveaxis(x, 2, 0)) for x in (q, e, w))))
    else:
        values = known[:, :, 0]
    values[missing] = np.nan
    return values


@lru_cache(maxsize=32)
def compiled_value(model: RobotModel, family: Family) -> StateMap | None:
    """The formula of V compiled; none where that is not possible."""

    def formula(code: StraightLine, q: list[Term], e: list[Term], w: list[Term], p: list[Term]) -> list[Any]:
        return [LoopColumns(model, PlainForms(code, family), p).value(q, e, w)]

    return state_map(formula, model.n, parameter_count(model), 1) if has_plain_forms(family) else None
