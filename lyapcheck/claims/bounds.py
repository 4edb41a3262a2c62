"""Rational bounds that a proof script states about numbers and robots; the claims made with them are decided.

What these functions hand back is a proposal: a claim that uses a wrong one is refuted or stays open.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from flint import ctx

from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.trigonometric import largest, lowest
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.statement import Relation
from lyapcheck.check.theorems.closed_loop import ClosedLoop
from lyapcheck.claims.arms import coriolis_matrix, mass_matrix
from lyapcheck.claims.exact import closed_value, exact_value
from lyapcheck.claims.expressions import Expr, expr, sqrt

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

T = TypeVar("T", Fraction, Expr)

BITS = 128
DIGITS = 4
HALVINGS = 60


def above(value: object, digits: int = DIGITS) -> Fraction:
    """The decimal number of so many places that is at least a number, and nearest to it.

    Raises:
        ValueError: it contains variables, or has no value.
    """
    with ctx.workprec(BITS):
        upper = Enclosure.from_arb(ball(closed_value(value))).upper
    return _ceiling(upper * 10**digits) / Fraction(10**digits)


def below(value: object, digits: int = DIGITS) -> Fraction:
    """The decimal number of so many places that is at most a number, and nearest to it."""
    return -above(-expr(value), digits)


def entry_sizes(entries: Iterable[Expr]) -> list[Fraction]:
    """For each polynomial in sines and cosines a number that its absolute value does not exceed."""
    return [largest(entry.tree) for entry in entries]


def entry_floors(entries: Iterable[Expr]) -> list[Fraction]:
    """For each polynomial in sines and cosines a number that it does not fall below."""
    return [lowest(entry.tree) for entry in entries]


class FamilyBounds:
    """Decimal numbers that claims can show to be bounds of an odd function h, and what follows from them.

    Args:
        n: the number of joints.
        gamma: at least sup |h|, an exact number or an expression; likewise the next two.
        rho: at least sup |h'|.
        L: at least sup h(x)/x.

    ``reach`` bounds ‖h(e)‖ by √nγ, and ``G`` bounds ‖h(e)‖/(1 + ‖e‖): min(Lr, √nγ)/(1 + r) is largest where
    both agree.
    """

    def __init__(self, n: int, gamma: object, rho: object, L: object) -> None:
        self.n = n
        self.gamma, self.rho, self.L = above(gamma), above(rho), above(L)
        self.reach = above(sqrt(n)) * self.gamma
        self.G = self.reach * self.L / (self.reach + self.L)

    def loop(
        self,
        h: tuple[Expr, Expr, Expr],
        form: tuple[Expr, Expr, Expr],
        desired: bool = False,
        condition: Iterable[Relation] = (),
        **numbers: Fraction,
    ) -> ClosedLoop:
        """The loop (11) with these bounds, as theorems are about it.

        Args:
            h: the function, its derivative and its potential U, in x.
            form: θ11, θ12, θ22 of dV/dt <= −[a b] Θ [a b]ᵀ in eps, kp, b_min, b_max, kv_max, beta, kc and vd.
            desired: whether C is C(q, q̇_d + w) with ‖q̇_d‖ <= vd.
            condition: what is asked of eps0 and the constants.
            numbers: the constants and eps0, where the conclusion is for these alone.
        """
        function, slope, potential = h
        corner, side, low = form
        return ClosedLoop(
            self.n,
            function.tree,
            slope.tree,
            potential.tree,
            *(self.gamma, self.rho, self.L, self.reach, self.G),
            (corner.tree, side.tree, low.tree),
            desired,
            tuple(condition),
            tuple(sorted(numbers.items())),
        )

    def drift(self, beta: T, kc: T) -> T:
        """c = β_M(ρ + G) + √nγ k_c."""
        return beta * (self.rho + self.G) + kc * self.reach

    def cross(self, b_max: T, kv_max: T) -> T:
        """d = λmax(B) + L λmax(K_v)."""
        return b_max + kv_max * self.L


class ArmBounds:
    """β_M, k_c, λmin(B) and λmax(B) of a robot without ranges, with the entries and sizes behind them.

    ‖M(q)‖ is at most its largest row sum of absolute values; ‖C(q,x)y‖ is at most (Σ c_ijk²)^½ ‖x‖‖y‖.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot
        friction = [number.value for number in robot.viscous]
        self.b_min, self.b_max = min(friction), max(friction)

    @cached_property
    def mass(self) -> list[Expr]:
        """The entries of M(q), row by row."""
        return [entry for row in mass_matrix(self.robot) for entry in row]

    @cached_property
    def sizes(self) -> list[Fraction]:
        """Bounds of the entries of M(q)."""
        return entry_sizes(self.mass)

    @cached_property
    def rows(self) -> list[Fraction]:
        """The sums of the rows of ``sizes``."""
        n = self.robot.n
        return [sum(self.sizes[n * i : n * i + n], Fraction(0)) for i in range(n)]

    @cached_property
    def symbols(self) -> list[Expr]:
        """The entries of C(q, unit k), row by row, for each k."""
        n = self.robot.n
        units = [[expr(int(i == j)) for i in range(n)] for j in range(n)]
        return [entry for unit in units for row in coriolis_matrix(self.robot, unit) for entry in row]

    @cached_property
    def symbol_sizes(self) -> list[Fraction]:
        """Bounds of the Christoffel symbols."""
        return entry_sizes(self.symbols)

    @cached_property
    def squares(self) -> Fraction:
        """Σ c_ijk²."""
        return sum((size**2 for size in self.symbol_sizes), Fraction(0))

    @cached_property
    def beta(self) -> Fraction:
        """β_M, kg·m²."""
        return above(max(self.rows))

    @cached_property
    def kc(self) -> Fraction:
        """k_c, kg·m²."""
        return above(sqrt(self.squares))


def largest_with(holds: Callable[[Fraction], bool], start: object = 1) -> Fraction | None:
    """The largest positive number, to six digits, up to which a condition that is lost once holds.

    Args:
        holds: the condition; true for every smaller positive number where it is true.
        start: where to begin.

    Returns:
        ``None`` where the condition is met neither by ``start`` nor by its halves.
    """
    low = exact_value(start)
    for _ in range(HALVINGS):
        if holds(low):
            break
        low /= 2
    else:
        return None
    high = 2 * low
    while high - low > low / 10**6:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low.limit_denominator(_ceiling(10**7 / low))


def _ceiling(value: Fraction) -> int:
    return -(-value.numerator // value.denominator)
