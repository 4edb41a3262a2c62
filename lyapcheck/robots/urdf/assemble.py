"""From URDF links and joints to the bodies that the joints of one chain move.

The links between two joints of the chain are rigid with each other; each is placed in the frame of the joint
before it and brings its mass m, first moment m c and inertia, and their sums are exact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.numbers.vectors import ZERO, Algebra
from lyapcheck.robots.urdf.bodies import tensor
from lyapcheck.robots.urdf.fields import ORIGIN, Triple
from lyapcheck.robots.urdf.parts import UrdfJoint, UrdfLink
from lyapcheck.robots.urdf.rotations import Rotation, Roundings, from_rpy, tidy, unit
from lyapcheck.robots.urdf.tree import Tree, carrier

OF = Algebra(Fraction)


@dataclass(frozen=True)
class _Pose:
    rotation: Rotation
    place: tuple[Fraction, ...]


_HERE = _Pose(UNIT, ORIGIN)


def moved_bodies(tree: Tree, chain: tuple[UrdfJoint, ...], roundings: Roundings) -> tuple[RigidLink, ...]:
    """The joints of the chain, base first, each with all that it moves up to the next one as one body."""
    moved_by = carrier(tree, chain)
    local, joints = _poses(tree, chain, roundings)
    result = []
    for i, joint in enumerate(chain):
        axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
        links = [link for link in tree.links.values() if moved_by[link.name] == i]
        result.append(_body(joints[joint.name], axis, links, local, roundings))
    return tuple(result)


def _poses(
    tree: Tree, chain: tuple[UrdfJoint, ...], roundings: Roundings
) -> tuple[Mapping[str, _Pose], Mapping[str, _Pose]]:
    """Every link, and every joint of the chain, in the frame of the joint of the chain before it."""
    links, joints = {tree.root: _HERE}, {}
    for joint in tree.downwards():
        above = links[joint.parent]
        turn = from_rpy(joint.rpy, f"joint {joint.name}", roundings)
        place = OF.add(above.place, OF.apply(above.rotation, joint.xyz))
        pose = _Pose(tidy(OF.product(above.rotation, turn)), tuple(place))
        if joint in chain:
            joints[joint.name], pose = pose, _HERE
        links[joint.child] = pose
    return links, joints


def _body(
    joint: _Pose, axis: Triple, links: list[UrdfLink], poses: Mapping[str, _Pose], roundings: Roundings
) -> RigidLink:
    masses = [(link.mass, _centre(link, poses[link.name])) for link in links]
    mass = sum((m for m, _ in masses), ZERO)
    moment = OF.add(ORIGIN, *(OF.scaled(m, c) for m, c in masses))
    com = ORIGIN if mass == 0 else tuple(OF.scaled(1 / mass, moment))
    total = [[ZERO] * 3 for _ in range(3)]
    for link, (m, c) in zip(links, masses, strict=True):
        arm = OF.add(c, OF.scaled(Fraction(-1), com))
        square = OF.dot(arm, arm)
        spread = [[m * (square * UNIT[i][k] - arm[i] * arm[k]) for k in range(3)] for i in range(3)]
        total = OF.sum(total, _inertia(link, poses[link.name], roundings), spread)
    return RigidLink(axis, joint.place, mass, com, tuple(map(tuple, total)), joint.rotation)


def _centre(link: UrdfLink, pose: _Pose) -> list[Fraction]:
    """The centre of mass of a link from the joint that moves it."""
    return OF.add(pose.place, OF.apply(pose.rotation, link.com))


def _inertia(link: UrdfLink, pose: _Pose, roundings: Roundings) -> list[list[Fraction]]:
    if not any(link.inertia):
        return [[ZERO] * 3 for _ in range(3)]
    turn = from_rpy(link.rpy, f"inertia of link {link.name}", roundings)
    return OF.congruent(tidy(OF.product(pose.rotation, turn)), tensor(link))
