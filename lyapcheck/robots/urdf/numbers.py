"""The numbers of a URDF file under the names that reports use, each with its line as source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.fields import JointEntry, Number
from lyapcheck.robots.urdf.parts import Triple, UrdfJoint, decimal
from lyapcheck.robots.urdf.tree import Tree
from lyapcheck.robots.urdf.xml import INERTIA, Element

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
