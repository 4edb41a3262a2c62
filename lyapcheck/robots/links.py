"""M and the potential of a serial chain of revolute joints, exactly, from its links.

The frame of a link is that of its joint; without ``turn`` it is parallel to the base frame at q = 0.
Bodies are composed from the tip to the base; a composed body is its mass m, first moment m·c and inertia J
about the origin of its frame, and everything in the frame of joint j depends on the joints after j only,
which keeps the polynomials small.

References: composite rigid body algorithm, featherstone2008rigid chapter 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.robots import trig

Vector = list[Any]
Matrix = list[list[Any]]


@dataclass(frozen=True)
class Link:
    """One joint and the body it moves in the frame of the joint, with polynomials as entries.

    Args:
        axis: unit vector of the joint axis.
        origin: place of the joint in the frame of the link before, m.
        mass: kg.
        com: centre of mass from the joint, m.
        inertia: about the centre of mass, kg·m².
        turn: rotation from the frame of the joint at q = 0 to that of the link before; none when parallel.
    """

    axis: Vector
    origin: Vector
    mass: fmpq_mpoly
    com: Vector
    inertia: Matrix
    turn: Matrix | None = None


@dataclass(frozen=True)
class _Body:
    mass: fmpq_mpoly
    moment: Vector
    inertia: Matrix


def chain(
    ring: fmpq_mpoly_ctx, links: Sequence[Link], gravity: Vector
) -> tuple[tuple[tuple[fmpq_mpoly, ...], ...], fmpq_mpoly]:
    """Inertia matrix and potential energy of the chain, in normal form.

    M_ij = ∂²/∂q̇_i∂q̇_j of the kinetic energy; potential = −Σ m_k gᵀ p_k.

    Args:
        ring: the trigonometric ring with one pair of generators for each link.
        links: base first.
        gravity: acceleration of free fall in the base frame, m/s².
    """
    n = len(links)
    mass: list[list[Any]] = [[trig.constant(ring, 0)] * n for _ in range(n)]
    body = None
    for j in reversed(range(n)):
        own = _own(links[j])
        body = own if body is None else _add(own, _carried(ring, body, links[j + 1], j + 1))
        for i, value in _column(ring, links, body, j):
            mass[i][j] = mass[j][i] = value
    assert body is not None
    base = _carried(ring, body, links[0], 0)
    potential = trig.normal_form(-_dot(gravity, base.moment))
    return tuple(tuple(row) for row in mass), potential


def least_pivots(links: Sequence[Link]) -> tuple[Fraction, ...]:
    """For each joint the moment of its own link about its axis, kg·m²; nothing where parameters enter.

    Soundness: eliminating from the tip, M = UᵀDU with U unit triangular and D_k = s_kᵀ A_k s_k, where the
    articulated inertia A_k is that of link k alone plus a positive semidefinite part. So D_k is never below
    the moment of link k, for all angles, and M is positive definite where all of these are positive.

    References: articulated body algorithm, featherstone2008rigid chapter 7.
    """
    own = [_dot(link.axis, _apply(_own(link).inertia, link.axis)) for link in links]
    if not all(moment.is_constant() for moment in own):
        return ()
    return tuple(
        trig.fraction(moment.leading_coefficient()) if moment != 0 else Fraction(0) for moment in own
    )


def _column(ring: fmpq_mpoly_ctx, links: Sequence[Link], body: _Body, j: int) -> list[tuple[int, fmpq_mpoly]]:
    """M_ij for i ≤ j: the momentum of the composed body per unit of q̇_j, felt at each joint before."""
    momentum = _cross(links[j].axis, body.moment)
    angular = _apply(body.inertia, links[j].axis)
    entries = [(j, trig.normal_form(_dot(links[j].axis, angular)))]
    for i in reversed(range(j)):
        turn = _rotation(ring, links[i + 1], i + 1)
        momentum = _normal(_apply(turn, momentum))
        angular = _normal(_plus(_apply(turn, angular), _cross(links[i + 1].origin, momentum)))
        entries.append((i, trig.normal_form(_dot(links[i].axis, angular))))
    return entries


def _own(link: Link) -> _Body:
    """The link alone, about its joint (Steiner)."""
    moment = [link.mass * x for x in link.com]
    outer = _outer(link.com, moment)
    inertia = _sum(link.inertia, _shifted(outer))
    return _Body(link.mass, moment, inertia)


def _carried(ring: fmpq_mpoly_ctx, body: _Body, link: Link, joint: int) -> _Body:
    """The body as seen from the frame before the joint: turned by q, moved to the joint's place."""
    turn = _rotation(ring, link, joint)
    turned = _normal(_apply(turn, body.moment))
    rows = [_normal(row) for row in _product(turn, body.inertia)]
    inertia = [_normal(row) for row in _product(rows, _transpose(turn))]
    p = link.origin
    both = _sum(_sum(_outer(p, turned), _outer(turned, p)), _outer(p, [body.mass * x for x in p]))
    moved = _sum(inertia, _shifted(both))
    return _Body(body.mass, _plus(turned, [body.mass * x for x in p]), [_normal(row) for row in moved])


def _add(a: _Body, b: _Body) -> _Body:
    return _Body(a.mass + b.mass, _plus(a.moment, b.moment), _sum(a.inertia, b.inertia))


def _rotation(ring: fmpq_mpoly_ctx, link: Link, joint: int) -> Matrix:
    """From the frame of a link to that before: turn · (I cos q + K sin q + a aᵀ (1 − cos q))."""
    n = trig.joint_count(ring)
    sine, cosine = ring.gen(joint), ring.gen(n + joint)
    axis = link.axis
    x, y, z = axis
    skew = [[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]]
    own = [
        [(cosine if i == k else 0) + skew[i][k] * sine + axis[i] * axis[k] * (1 - cosine) for k in range(3)]
        for i in range(3)
    ]
    return own if link.turn is None else _product(link.turn, own)


def _shifted(outer: Matrix) -> Matrix:
    """tr(S)·I − S, the inertia of the second moments S."""
    trace = outer[0][0] + outer[1][1] + outer[2][2]
    return [[(trace if i == k else 0) - outer[i][k] for k in range(3)] for i in range(3)]


def _normal(vector: Vector) -> Vector:
    return [trig.normal_form(x) for x in vector]


def _outer(a: Vector, b: Vector) -> Matrix:
    return [[x * y for y in b] for x in a]


def _dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _plus(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def _sum(a: Matrix, b: Matrix) -> Matrix:
    return [_plus(x, y) for x, y in zip(a, b, strict=True)]


def _apply(a: Matrix, x: Vector) -> Vector:
    return [_dot(row, x) for row in a]


def _transpose(a: Matrix) -> Matrix:
    return [list(row) for row in zip(*a, strict=True)]


def _product(a: Matrix, b: Matrix) -> Matrix:
    return [[_dot(row, column) for column in _transpose(b)] for row in a]
