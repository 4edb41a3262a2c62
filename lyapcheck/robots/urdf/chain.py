"""Which joints of a URDF tree are the arm: those to a tip, or the longest run of revolute joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from fractions import Fraction

from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.urdf.parts import MOVING, UrdfJoint, UrdfNotes
from lyapcheck.robots.urdf.tree import Tree
from lyapcheck.robots.urdf.xml import Element

MOST_JOINTS = 12
_SHOWN = 8
_RATIO = Fraction(3, 2)
"""How much longer than any other a branch is that goes on: a camera beside an arm, and not a finger."""
Run = tuple[UrdfJoint, ...]


def choose_chain(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    """The joints of the arm, base first; empty when a problem was noted.

    With a tip the revolute joints between base and tip; joints above all of them are held. Without one the
    longest run of revolute joints up to where the chains part, of several the one nearest to the base.
    """
    before = len(notes.problems)
    _check_names(tree, choice, robot, notes)
    if len(notes.problems) > before:
        return ()
    chain = _to_tip(tree, choice, robot, notes) if choice.tip else _longest(tree, choice, robot, notes)
    if len(notes.problems) == before and not chain:
        tried = [Choice(fixed=choice.fixed), Choice()]
        others = [_choosing(tree, run, one) for one in tried for run in _best(_runs(tree, one))]
        repair = f"choose {others[0]}" if others else "give a file of an arm"
        notes.fail(robot, "robot", "", "has no revolute joint on this chain", repair)
    if len(chain) > MOST_JOINTS:
        rule = f"has a chain of {len(chain)} joints, more than {MOST_JOINTS}"
        nearer = _choosing(tree, chain[:MOST_JOINTS], choice)
        notes.fail(robot, "robot", "", rule, f"end it before, with {nearer}")
    return chain if len(notes.problems) == before else ()


def options(base: str, tip: str, fixed: Mapping[str, Fraction]) -> str:
    """How to choose a chain, for every command and in an arm file."""
    words, values = [("base", base), ("tip", tip)], {j: decimal_text(x) for j, x in fixed.items()}
    given = [f"--{key} {link}" for key, link in words if link]
    given += [f"--fixed {joint}={value}" for joint, value in values.items()]
    keys = [f'{key} = "{link}"' for key, link in words if link]
    if fixed:
        keys.append(f"fixed = {{ {', '.join(f'{joint} = {value}' for joint, value in values.items())} }}")
    return f"{' '.join(given)} (in an arm file that names this URDF: {' and '.join(keys)})"


def held(tree: Tree, chain: Run, fixed: Mapping[str, Fraction]) -> list[str]:
    """What a reader has to know about joints that could move and are not of the arm."""
    still = [joint for joint in tree.joints.values() if joint.moves and joint not in chain]
    if not still:
        return []
    names = [
        f"{joint.name} ({joint.kind})"
        + (f" at {decimal_text(fixed[joint.name])}" if fixed.get(joint.name) else "")
        for joint in still
    ]
    what = "Joints that are not of the arm are held, at zero where nothing else is said"
    return [f"{what}: {', '.join(names)}; --base, --tip and --fixed choose other arms"]


def _check_names(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> None:
    for key, link in (("base", choice.base), ("tip", choice.tip)):
        if link and link not in tree.links:
            near = ", ".join(_near(link, tree.links))
            notes.fail(robot, key, link, "is no link of this file", f"name one, for instance {near}")
    for name, value in choice.fixed.items():
        joint = tree.joints.get(name)
        if joint is None:
            near = ", ".join(_near(name, tree.joints))
            notes.fail(robot, "fixed", name, "is no joint of this file", f"name one, for instance {near}")
        elif joint.kind not in (*MOVING, "prismatic") and value:
            rule = f"is {joint.kind}, which no single number places"
            notes.fail(joint.element, f"fixed: {name}", decimal_text(value), rule, "hold it at 0")


def _near(word: str, names: Iterable[str]) -> list[str]:
    known = list(names)
    return get_close_matches(word, known, 3, 0.4) or known[:_SHOWN]


def _to_tip(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    path, base = tree.path(choice.tip), choice.base or tree.root
    links = [tree.root, *(joint.child for joint in path)]
    if base not in links:
        above = f"use one of {', '.join(links[:-1][:_SHOWN])}"
        notes.fail(robot, "base", base, f"is not between {tree.root} and {choice.tip}", above)
        return ()
    moving = [joint for joint in path[links.index(base) :] if _moves(joint, choice)]
    first = next((i for i, joint in enumerate(moving) if joint.turns), len(moving))
    chain = tuple(moving[first:])
    strange = [joint for joint in chain if not joint.turns]
    if strange:
        _refuse(strange, chain, choice, notes)
    return chain


def _moves(joint: UrdfJoint, choice: Choice) -> bool:
    return joint.moves and joint.name not in choice.fixed


def _refuse(strange: Sequence[UrdfJoint], chain: Run, choice: Choice, notes: UrdfNotes) -> None:
    first = strange[0]
    rule = f"is {first.kind}, and the paper assumes revolute joints: its bounds on M, C and g do not hold"
    if first.kind in MOVING:
        rule = "mimics another joint, and the paper assumes one motor for each joint"
    elif first.kind == "prismatic":
        rule = "is prismatic, and the paper assumes revolute joints: its bounds on M, C and g fail along it"
    more = "" if len(strange) == 1 else f" (so do {', '.join(joint.name for joint in strange[1:])})"
    still = {**choice.fixed, **{joint.name: Fraction(0) for joint in strange}}
    hold = options(choice.base, choice.tip, still)
    last = strange[-1]
    behind = (
        "" if last is chain[-1] else f", or begin behind it: {options(last.child, choice.tip, choice.fixed)}"
    )
    ended = options(choice.base, first.parent, choice.fixed)
    repair = f"hold it: {hold}{behind}, or end the arm before it: {ended}"
    notes.fail(first.element, f"joint {first.name}", "", rule + more, repair)


# --- The longest run of revolute joints.


def _longest(tree: Tree, choice: Choice, robot: Element, notes: UrdfNotes) -> Run:
    best = _best(_runs(tree, choice))
    if len(best) < 2:
        return best[0] if best else ()
    tips = [run[-1].child for run in best]
    size = f"{len(best[0])} joint{'s' if len(best[0]) > 1 else ''}"
    rule = f"has {len(best)} arms of {size}, to the tips {', '.join(tips[:_SHOWN])}"
    notes.fail(robot, "robot", "", rule, f"choose one: {_choosing(tree, best[0], choice)}")
    return ()


def _best(runs: Sequence[tuple[int, Run]]) -> list[Run]:
    """The longest runs, of these the ones with the fewest joints above."""
    best = max(((len(run), -above) for above, run in runs), default=None)
    return [run for above, run in runs if (len(run), -above) == best]


def _runs(tree: Tree, choice: Choice) -> list[tuple[int, Run]]:
    """Runs of revolute joints up to where chains part, each with the number of joints above it."""
    depth = dict.fromkeys(tree.links, 0)
    """How many joints move, one after the other, below each link."""
    for joint in reversed(tree.downwards()):
        size = depth[joint.child] + _moves(joint, choice)
        depth[joint.parent] = max(depth[joint.parent], size)
    result: list[tuple[int, Run]] = []
    waiting: list[tuple[str, int, Run]] = [(choice.base or tree.root, 0, ())]
    while waiting:
        link, above, run = waiting.pop(0)
        hanging = _hanging(tree, link, choice)
        sizes = sorted((1 + depth[joint.child] for joint in hanging), reverse=True)
        on = [joint for joint in hanging if 1 + depth[joint.child] == sizes[0]]
        parts = len(sizes) > 1 and sizes[0] < _RATIO * sizes[1]
        main = None if parts or not on else on[0]
        if run and (main is None or not main.turns):
            result.append((above, run))
        for joint in hanging:
            before = run if joint is main else ()
            added = (*before, joint) if joint.turns else ()
            waiting.append((joint.child, above + len(run) + 1 - len(added), added))
    return result


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
