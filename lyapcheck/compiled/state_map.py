"""Functions of states (q, e, w) compiled into loops over many states."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.library import library, resource
from lyapcheck.compiled.straight_line import StraightLine, Term, TooLong
from lyapcheck.compiled.threads import over_shares

Columns = list[Term]
Formula = Callable[[StraightLine, Columns, Columns, Columns, Columns], Sequence[Any]]
"""(code, q, e, w, parameters) ↦ the outputs."""

LANES = 64
"""States worked on together."""


class StateMap:
    """A compiled function of states and parameters; `state_map` makes one.

    Args:
        call: ``map_states`` of its library.
        n: joints.
        outputs: how many numbers it gives.

    Soundness: plain doubles, rounded to nearest, without bounds.
    """

    def __init__(self, call: Any, n: int, outputs: int) -> None:
        self._call, self.n, self.outputs = call, n, outputs

    def __call__(self, q: Array, e: Array, w: Array, parameters: Array) -> Array | None:
        """The outputs (groups, count, outputs) at states (groups, count, n) with parameters (groups, p).

        Returns:
            None where a state is not finite or beyond the range of the compiled functions.
        """
        groups, count, _ = q.shape
        out = np.empty((groups, count, self.outputs))

        def share(start: int, stop: int) -> int:
            if groups == 1:
                parts = [x[:, start:stop] for x in (q, e, w)]
                return int(self._call(1, stop - start, *map(_at, (*parts, parameters, out[:, start:stop]))))
            parts = [x[start:stop] for x in (q, e, w, parameters, out)]
            return int(self._call(stop - start, count, *map(_at, parts)))

        total = count if groups == 1 else groups
        bad = over_shares(share, total, LANES if groups == 1 else 1) if total else 0
        return None if bad else out


def state_map(formula: Formula, n: int, parameters: int, outputs: int) -> StateMap | None:
    """Compile a function of states; none where there is no compiler or the function is too long.

    Args:
        formula: writes the function on terms.
        n: joints.
        parameters: how many parameters it has.
        outputs: how many numbers it gives.
    """
    try:
        source = _source(formula, n, parameters, outputs)
    except TooLong:
        return None
    result = library(source)
    if result is None:
        return None
    call = result.map_states
    call.restype = ctypes.c_int64
    call.argtypes = [ctypes.c_int64] * 2 + [ctypes.c_void_p] * 5
    return StateMap(call, n, outputs)


def _source(formula: Formula, n: int, parameters: int, outputs: int) -> str:
    code = StraightLine()
    q, e, w = ([code.name(f"{x}[{i}][l]") for i in range(n)] for x in "qew")
    values = formula(code, q, e, w, [code.name(f"p[{i}]") for i in range(parameters)])
    body = code.store([f"out[{k}][l]" for k in range(outputs)], values)
    sizes = {"N": n, "P": parameters, "OUT": outputs, "LANES": LANES}
    defines = [f"#define {name} {size}" for name, size in sizes.items()]
    return "\n".join([*defines, resource("map.c").replace("MAP_BODY\n", body + "\n"), ""])


def _at(values: Array) -> int:
    return values.ctypes.data
