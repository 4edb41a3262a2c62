"""sin, cos and the functions of a family on columns of states, as NumPy arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lyapcheck._types import Array
from lyapcheck.family import Family


@dataclass(frozen=True, eq=False)
class ColumnForms:
    """What formulas ask of an arithmetic, for arrays and one family; accurate to the last places."""

    family: Family

    def sin(self, x: Array) -> Array:
        """sin x."""
        return np.asarray(np.sin(x))

    def cos(self, x: Array) -> Array:
        """cos x."""
        return np.asarray(np.cos(x))

    def sqrt(self, x: Array) -> Array:
        """√x."""
        return np.asarray(np.sqrt(x))

    def ratio(self, a: Array, b: Array) -> Array:
        """a/b, and 0 where b = 0."""
        return np.divide(a, b, out=np.zeros_like(b), where=b > 0.0)

    def h(self, x: Array) -> Array:
        """h(x)."""
        return self.family.h(x)

    def dh(self, x: Array) -> Array:
        """h'(x)."""
        return self.family.dh(x)

    def potential(self, x: Array) -> Array:
        """U(x)."""
        return self.family.potential(x)
