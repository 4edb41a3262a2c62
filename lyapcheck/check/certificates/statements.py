"""The kinds of statement that a certificate can be about, as data.

References: ``reyes2019family``.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.functions import Tree
from lyapcheck.check.witness import Comparison


@dataclass(frozen=True)
class Relation:
    """``left <= right`` or ``left < right``."""

    left: Tree
    operator: str
    right: Tree

    def __post_init__(self) -> None:
        if self.operator not in ("<=", "<"):
            raise ValueError(f"a relation has <= or <, not {self.operator!r}")

    @property
    def strict(self) -> bool:
        """Whether equality is excluded."""
        return self.operator == "<"

    @property
    def gap(self) -> Tree:
        """``right - left``, which the relation says is not negative (positive, if strict)."""
        return ("add", self.right, ("neg", self.left))

    @property
    def comparison(self) -> Comparison:
        """The relation as witnesses are replayed."""
        return self.left, self.operator, self.right

    def __bool__(self) -> bool:
        raise TypeError(
            "a relation is a statement to decide, it has no truth value; write a < b and b < c as two"
        )


class Statement:
    """Something that is true or false, as plain data."""


@dataclass(frozen=True)
class Identity(Statement):
    """``left = right`` for all values of the variables."""

    left: Tree
    right: Tree


@dataclass(frozen=True)
class ForAll(Statement):
    """A relation for every value of one variable in the interval from low to high (None: unbounded)."""

    relation: Relation
    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False
    variable: str = "x"


@dataclass(frozen=True)
class Constant(Statement):
    """A relation between numbers."""

    relation: Relation


@dataclass(frozen=True)
class NormBound(Statement):
    """``‖(f(x_1), …, f(x_n))‖ <= bound · ‖x‖^power`` for every x in Rⁿ; f an expression in the variable x."""

    component: Tree
    n: int
    bound: Tree
    power: int = 0


@dataclass(frozen=True)
class Variable:
    """A real variable of an implication; ``low`` bounds it from below, strictly when ``strict``."""

    name: str
    low: Fraction | None = None
    strict: bool = True


@dataclass(frozen=True)
class Implies(Statement):
    """For all values of the variables: if every hypothesis holds, so does the conclusion."""

    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation


@dataclass(frozen=True)
class ForSmall(Statement):
    """If the hypotheses hold, the relation holds for every small enough positive value of one variable.

    Every variable named in ``bounded`` runs over (0, 1], and the threshold serves all of them.
    """

    small: str
    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation
    bounded: tuple[str, ...] = ()


@dataclass(frozen=True)
class Agrees(Statement):
    """A printed number agrees with a formula in printed numbers, to half a unit in each last place.

    Where it does not, the value that ``solve_for`` would need is reported; the formula is proportional to it.
    """

    formula: Tree
    inputs: tuple[tuple[str, str], ...]
    printed: str
    solve_for: str | None = None


@dataclass(frozen=True)
class AllOf(Statement):
    """Every part holds; each part has a name for the report."""

    parts: tuple[tuple[str, Statement], ...]


@dataclass(frozen=True)
class Majorant:
    """``constant · Π symbol^power``: a product of norms, named constants and ε, all of them >= 0."""

    constant: Tree
    powers: tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class NormChain(Statement):
    """A product of factors is at most a bound, by the Cauchy–Schwarz inequality.

    Each factor lists its majorants, any of which may be used; ``smaller`` pairs symbols (a, b) with a <= b.
    """

    factors: tuple[tuple[Majorant, ...], ...]
    bound: Majorant
    smaller: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class TrigonometricBound(Statement):
    """``|f_i(q)| <= bound_i`` for all q, each f_i a polynomial in sines and cosines of q.

    A bound of ``None`` asks only that f_i is bounded.
    """

    entries: tuple[tuple[Tree, Fraction | None], ...]


@dataclass(frozen=True)
class TrigonometricPositive(Statement):
    """``f_i(q) > 0`` for all q, each f_i a polynomial in sines and cosines of q."""

    entries: tuple[Tree, ...]


Ends = tuple[Fraction, Fraction]
Monomials = tuple[tuple[tuple[int, ...], Fraction], ...]
"""Exponents of s1 … sn, c1 … cn and the parameters, with the coefficient."""


@dataclass(frozen=True)
class Decreasing(Statement):
    """dV/dt < 0 along (11) at every state but the origin, for every arm in the ranges.

    ``mass`` is M(q), kg·m²; ``viscous`` the range of each diagonal entry of B, N·m·s/rad; ``parameters`` the
    range of each parameter in M; ``family`` and ``m`` name h; ``kp`` and ``kv`` are in N·m, ``eps0`` is ε₀;
    ``coupling`` is the diagonal of Λ in y = w − εΛh, empty for (13).
    """

    mass: tuple[tuple[Monomials, ...], ...]
    viscous: tuple[Ends, ...]
    parameters: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction
    coupling: tuple[Fraction, ...]


@dataclass(frozen=True)
class DampingBelow(Statement):
    """For all κ > 0 and ε₀ > 0: where dV/dt < 0 at every state but the origin, κ λmax(K_v) < bound.

    The gains are K_p and κ K_v; the other fields are those of ``Decreasing``, with (13) for V.
    """

    mass: tuple[tuple[Monomials, ...], ...]
    viscous: tuple[Ends, ...]
    parameters: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    bound: Tree

    def with_damping(self, factor: Fraction, eps0: Fraction) -> Decreasing:
        """That dV/dt < 0 at one κ and one ε₀."""
        kv = tuple(factor * k for k in self.kv)
        arm = (self.mass, self.viscous, self.parameters)
        return Decreasing(*arm, self.family, self.m, self.kp, kv, eps0, ())

    def below(self, factor: Fraction) -> Constant:
        """That κ λmax(K_v) < bound at one κ."""
        return Constant(Relation(("num", str(factor * max(self.kv))), "<", self.bound))
