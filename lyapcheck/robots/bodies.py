"""Arms by ``[[links]]``: the mass geometry of each link, whether such a body can exist, and the chain."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice, product
from math import isqrt
from typing import Any, ClassVar

from flint import fmpq, fmpq_mat

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import is_positive_semidefinite
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import Notes
from lyapcheck.robots.dynamics import Chain, Dynamics, ParameterShare
from lyapcheck.robots.fields import ROTOR, ArmFields, JointEntry, Number, Sign, read_joints
from lyapcheck.robots.plant import RobotModel

_ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
_PLACE = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}
_ZERO = Number(Fraction(0))


@dataclass(frozen=True)
class BodyEntry:
    """One link as read; ``inertia`` has the six entries of a tensor, or only ``planar``."""

    axis: tuple[Number, ...]
    origin: tuple[Number, ...]
    mass: Number
    com: tuple[Number, ...]
    inertia: dict[str, Number]

    def numbers(self, name: str) -> dict[str, Number]:
        """The numbers of the link under the names that reports use; axes and plain zeros are not listed."""
        result = {f"{name}_mass": self.mass}
        for key, vector in (("origin", self.origin), ("com", self.com)):
            result |= components(f"{name}_{key}", vector)
        return result | {f"{name}_{key}": entry for key, entry in self.inertia.items()}


def components(name: str, vector: Sequence[Number]) -> dict[str, Number]:
    """The components of a vector as ``name_x`` and so on, without those that are exactly zero."""
    named = {f"{name}_{letter}": x for letter, x in zip("xyz", vector, strict=True)}
    return {key: x for key, x in named.items() if x.value or x.ranged or x.assumed}


def read_bodies(tables: list[ArmFields]) -> list[BodyEntry | None]:
    """The links, base first; ``None`` for a link with a problem."""
    bodies = [_read_body(table) for table in tables]
    axes = [[x.value for x in body.axis] for body in bodies if body is not None]
    if all(_parallel(axis, axes[0]) for axis in axes):
        return bodies
    for table, body in zip(tables, bodies, strict=True):
        if body is not None and "inertia" in body.inertia:
            rule = "one number describes turning in a plane only, and the axes of this arm are not parallel"
            table.fail("inertia", rule, "give a table of ixx, iyy, izz and, where not zero, ixy, ixz, iyz")
    return bodies


def _read_body(fields: ArmFields) -> BodyEntry | None:
    axis = _read_axis(fields)
    origin, com = fields.vector("origin", "m"), fields.vector("com", "m")
    mass = fields.quantity("mass", "kg", Sign.POSITIVE, required=True)
    inertia = _read_inertia(fields)
    if axis is None or origin is None or com is None or mass is None or inertia is None:
        return None
    return BodyEntry(axis, origin, mass, com, inertia)


def _read_axis(fields: ArmFields) -> tuple[Number, ...] | None:
    axis = fields.vector("axis", "")
    if axis is None:
        return None
    square = sum((x.value**2 for x in axis), Fraction(0))
    length = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    if any(x.ranged for x in axis) or length**2 != square or not length:
        rule = "must be a vector whose length is a rational number other than 0"
        fields.fail("axis", rule, "write [0, 0, 1], or [3, 4, 0]; a URDF file may have any")
        return None
    return tuple(replace(x, value=x.value / length) for x in axis)


def _read_inertia(fields: ArmFields) -> dict[str, Number] | None:
    value = fields.data.get("inertia")
    if isinstance(value, list):
        fields.raw("inertia")
        rule = "must be a table of the entries, or one number where all axes are parallel"
        repair = (
            "write inertia = { ixx = …, iyy = …, izz = … }, with ixy, ixz and iyz where they are not zero"
        )
        fields.fail("inertia", rule, repair)
        return None
    if not isinstance(value, dict) or "value" in value:
        planar = fields.quantity("inertia", "kg·m²", Sign.NONNEGATIVE, required=True)
        return None if planar is None else {"inertia": planar}
    table = fields.table("inertia")
    if table is None:
        return None
    read = {key: table.quantity(key, "kg·m²", required=key in _ENTRIES[:3]) for key in _ENTRIES}
    table.close()
    if any(read[key] is None and key in (*_ENTRIES[:3], *table.data) for key in _ENTRIES):
        return None
    tensor = {key: number or _ZERO for key, number in read.items()}
    broken = _broken_rule(tensor)
    if broken:
        fields.fail(
            "inertia", broken, "check the signs and the point about which it is given (the centre of mass)"
        )
        return None
    return tensor


def bodily(tensor: Sequence[Sequence[Fraction]]) -> bool:
    """Whether some body has this inertia: the second moments ½tr(I) − I are positive semidefinite.

    They are so exactly when no principal moment is above the sum of the others.
    """
    half = (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 2
    return is_positive_semidefinite([[half * (i == k) - tensor[i][k] for k in range(3)] for i in range(3)])


def _broken_rule(tensor: dict[str, Number]) -> str:
    """Why no body has this inertia for some values in range; empty when there is one.

    Both conditions are convex and the entries independent, so the corners of the ranges decide.
    """
    for matrix in _corners(tensor):
        if not is_positive_semidefinite(matrix):
            return "must be positive semidefinite"
        if not bodily(matrix):
            return "must obey the triangle inequality (no principal moment above the sum of the others)"
    return ""


def _corners(tensor: dict[str, Number]) -> Iterator[list[list[Fraction]]]:
    for corner in product(*(sorted(set(tensor[key].bounds)) for key in _ENTRIES)):
        matrix = [[Fraction(0)] * 3 for _ in range(3)]
        for key, value in zip(_ENTRIES, corner, strict=True):
            i, k = _PLACE[key]
            matrix[i][k] = matrix[k][i] = value
        yield matrix


def _parallel(a: list[Fraction], b: list[Fraction]) -> bool:
    return all(a[i] * b[k] == a[k] * b[i] for i in range(3) for k in range(3))


# --- The arm that links make.


MOST_JOINTS = 12
_TENSOR = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))


@dataclass(frozen=True)
class ChainPlan:
    """A serial chain of links."""

    place: ClassVar[str] = "links"
    joints: list[JointEntry]
    bodies: list[BodyEntry]
    gravity: tuple[Number, ...]
    torques: None = None

    def numbers(self) -> dict[str, Number]:
        """Masses, lengths and inertias as ``joint_key``, gravity as ``gravity_x`` and so on."""
        result = components("gravity", self.gravity)
        for joint, body in zip(self.joints, self.bodies, strict=True):
            result |= body.numbers(joint.name) | joint.rotors
        return result

    def used(self) -> set[str]:
        """All of them."""
        return set(self.numbers())

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> Dynamics:
        def entry(name: str) -> Any:
            if name in parameters:
                return ParameterShare(name)
            return numbers[name].value if name in numbers else Fraction(0)

        bodies = zip(self.joints, self.bodies, strict=True)
        links = tuple(_link(joint.name, body, entry) for joint, body in bodies)
        return Chain(links, tuple(entry(f"gravity_{letter}") for letter in "xyz"), parameters)


def _link(name: str, body: BodyEntry, entry: Callable[[str], Any]) -> RigidLink:
    axis = tuple(x.value for x in body.axis)
    if "inertia" in body.inertia:
        own = entry(f"{name}_inertia")
        inertia = tuple(tuple(_times(own, a * b) for b in axis) for a in axis)
    else:
        inertia = tuple(tuple(entry(f"{name}_{key}") for key in row) for row in _TENSOR)
    origin, com = (tuple(entry(f"{name}_{key}_{letter}") for letter in "xyz") for key in ("origin", "com"))
    rotor = entry(f"{name}{ROTOR}")
    return RigidLink(axis, origin, entry(f"{name}_mass"), com, inertia, UNIT, rotor)


def _times(number: Any, factor: Fraction) -> Any:
    """The multiple of an exact number or of a parameter."""
    if isinstance(number, ParameterShare):
        return replace(number, factor=factor) if factor else factor
    return number * factor


def read_chain(
    top: ArmFields, tables: list[ArmFields], gravity: tuple[Number, ...] | None
) -> ChainPlan | None:
    """The arm of ``[[links]]``, ``None`` where it cannot be built; problems are noted."""
    joints, bodies = read_joints(top, "links", tables, MOST_JOINTS), read_bodies(tables)
    for table in tables:
        table.close()
    sound = [body for body in bodies if body is not None]
    return ChainPlan(joints, sound, gravity) if gravity and len(sound) == len(tables) else None


# --- A check that an arm as described can exist: M positive definite at a spread of states.


_STATES = 8
_MOST_CORNERS = 64


def check_positive_definite(model: RobotModel, place: str, notes: Notes) -> None:
    """Note a problem when M is not positive definite at a state, at a corner of the parameter ranges."""
    broken = impossible_state(model)
    if broken:
        repair = "every joint must move some inertia: check masses, inertias, signs and ranges"
        notes.fail((place,), None, broken, repair)


def impossible_state(model: RobotModel) -> str:
    """Where M is not positive definite, as the rule that this breaks; empty when no such state was found.

    Exact at each state, but at finitely many: it finds slips in a file and proves nothing. A chain of bodies
    each with a moment about its own axis has no such state, see ``check.kinds.chain``.
    """
    chain = model.chain
    if chain is not None and all(link.fits and link.about_axis > 0 for link in chain.links):
        return ""
    for corner, state in product(_corners_physics(model), range(_STATES)):
        tangents = [_tangent(state, joint) for joint in range(model.n)]
        sin = [2 * t / (1 + t * t) for t in tangents]
        cos = [(1 - t * t) / (1 + t * t) for t in tangents]
        parameters = {name: rational(value) for name, value in corner.items()}
        if not _positive_definite(model.at(sin, cos, rational, parameters).mass()):
            where = [f"cos q{i + 1} = {value}" for i, value in enumerate(cos)]
            where += [f"{name} = {decimal_text(value)}" for name, value in corner.items()]
            return f"makes M not positive definite, e.g. at {', '.join(where)}"
    return ""


def _corners_physics(model: RobotModel) -> Iterator[dict[str, Fraction]]:
    """Corners of the box of parameters, the first few when there are very many."""
    bounds = [number.bounds for number in model.parameters.values()]
    for values in islice(product(*bounds), _MOST_CORNERS):
        yield dict(zip(model.parameters, values, strict=True))


def _tangent(state: int, joint: int) -> fmpq:
    """tan(q/2) of a joint: 0 everywhere in the first state, then spread over the circle."""
    return fmpq((state * (2 * joint + 3)) % 23, 5) * (-1 if state % 2 else 1)


def _positive_definite(rows: list[list[fmpq]]) -> bool:
    return all(fmpq_mat([row[:k] for row in rows[:k]]).det() > 0 for k in range(1, len(rows) + 1))
