"""The statements of lyapcheck's own loop given to numba: what is left is what compiles them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np

from lyapcheck.compiled.writer import Writer
from lyapcheck.lyapunov.numeric import LyapunovNumeric, formula

CHOICE = re.compile(r"\(\((.+?)\) \? \(\s*(\S+)\s*\)\s*: \(\s*(\S+)\s*\)\)")
LOOP = """
from math import copysign, cos, expm1, fabs, log, log1p, sin, sqrt

from numba import njit, prange

@njit(fastmath=True)
def smaller(a, b): return b if a > b else a

@njit(fastmath=True)
def larger(a, b): return b if a < b else a

@njit(parallel=True, fastmath=True)
def run(q, e, w, p):
    out = np.empty(len(q))
    for k in prange(len(q)):
        {body}
    return out
"""


def numba_loop(kept: LyapunovNumeric, name: str) -> Callable[..., np.ndarray]:
    """A function of rows (count, n) of q, e and w."""
    writer, n = Writer(), kept.model.n
    rows = [[writer.read(f"{x}[k, {i}]") for i in range(n)] for x in "qew"]
    numbers = [writer.read(f"p[{i}]") for i in range(3 * n + 1)]
    text = writer.body(["out[k]"], formula(kept.model, kept.family, name, writer, [*rows, numbers]))
    lines = [line for line in CHOICE.sub(r"(\2 if \1 else \3)", text).splitlines() if line]
    body = "\n        ".join(_python(line) for line in lines)
    made: dict[str, Any] = {"np": np}
    exec(LOOP.format(body=body), made)
    p = np.array([*kept.kp, *kept.kv, *kept.viscous, kept.eps0])
    return lambda q, e, w: made["run"](q, e, w, p)


def _python(line: str) -> str:
    """A statement of C in Python."""
    bare = line.removeprefix("const double ").rstrip(";").replace("v_", "")
    return re.sub(r"-?0x[0-9a-f.]+p[+-]\d+", lambda found: repr(float.fromhex(found[0])), bare)
