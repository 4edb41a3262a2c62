"""Which joints of a URDF tree are the arm: those to a tip, or the longest run of revolute joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from fractions import Fraction

from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.urdf.tree import MOVING, SHOWN, Tree, UrdfJoint
from lyapcheck.robots.urdf.xml import Element, UrdfNotes

MOST_JOINTS = 12
_RATIO = Fraction(3, 2)
"""How much longer than any other a branch is that goes on: a camera beside an arm, and not a finger."""
Run = tuple[UrdfJoint, ...]


def choose_chain(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    """The joints of the arm, base first; empty when a problem was noted.

    With a tip the revolute joints between base and tip; joints above all of them are held. Without one the
    longest run of revolute joints up to where the chains part, of several the one nearest to the base.
    """
    before, given = len(notes.problems), {"base": choice.base, "tip": choice.tip}
    named: list[tuple[str, str, str, Iterable[str]]]
    named = [(key, link, "link", tree.links) for key, link in given.items() if link]
    named += [("fixed", name, "joint", tree.joints) for name in choice.fixed]
    for key, name, what, known in named:
        if name not in known:
            near = ", ".join(get_close_matches(name, [*known], 3, 0.4) or [*known][:SHOWN])
            notes.fail(robot, key, name, f"is no {what} of this file", f"name one, for instance {near}")
    for name, value in choice.fixed.items():
        joint = tree.joints.get(name)
        if joint is not None and joint.kind not in (*MOVING, "prismatic") and value:
            rule = f"is {joint.kind}, which no single number places"
            notes.fail(joint.element, f"fixed: {name}", decimal_text(value), rule, "hold it at 0")
    if len(notes.problems) > before:
        return ()
    chain = _to_tip(tree, choice, robot, notes) if choice.tip else _longest(tree, choice, robot, notes)
    if len(notes.problems) == before and not chain:
        tried = [Choice(fixed=choice.fixed), Choice()]
        others = [_choosing(tree, run, one) for one in tried for run in _best(tree, one)]
        repair = f"choose {others[0]}" if others else "give a file of an arm"
        notes.fail(robot, "robot", "", "has no revolute joint on this chain", repair)
    if len(chain) > MOST_JOINTS:
        rule = f"has a chain of {len(chain)} joints, more than {MOST_JOINTS}"
        nearer = _choosing(tree, chain[:MOST_JOINTS], choice)
        notes.fail(robot, "robot", "", rule, f"end it before, with {nearer}")
    return chain if len(notes.problems) == before else ()


def options(base: str, tip: str, fixed: Mapping[str, Fraction]) -> str:
    """How to choose a chain, for every command and in an arm file."""
    given = [f"--{key} {link}" for key, link in (("base", base), ("tip", tip)) if link]
    given += [f"--fixed {joint}={decimal_text(value)}" for joint, value in fixed.items()]
    keys = " and ".join(Choice(base, tip, fixed).lines)
    return f"{' '.join(given)} (in an arm file that names this URDF: {keys})"


def _to_tip(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    path, base = tree.path(choice.tip), choice.base or tree.root
    links = [tree.root, *(joint.child for joint in path)]
    if base not in links:
        above = f"use one of {', '.join(links[:-1][:SHOWN])}"
        notes.fail(robot, "base", base, f"is not between {tree.root} and {choice.tip}", above)
        return ()
    moving = [joint for joint in path[links.index(base) :] if _moves(joint, choice)]
    first = next((i for i, joint in enumerate(moving) if joint.turns), len(moving))
    chain = tuple(moving[first:])
    strange = [joint for joint in chain if not joint.turns]
    if strange:
        worst, last = strange[0], strange[-1]
        rule = f"is {worst.kind}, and the paper assumes revolute joints: its bounds on M, C and g do not hold"
        if worst.kind == "prismatic":
            rule = (
                "is prismatic, and the paper assumes revolute joints: its bounds on M, C and g fail along it"
            )
        elif worst.kind in MOVING:
            rule = "mimics another joint, and the paper assumes one motor for each joint"
        if len(strange) > 1:
            rule += f" (so do {', '.join(joint.name for joint in strange[1:])})"
        still = {**choice.fixed, **{joint.name: Fraction(0) for joint in strange}}
        repair = f"hold it: {options(choice.base, choice.tip, still)}"
        if last is not chain[-1]:
            repair += f", or begin behind it: {options(last.child, choice.tip, choice.fixed)}"
        repair += f", or end the arm before it: {options(choice.base, worst.parent, choice.fixed)}"
        notes.fail(worst.element, f"joint {worst.name}", "", rule, repair)
    return chain


def _moves(joint: UrdfJoint, choice: Choice) -> bool:
    return joint.moves and joint.name not in choice.fixed


# --- The longest run of revolute joints.


def _longest(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    best = _best(tree, choice)
    if len(best) < 2:
        return best[0] if best else ()
    tips = [run[-1].child for run in best]
    size = f"{len(best[0])} joint{'s' if len(best[0]) > 1 else ''}"
    rule = f"has {len(best)} arms of {size}, to the tips {', '.join(tips[:SHOWN])}"
    notes.fail(robot, "robot", "", rule, f"choose one: {_choosing(tree, best[0], choice)}")
    return ()


def _best(tree: Tree, choice: Choice) -> Sequence[Run]:
    """The longest runs of revolute joints up to where chains part, of these with the fewest joints above."""
    depth = dict.fromkeys(tree.links, 0)
    """How many joints move, one after the other, below each link."""
    for joint in reversed(tree.downwards()):
        size = depth[joint.child] + _moves(joint, choice)
        depth[joint.parent] = max(depth[joint.parent], size)
    runs: list[tuple[int, Run]] = []
    """Each with the number of joints above it."""
    waiting: list[tuple[str, int, Run]] = [(choice.base or tree.root, 0, ())]
    while waiting:
        link, above, run = waiting.pop(0)
        hanging = _hanging(tree, link, choice)
        sizes = sorted((1 + depth[joint.child] for joint in hanging), reverse=True)
        on = [joint for joint in hanging if 1 + depth[joint.child] == sizes[0]]
        parts = len(sizes) > 1 and sizes[0] < _RATIO * sizes[1]
        main = None if parts or not on else on[0]
        if run and (main is None or not main.turns):
            runs.append((above, run))
        for joint in hanging:
            before = run if joint is main else ()
            added = (*before, joint) if joint.turns else ()
            waiting.append((joint.child, above + len(run) + 1 - len(added), added))
    best = max(((len(run), -above) for above, run in runs), default=None)
    return [run for above, run in runs if (len(run), -above) == best]


def _hanging(tree: Tree, link: str, choice: Choice) -> list[UrdfJoint]:
    """The joints that move next below a link."""
    result, waiting = [], [link]
    while waiting:
        for joint in tree.below.get(waiting.pop(), ()):
            if _moves(joint, choice):
                result.append(joint)
            else:
                waiting.append(joint.child)
    return result


def _choosing(tree: Tree, run: Run, choice: Choice) -> str:
    """How to choose a run: by its tip, and by its base where joints above would be of the chain."""
    above = any(joint.turns and _moves(joint, choice) for joint in tree.path(run[0].parent))
    return options(run[0].parent if above or choice.base else "", run[-1].child, choice.fixed)
