"""The matrices of a robot as expressions for a proof script."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.chain import ChainAbove, ChainIdentity
from lyapcheck.check.kinds.coriolis import CoriolisAtRest, MassSymmetric, RateLessTwiceCoriolis, RateOfMass
from lyapcheck.check.statement import Ends, Statement
from lyapcheck.claims.bounds import ArmBounds
from lyapcheck.claims.claim import lacking
from lyapcheck.claims.expressions import Expr, cos, diff, expr, sin, total, var
from lyapcheck.claims.letters import Matrix, Vector, vector
from lyapcheck.claims.statements import bounded
from lyapcheck.control import limits as arm_limits
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms
from lyapcheck.search.closed_loop import mass_of

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.dynamics import ArmAtAngles, Chain


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


def ranges_of(robot: RobotModel) -> tuple[Ends, ...]:
    """The range of each uncertain number, in the order in which polynomials have them."""
    return tuple(number.bounds for number in robot.parameters.values())


def mass_symmetric(robot: RobotModel) -> Statement:
    """M(q) = M(q)ᵀ."""
    return _of_links(robot, "symmetric") or MassSymmetric(mass_of(robot), ranges_of(robot))


def coriolis_at_rest(robot: RobotModel) -> Statement:
    """C(q, 0) = 0, C by Christoffel symbols."""
    return _of_links(robot, "at rest") or CoriolisAtRest(mass_of(robot), ranges_of(robot), ())


def rate_of_mass(robot: RobotModel) -> Statement:
    """Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ, and both are symmetric."""
    return _of_links(robot, "rate") or RateOfMass(mass_of(robot), ranges_of(robot), ())


def rate_less_twice_coriolis(robot: RobotModel) -> Statement:
    """½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric."""
    return _of_links(robot, "skew") or RateLessTwiceCoriolis(mass_of(robot), ranges_of(robot), ())


def mass_positive(robot: RobotModel) -> Statement:
    """M(q) ≻ 0 at the robot's nominal numbers."""
    chain = _chain(robot.fixed())
    return ArmBounds(robot).mass_above() if chain is None else ChainAbove(chain.links, Fraction(0))


def mass_bounded(robot: RobotModel) -> Statement:
    """‖M(q)‖ ≤ β_M at the robot's nominal numbers."""
    return _along_links(robot, "lambda_max") or ArmBounds(robot).mass_below()


def coriolis_bounded(robot: RobotModel) -> Statement:
    """‖C(q, x)y‖ ≤ k_c ‖x‖ ‖y‖ at the robot's nominal numbers.

    Raises:
        Lacking: M(q) is too long to be written out.
    """
    try:
        return _along_links(robot, "k_c") or ArmBounds(robot).coriolis_below()
    except TooManyTerms as error:
        raise lacking(str(error)) from None


def gravity_bounded(robot: RobotModel) -> Statement:
    """‖g(q)‖, or every |g_i(q)|, is bounded at the robot's nominal numbers."""
    return _along_links(robot, "k_g") or bounded(gravity_vector(robot.fixed()))


def _along_links(robot: RobotModel, name: str) -> Statement | None:
    """A bound of a constant of an arm of many joints: a thousandth larger than was shown, in four digits.

    Its proof is looked for again by who decides the claim, maybe in a process with other threads of BLAS,
    where the semidefinite program may end at a slightly larger bound.
    """
    from lyapcheck.constants.storage import storage_proof

    chain = _chain(robot.fixed())
    shown = None if chain is None else storage_proof(chain, name)
    return None if shown is None else shown.at_end(significant_up(shown.bound * Fraction(1001, 1000), 4))


def _of_links(robot: RobotModel, identity: str) -> ChainIdentity | None:
    chain = _chain(robot)
    return None if chain is None else ChainIdentity(chain.links, identity)


def _chain(robot: RobotModel) -> Chain | None:
    """The links of an arm of many joints, whose polynomials are long."""
    return robot.chain if robot.n > FEW_JOINTS else None
