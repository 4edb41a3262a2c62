"""Families whose numeric forms are short expressions, the same for floats, arrays and graphs."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.family.arithmetic import Arithmetic, arrays, graphs
from lyapcheck.family.base import Family, NumericForms

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lyapcheck.family.base import Doubles


@dataclass(frozen=True)
class ElementaryFamily(Family):
    """A family that gives its numeric forms once, in terms of an arithmetic."""

    @abstractmethod
    def numeric(self, of: Arithmetic, x: Any) -> NumericForms:
        """The forms at x, accurate to a few units in the last place."""

    def casadi(self, x: Any) -> NumericForms:
        """The same expressions as CasADi SX."""
        return self.numeric(graphs(), x)

    def values(self, x: ArrayLike, form: str) -> Doubles:
        """The same expressions for an array."""
        import numpy as np

        x = np.asarray(x, dtype=float)
        with np.errstate(all="ignore"):
            values = getattr(self.numeric(arrays(), x), form)
        return np.where(np.isnan(x), x, values)
