"""The chain of moving joints from the root of a URDF tree to one tip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.numbers.vectors import ZERO, Algebra, is_positive_semidefinite
from lyapcheck.errors import nearest
from lyapcheck.robots.chain_bounds import bodily
from lyapcheck.robots.urdf.parts import MOVING, ORIGIN, Triple, UrdfJoint, UrdfLink, UrdfNotes
from lyapcheck.robots.urdf.rotations import Rotation, Roundings, from_rpy, tidy, unit
from lyapcheck.robots.urdf.xml import Element

MOST_JOINTS = 12
_SHOWN = 8


@dataclass(frozen=True)
class Tree:
    """Links and joints that form one tree; ``above`` is the joint that each link but the root hangs on."""

    root: str
    links: dict[str, UrdfLink]
    joints: dict[str, UrdfJoint]
    above: dict[str, UrdfJoint]

    def path(self, link: str) -> list[UrdfJoint]:
        """All joints from the root to a link."""
        result: list[UrdfJoint] = []
        while link != self.root:
            result.append(self.above[link])
            link = self.above[link].parent
        return result[::-1]

    def moving(self, link: str) -> tuple[UrdfJoint, ...]:
        """The joints that move between the root and a link."""
        return tuple(joint for joint in self.path(link) if joint.moves)

    def downwards(self) -> list[UrdfJoint]:
        """All joints, each after the one above it."""
        below: dict[str, list[UrdfJoint]] = {}
        for joint in self.joints.values():
            below.setdefault(joint.parent, []).append(joint)
        result, waiting = [], [self.root]
        while waiting:
            here = below.get(waiting.pop(), [])
            result += here
            waiting += [joint.child for joint in here]
        return result

    def tips(self) -> list[str]:
        """The links that nothing hangs on, in the order of the file."""
        parents = {joint.parent for joint in self.above.values()}
        return [link for link in self.links if link not in parents]


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


def choose_chain(tree: Tree, tip: str | None, robot: Element, notes: UrdfNotes) -> tuple[UrdfJoint, ...]:
    """The moving joints to the tip, or those of the longest chain; empty when a problem was noted."""
    if tip is not None and tip not in tree.links:
        near = get_close_matches(tip, tree.links, 3, 0.4) or list(tree.links)[:_SHOWN]
        notes.fail(robot, "tip", tip, "is no link of this file", f"name one, for instance {', '.join(near)}")
        return ()
    searched = tuple(tree.joints.values()) if tip is None else tree.moving(tip)
    strange = [joint for joint in searched if joint.moves and joint.kind not in MOVING]
    for joint in strange:
        _refuse_kind(joint, notes)
    if strange:
        return ()
    chain = _longest(tree, robot, notes) if tip is None else searched
    chain = tuple(joint for joint in chain if joint.moves)
    _check_chain(chain, robot, notes)
    return chain


def _check_chain(chain: tuple[UrdfJoint, ...], robot: Element, notes: UrdfNotes) -> None:
    if not chain:
        notes.fail(robot, "robot", "", "has no revolute joint on this chain", "name another tip")
    if len(chain) > MOST_JOINTS:
        rule = f"has a chain of {len(chain)} joints, more than {MOST_JOINTS}"
        notes.fail(robot, "robot", "", rule, "choose a tip nearer to the base")
    for joint in chain:
        if joint.element.all("mimic"):
            rule = "mimics another joint, and the paper assumes one motor for each joint"
            _refuse(joint, rule, notes)


def _refuse_kind(joint: UrdfJoint, notes: UrdfNotes) -> None:
    rule = f"is {joint.kind}, and the paper assumes revolute joints: its bounds on M, C and g do not hold"
    if joint.kind == "prismatic":
        rule = "is prismatic, and the paper assumes revolute joints: its bounds on M, C and g fail along it"
    _refuse(joint, rule, notes)


def _refuse(joint: UrdfJoint, rule: str, notes: UrdfNotes) -> None:
    repair = (
        f"make it fixed, or end the chain before it: {_write_tip(joint.parent)}; what lies behind a tip is "
        "held at its zero position"
    )
    notes.fail(joint.element, f"joint {joint.name}", "", rule, repair)


def _longest(tree: Tree, robot: Element, notes: UrdfNotes) -> tuple[UrdfJoint, ...]:
    """The chain with the most moving joints; two of the same length are a problem."""
    chains: dict[tuple[str, ...], str] = {}
    for tip in tree.tips():
        chains.setdefault(tuple(joint.name for joint in tree.moving(tip)), tip)
    most = max(len(names) for names in chains)
    tips = [tip for names, tip in chains.items() if len(names) == most]
    if len(tips) > 1 and most:
        rule = f"has {len(tips)} chains of {most} joints, to the tips {', '.join(tips[:_SHOWN])}"
        notes.fail(robot, "robot", "", rule, f"choose one: {_write_tip(tips[0])}")
    return tree.moving(tips[0])


def _write_tip(link: str) -> str:
    """How to end the chain at a link, whatever the command: only ``lyapcheck robot`` takes --tip."""
    return (
        f'write tip = "{link}" in an arm file that names this URDF (lyapcheck robot also takes --tip {link})'
    )


def held(tree: Tree, chain: tuple[UrdfJoint, ...]) -> list[UrdfJoint]:
    """The joints that could move but are not of the chain: they are held at their zero position."""
    return [joint for joint in tree.joints.values() if joint.moves and joint not in chain]


def carrier(tree: Tree, chain: tuple[UrdfJoint, ...]) -> Mapping[str, int | None]:
    """For each link the joint of the chain that moves it, counted from 0; ``None`` for the base."""
    numbers = {joint.name: i for i, joint in enumerate(chain)}
    return {
        link: max((numbers[j.name] for j in tree.path(link) if j.name in numbers), default=None)
        for link in tree.links
    }


# --- Whether the bodies of a URDF file can exist.


def moved_links(tree: Tree, chain: tuple[UrdfJoint, ...]) -> list[UrdfLink]:
    """The links that the chain moves; those of the base do not matter."""
    return [tree.links[name] for name, joint in carrier(tree, chain).items() if joint is not None]


def check_bodies(links: list[UrdfLink], notes: UrdfNotes) -> None:
    """Note every link whose inertia is not positive semidefinite: M would not be positive definite."""
    for link in links:
        if not is_positive_semidefinite(tensor(link)):
            repair = "check the signs and the point about which it is given (the centre of mass)"
            notes.fail(
                link.element, f"link {link.name}: inertia", "", "must be positive semidefinite", repair
            )


def impossible(links: list[UrdfLink]) -> list[str]:
    """The links with a principal moment above the sum of the others: no body has that, but many files do."""
    return [link.name for link in links if not bodily(tensor(link))]


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
