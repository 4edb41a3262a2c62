"""From URDF links and joints to the bodies that the joints of one chain move.

The links between two joints of the chain are rigid with each other; each is placed in the frame of the joint
before it and brings its mass m, first moment m c and inertia, and their sums are exact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.robots.urdf.fields import ORIGIN, Triple
from lyapcheck.robots.urdf.parts import UrdfJoint, UrdfLink
from lyapcheck.robots.urdf.rotations import (
    UNIT,
    Rotation,
    Roundings,
    apply,
    conjugate,
    from_rpy,
    product,
    tidy,
    unit,
)
from lyapcheck.robots.urdf.tree import Tree, carrier

_ZERO = Fraction(0)


@dataclass(frozen=True)
class Segment:
    """One joint of the chain and all that it moves up to the next one, in the frame of the joint.

    Args:
        turn: rotation from the frame of the joint at its zero position to that of the joint before.
        axis: of length exactly 1.
        origin: of the joint, in the frame of the joint before (or the base), m.
        mass: kg.
        com: centre of mass from the joint, m.
        inertia: about the centre of mass, kg·m².
    """

    turn: Rotation
    axis: Triple
    origin: Triple
    mass: Fraction
    com: Triple
    inertia: Rotation


@dataclass(frozen=True)
class _Pose:
    rotation: Rotation
    place: Triple


_HERE = _Pose(UNIT, ORIGIN)


def segments(tree: Tree, chain: tuple[UrdfJoint, ...], roundings: Roundings) -> list[Segment]:
    """The moved bodies, base first."""
    moved_by = carrier(tree, chain)
    local, joints = _poses(tree, chain, roundings)
    result = []
    for i, joint in enumerate(chain):
        axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
        links = [link for link in tree.links.values() if moved_by[link.name] == i]
        pose = joints[joint.name]
        result.append(_segment(pose, axis, links, local, roundings))
    return result


def _poses(
    tree: Tree, chain: tuple[UrdfJoint, ...], roundings: Roundings
) -> tuple[Mapping[str, _Pose], Mapping[str, _Pose]]:
    """Every link, and every joint of the chain, in the frame of the joint of the chain before it."""
    links, joints = {tree.root: _HERE}, {}
    for joint in tree.downwards():
        above = links[joint.parent]
        turn = from_rpy(joint.rpy, f"joint {joint.name}", roundings)
        place = _plus(above.place, apply(above.rotation, joint.xyz))
        pose = _Pose(tidy(product(above.rotation, turn)), place)
        if joint in chain:
            joints[joint.name], pose = pose, _HERE
        links[joint.child] = pose
    return links, joints


def _segment(
    joint: _Pose, axis: Triple, links: list[UrdfLink], poses: Mapping[str, _Pose], roundings: Roundings
) -> Segment:
    masses = [(link.mass, _centre(link, poses[link.name])) for link in links]
    mass = sum((m for m, _ in masses), _ZERO)
    moment = tuple(sum((m * c[k] for m, c in masses), _ZERO) for k in range(3))
    com = ORIGIN if mass == 0 else (moment[0] / mass, moment[1] / mass, moment[2] / mass)
    total = [[_ZERO] * 3 for _ in range(3)]
    for link, (m, c) in zip(links, masses, strict=True):
        own = _inertia(link, poses[link.name], roundings)
        arm = _minus(c, com)
        square = sum((x * x for x in arm), _ZERO)
        for i in range(3):
            for k in range(3):
                total[i][k] += own[i][k] + m * ((square if i == k else 0) - arm[i] * arm[k])
    return Segment(joint.rotation, axis, joint.place, mass, com, _matrix(total))


def _centre(link: UrdfLink, pose: _Pose) -> Triple:
    """The centre of mass of a link from the joint that moves it."""
    return _plus(pose.place, apply(pose.rotation, link.com))


def _inertia(link: UrdfLink, pose: _Pose, roundings: Roundings) -> Rotation:
    xx, yy, zz, xy, xz, yz = link.inertia
    tensor = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    if not any(link.inertia):
        return tensor
    turn = from_rpy(link.rpy, f"inertia of link {link.name}", roundings)
    return conjugate(tidy(product(pose.rotation, turn)), tensor)


def _plus(a: Triple, b: Triple) -> Triple:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _minus(a: Triple, b: Triple) -> Triple:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _matrix(rows: list[list[Fraction]]) -> Rotation:
    first, second, third = ((row[0], row[1], row[2]) for row in rows)
    return first, second, third
