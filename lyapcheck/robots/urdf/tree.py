"""The chain of moving joints from the root of a URDF tree to one tip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches

from lyapcheck.errors import nearest
from lyapcheck.robots.urdf.fields import UrdfNotes
from lyapcheck.robots.urdf.parts import MOVING, UrdfJoint, UrdfLink
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
