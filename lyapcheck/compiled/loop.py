"""Formulas of many lanes as one C loop, printed by SymPy and kept under the digest of the question."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import lru_cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

import numpy as np

from lyapcheck import store
from lyapcheck._types import Array
from lyapcheck.compiled.compiler import compiler, machine, prelude
from lyapcheck.compiled.library import library
from lyapcheck.compiled.threads import over_shares

LANES = 64
"""Lanes worked on together."""
SHARE = 4096
"""Lanes from which a second processor is worth waking."""
Formula = Callable[[Any, Sequence[Sequence[Any]]], Sequence[Any]]
"""(writer, the entries of each array) ↦ the outputs."""


class Loop:
    """A compiled function of arrays; `loop` makes one.

    Soundness: plain doubles, rounded to nearest, without bounds. A lane does not depend on its company.
    """

    def __init__(self, run: Any, outputs: int) -> None:
        self._run, self.outputs = run, outputs

    def __call__(self, *arrays: Array, out: Array | None = None) -> Array:
        """The outputs (outputs, lanes) of arrays (entries, lanes) with any strides, in ``out`` if given."""
        lanes = arrays[0].shape[1]
        out = np.empty((self.outputs, lanes)) if out is None else out
        every = (*arrays, out)
        at = (ctypes.c_void_p * len(every))(*(x.__array_interface__["data"][0] for x in every))
        steps = (ctypes.c_long * (2 * len(every)))(*(s // 8 for x in every for s in x.strides))

        def share(start: int, stop: int) -> int:
            self._run(start, stop, at, steps)
            return 0

        if lanes < 2 * SHARE:
            share(0, lanes)
        else:
            over_shares(share, lanes, LANES)
        return out


def loop(question: Sequence[object], sizes: Sequence[int], outputs: int, formula: Formula) -> Loop | None:
    """The loop that answers a question; none where there is no compiler, or the formula is too long.

    Args:
        question: all that the formula depends on, such as an arm and a family; equal questions share a loop.
        sizes: entries a lane of each array.
        outputs: how many numbers come out a lane.
        formula: writes the statements; asked only where the loop is not kept already.
    """
    made: list[Loop | None] = _made(_key(question, sizes), str(store.home()), compiler())
    if not made:
        known = compiled((*question, *sizes), lambda: source(sizes, outputs, formula))
        if known is not None:
            known.run.restype = None
            known.run.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
        made.append(None if known is None else Loop(known.run, outputs))
    return made[0]


def compiled(question: Sequence[object], write: Callable[[], str | None]) -> ctypes.CDLL | None:
    """The library of the C text that answers a question; none where there is no compiler or no text.

    Args:
        question: all that the text depends on besides the source of lyapcheck.
        write: the text; asked only where nothing is kept under the question.
    """
    command = compiler()
    if command is None:
        return None
    return library(store.exact(_key(question), machine(command)), command, write)


def _key(*question: object) -> str:
    return store.exact(*question, store.source_digest())


@lru_cache(maxsize=64)
def _made(key: str, home: str, command: str | None) -> list[Loop | None]:
    """A place for the loop of a question, cache and compiler; empty until it is made."""
    return []


def source(sizes: Sequence[int], outputs: int, formula: Formula) -> str | None:
    """The C text; none where it is too long."""
    from lyapcheck.compiled.writer import TooLong, Writer

    writer, ends = Writer(), [sum(sizes[:k]) for k in range(len(sizes) + 1)]
    try:
        inputs = [writer.read(f"x[{i}][l]") for i in range(ends[-1])]
        values = formula(writer, [inputs[a:b] for a, b in pairwise(ends)])
        body = writer.body([f"y[{k}][l]" for k in range(outputs)], values)
    except TooLong:
        return None
    numbers = {"GROUPS": len(sizes), "INPUTS": ends[-1], "OUTPUTS": outputs, "LANES": LANES}
    defines = [f"#define {name} {value}" for name, value in numbers.items()]
    defines.append(f"static const int SIZES[] = {{{', '.join(map(str, sizes))}}};")
    text = files("lyapcheck.compiled").joinpath("loop.c").read_text(encoding="utf-8")
    return "\n".join([prelude(), *defines, text.replace("BODY", body)])
