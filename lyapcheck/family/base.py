"""What every family offers: its values in four arithmetics, and its constants."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from flint import arb

from lyapcheck.check.numbers.members import Member, member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.errors import argument_error
from lyapcheck.family.arithmetic import Arithmetic, arrays, graphs

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from lyapcheck.check.expressions.expression import Tree

    Doubles = NDArray[Any]


@dataclass(frozen=True)
class SymbolicForms:
    """h, h' and U as SymPy expressions."""

    h: Any
    dh: Any
    potential: Any


class Forms(Protocol):
    """h(x), h'(x), U(x) and h(x)/x in one arithmetic; each may be worked out when it is asked for."""

    @property
    def h(self) -> Any:
        """h(x)."""

    @property
    def dh(self) -> Any:
        """h'(x)."""

    @property
    def potential(self) -> Any:
        """U(x)."""

    @property
    def secant(self) -> Any:
        """h(x)/x, continued by h'(0) at 0."""


@dataclass(frozen=True)
class NumericForms:
    """h, h', U and h(x)/x in one arithmetic."""

    h: Any
    dh: Any
    potential: Any
    secant: Any


@dataclass(frozen=True)
class FamilyConstants:
    """γ = sup h, ρ = sup |h'|, L = sup h(x)/x and where they are reached.

    ``gamma`` is ``None`` for an unbounded function; a place is ``None`` where only the limit reaches it.
    """

    gamma: Enclosure | None
    rho: Enclosure
    L: Enclosure
    gamma_at: Enclosure | None
    rho_at: Enclosure | None
    L_at: Enclosure | None


@dataclass(frozen=True)
class Family(ABC):
    """An odd function h of one angle or rate, zero only at 0, with h' and the potential U (U' = h, U(0) = 0).

    NumPy forms take any array of doubles and work elementwise. ±inf gives the limit, and NaN stays NaN. The
    argument is in rad for joint errors, in rad/s for rates. h is dimensionless, a gain gives it a unit.
    """

    name: str
    m: int | None = None
    bounded: bool = True

    @property
    @abstractmethod
    def gamma(self) -> Tree | None:
        """γ = sup h as a term that the checker knows; ``None`` where h is unbounded."""

    def h(self, x: ArrayLike) -> Doubles:
        """h(x)."""
        return self.values(x, "h")

    def dh(self, x: ArrayLike) -> Doubles:
        """h'(x)."""
        return self.values(x, "dh")

    def potential(self, x: ArrayLike) -> Doubles:
        """U(x), the integral of h from 0 to x."""
        return self.values(x, "potential")

    def secant(self, x: ArrayLike) -> Doubles:
        """h(x)/x, continued by h'(0) at x = 0."""
        return self.values(x, "secant")

    def values(self, x: ArrayLike, form: str) -> Doubles:
        """One of ``Forms`` at each element; NaN stays NaN."""
        import numpy as np

        x = np.asarray(x, dtype=float)
        with np.errstate(all="ignore"):
            values = getattr(self.numeric(arrays(), x), form)
        return np.where(np.isnan(x), x, values)

    @abstractmethod
    def numeric(self, of: Arithmetic, x: Any) -> Forms:
        """h, h', U and h(x)/x in any arithmetic, accurate to a few units in the last place."""

    @abstractmethod
    def sympy(self, x: Any) -> SymbolicForms:
        """h, h' and U at a SymPy expression."""

    def casadi(self, x: Any) -> Forms:
        """The same, elementwise, at a CasADi SX expression."""
        return self.numeric(graphs(), x)

    @property
    def checked(self) -> Member:
        """The function of this name that the checker knows.

        Raises:
            InputError: there is none.
        """
        try:
            return member(self.name, self.m)
        except ValueError as error:
            repair = "give the checker a file for it, see docs/extend.md, or choose another family"
            raise argument_error("family", self.name, str(error), repair) from error

    def ball_h(self, x: arb) -> arb:
        """A ball that contains h over the ball x; by default that of the checker."""
        return self.checked.h(x)

    def ball_dh(self, x: arb) -> arb:
        """A ball that contains h' over the ball x; by default that of the checker."""
        return self.checked.dh(x)

    def ball_potential(self, x: arb) -> arb:
        """A ball that contains U over the ball x; by default that of the checker."""
        return self.checked.potential(x)

    def turning_points(self) -> tuple[tuple[arb, ...], tuple[arb, ...]]:
        """The x > 0 at which h, and those at which h', may stop being monotone; none by default."""
        return (), ()

    @abstractmethod
    def constants(self, digits: int = 30) -> FamilyConstants:
        """γ, ρ and L to at least ``digits`` significant digits."""
