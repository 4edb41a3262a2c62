"""The operations of recorded code carried out on NumPy arrays at once: the fallback of compiled loops."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

_OPERATIONS: dict[str, Callable[..., Any]] = {
    "sine": np.sin,
    "cosine": np.cos,
    "sqrt": np.sqrt,
    "log": np.log,
    "atan": np.arctan,
    "fabs": np.abs,
    "copysign": np.copysign,
    "smaller": np.minimum,
    "larger": np.maximum,
    "exp_of_negative": lambda a: np.exp(-a),
    "one_minus_exp": lambda a: -np.expm1(-a),
    "log_one_plus": np.log1p,
}


class PlainArrays:
    """Stands where a formula expects a `Code`: what that would record, this does.

    Soundness: the same formulas in the same plain doubles, with NumPy's elementary functions.
    """

    def term(self, value: Any) -> Any:
        """A number as it is."""
        return value

    def call(self, function: str, *arguments: Any) -> Any:
        """A function of arrays under its name in C."""
        return _OPERATIONS[function](*arguments)

    def where(self, condition: Any, yes: Any, no: Any) -> Any:
        """``yes`` where the condition holds, else ``no``."""
        return np.where(condition, yes, no)
