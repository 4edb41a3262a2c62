"""Runs on the bench by compiled code."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.compiler import prelude
from lyapcheck.compiled.loop import TooLong, Writer, compiled
from lyapcheck.family import Family
from lyapcheck.lyapunov.numeric import arm_digest
from lyapcheck.robots import RobotModel
from studies.printed_experiment.bench_step import BenchStep, parameter_count

LANES = 8
"""Runs that advance together."""


class CompiledBench:
    """The bench for one arm, one family and one period; `compiled_bench` makes one."""

    def __init__(self, call: Any) -> None:
        self._call = call

    def __call__(self, starts: Array, parameters: Array, periods: int) -> Array:
        """(R, periods + 1, 3n) q, w, τ from starts (R, 2n) and parameters (R, p), both without gaps."""
        runs, size = starts.shape
        out = np.empty((runs, periods + 1, size // 2 * 3))
        self._call(runs, periods, starts.ctypes.data, parameters.ctypes.data, out.ctypes.data)
        return out


@lru_cache(maxsize=32)
def compiled_bench(
    model: RobotModel, family: Family, period: float, substeps: int, sweeps: int
) -> CompiledBench | None:
    """Compile the bench; none where there is no compiler or the arm's formulas are too long."""
    question = (
        arm_digest(model),
        model.encoder,
        model.torque_limit,
        family,
        period,
        substeps,
        sweeps,
        *_files(),
    )
    result = compiled(question, lambda: _source(model, family, period, substeps, sweeps))
    if result is None:
        return None
    whole, place = ctypes.c_int64, ctypes.c_void_p
    result.bench_runs.restype = None
    result.bench_runs.argtypes = [whole, whole, place, place, place]
    return CompiledBench(result.bench_runs)


def _files() -> list[str]:
    """What the loop is made of besides lyapcheck."""
    here = files("studies.printed_experiment")
    return [here.joinpath(name).read_text(encoding="utf-8") for name in ("bench.c", "bench_step.py")]


def _source(model: RobotModel, family: Family, period: float, substeps: int, sweeps: int) -> str | None:
    sizes = {"N": model.n, "P": parameter_count(model), "LANES": LANES, "SUBSTEPS": substeps}
    defines = [f"#define {name} {value}" for name, value in (sizes | {"PERIOD": period.hex()}).items()]
    try:
        parts = [_controller(model, family, period), _arm(model, family, period, substeps, sweeps)]
    except TooLong:
        return None
    return "\n".join([prelude(), "#include <stdint.h>", *defines, *parts, _files()[0]])


def _controller(model: RobotModel, family: Family, period: float) -> str:
    writer, n = Writer(), model.n
    q, last = _names(writer, "y", n), _names(writer, "last", n)
    torque, readings = _step(model, family, writer, period, 0).controller(q, last)
    places = [f"{x}[{i}][l]" for x in ("torque", "last") for i in range(n)]
    body = writer.body(places, [*torque, *readings])
    return _function("controller", "double last[N][LANES], double torque[N][LANES]", body)


def _arm(model: RobotModel, family: Family, period: float, substeps: int, sweeps: int) -> str:
    writer, n = Writer(), model.n
    y, torque = _names(writer, "y", 2 * n), _names(writer, "torque", n)
    step = _step(model, family, writer, period, sweeps)
    q, w = step.move(y[:n], y[n:], torque, period / substeps)
    body = writer.body([f"y[{i}][l]" for i in range(2 * n)], [*q, *w])
    return _function("arm", "const double torque[N][LANES]", body)


def _step(model: RobotModel, family: Family, writer: Writer, period: float, sweeps: int) -> BenchStep:
    parameters, of = _names(writer, "p", parameter_count(model)), writer.arithmetic
    return BenchStep(model, of, lambda x: family.numeric(of, x).h, parameters, period, sweeps)


def _names(writer: Writer, array: str, count: int) -> list[Any]:
    return [writer.read(f"{array}[{i}][l]") for i in range(count)]


def _function(name: str, arguments: str, body: str) -> str:
    return f"""
static void {name}(double y[2 * N][LANES], const double p[P][LANES], {arguments})
{{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {{
{body}
    }}
}}
"""
