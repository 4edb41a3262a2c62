"""Arms by ``[[links]]``: the mass geometry of each link, whether such a body can exist, and the chain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice, product
from typing import Any, ClassVar

from flint import fmpq, fmpq_mat

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.numbers.polynomials import rational, rational_root
from lyapcheck.check.numbers.vectors import is_positive_semidefinite
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.dynamics import Chain, ParameterShare
from lyapcheck.robots.fields import ROTOR, ArmFields, JointEntry, Number, Sign, read_joints
from lyapcheck.robots.plant import RobotModel, of_a_body

_ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
_TENSOR = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
MOST_JOINTS = 12


def components(name: str, vector: Sequence[Number]) -> dict[str, Number]:
    """The components of a vector as ``name_x`` and so on, without those that are exactly zero."""
    named = {f"{name}_{letter}": x for letter, x in zip("xyz", vector, strict=False)}
    return {key: x for key, x in named.items() if x.value or x.ranged or x.assumed}


def _read_body(fields: ArmFields, name: str) -> tuple[tuple[Fraction, ...], dict[str, Number]] | None:
    """The axis of a link, of length 1, and its numbers; an inertia is six entries, or one for all."""
    axis = fields.vector("axis", "")
    length = rational_root(sum((x.value**2 for x in axis or ()), Fraction(0)))
    if axis is not None and (any(x.ranged for x in axis) or not length):
        rule = "must be a vector whose length is a rational number other than 0"
        fields.fail("axis", rule, "write [0, 0, 1], or [3, 4, 0]; a URDF file may have any")
        axis = None
    origin, com = fields.vector("origin", "m"), fields.vector("com", "m")
    mass = fields.quantity("mass", "kg", Sign.POSITIVE, required=True)
    inertia = _read_inertia(fields)
    if axis is None or not length or origin is None or com is None or mass is None or inertia is None:
        return None
    numbers = {f"{name}_mass": mass, **components(f"{name}_origin", origin), **components(f"{name}_com", com)}
    numbers |= {f"{name}_{key}": entry for key, entry in inertia.items()}
    return tuple(x.value / length for x in axis), numbers


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
    tensor = {key: number or Number(Fraction(0)) for key, number in read.items()}
    # both conditions are convex and the entries independent, so the corners of the ranges decide
    for corner in product(*(sorted(set(tensor[key].bounds)) for key in _ENTRIES)):
        entries = dict(zip(_ENTRIES, corner, strict=True))
        matrix = [[entries[key] for key in row] for row in _TENSOR]
        broken = "" if is_positive_semidefinite(matrix) else "must be positive semidefinite"
        if not broken and not of_a_body(matrix):
            broken = "must obey the triangle inequality (no principal moment above the sum of the others)"
        if broken:
            repair = "check the signs and the point about which it is given (the centre of mass)"
            fields.fail("inertia", broken, repair)
            return None
    return tensor


# --- The arm that links make.


@dataclass(frozen=True)
class ChainPlan:
    """A serial chain of links, and its numbers: ``joint_mass``, ``joint_com_x``, ``gravity_x`` and so on."""

    place: ClassVar[str] = "links"
    joints: list[JointEntry]
    axes: list[tuple[Fraction, ...]]
    numbers: dict[str, Number]
    torques: None = None

    @property
    def used(self) -> set[str]:
        """All of them."""
        return set(self.numbers)

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> Chain:
        def entry(name: str) -> Any:
            if name in parameters:
                return ParameterShare(name)
            return numbers[name].value if name in numbers else Fraction(0)

        links = []
        for joint, axis in zip(self.joints, self.axes, strict=True):
            name = joint.name
            if f"{name}_inertia" in numbers:
                own = entry(f"{name}_inertia")
                inertia = tuple(tuple(_times(own, a * b) for b in axis) for a in axis)
            else:
                inertia = tuple(tuple(entry(f"{name}_{key}") for key in row) for row in _TENSOR)
            origin, com = (tuple(entry(f"{name}_{key}_{x}") for x in "xyz") for key in ("origin", "com"))
            mass, rotor = entry(f"{name}_mass"), entry(f"{name}{ROTOR}")
            links.append(RigidLink(axis, origin, mass, com, inertia, UNIT, rotor))
        return Chain(tuple(links), tuple(entry(f"gravity_{letter}") for letter in "xyz"), parameters)


def _times(number: Any, factor: Fraction) -> Any:
    """The multiple of an exact number or of a parameter."""
    if isinstance(number, ParameterShare):
        return replace(number, factor=factor) if factor else factor
    return number * factor


def read_chain(
    top: ArmFields, tables: list[ArmFields], gravity: tuple[Number, ...] | None
) -> ChainPlan | None:
    """The arm of ``[[links]]``, ``None`` where it cannot be built; problems are noted."""
    joints = read_joints(top, "links", tables, MOST_JOINTS)
    bodies = [_read_body(table, joint.name) for table, joint in zip(tables, joints, strict=True)]
    axes = [body[0] for body in bodies if body is not None]
    pairs = list(product(range(3), repeat=2))
    planar = all(axis[i] * axes[0][k] == axis[k] * axes[0][i] for axis in axes for i, k in pairs)
    numbers = components("gravity", gravity or ())
    for table, joint, body in zip(tables, joints, bodies, strict=True):
        table.close()
        own = {} if body is None else body[1]
        if f"{joint.name}_inertia" in own and not planar:
            rule = "one number describes turning in a plane only, and the axes of this arm are not parallel"
            table.fail("inertia", rule, "give a table of ixx, iyy, izz and, where not zero, ixy, ixz, iyz")
        numbers |= own | joint.rotors
    return ChainPlan(joints, axes, numbers) if gravity and len(axes) == len(tables) else None


# --- A check that an arm as described can exist: M positive definite at a spread of states.


_STATES = 8
_MOST_CORNERS = 64


def impossible_state(model: RobotModel) -> str:
    """Where M is not positive definite, as the rule that this breaks; empty when no such state was found.

    Exact at each state, but at finitely many: it finds slips in a file and proves nothing. A chain of bodies
    each with a moment about its own axis has no such state, see ``check.kinds.chain``.
    """
    chain = model.chain
    if chain is not None and all(link.fits and link.about_axis > 0 for link in chain.links):
        return ""
    bounds = [number.bounds for number in model.parameters.values()]
    for ends, state in product(islice(product(*bounds), _MOST_CORNERS), range(_STATES)):
        # tan(q/2) of each joint: 0 everywhere in the first state, then spread over the circle
        sign = -1 if state % 2 else 1
        tangents = [fmpq((state * (2 * joint + 3)) % 23, 5) * sign for joint in range(model.n)]
        sin = [2 * t / (1 + t * t) for t in tangents]
        cos = [(1 - t * t) / (1 + t * t) for t in tangents]
        corner = dict(zip(model.parameters, ends, strict=True))
        rows = model.at(sin, cos, rational, {name: rational(x) for name, x in corner.items()}).mass()
        if any(fmpq_mat([row[:k] for row in rows[:k]]).det() <= 0 for k in range(1, model.n + 1)):
            where = [f"cos q{i + 1} = {value}" for i, value in enumerate(cos)]
            where += [f"{name} = {decimal_text(value)}" for name, value in corner.items()]
            return f"makes M not positive definite, e.g. at {', '.join(where)}"
    return ""
