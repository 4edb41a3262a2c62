"""Rational bounds that a proof script states about numbers and robots; the claims made with them are decided.

What these functions hand back is a proposal: a claim that uses a wrong one is refuted or stays open.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from flint import arb, ctx

from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.inertia import Mass, MassAbove, MassBelow
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.claims.expressions import Expr, closed_value, diff, exact_value, expr, sqrt, var
from lyapcheck.claims.statements import for_all, identity, norm_bound
from lyapcheck.search.closed_loop import mass_of

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

Function = tuple[Expr, Expr, Expr]
"""h, h' and U in x."""
T = TypeVar("T", Fraction, Expr)

BITS = 128
DIGITS = 4
HALVINGS = 60


def above(value: object, digits: int = DIGITS) -> Fraction:
    """Round a number up to a decimal with this many places.

    Raises:
        ValueError: it contains variables, or has no value.
    """
    with ctx.workprec(BITS):
        upper = Enclosure.from_arb(ball(closed_value(value))).upper
    return _ceiling(upper * 10**digits) / Fraction(10**digits)


def below(value: object, digits: int = DIGITS) -> Fraction:
    """The decimal number of so many places that is at most a number, and nearest to it."""
    return -above(-expr(value), digits)


class FamilyBounds:
    """Decimal bounds of an odd function h that claims can prove, and their consequences.

    Args:
        n: the number of joints.
        gamma: at least sup |h|, an exact number or an expression.
        rho: at least sup |h'|.
        L: at least sup h(x)/x.

    ``reach`` bounds ‖h(e)‖ by √nγ. ``G`` bounds ‖h(e)‖/(1 + ‖e‖) by the r with Lr = √nγ.
    """

    def __init__(self, n: int, gamma: object, rho: object, L: object) -> None:
        self.n = n
        self.gamma, self.rho, self.L = above(gamma), above(rho), above(L)
        self.reach = above(sqrt(n)) * self.gamma
        self.G = self.reach * self.L / (self.reach + self.L)

    def of_h(self, h: Function) -> AllOf:
        """That these are bounds of h, as theorems ask for it: |h| <= γ, |h'| <= ρ, |h(x)| <= L|x|, h odd."""
        x, (value, slope, _) = var("x"), h
        return AllOf(
            (
                ("h(−x) = −h(x)", identity(value.at(x=-x), -value)),
                ("0 < h(x) for x > 0", for_all(expr(0) < value, 0, open_low=True)),
                ("h ≤ γ", for_all(value <= self.gamma)),
                ("−γ ≤ h", for_all(expr(-self.gamma) <= value)),
                ("h' is the derivative of h", identity(diff(value, "x"), slope)),
                ("h' ≤ ρ", for_all(slope <= self.rho)),
                ("−ρ ≤ h'", for_all(expr(-self.rho) <= slope)),
                ("|h(x)| ≤ L|x|", norm_bound(value, 1, self.L, power=1)),
            )
        )

    def drift(self, beta: T, kc: T) -> T:
        """c = β_M(ρ + G) + √nγ k_c."""
        return beta * (self.rho + self.G) + kc * self.reach

    def cross(self, b_max: T, kv_max: T) -> T:
        """d = λmax(B) + L λmax(K_v)."""
        return b_max + kv_max * self.L


class ArmBounds:
    """M(q) ≻ 0, β_M, k_c, λmin(B) and λmax(B) of a robot at its nominal numbers, with their statements.

    ‖M(q)‖ is at most its largest row sum of absolute values. ‖C(q,x)y‖ is at most (Σ c_ijk²)^½ ‖x‖‖y‖.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot.fixed()
        self.viscous = tuple(number.value for number in self.robot.viscous)
        self.b_min, self.b_max = min(self.viscous), max(self.viscous)

    @cached_property
    def mass(self) -> Mass:
        """M(q) as statements have it."""
        return mass_of(self.robot)

    @cached_property
    def inertia(self) -> Inertia:
        """M(q) as the checker bounds it."""
        return Inertia(self.mass, ())

    @cached_property
    def beta(self) -> Fraction:
        """β_M, kg·m²."""
        return above(self.inertia.largest_row)

    @cached_property
    def kc(self) -> Fraction:
        """k_c, kg·m²."""
        return above(sqrt(self.inertia.squares_of_symbols))

    def guessed_floor(self) -> Fraction:
        """Half of λmin(M) at a few postures, down to a power of two, kg·m²: a proposal for ``mass_above``."""
        import numpy as np

        postures = ([Fraction(k * (i + 1), 3) for i in range(self.robot.n)] for k in range(7))
        result = min(float(np.linalg.eigvalsh(_doubles(self.inertia.at(q, ())))[0]) for q in postures)
        return Fraction(2) ** math.floor(math.log2(result / 2)) if result > 0 else Fraction(1, 2**20)

    def mass_above(self, low: object = 0) -> MassAbove:
        """M(q) − low·I is positive definite for all q."""
        return MassAbove(self.mass, (), exact_value(low))

    def mass_below(self) -> MassBelow:
        """‖M(q)‖ <= β_M for all q."""
        return MassBelow(self.mass, (), self.beta)

    def coriolis_below(self) -> CoriolisBelow:
        """‖C(q, x)y‖ <= k_c ‖x‖ ‖y‖ for all q, x and y."""
        return CoriolisBelow(self.mass, (), self.kc)


def _doubles(rows: list[list[arb]]) -> list[list[float]]:
    return [[float(entry) for entry in row] for row in rows]


def largest_with(holds: Callable[[Fraction], bool], start: object = 1) -> Fraction | None:
    """Return the largest positive number, to six digits, up to which a condition holds.

    Args:
        holds: the condition. If it is true for a number, it is true for every smaller positive number.
        start: the first number to try.

    Returns:
        None if neither ``start`` nor its halves satisfy the condition.
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
