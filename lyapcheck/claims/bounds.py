"""Rational bounds that a proof script states about numbers and robots; the claims made with them are decided.

What these functions hand back is a proposal: a claim that uses a wrong one is refuted or stays open.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, TypeVar

from flint import ctx

from lyapcheck.asked import bound_of_constant
from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.chain import ChainAbove, ChainIdentity
from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    CoriolisBelow,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.numbers.polynomials import Enclosure, root_above
from lyapcheck.check.statement import Mass, Statement
from lyapcheck.claims.claim import lacking
from lyapcheck.claims.expressions import (
    Expr,
    closed_value,
    cos,
    diff,
    exact_value,
    expr,
    sin,
    sqrt,
    total,
    var,
)
from lyapcheck.claims.letters import Matrix, Vector, vector
from lyapcheck.claims.statements import for_all, identity, norm_bound
from lyapcheck.control import limits as arm_limits
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.check.loop.chain import RigidLink
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.trig import ArmAtAngles


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
    Where M(q) is too long to be written out, bounds along the links take their place.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot.fixed()
        self.viscous = tuple(number.value for number in self.robot.viscous)
        self.b_min, self.b_max = min(self.viscous), max(self.viscous)

    @property
    def mass(self) -> Mass:
        """M(q) as statements have it."""
        return self.robot.mass_terms

    @property
    def inertia(self) -> Inertia:
        """M(q) as the checker bounds it."""
        return _inertia(self.robot)

    @cached_property
    def links(self) -> Chain | None:
        """The links where M(q) is too long to be written out."""
        try:
            return None if self.mass else self.robot.chain
        except TooManyTerms:
            if self.robot.chain is None:
                raise
            return self.robot.chain

    @property
    def beta(self) -> Fraction:
        """β_M, kg·m²."""
        return above(self.inertia.largest_row) if self.links is None else self._shown("lambda_max")[1]

    @property
    def kc(self) -> Fraction:
        """k_c, kg·m²."""
        return above(sqrt(self.inertia.squares_of_symbols)) if self.links is None else self._shown("k_c")[1]

    def _shown(self, name: str) -> tuple[Statement, Fraction]:
        """A bound along the links, and its number.

        Raises:
            Lacking: none was found.
        """
        found = None if self.links is None else _of_chain(self.links.links, self.links.fall, name)
        if found is None:
            raise lacking(f"no bound of {name} was found along the links")
        return found

    def guessed_floor(self) -> Fraction:
        """Half of λmin(M) at a few postures, down to a power of two, kg·m²: a proposal for ``mass_above``."""
        import numpy as np

        from lyapcheck.robots.numeric import NumericModel

        model = NumericModel(self.robot)
        postures = np.array([[k * (i + 1) / 3 for i in range(self.robot.n)] for k in range(7)])
        result = float(np.linalg.eigvalsh(model.mass(postures)).min())
        return Fraction(2) ** math.floor(math.log2(result / 2)) if result > 0 else Fraction(1, 2**20)

    def mass_above(self, low: object = 0) -> MassAbove | ChainAbove:
        """M(q) − low·I is positive definite for all q."""
        least = exact_value(low)
        return MassAbove(self.mass, (), least) if self.links is None else ChainAbove(self.links.links, least)

    def mass_below(self) -> Statement:
        """‖M(q)‖ <= β_M for all q."""
        return MassBelow(self.mass, (), self.beta) if self.links is None else self._shown("lambda_max")[0]

    def gravity_below(self) -> GravityBelow:
        """‖g(q)‖ <= k_g for all q, where g(q) is written out."""
        gravity = tuple(tuple(to_terms(torque)) for torque in self.robot.gravity)
        bound = GravityBelow(self.robot.n, gravity, (), Fraction(0))
        return replace(bound, high=above(root_above(bound.square_by_sizes())))

    def coriolis_below(self) -> Statement:
        """‖C(q, x)y‖ <= k_c ‖x‖ ‖y‖ for all q, x and y."""
        return CoriolisBelow(self.mass, (), self.kc) if self.links is None else self._shown("k_c")[0]


@lru_cache(maxsize=4)
def _inertia(robot: RobotModel) -> Inertia:
    """Several claims ask for that of the same robot, and its harmonics can take seconds."""
    return Inertia(robot.mass_terms, ())


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


# --- The matrices of a robot as expressions for a proof script.


def mass_matrix(robot: RobotModel) -> Matrix:
    """M(q) in the variables q1, …, qn and the uncertain numbers of the robot by name."""
    return _place(robot).mass()


def coriolis_matrix(robot: RobotModel, x: Sequence[Expr]) -> Matrix:
    """C(q, x) of the Christoffel symbols."""
    return _place(robot).coriolis(x)


def gravity_vector(robot: RobotModel) -> Vector:
    """g(q)."""
    return _place(robot).gravity()


def rate_of(a: Matrix, w: Sequence[Expr]) -> Matrix:
    """dA(q)/dt along q̇ = w."""
    return [[total(diff(entry, f"q{k + 1}") * w[k] for k in range(len(w))) for entry in row] for row in a]


def _place(robot: RobotModel) -> ArmAtAngles:
    """The polynomials, written out, at the angles q1, …, qn."""
    q = vector("q", robot.n)
    sines, cosines = [sin(angle) for angle in q], [cos(angle) for angle in q]
    parameters = {name: var(name) for name in robot.parameters}
    return robot.dynamics.polynomials.at(sines, cosines, parameters, expr)


def torque_limits(robot: RobotModel) -> list[Fraction]:
    """τmax of each joint, N·m; of one with a range the least.

    Raises:
        Lacking: the robot has none for some joint.
    """
    result = [number.bounds[0] for number in robot.torque_limit if number is not None]
    if len(result) < robot.n:
        raise lacking("needs a torque limit for every joint; add it to the arm file")
    return result


def gravity_bounds(robot: RobotModel) -> list[Fraction]:
    """k_gi of each joint for all values of the ranges, N·m: printed by the source, else computed."""
    return list(arm_limits.gravity_bounds(robot))


# --- Properties of M(q) and C(q, w) of one robot as statements, for all values of its uncertain numbers.


def mass_symmetric(robot: RobotModel) -> Statement:
    """M(q) = M(q)ᵀ."""
    return _of_links(robot, "symmetric") or MassSymmetric(robot.mass_terms, robot.ranges)


def coriolis_at_rest(robot: RobotModel) -> Statement:
    """C(q, 0) = 0, C by Christoffel symbols."""
    return _of_links(robot, "at rest") or CoriolisAtRest(robot.mass_terms, robot.ranges, ())


def rate_of_mass(robot: RobotModel) -> Statement:
    """Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ, and both are symmetric."""
    return _of_links(robot, "rate") or RateOfMass(robot.mass_terms, robot.ranges, ())


def rate_less_twice_coriolis(robot: RobotModel) -> Statement:
    """½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric."""
    return _of_links(robot, "skew") or RateLessTwiceCoriolis(robot.mass_terms, robot.ranges, ())


def mass_positive(robot: RobotModel) -> Statement:
    """M(q) ≻ 0 at the robot's nominal numbers."""
    chain = _chain(robot.fixed())
    return ArmBounds(robot).mass_above() if chain is None else ChainAbove(chain.links, Fraction(0))


def mass_bounded(robot: RobotModel) -> Statement:
    """‖M(q)‖ ≤ β_M at the robot's nominal numbers."""
    return _along_links(robot, "lambda_max") or ArmBounds(robot).mass_below()


def coriolis_bounded(robot: RobotModel) -> Statement:
    """‖C(q, x)y‖ ≤ k_c ‖x‖ ‖y‖ at the robot's nominal numbers."""
    return _along_links(robot, "k_c") or ArmBounds(robot).coriolis_below()


def gravity_bounded(robot: RobotModel, by: Sequence[object] | None = None) -> Statement:
    """‖g(q)‖ at the robot's nominal numbers is at most a number, or every |g_i(q)| the one given for it."""
    if by is None:
        return _along_links(robot, "k_g") or ArmBounds(robot).gravity_below()
    ends = list(map(exact_value, by))
    nominal = robot.fixed()
    long = _chain(nominal) is not None
    bounds = (bound_of_constant(f"k_g{i}", nominal, end, long) for i, end in enumerate(ends, 1))
    return AllOf(tuple((f"joint {i}", bound) for i, bound in enumerate(bounds, 1)))


def _along_links(robot: RobotModel, name: str) -> Statement | None:
    """A bound of a constant of an arm of many joints."""
    chain = _chain(robot.fixed())
    found = None if chain is None else _of_chain(chain.links, chain.fall, name)
    return None if found is None else found[0]


@lru_cache(maxsize=8)
def _of_chain(
    links: tuple[RigidLink, ...], fall: tuple[Fraction, ...], name: str
) -> tuple[Statement, Fraction] | None:
    """A bound and its number: a thousandth larger than was shown, in four digits.

    Its proof is looked for again by who decides the claim, maybe in a process with other threads of BLAS,
    where the semidefinite program may end at a slightly larger bound.
    """
    from lyapcheck.constants.storage import storage_proof

    shown = storage_proof(Chain(links, fall), name)
    if shown is None:
        return None
    number = significant_up(shown.bound * Fraction(1001, 1000), 4)
    return shown.at_end(number), number


def _of_links(robot: RobotModel, identity: str) -> ChainIdentity | None:
    chain = _chain(robot)
    return None if chain is None else ChainIdentity(chain.links, identity)


def _chain(robot: RobotModel) -> Chain | None:
    """The links of an arm of many joints, whose polynomials are long."""
    return robot.chain if robot.n > FEW_JOINTS else None
