"""The batch of runs integrated by compiled code."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from importlib.resources import files
from typing import Any

from lyapcheck.compiled.forms import PlainForms, has_plain_forms
from lyapcheck.compiled.library import library
from lyapcheck.compiled.straight_line import StraightLine, TooLong
from lyapcheck.compiled.threads import over_shares
from lyapcheck.family import Family
from lyapcheck.robots import RobotModel
from lyapcheck.simulate.batch import dop853
from lyapcheck.simulate.batch.dop853 import Weights
from lyapcheck.simulate.batch.integrator import InitialValueProblems, Paths, empty_paths
from lyapcheck.simulate.batch.loop import LoopColumns, parameter_count

LANES = 8
"""Runs that advance together in one thread."""


class CompiledRuns:
    """The integrator for one arm and one family; `compiled_runs` makes one."""

    name = "compiled"

    def __init__(self, call: Any) -> None:
        self._call = call

    def __call__(self, problems: InitialValueProblems) -> Paths:
        """Integrate every run to T, in threads."""
        paths, of = empty_paths(problems), problems

        def share(start: int, stop: int) -> int:
            inputs = (x[start:stop].ctypes.data for x in (of.y0, of.parameters, of.bands))
            numbers = (of.T, of.tolerance, of.tolerance / 100, of.max_steps)
            arrays = (paths.y, paths.seen, paths.status, paths.steps)
            outputs = (x[start:stop].ctypes.data for x in arrays)
            self._call(stop - start, of.points, *inputs, *numbers, *outputs)
            return 0

        over_shares(share, len(of.y0), LANES)
        return paths


@lru_cache(maxsize=32)
def compiled_runs(model: RobotModel, family: Family) -> CompiledRuns | None:
    """Compile the integrator; none where there is no compiler or the arm's formulas are too long."""
    if not has_plain_forms(family):
        return None
    try:
        result = library(_source(model, family))
    except TooLong:
        return None
    if result is None:
        return None
    whole, number, place = ctypes.c_int64, ctypes.c_double, ctypes.c_void_p
    call = result.integrate_runs
    call.restype = None
    call.argtypes = [whole, whole, *3 * [place], *3 * [number], whole, *4 * [place]]
    return CompiledRuns(call)


def _source(model: RobotModel, family: Family) -> str:
    n, size, count = model.n, 2 * model.n + 2, parameter_count(model)
    functions = []
    for head, formula in ((_RATE, LoopColumns.rate), (_WATCH, LoopColumns.watched)):
        code = StraightLine()
        loop = LoopColumns(model, PlainForms(code, family), [code.name(f"p[{i}][l]") for i in range(count)])
        values = formula(loop, [code.name(f"y[{i}][l]") for i in range(size)])
        body = code.store([f"out[{i}][l]" for i in range(len(values))], values)
        functions.append(head + _LOOP.replace("BODY", body))
    sizes = {"N": n, "D": size, "P": count, "LANES": LANES}
    defines = [f"#define {name} {value}" for name, value in (sizes | _table()).items()]
    return "\n".join([*defines, *functions, *map(_resource, ("dop853.c", "extremes.c", "batch.c"))])


_RATE = "static void rate(const double y[D][LANES], const double p[P][LANES], double out[D][LANES])"
_WATCH = "static void watch(const double y[D][LANES], const double p[P][LANES], double out[N + 1][LANES])"
_LOOP = """
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
BODY
    }
}
"""


def _resource(name: str) -> str:
    return files("lyapcheck.simulate.batch").joinpath(name).read_text(encoding="utf-8")


def _table() -> dict[str, str]:
    """The weights of the method as C expressions in the stages k."""
    rows = {f"STAGE_{i}": row for i, row in enumerate(dop853.STAGES, start=1)}
    rows |= {f"EXTRA_{i}": row for i, row in enumerate(dop853.EXTRA, start=13)}
    rows |= {f"DENSE_{i}": row for i, row in enumerate(dop853.DENSE, start=3)}
    rows |= {"STEP": dop853.STEP, "ERROR_5": dop853.ERROR_5, "ERROR_3": dop853.ERROR_3}
    return {name: _sum(row) for name, row in rows.items()}


def _sum(row: Weights) -> str:
    return " + ".join(f"({weight.hex()}) * s->k[{j}][i][l]" for j, weight in row.items())
