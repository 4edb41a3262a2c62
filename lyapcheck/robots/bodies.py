"""Reading ``[[links]]``: the mass geometry of each link, and whether such a body can exist."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from lyapcheck.check.numbers.matrices import is_positive_semidefinite
from lyapcheck.robots.chain_bounds import bodily
from lyapcheck.robots.fields import ArmFields, Sign
from lyapcheck.robots.number import Number

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
    if any(x.ranged for x in axis) or sum(x.value**2 for x in axis) != 1:
        fields.fail("axis", "must be a vector of length exactly 1", "write [0, 0, 1], or [0.6, 0.8, 0]")
        return None
    return axis


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
