"""A chain of links in plain numbers, for whoever works along the links rather than with polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.robots import trig
from lyapcheck.robots.links import Link

Vector = tuple[Fraction, ...]
Matrix = tuple[Vector, ...]
UNIT: Matrix = tuple(tuple(Fraction(int(i == k)) for k in range(3)) for i in range(3))


@dataclass(frozen=True)
class RigidLink:
    """One joint and the body that it moves, in the frame of the joint; see ``lyapcheck.robots.links.Link``.

    Args:
        axis: unit vector of the joint axis.
        origin: place of the joint in the frame of the link before, m.
        mass: kg.
        com: centre of mass from the joint, m.
        inertia: about the centre of mass, kg·m².
        turn: rotation from the frame of the joint at q = 0 to that of the link before.
    """

    axis: Vector
    origin: Vector
    mass: Fraction
    com: Vector
    inertia: Matrix
    turn: Matrix


@dataclass(frozen=True)
class Chain:
    """The links, base first, and the acceleration of free fall in the base frame, m/s²."""

    links: tuple[RigidLink, ...]
    gravity: Vector


def exact_chain(links: Sequence[Link], gravity: Sequence[fmpq_mpoly]) -> Chain | None:
    """The chain of links whose entries are all constant; ``None`` where uncertain parameters enter."""
    parts = [x for link in links for x in (*link.axis, *link.origin, link.mass, *link.com, *gravity)]
    parts += [x for link in links for row in link.inertia for x in row]
    if not all(x.is_constant() for x in parts):
        return None
    return Chain(tuple(map(_rigid, links)), _vector(gravity))


def _rigid(link: Link) -> RigidLink:
    return RigidLink(
        _vector(link.axis),
        _vector(link.origin),
        _value(link.mass),
        _vector(link.com),
        tuple(map(_vector, link.inertia)),
        UNIT if link.turn is None else tuple(map(_vector, link.turn)),
    )


def _vector(entries: Sequence[fmpq_mpoly]) -> Vector:
    return tuple(map(_value, entries))


def _value(poly: fmpq_mpoly) -> Fraction:
    return trig.fraction(poly.leading_coefficient()) if poly != 0 else Fraction(0)
