"""The links of an arm as moving bodies: their kinetic energies as expressions for a proof script.

The velocity v of the origin of a link's frame and its angular velocity ω, in the coordinates of that frame,
follow from those of the link before: with T its turn, R(q_k) the rotation about its axis a and p its place,

    ω_k = (T R)ᵀ ω_{k−1} + a x_k,        v_k = (T R)ᵀ (v_{k−1} + ω_{k−1} × p),

and twice its kinetic energy is m‖v + ω × c‖² + ωᵀ J ω, with J about the centre of mass c.

Numbers are worked out here, and what is 0 is left out: a certificate holds every copy of a velocity.

They show that M is positive definite where determinants are too large, see ``positive_definite``.

References: featherstone2008rigid, chapter 5.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.statement import Statement
from lyapcheck.claims.arms import leading_minors, mass_matrix
from lyapcheck.claims.expressions import Expr, cos, expr, sin, total, var
from lyapcheck.claims.products import Matrix, Vector, form, transpose, vector
from lyapcheck.claims.statements import all_of, always_positive, identity, implies, reals

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.chain import Chain, RigidLink


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
        return _sum(_times(self.mass, _total(map(_square, self.velocity))), _form(self.spin, self.inertia))


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
            speed = _apply(back, _plus(speed, _cross(spin, _numbers(link.origin))))
            spin = _apply(back, spin)
        spin = _plus(spin, [_times(a, rate) for a in axis])
        mass, inertia = expr(link.mass), [_numbers(row) for row in link.inertia]
        turning = Body(mass, _cross(axis, com), axis, inertia, expr(0))
        found.append(Body(mass, _plus(speed, _cross(spin, com)), spin, inertia, turning.energy))
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
    columns = []
    for j in range(3):
        unit = [expr(int(i == j)) for i in range(3)]
        along = [_times(a[j], x) for x in a]
        across, around = _plus(unit, [_times(expr(-1), x) for x in along]), _cross(a, unit)
        parts = zip(*(_apply(turn, part) for part in (along, across, around)), strict=True)
        columns.append([_total((x, _times(cos(angle), y), _times(sin(angle), z))) for x, y, z in parts])
    return transpose(columns)


def _at_rest(velocity: Vector) -> bool:
    """Whether a velocity is the number 0: what stands still before the first joint that moves is left out."""
    return all(_number(entry) == 0 for entry in velocity)


def _numbers(entries: Sequence[object]) -> Vector:
    return [expr(entry) for entry in entries]


def _number(entry: Expr) -> Fraction | None:
    """The value of an entry that is a number."""
    return Fraction(entry.tree[1]) if entry.tree[0] == "num" else None


def _sum(a: Expr, b: Expr) -> Expr:
    x, y = _number(a), _number(b)
    if x is not None and y is not None:
        return expr(x + y)
    return b if x == 0 else a if y == 0 else a + b


def _times(a: Expr, b: Expr) -> Expr:
    x, y = _number(a), _number(b)
    if x is not None and y is not None:
        return expr(x * y)
    if x == 0 or y == 0:
        return expr(0)
    return b if x == 1 else a if y == 1 else a * b


def _square(a: Expr) -> Expr:
    value = _number(a)
    return a**2 if value is None else expr(value**2)


def _total(terms: Iterable[Expr]) -> Expr:
    return reduce(_sum, terms, expr(0))


def _plus(a: Vector, b: Vector) -> Vector:
    return [_sum(x, y) for x, y in zip(a, b, strict=True)]


def _apply(a: Matrix, x: Vector) -> Vector:
    return [_total(map(_times, row, x)) for row in a]


def _form(x: Vector, a: Matrix) -> Expr:
    """xᵀ A x."""
    return _total(map(_times, x, _apply(a, x)))


def _cross(a: Vector, b: Vector) -> Vector:
    minus = expr(-1)
    pairs = [(_times(a[i - 2], b[i - 1]), _times(minus, _times(a[i - 1], b[i - 2]))) for i in range(3)]
    return [_sum(x, y) for x, y in pairs]
