"""Families whose numeric forms are short expressions, the same for floats, arrays and graphs."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.family.arithmetic import Arithmetic, arrays, graphs
from lyapcheck.family.base import CasadiForms, Family

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lyapcheck.family.base import Doubles


@dataclass(frozen=True)
class NumericForms:
    """h, h', U and h(x)/x in one arithmetic."""

    h: Any
    dh: Any
    potential: Any
    secant: Any


@dataclass(frozen=True)
class ElementaryFamily(Family):
    """A family that gives its numeric forms once, in terms of an arithmetic."""

    @abstractmethod
    def numeric(self, of: Arithmetic, x: Any) -> NumericForms:
        """The forms at x, accurate to a few units in the last place."""

    def h(self, x: ArrayLike) -> Doubles:
        """h(x)."""
        return self._array(x, "h")

    def dh(self, x: ArrayLike) -> Doubles:
        """h'(x)."""
        return self._array(x, "dh")

    def potential(self, x: ArrayLike) -> Doubles:
        """U(x)."""
        return self._array(x, "potential")

    def secant(self, x: ArrayLike) -> Doubles:
        """h(x)/x."""
        return self._array(x, "secant")

    def casadi(self, x: Any) -> CasadiForms:
        """The same expressions as CasADi SX."""
        forms = self.numeric(graphs(), x)
        return CasadiForms(forms.h, forms.dh, forms.potential, forms.secant)

    def _array(self, x: ArrayLike, form: str) -> Doubles:
        import numpy as np

        x = np.asarray(x, dtype=float)
        with np.errstate(all="ignore"):
            values = getattr(self.numeric(arrays(), x), form)
        return np.where(np.isnan(x), x, values)
