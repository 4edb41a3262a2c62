"""The links of an arm as moving bodies: their kinetic energies as expressions for a proof script.

The velocity v of the origin of a link's frame and its angular velocity ω, in the coordinates of that frame,
follow from those of the link before: with T its turn, R(q_k) the rotation about its axis a and p its place,

    ω_k = (T R)ᵀ ω_{k−1} + a x_k,        v_k = (T R)ᵀ (v_{k−1} + ω_{k−1} × p),

and twice its kinetic energy is m‖v + ω × c‖² + ωᵀ J ω, with J about the centre of mass c.

They show that M is positive definite where determinants are too large, see ``positive_definite``.

References: featherstone2008rigid, chapter 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.statement import Statement
from lyapcheck.claims.arms import leading_minors, mass_matrix
from lyapcheck.claims.expressions import Expr, cos, expr, sin, total, var
from lyapcheck.claims.products import Matrix, Vector, apply, dot, form, transpose, vector
from lyapcheck.claims.statements import all_of, always_positive, identity, implies, reals

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.chain import Chain, RigidLink

ZERO = expr(0).tree


@dataclass(frozen=True)
class Body:
    """One link in motion.

    Args:
        mass: kg.
        velocity: of its centre of mass, m/s.
        spin: its angular velocity, rad/s.
        inertia: about the centre of mass, kg·m².
        own: its moment about its own joint axis, kg·m².
    """

    mass: Expr
    velocity: Vector
    spin: Vector
    inertia: Matrix
    own: Expr

    @property
    def energy(self) -> Expr:
        """Twice the kinetic energy, J."""
        return self.mass * dot(self.velocity, self.velocity) + form(self.spin, self.inertia, self.spin)


def bodies(chain: Chain, x: Sequence[Expr]) -> list[Body]:
    """The links, base first, when the joints turn at the rates x; the angles are q1, …, qn.

    Args:
        chain: the links.
        x: a rate for each joint, rad/s.
    """
    spin, speed = [expr(0)] * 3, [expr(0)] * 3
    found = []
    for k, (link, rate) in enumerate(zip(chain.links, x, strict=True)):
        axis, com = _numbers(link.axis), _numbers(link.com)
        if not _at_rest(spin) or not _at_rest(speed):
            back = transpose(_turned(link, var(f"q{k + 1}")))
            speed = apply(back, _sum(speed, _cross(spin, _numbers(link.origin))))
            spin = apply(back, spin)
        spin = _sum(spin, [a * rate for a in axis]) if rate.tree != ZERO else spin
        mass, inertia = expr(link.mass), [_numbers(row) for row in link.inertia]
        arm = _cross(axis, com)
        own = mass * dot(arm, arm) + form(axis, inertia, axis)
        found.append(Body(mass, _sum(speed, _cross(spin, com)), spin, inertia, own))
    return found


def positive_definite(robot: RobotModel) -> AllOf:
    """M(q) ≻ 0 for all q: by the leading minors, or where the links are known by the first joint that moves.

    If joint k is the first that moves, its link turns about a fixed axis and has the energy ½ own x_k² > 0;
    no link has a negative one, and ½ xᵀMx is their sum.

    Args:
        robot: an arm without uncertain numbers.
    """
    mass = mass_matrix(robot)
    if robot.chain is None:
        return all_of(leading_minors_are_positive=always_positive(leading_minors(mass)))
    rates = vector("x", robot.n)
    links = bodies(robot.chain, rates)
    energies = total(link.energy for link in links)
    parts: dict[str, Statement] = {"sum_of_the_energies": identity(form(rates, mass, rates), energies)}
    for k in range(robot.n):
        first = bodies(robot.chain, [expr(0)] * k + rates[k:])[k]
        parts |= {f"{part}_{k + 1}": statement for part, statement in _first_to_move(first, rates[k]).items()}
    return all_of(**parts)


def _first_to_move(link: Body, rate: Expr) -> dict[str, Statement]:
    """What is needed of one link, the joints before which are at rest."""
    spin = vector("o", 3)
    return {
        "mass_not_negative": Constant(expr(0) <= link.mass),
        "inertia_not_negative": implies(
            reals("o1", "o2", "o3"), (), expr(0) <= form(spin, link.inertia, spin)
        ),
        "energy_when_its_joint_is_the_first_to_move": identity(link.energy, link.own * rate**2),
        "moment_about_its_axis_positive": Constant(expr(0) < link.own),
    }


def _turned(link: RigidLink, angle: Expr) -> Matrix:
    """T R(q): R = a aᵀ + cos q (I − a aᵀ) + sin q [a]×."""
    a, turn = _numbers(link.axis), [_numbers(row) for row in link.turn]
    units = [[expr(int(i == j)) for i in range(3)] for j in range(3)]
    columns = []
    for unit in units:
        along = dot(a, unit)
        across, around = [u - along * x for u, x in zip(unit, a, strict=True)], _cross(a, unit)
        column = [
            along * x + cos(angle) * y + sin(angle) * z for x, y, z in zip(a, across, around, strict=True)
        ]
        columns.append(apply(turn, column))
    return transpose(columns)


def _at_rest(velocity: Vector) -> bool:
    """Whether a velocity is the number 0: what stands still before the first joint that moves is left out."""
    return all(entry.tree == ZERO for entry in velocity)


def _numbers(entries: Sequence[object]) -> Vector:
    return [expr(entry) for entry in entries]


def _sum(a: Vector, b: Vector) -> Vector:
    return [total((x, y)) for x, y in zip(a, b, strict=True)]


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
