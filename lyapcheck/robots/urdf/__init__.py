"""URDF files: serial chains of revolute joints, exactly as far as decimals are exact."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path

from lyapcheck.check.numbers.vectors import is_positive_semidefinite
from lyapcheck.errors import InputError
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.escapes import printable
from lyapcheck.robots.bodies import impossible_state
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import JointEntry, Number, decimal, of_joints
from lyapcheck.robots.plant import RobotModel, of_a_body
from lyapcheck.robots.urdf.chain import choose_chain, options
from lyapcheck.robots.urdf.rotations import Roundings, moved_bodies
from lyapcheck.robots.urdf.tree import SHOWN, Tree, UrdfJoint, UrdfLink, build_tree, moved_links, read_parts
from lyapcheck.robots.urdf.xml import INERTIA, Element, UrdfNotes

_EARTH = "URDF says nothing of gravity; the base frame is taken to have z upwards"
_NO_DAMPING = "the file gives no damping, which means 0; property 2.7 needs more than that"


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
    links, joints = read_parts(root, notes)
    tree = None if notes.problems else build_tree(links, joints, root, notes)
    chain = () if tree is None else choose_chain(tree, choice, root, notes)
    if tree is None or notes.problems:
        raise InputError(notes.problems)
    moved = moved_links(tree, chain)
    _require_inertia(tree, chain, moved, choice, root, notes)
    roundings = Roundings()
    bodies = moved_bodies(tree, chain, choice.fixed, roundings)
    for body, own in zip(bodies, moved, strict=True):
        for link in () if is_positive_semidefinite(body.inertia) else own:
            if not is_positive_semidefinite(link.tensor):
                key, rule = f"link {link.name}: inertia", "must be positive semidefinite"
                repair = "check the signs and the point about which it is given (the centre of mass)"
                notes.fail(link.element, key, "", rule, repair)
    if notes.problems:
        raise InputError(notes.problems)
    earth = (Fraction(0), Fraction(0), Fraction("-9.81"))
    fall = gravity or [Number(x, "m/s²", assumed=bool(x), note=_EARTH if x else "") for x in earth]
    file, stem = printable(source or path.name), printable(path.name.partition(".")[0] or path.stem)
    motors = [_motor(joint, file) for joint in chain]
    numbers = {f"gravity_{letter}": x for letter, x in zip("xyz", fall, strict=True) if x.value}
    numbers |= dict(_places_and_masses(tree, file))
    for motor in motors:
        numbers |= motor.numbers()
    told = _remarks(tree, chain, moved, choice.fixed)
    model = RobotModel(
        name=stem,
        title=f"{root.attributes.get('name', stem)[:80]} (URDF)",
        dynamics=Chain(bodies, tuple(entry.value for entry in fall)),
        **of_joints(motors),
        numbers=numbers,
        remarks=(*remarks, *roundings.sentences(), *told, *notes.told(), *_rotors(root, chain)),
    )
    if broken := impossible_state(model):
        bare = _bare(tree, moved)
        repair = f"every joint must move some inertia{': ' if bare else ''}{bare}; check masses and inertias"
        notes.fail(root, "robot", "", broken, repair)
        raise InputError(notes.problems)
    return model


def _require_inertia(
    tree: Tree,
    chain: tuple[UrdfJoint, ...],
    moved: list[list[UrdfLink]],
    choice: Choice,
    robot: Element,
    notes: UrdfNotes,
) -> None:
    """Refuse an arm whose last joint moves nothing that has mass or inertia: M would be singular."""
    heavy = [i for i, links in enumerate(moved) if any(link.mass or any(link.inertia) for link in links)]
    if heavy and heavy[-1] == len(chain) - 1:
        return
    rule, repair = (
        _bare(tree, moved),
        "give the moved links masses and inertias, as CAD programs compute them",
    )
    if heavy:
        end = options(choice.base, chain[heavy[-1]].child, choice.fixed)
        rule = f"has a joint {chain[-1].name} that moves no mass: {rule}"
        repair = f"give it mass and inertia, or end the arm before it: {end}"
    else:
        rule += ": this file describes geometry only"
    notes.fail(robot, "robot", "", rule, repair)
    raise InputError(notes.problems)


def _bare(tree: Tree, moved: list[list[UrdfLink]]) -> str:
    """Which of the moved links have no mass, and where they stand in the file."""
    bare = [link for links in moved for link in links if not link.described]
    zero = [link for links in moved for link in links if link.described and not link.mass]
    none = sum(not link.described for link in tree.links.values())
    count = f"{none} of {len(tree.links)} links have no <inertial>"
    parts = [f"{count}: {_places(bare)}"] if bare else []
    parts += [f"{'link' if len(zero) == 1 else 'links'} of mass 0: {_places(zero)}"] if zero else []
    return "; ".join(parts)


def _places(links: list[UrdfLink]) -> str:
    more = f" and {len(links) - SHOWN} more" if len(links) > SHOWN else ""
    return ", ".join(f"{link.name} (line {link.element.line})" for link in links[:SHOWN]) + more


def _remarks(
    tree: Tree, chain: tuple[UrdfJoint, ...], moved: list[list[UrdfLink]], fixed: Mapping[str, Fraction]
) -> Iterator[str]:
    """What was decided that the file does not say."""
    still = [
        f"{joint.name} ({joint.kind})"
        + (f" at {decimal_text(fixed[joint.name])}" if fixed.get(joint.name) else "")
        for joint in tree.joints.values()
        if joint.moves and joint not in chain
    ]
    if still:
        what = "Joints that are not of the arm are held, at zero where nothing else is said"
        yield f"{what}: {', '.join(still)}; --base, --tip and --fixed choose other arms"
    links = [link for own in moved for link in own]
    for what, names in (
        (
            "No torque limit is known where the file has none or 0",
            [joint.name for joint in chain if joint.effort is None],
        ),
        (
            "No body has the inertia that the file gives, a principal moment above the sum of the others",
            [link.name for link in links if not of_a_body(link.tensor)],
        ),
        (
            "No body has an inertia and no mass, as the file gives",
            [link.name for link in links if link.mass == 0 and any(link.inertia)],
        ),
    ):
        if names:
            yield f"{what}: {', '.join(names)}"
    bare = [link for link in links if not link.described and tree.below.get(link.name)]
    if bare:
        yield f"Links without <inertial> have no mass: {_places(bare)}"


# --- The numbers of a URDF file under the names that reports use, each with its line as source.


def _motor(joint: UrdfJoint, file: str) -> JointEntry:
    """What ``<dynamics>`` and ``<limit>`` of a joint say."""
    source = _source(joint.element, file)
    viscous = Number(joint.damping or Fraction(0), "N·m·s/rad", source)
    if joint.damping is None:
        viscous = Number(Fraction(0), "N·m·s/rad", "", assumed=True, note=_NO_DAMPING)
    coulomb, limit = (None if x is None else Number(x, "N·m", source) for x in (joint.friction, joint.effort))
    return JointEntry(joint.name, viscous, coulomb, limit, None, None)


def _places_and_masses(tree: Tree, file: str) -> Iterator[tuple[str, Number]]:
    """Mass, centre of mass and inertia of every link, and the place of every joint, where not zero."""
    for link in tree.links.values():
        entries = [("mass", link.mass, "kg")]
        entries += [(f"com_{letter}", x, "m") for letter, x in zip("xyz", link.com, strict=True)]
        entries += [(key, x, "kg·m²") for key, x in zip(INERTIA, link.inertia, strict=True)]
        for key, value, unit in entries:
            if value:
                yield f"{link.name}_{key}", Number(value, unit, _source(link.element, file))
    for joint in tree.joints.values():
        for letter, x in zip("xyz", joint.xyz, strict=True):
            if x:
                yield f"{joint.name}_origin_{letter}", Number(x, "m", _source(joint.element, file))


def _source(element: Element, file: str) -> str:
    return f"{file}, line {element.line}"


# --- What transmissions say of rotors: told, as M is that of the links.


_INERTIA = ("motorInertia", "rotorInertia", "drake:rotor_inertia", "rotor_inertia", "armature")
_RATIO = ("mechanicalReduction", "drake:gear_ratio", "gear_ratio")


def _rotors(root: Element, chain: Iterable[UrdfJoint]) -> list[str]:
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
            return decimal((element.attributes.get("value") or "".join(element.texts)).strip())
        for tag in tags:
            if tag in element.attributes:
                return decimal(element.attributes[tag].strip())
    return None
