"""CasADi functions called without the cost of its argument conversions."""

from __future__ import annotations

from typing import Any

import numpy as np

from lyapcheck._types import Array


class Compiled:
    """A CasADi function of vectors with one dense output, evaluated on buffers in microseconds.

    The answer is a fresh array each time, (rows, columns), or (rows,) when there is a single column.
    """

    def __init__(self, function: Any) -> None:
        self._buffer, self._evaluate = function.buffer()
        self._inputs = [np.zeros(function.nnz_in(i)) for i in range(function.n_in())]
        rows, columns = function.size_out(0)
        self._shape = (rows,) if columns == 1 else (columns, rows)
        self._output = np.zeros(rows * columns)
        for i, values in enumerate(self._inputs):
            self._buffer.set_arg(i, memoryview(values.data))
        self._buffer.set_res(0, memoryview(self._output.data))

    def __call__(self, *values: Array) -> Array:
        """The output at the given inputs, in the order of the function's arguments."""
        for held, given in zip(self._inputs, values, strict=True):
            held[:] = given
        self._evaluate()
        return self._output.reshape(self._shape).T.copy()
