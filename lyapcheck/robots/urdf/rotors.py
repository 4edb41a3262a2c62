"""What transmissions of a URDF file say of rotors: told, as M is that of the links."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.urdf.parts import UrdfJoint, decimal
from lyapcheck.robots.urdf.xml import Element

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
