"""The matrices of a robot as expressions for a proof script."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.claims.case import lacking
from lyapcheck.claims.expressions import Expr, cos, diff, expr, sin, total, var
from lyapcheck.claims.products import Matrix, Vector, vector

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


MOST_ROWS = 4


def determinant(a: Matrix) -> Expr:
    """det A, by expansion along the first row."""
    if len(a) == 1:
        return a[0][0]
    minors = ([row[:j] + row[j + 1 :] for row in a[1:]] for j in range(len(a)))
    return total((-1) ** j * a[0][j] * determinant(minor) for j, minor in enumerate(minors))


def leading_minors(a: Matrix) -> Vector:
    """The leading principal minors: a symmetric A is positive definite where all are positive (Sylvester).

    Raises:
        Lacking: for more rows than determinants can be written out for.
    """
    if len(a) > MOST_ROWS:
        raise lacking(f"the determinants of {len(a)} rows are too large to be written out")
    return [determinant([row[:k] for row in a[:k]]) for k in range(1, len(a) + 1)]


def mass_matrix(robot: RobotModel) -> Matrix:
    """M(q) in the variables q1, …, qn and the uncertain numbers of the robot by name."""
    return robot.mass_at(*_angles(robot), _lift(), _parameters(robot))


def coriolis_matrix(robot: RobotModel, x: Sequence[Expr]) -> Matrix:
    """C(q, x) of the Christoffel symbols."""
    return robot.coriolis_at(*_angles(robot), x, _lift(), _parameters(robot))


def gravity_vector(robot: RobotModel) -> Vector:
    """g(q)."""
    return robot.gravity_at(*_angles(robot), _lift(), _parameters(robot))


def rate_of(a: Matrix, w: Sequence[Expr]) -> Matrix:
    """dA(q)/dt along q̇ = w."""
    return [[total(diff(entry, f"q{k + 1}") * w[k] for k in range(len(w))) for entry in row] for row in a]


def _angles(robot: RobotModel) -> tuple[Vector, Vector]:
    q = vector("q", robot.n)
    return [sin(angle) for angle in q], [cos(angle) for angle in q]


def _parameters(robot: RobotModel) -> dict[str, Expr]:
    return {name: var(name) for name in robot.parameters}


def _lift() -> Callable[[Fraction], Expr]:
    return expr
