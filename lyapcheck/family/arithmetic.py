"""The operations beyond + - * / that numeric forms need, for NumPy arrays and CasADi graphs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any


@dataclass(frozen=True)
class Arithmetic:
    """One kind of number: how to branch on it and how to take its elementary functions."""

    where: Callable[[Any, Any, Any], Any]
    fabs: Callable[[Any], Any]
    smaller: Callable[[Any, Any], Any]
    larger: Callable[[Any, Any], Any]
    sqrt: Callable[[Any], Any]
    log: Callable[[Any], Any]
    arctan: Callable[[Any], Any]


@cache
def arrays() -> Arithmetic:
    """NumPy arrays of doubles."""
    import numpy as np

    return Arithmetic(
        where=np.where,
        fabs=np.abs,
        smaller=np.minimum,
        larger=np.maximum,
        sqrt=np.sqrt,
        log=np.log,
        arctan=np.arctan,
    )


@cache
def graphs() -> Arithmetic:
    """CasADi SX expressions."""
    import casadi as ca

    return Arithmetic(
        where=ca.if_else,
        fabs=ca.fabs,
        smaller=ca.fmin,
        larger=ca.fmax,
        sqrt=ca.sqrt,
        log=ca.log,
        arctan=ca.atan,
    )
