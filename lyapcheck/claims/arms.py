"""The matrices of a robot, or of any robot, as expressions for a proof script."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.claims.expressions import Expr, cos, diff, expr, sin, total, var

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

Vector = list[Expr]
Matrix = list[list[Expr]]


def vector(name: str, n: int) -> Vector:
    """The variables name1, …, namen."""
    return [var(f"{name}{i + 1}") for i in range(n)]


def matrix(name: str, n: int, symmetric: bool = False) -> Matrix:
    """An n × n matrix of variables name11, name12, …."""
    return [
        [
            var(f"{name}{min(i, j) + 1}{max(i, j) + 1}" if symmetric else f"{name}{i + 1}{j + 1}")
            for j in range(n)
        ]
        for i in range(n)
    ]


def dot(x: Sequence[Expr], y: Sequence[Expr]) -> Expr:
    """xᵀy."""
    return total(a * b for a, b in zip(x, y, strict=True))


def apply(a: Matrix, x: Sequence[Expr]) -> Vector:
    """A x."""
    return [dot(row, x) for row in a]


def form(x: Sequence[Expr], a: Matrix, y: Sequence[Expr]) -> Expr:
    """xᵀ A y."""
    return dot(x, apply(a, y))


def transpose(a: Matrix) -> Matrix:
    """Aᵀ."""
    return [list(column) for column in zip(*a, strict=True)]


def plus(a: Matrix, b: Matrix) -> Matrix:
    """A + B."""
    return [[x + y for x, y in zip(p, q, strict=True)] for p, q in zip(a, b, strict=True)]


def determinant(a: Matrix) -> Expr:
    """det A, by expansion along the first row."""
    if len(a) == 1:
        return a[0][0]
    minors = ([row[:j] + row[j + 1 :] for row in a[1:]] for j in range(len(a)))
    return total((-1) ** j * a[0][j] * determinant(minor) for j, minor in enumerate(minors))


def leading_minors(a: Matrix) -> Vector:
    """The leading principal minors: a symmetric A is positive definite where all are positive (Sylvester)."""
    return [determinant([row[:k] for row in a[:k]]) for k in range(1, len(a) + 1)]


def scaled(x: Sequence[Expr], y: Sequence[Expr]) -> Vector:
    """The elementwise product, diag(x) y."""
    return [a * b for a, b in zip(x, y, strict=True)]


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
