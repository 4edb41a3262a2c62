"""The operations beyond + - * / that formulas need, for NumPy arrays, CasADi graphs and written code."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
    nearest: Callable[[Any], Any]
    """The nearest whole number (any of two at a tie)."""
    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    expm1: Callable[[Any], Any]
    log1p: Callable[[Any], Any]
    copysign: Callable[[Any, Any], Any]
    lift: Callable[[Any], Any] = float
    """An exact number as a value."""
    names: Callable[[Sequence[Any]], list[Any]] = list
    """Values that are used more than once: as they are, but where formulas are written down."""

    def name(self, value: Any) -> Any:
        """A value that is used more than once."""
        return self.names([value])[0]


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
        nearest=np.rint,
        sin=np.sin,
        cos=np.cos,
        expm1=np.expm1,
        log1p=np.log1p,
        copysign=np.copysign,
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
        nearest=lambda a: ca.floor(a + 0.5),
        sin=ca.sin,
        cos=ca.cos,
        expm1=ca.expm1,
        log1p=ca.log1p,
        copysign=ca.copysign,
    )
