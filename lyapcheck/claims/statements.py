"""The kinds of statement that a claim can make, as data; the kind chooses the procedure that decides it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.functions import Tree
from lyapcheck.claims.expressions import Expr, Relation, expr


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
class Missing(Statement):
    """A statement that this case cannot give: a gain set or a robot is lacking."""

    reason: str


def identity(left: object, right: object) -> Identity:
    """``left = right`` for all values of the variables."""
    return Identity(expr(left).tree, expr(right).tree)


def for_all(
    relation: Relation,
    low: object | None = None,
    high: object | None = None,
    open_low: bool = False,
    open_high: bool = False,
    variable: str = "x",
) -> ForAll:
    """A relation for every x from low to high, ends included unless said to be open; None is infinity."""
    return ForAll(relation, _end(low), _end(high), open_low, open_high, variable)


def norm_bound(component: Expr, n: int, bound: object, power: int = 0) -> NormBound:
    """``‖(f(x_i))_i‖ <= bound · ‖x‖^power`` for every x in Rⁿ."""
    return NormBound(component.tree, n, expr(bound).tree, power)


def positive(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all positive reals."""
    return tuple(Variable(name, Fraction(0)) for name in names)


def nonnegative(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all reals >= 0."""
    return tuple(Variable(name, Fraction(0), strict=False) for name in names)


def reals(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all reals."""
    return tuple(Variable(name) for name in names)


def implies(
    variables: tuple[Variable, ...], hypotheses: tuple[Relation, ...], conclusion: Relation
) -> Implies:
    """For all values of the variables: the hypotheses together give the conclusion."""
    return Implies(variables, hypotheses, conclusion)


def all_of(**parts: Statement) -> AllOf:
    """Every part holds; the keywords name them (underscores read as spaces)."""
    return AllOf(tuple((name.replace("_", " "), part) for name, part in parts.items()))


def agrees(formula: Expr, printed: str, solve_for: str | None = None, **inputs: str) -> Agrees:
    """A printed number agrees with a formula whose variables are the printed numbers ``inputs``."""
    return Agrees(formula.tree, tuple(sorted(inputs.items())), printed, solve_for)


def _exact(value: object) -> Fraction:
    """The rational value of an exact number."""
    return Fraction(expr(value).tree[1])


def _end(value: object | None) -> Fraction | None:
    return None if value is None else _exact(value)


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


@dataclass(frozen=True)
class Theorem(Statement):
    """A theorem applied: each of its hypotheses is a claim that this one uses."""

    name: str
    hypotheses: tuple[tuple[str, str], ...]


def majorant(constant: object = 1, **powers: int) -> Majorant:
    """``constant · Π symbol^power``."""
    return Majorant(expr(constant).tree, tuple(sorted(powers.items())))


def norm_chain(
    factors: Iterable[tuple[Majorant, ...]], bound: Majorant, smaller: tuple[tuple[str, str], ...] = ()
) -> NormChain:
    """A product of factors is at most a bound."""
    return NormChain(tuple(factors), bound, smaller)


def bounded(entries: Iterable[Expr], by: Iterable[object] | None = None) -> TrigonometricBound:
    """Polynomials in sines and cosines are bounded, or bounded by given numbers."""
    trees = [entry.tree for entry in entries]
    limits = [None] * len(trees) if by is None else [_exact(b) for b in by]
    return TrigonometricBound(tuple(zip(trees, limits, strict=True)))


def always_positive(entries: Iterable[Expr]) -> TrigonometricPositive:
    """Polynomials in sines and cosines are positive for all angles."""
    return TrigonometricPositive(tuple(entry.tree for entry in entries))


def theorem(name: str, **hypotheses: str) -> Theorem:
    """A theorem applied; the keywords name its hypotheses, their values are the ids of claims."""
    return Theorem(name, tuple((key.replace("_", " "), claim) for key, claim in hypotheses.items()))
