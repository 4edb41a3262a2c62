"""The tree of links and joints of a URDF file, and the bodies that the joints of a chain of it move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.numbers.vectors import ZERO, Algebra, is_positive_semidefinite
from lyapcheck.errors import nearest
from lyapcheck.robots.urdf.parts import ORIGIN, Triple, UrdfJoint, UrdfLink, UrdfNotes
from lyapcheck.robots.urdf.rotations import (
    ROUNDED_INERTIA,
    Rotation,
    Roundings,
    about,
    oriented,
    tidy,
    unit,
)
from lyapcheck.robots.urdf.xml import Element

_SHOWN = 8


@dataclass(frozen=True)
class Tree:
    """Links and joints that form one tree; ``above`` is the joint that each link but the root hangs on."""

    root: str
    links: dict[str, UrdfLink]
    joints: dict[str, UrdfJoint]
    above: dict[str, UrdfJoint]

    def path(self, link: str) -> list[UrdfJoint]:
        result: list[UrdfJoint] = []
        while link != self.root:
            result.append(self.above[link])
            link = self.above[link].parent
        return result[::-1]

    @cached_property
    def below(self) -> dict[str, list[UrdfJoint]]:
        result: dict[str, list[UrdfJoint]] = {}
        for joint in self.joints.values():
            result.setdefault(joint.parent, []).append(joint)
        return result

    def downwards(self) -> list[UrdfJoint]:
        """All joints, each after the one above it."""
        result, waiting = [], [self.root]
        while waiting:
            here = self.below.get(waiting.pop(), [])
            result += here
            waiting += [joint.child for joint in here]
        return result


def build_tree(
    links: dict[str, UrdfLink], joints: dict[str, UrdfJoint], robot: Element, notes: UrdfNotes
) -> Tree | None:
    """The tree, ``None`` where the joints do not make one; problems are noted."""
    before = len(notes.problems)
    above: dict[str, UrdfJoint] = {}
    for joint in joints.values():
        for key, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                repair = nearest(link, links, "name a link of this file")
                notes.fail(
                    joint.element, f"joint {joint.name}: {key}", link, "is no link of this file", repair
                )
        if joint.child in above:
            rule = f"already hangs on joint {above[joint.child].name}: closed chains are not understood"
            notes.fail(
                joint.element, f"joint {joint.name}: child", joint.child, rule, "remove one of the joints"
            )
        above.setdefault(joint.child, joint)
    roots = [link for link in links if link not in above]
    if len(notes.problems) == before and len(roots) != 1:
        names = ", ".join(roots[:_SHOWN])
        rule = f"has {len(roots)} links that hang on no joint: {names}" if roots else "has joints in a circle"
        notes.fail(robot, "robot", "", rule, "connect all links to one tree")
    if len(notes.problems) > before:
        return None
    tree = Tree(roots[0], links, joints, above)
    return tree if _connected(tree, robot, notes) else None


def _connected(tree: Tree, robot: Element, notes: UrdfNotes) -> bool:
    """Whether every link can be reached from the root."""
    reached = {tree.root, *(joint.child for joint in tree.downwards())}
    lost = [link for link in tree.links if link not in reached]
    if lost:
        rule = f"has joints in a circle: {', '.join(lost[:_SHOWN])} cannot be reached from {tree.root}"
        notes.fail(robot, "robot", "", rule, "connect all links to one tree")
    return not lost


def carrier(tree: Tree, chain: tuple[UrdfJoint, ...]) -> Mapping[str, int | None]:
    """For each link the joint of the chain that moves it, counted from 0; ``None`` for the base."""
    numbers = {joint.name: i for i, joint in enumerate(chain)}
    result: dict[str, int | None] = {tree.root: None}
    for joint in tree.downwards():
        result[joint.child] = numbers.get(joint.name, result[joint.parent])
    return result


def moved_links(tree: Tree, chain: tuple[UrdfJoint, ...]) -> list[list[UrdfLink]]:
    """The links of each body that the chain moves, base first; those of the base do not matter."""
    moved_by = carrier(tree, chain)
    return [[link for link in tree.links.values() if moved_by[link.name] == i] for i in range(len(chain))]


def tensor(link: UrdfLink) -> list[list[Fraction]]:
    """The inertia of a link as the file gives it."""
    xx, yy, zz, xy, xz, yz = link.inertia
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]


# --- From URDF links and joints to the bodies that the joints of one chain move.
#
# The links between two joints of the chain are rigid with each other; each is placed in the frame of the
# joint before it and brings its mass m, first moment m c and inertia, and their sums are exact.


OF = Algebra(Fraction)


@dataclass(frozen=True)
class _Pose:
    rotation: Rotation
    place: tuple[Fraction, ...]

    def then(self, rotation: Rotation, place: Sequence[Fraction]) -> _Pose:
        moved = OF.add(self.place, OF.apply(self.rotation, place))
        return _Pose(tidy(OF.product(self.rotation, rotation)), tuple(moved))


_HERE = _Pose(UNIT, ORIGIN)


def moved_bodies(
    tree: Tree, chain: tuple[UrdfJoint, ...], fixed: Mapping[str, Fraction], roundings: Roundings
) -> tuple[RigidLink, ...]:
    """The joints of the chain, base first, each with all that it moves up to the next one as one body."""
    local, joints = _poses(tree, chain, fixed, roundings)
    result = []
    for joint, links in zip(chain, moved_links(tree, chain), strict=True):
        axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
        result.append(_body(joints[joint.name], axis, links, local, roundings))
    return tuple(result)


def _poses(
    tree: Tree, chain: tuple[UrdfJoint, ...], fixed: Mapping[str, Fraction], roundings: Roundings
) -> tuple[Mapping[str, _Pose], Mapping[str, _Pose]]:
    """Every link, and every joint of the chain, in the frame of the joint of the chain before it."""
    links, joints = {tree.root: _HERE}, {}
    for joint in tree.downwards():
        turn = oriented(joint.turn, f"joint {joint.name}", roundings)
        pose = links[joint.parent].then(turn, joint.xyz)
        value = fixed.get(joint.name)
        if joint in chain:
            joints[joint.name], pose = pose, _HERE
        elif value:
            axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
            where = f"joint {joint.name}, where it is held"
            slides = joint.kind == "prismatic"
            turn = UNIT if slides else about(axis, value, where, roundings)
            pose = pose.then(turn, OF.scaled(value, axis) if slides else ORIGIN)
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
        total = OF.sum(total, _inertia(link, poses[link.name], roundings), _point(m, arm))
    total = _rounded_up(total, _point(mass, com), links, roundings)
    return RigidLink(axis, joint.place, mass, com, tuple(map(tuple, total)), joint.rotation)


def _point(m: Fraction, place: Sequence[Fraction]) -> list[list[Fraction]]:
    square = OF.dot(place, place)
    return [[m * (square * UNIT[i][k] - place[i] * place[k]) for k in range(3)] for i in range(3)]


def _rounded_up(
    total: list[list[Fraction]], around: list[list[Fraction]], links: list[UrdfLink], roundings: Roundings
) -> list[list[Fraction]]:
    """An inertia that misses being positive semidefinite by the digits that a program printed, mended."""
    size = sum((total[i][i] + around[i][i] for i in range(3)), ZERO)
    if is_positive_semidefinite(total) or size <= 0:
        return total
    added = size * ROUNDED_INERTIA
    mended = [[total[i][k] + added * (i == k) for k in range(3)] for i in range(3)]
    if not is_positive_semidefinite(mended):
        return total
    roundings.mended += [link.name for link in links if not is_positive_semidefinite(tensor(link))]
    return mended


def _centre(link: UrdfLink, pose: _Pose) -> list[Fraction]:
    """The centre of mass of a link from the joint that moves it."""
    return OF.add(pose.place, OF.apply(pose.rotation, link.com))


def _inertia(link: UrdfLink, pose: _Pose, roundings: Roundings) -> list[list[Fraction]]:
    if not any(link.inertia):
        return [[ZERO] * 3 for _ in range(3)]
    turn = oriented(link.turn, f"inertia of link {link.name}", roundings)
    return OF.congruent(tidy(OF.product(pose.rotation, turn)), tensor(link))
