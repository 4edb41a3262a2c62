"""What every family offers: its values in four arithmetics, and its constants."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from flint import arb

from lyapcheck.check.expressions.grammar import MAX_M
from lyapcheck.check.numbers.members import Member, member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.errors import argument_error
from lyapcheck.extensions import modules
from lyapcheck.family import members

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from lyapcheck.check.expressions.expression import Tree

    Doubles = NDArray[Any]


# --- The operations beyond + - * / that formulas need, for NumPy arrays, CasADi graphs and written code.


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


PLAIN = ("sqrt", "log", "sin", "cos", "expm1", "log1p", "copysign")
"""Functions that NumPy and CasADi call by the same names."""


@cache
def arrays() -> Arithmetic:
    """NumPy arrays of doubles."""
    import numpy as np

    own: dict[str, Any] = {"where": np.where, "fabs": np.abs, "smaller": np.minimum, "larger": np.maximum}
    own |= {"arctan": np.arctan, "nearest": np.rint}
    return Arithmetic(**own, **{name: getattr(np, name) for name in PLAIN})


@cache
def graphs() -> Arithmetic:
    """CasADi SX expressions."""
    import casadi as ca

    own: dict[str, Any] = {
        "where": ca.if_else,
        "fabs": ca.fabs,
        "smaller": ca.fmin,
        "larger": ca.fmax,
        "arctan": ca.atan,
    }
    own["nearest"] = lambda a: ca.floor(a + 0.5)
    return Arithmetic(**own, **{name: getattr(ca, name) for name in PLAIN})


@dataclass(frozen=True)
class SymbolicForms:
    """h, h' and U as SymPy expressions."""

    h: Any
    dh: Any
    potential: Any


@dataclass(frozen=True)
class NumericForms:
    """h, h', U and h(x)/x in one arithmetic, the last continued by h'(0) at 0."""

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
        """One of ``NumericForms`` at each element; NaN stays NaN."""
        import numpy as np

        x = np.asarray(x, dtype=float)
        with np.errstate(all="ignore"):
            values = getattr(self.numeric(arrays(), x), form)
        return np.where(np.isnan(x), x, values)

    @abstractmethod
    def numeric(self, of: Arithmetic, x: Any) -> Any:
        """What `NumericForms` has, perhaps worked out when asked for, to a few units in the last place."""

    @abstractmethod
    def sympy(self, x: Any) -> SymbolicForms:
        """h, h' and U at a SymPy expression."""

    def casadi(self, x: Any) -> Any:
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

    @abstractmethod
    def constants(self, digits: int = 30) -> FamilyConstants:
        """γ, ρ and L to at least ``digits`` significant digits."""


# --- The families by name: each file in ``members`` is one, and nothing else need know of a new one.

LARGEST_M = MAX_M
"""The largest of which the checker judges statements."""


@cache
def names() -> tuple[str, ...]:
    """The names of all families, sorted."""
    return modules(members.__path__)


@lru_cache(maxsize=None, typed=True)  # typed: 1 == 1.0 == True, and only the first is an m
def named(name: str, m: int | None = None) -> Family:
    """The family of a name; ``m`` chooses the member of a family that has members.

    Raises:
        InputError: an unknown name, a missing m, or an m that the family does not have.
    """
    if name not in names():
        raise argument_error("family", name, f"is not one of {', '.join(names())}", "name one of these")
    family: Family = import_module(f"lyapcheck.family.members.{name}").create(m)
    return family


def require_member(m: object) -> int:
    """The m of a hyperbolic family, or the error that says what is wrong with it."""
    if isinstance(m, bool) or not isinstance(m, int) or not 1 <= m <= LARGEST_M:
        rule = f"must be a whole number from 1 to {LARGEST_M}"
        raise argument_error("m", m, rule, "give the member of the family, for instance m = 3")
    return m


def require_none(name: str, m: object) -> None:
    """Refuse an m for a family that has a single member."""
    if m is not None:
        raise argument_error("m", m, f"has no meaning for the family {name}", "leave m out")


def hyperbolic(m: int) -> Family:
    """The paper's family, member m: h = sinh^(2m-1) cosh / (1 + sinh^(2m))."""
    return named("hyperbolic", m)
