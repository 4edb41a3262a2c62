"""From a URDF file to a robot model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

from lyapcheck.check.numbers.vectors import is_positive_semidefinite
from lyapcheck.errors import InputError
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.escapes import printable
from lyapcheck.robots.bodies import bodily, impossible_state
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import JointEntry, Number, of_joints
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.urdf.chain import choose_chain, held, options
from lyapcheck.robots.urdf.parts import Triple, UrdfJoint, UrdfLink, UrdfNotes, decimal, read_parts
from lyapcheck.robots.urdf.rotations import Roundings
from lyapcheck.robots.urdf.tree import Tree, build_tree, moved_bodies, moved_links, tensor
from lyapcheck.robots.urdf.xml import INERTIA, Element

_SHOWN = 8
EARTH: Triple = (Fraction(0), Fraction(0), Fraction("-9.81"))
"""URDF says nothing of gravity; its base frame has z upwards by custom."""


def read_urdf(
    root: Element,
    path: Path,
    shown: str,
    choice: Choice,
    gravity: tuple[Number, ...] | None = None,
    remarks: tuple[str, ...] = (),
    source: str = "",
) -> RobotModel:
    """The arm of a URDF file: M, C and g of the revolute joints between its root and one tip.

    Decimals are exact; rotations are exactly orthogonal and rounded as ``remarks`` of the model says. Links
    that fixed joints connect are one body. A joint that is not of the chain is held, at zero or as chosen.

    Args:
        root: ``<robot>``.
        path: the file.
        shown: its name in messages.
        choice: the chain; by default the longest run of revolute joints up to where the chains part.
        gravity: acceleration of free fall in the frame of the root, m/s²; (0, 0, −9.81) by default.
        remarks: what else is taken for granted.
        source: where its numbers are printed, the name of the file by default.

    Raises:
        InputError: the file is not of a serial chain of revolute joints; carries every problem.
    """
    notes = UrdfNotes(shown)
    tree, chain = _chain(root, choice, notes)
    _require_inertia(tree, chain, choice, root, notes)
    roundings = Roundings()
    bodies = moved_bodies(tree, chain, choice.fixed, roundings)
    for body, links in zip(bodies, moved_links(tree, chain), strict=True):
        for link in () if is_positive_semidefinite(body.inertia) else links:
            if not is_positive_semidefinite(tensor(link)):
                key, rule = f"link {link.name}: inertia", "must be positive semidefinite"
                repair = "check the signs and the point about which it is given (the centre of mass)"
                notes.fail(link.element, key, "", rule, repair)
    if notes.problems:
        raise InputError(notes.problems)
    told = (*remarks, *roundings.sentences(), *_remarks(tree, chain, choice, notes), *rotors(root, chain))
    fall = gravity or gravity_numbers(EARTH)
    file, stem = printable(source or path.name), printable(path.name.partition(".")[0] or path.stem)
    motors = [motor_of(joint, file) for joint in chain]
    numbers = {f"gravity_{letter}": x for letter, x in zip("xyz", fall, strict=True) if x.value}
    model = RobotModel(
        name=stem,
        title=f"{root.attributes.get('name', stem)[:80]} (URDF)",
        dynamics=Chain(bodies, tuple(entry.value for entry in fall)),
        **of_joints(motors),
        numbers=numbers | link_numbers(tree, file) | joint_numbers(tree, motors, file),
        remarks=told,
    )
    if broken := impossible_state(model):
        bare = _bare(tree, moved_links(tree, chain))
        repair = f"every joint must move some inertia{': ' if bare else ''}{bare}; check masses and inertias"
        notes.fail(root, "robot", "", broken, repair)
        raise InputError(notes.problems)
    return model


def _chain(root: Element, choice: Choice, notes: UrdfNotes) -> tuple[Tree, tuple[UrdfJoint, ...]]:
    links, joints = read_parts(root, notes)
    if notes.problems:
        raise InputError(notes.problems)
    tree = build_tree(links, joints, root, notes)
    chain = () if tree is None else choose_chain(tree, choice, root, notes)
    if tree is None or notes.problems:
        raise InputError(notes.problems)
    return tree, chain


def _require_inertia(
    tree: Tree, chain: tuple[UrdfJoint, ...], choice: Choice, robot: Element, notes: UrdfNotes
) -> None:
    """Refuse an arm whose last joint moves nothing that has mass or inertia: M would be singular."""
    bodies = moved_links(tree, chain)
    heavy = [i for i, links in enumerate(bodies) if any(link.mass or any(link.inertia) for link in links)]
    if heavy and heavy[-1] == len(chain) - 1:
        return
    rule, repair = (
        _bare(tree, bodies),
        "give the moved links masses and inertias, as CAD programs compute them",
    )
    if heavy:
        last = chain[heavy[-1]]
        end = options(choice.base, last.child, choice.fixed)
        rule = f"has a joint {chain[-1].name} that moves no mass: {rule}"
        repair = f"give it mass and inertia, or end the arm before it: {end}"
    else:
        rule += ": this file describes geometry only"
    notes.fail(robot, "robot", "", rule, repair)
    raise InputError(notes.problems)


def _bare(tree: Tree, bodies: list[list[UrdfLink]]) -> str:
    """Which of the moved links have no mass, and where they stand in the file."""
    moved = [link for links in bodies for link in links]
    bare = [link for link in moved if not link.described]
    zero = [link for link in moved if link.described and not link.mass]
    none = sum(not link.described for link in tree.links.values())
    count = f"{none} of {len(tree.links)} links have no <inertial>"
    parts = [f"{count}: {_places(bare)}"] if bare else []
    parts += [f"{'link' if len(zero) == 1 else 'links'} of mass 0: {_places(zero)}"] if zero else []
    return "; ".join(parts)


def _places(links: list[UrdfLink]) -> str:
    more = f" and {len(links) - _SHOWN} more" if len(links) > _SHOWN else ""
    return ", ".join(f"{link.name} (line {link.element.line})" for link in links[:_SHOWN]) + more


def _remarks(tree: Tree, chain: tuple[UrdfJoint, ...], choice: Choice, notes: UrdfNotes) -> tuple[str, ...]:
    """What was decided that the file does not say."""
    result = held(tree, chain, choice.fixed)
    unlimited = [joint.name for joint in chain if joint.effort is None]
    if unlimited:
        result.append(f"No torque limit is known where the file has none or 0: {', '.join(unlimited)}")
    moved = [link for links in moved_links(tree, chain) for link in links]
    strange = [link.name for link in moved if not bodily(tensor(link))]
    if strange:
        result.append(
            "No body has the inertia that the file gives, a principal moment above the sum of the others: "
            f"{', '.join(strange)}"
        )
    massless = [link.name for link in moved if link.mass == 0 and any(link.inertia)]
    if massless:
        result.append(f"No body has an inertia and no mass, as the file gives: {', '.join(massless)}")
    bare = [link for link in moved if not link.described and tree.below.get(link.name)]
    if bare:
        result.append(f"Links without <inertial> have no mass: {_places(bare)}")
    return (*result, *notes.told())


# --- The numbers of a URDF file under the names that reports use, each with its line as source.

_NO_DAMPING = "the file gives no damping, which means 0; property 2.7 needs more than that"


def motor_of(joint: UrdfJoint, file: str) -> JointEntry:
    """What ``<dynamics>`` and ``<limit>`` of a joint say."""
    source = _source(joint.element, file)
    viscous = Number(joint.damping or Fraction(0), "N·m·s/rad", source)
    if joint.damping is None:
        viscous = Number(Fraction(0), "N·m·s/rad", "", assumed=True, note=_NO_DAMPING)
    coulomb = None if joint.friction is None else Number(joint.friction, "N·m", source)
    limit = None if joint.effort is None else Number(joint.effort, "N·m", source)
    return JointEntry(joint.name, viscous, coulomb, limit, None, None)


def gravity_numbers(gravity: Triple) -> tuple[Number, ...]:
    """The gravity that is taken where the user gives none."""
    note = "URDF says nothing of gravity; the base frame is taken to have z upwards"
    return tuple(Number(x, "m/s²", assumed=True, note=note) if x else Number(x, "m/s²") for x in gravity)


def link_numbers(tree: Tree, file: str) -> dict[str, Number]:
    """Mass, centre of mass and inertia of every link that has any, as the file writes them."""
    result: dict[str, Number] = {}
    for link in tree.links.values():
        source = _source(link.element, file)
        entries = [("mass", link.mass, "kg")]
        entries += [(f"com_{letter}", x, "m") for letter, x in zip("xyz", link.com, strict=True)]
        entries += [(key, x, "kg·m²") for key, x in zip(INERTIA, link.inertia, strict=True)]
        for key, value, unit in entries:
            if value:
                result[f"{link.name}_{key}"] = Number(value, unit, source)
    return result


def joint_numbers(tree: Tree, motors: Sequence[JointEntry], file: str) -> dict[str, Number]:
    """The places of all joints, and the motors of those of the chain."""
    result: dict[str, Number] = {}
    for joint in tree.joints.values():
        source = _source(joint.element, file)
        for letter, x in zip("xyz", joint.xyz, strict=True):
            if x:
                result[f"{joint.name}_origin_{letter}"] = Number(x, "m", source)
    for motor in motors:
        result |= motor.numbers()
    return result


def _source(element: Element, file: str) -> str:
    return f"{file}, line {element.line}"


# --- What transmissions say of rotors: told, as M is that of the links.


_INERTIA = ("motorInertia", "rotorInertia", "drake:rotor_inertia", "rotor_inertia", "armature")
_RATIO = ("mechanicalReduction", "drake:gear_ratio", "gear_ratio")


def rotors(root: Element, chain: Iterable[UrdfJoint]) -> list[str]:
    """A sentence on the reflected inertia I r² of each joint of the arm whose rotor the file describes."""
    names, said = [joint.name for joint in chain], {}
    for part in (*root.all("transmission"), *root.all("joint")):
        inside = list(_all(part))
        joints = [part, *part.all("joint")]
        inertia, ratio = _number(inside, _INERTIA), _number(inside, _RATIO)
        for name in (joint.attributes.get("name", "") for joint in joints if joint.tag == "joint"):
            if inertia and name in names:
                said[name] = inertia * (1 if ratio is None else ratio) ** 2
    words = ", ".join(f"{name} {decimal_text(value)} kg·m²" for name, value in said.items())
    return [f"Rotor inertia that the file gives is not in M: {words}"] if said else []


def _all(element: Element) -> Iterator[Element]:
    yield element
    for child in element.children:
        yield from _all(child)


def _number(elements: Iterable[Element], tags: tuple[str, ...]) -> Fraction | None:
    """What the first element of such a tag says, as its value or between its tags."""
    for element in elements:
        if element.tag in tags:
            return decimal((element.attributes.get("value") or element.text).strip())
        for tag in tags:
            if tag in element.attributes:
                return decimal(element.attributes[tag].strip())
    return None
