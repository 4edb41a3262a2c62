"""Rotations with rational entries, and the bodies that joints move, placed by them.

Rotations are exactly orthogonal, and within 10⁻¹⁵ rad of the angles as written.

The sine and cosine of a decimal angle other than 0 are never rational, so an angle of a file cannot be kept
exactly. An angle within 10⁻⁹ rad of a multiple of π/2 is taken as that multiple, for that is what a file
means by 1.57079632679; any other one, 1.5708 too, is replaced by a rational point of the circle close to it.
Both are reported.

References: the half-angle parametrisation of the circle; a quaternion with rational entries gives a
rational rotation.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from flint import arb, fmpz_mat

from lyapcheck.check.loop.chain import UNIT, RigidLink, rotation
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import dyadic, rational_root
from lyapcheck.check.numbers.vectors import ZERO, Algebra, is_positive_semidefinite
from lyapcheck.robots.urdf.tree import Tree, UrdfJoint, UrdfLink, moved_links
from lyapcheck.robots.urdf.xml import ORIGIN, Triple

SNAP = Fraction(1, 10**9)
"""Radians."""
CLOSE = Fraction(1, 10**15)
FULL_TURN = 7
"""Radians, from which a file may mean degrees."""
ROUNDED_INERTIA = Fraction(1, 10**12)
"""Of all moments of a body about its joint: less than the digits of a file say of them."""
_STEP = Fraction(1, 10**16)
_LARGE = 10**26
_BITS = 256

Rotation = tuple[tuple[Fraction, ...], ...]
OF = Algebra(Fraction)


@dataclass
class Roundings:
    """Which angles and axes were not taken exactly as written, by the place that says them."""

    snapped: dict[str, Fraction] = field(default_factory=dict)
    rounded: list[str] = field(default_factory=list)
    mended: list[str] = field(default_factory=list)
    turned: list[str] = field(default_factory=list)

    def note(self, place: str) -> None:
        if place not in self.rounded:
            self.rounded.append(place)

    def sentences(self) -> tuple[str, ...]:
        result = [f"An angle of {place} is above a full turn: is it in degrees?" for place in self.turned]
        if self.snapped:
            worst = max(self.snapped, key=lambda place: self.snapped[place])
            result.append(
                f"Angles within {float(SNAP):.0e} rad of a multiple of π/2 are taken as that multiple; "
                f"the largest difference is {float(self.snapped[worst]):.1e} rad ({worst})"
            )
        if self.rounded:
            result.append(
                f"Rotations and axes that no exact rational can give are rounded by less than "
                f"{float(CLOSE):.0e} rad: {', '.join(self.rounded)}"
            )
        if self.mended:
            result.append(
                "Principal moments below 0 by rounding are raised by "
                f"{float(ROUNDED_INERTIA):.0e} of the moments of the body: {', '.join(self.mended)}"
            )
        return tuple(result)


def oriented(turn: Sequence[Fraction], place: str, roundings: Roundings) -> Rotation:
    """The rotation of an ``<origin>``: that of three angles (see `from_rpy`), or of a quaternion x y z w."""
    if len(turn) == 3:
        return from_rpy((turn[0], turn[1], turn[2]), place, roundings)
    x, y, z, w = turn
    exact = _from_quaternion((w, x, y, z))
    result = tidy(exact)
    if result != exact:
        roundings.note(place)
    return result


def from_rpy(rpy: Triple, place: str, roundings: Roundings) -> Rotation:
    """Rz(yaw) Ry(pitch) Rx(roll), the fixed-axis angles of URDF, rad."""
    result: Rotation = UNIT
    if max(map(abs, rpy)) > FULL_TURN:
        roundings.turned.append(place)
    for axis, angle in enumerate(rpy):
        if angle:
            result = _rotation(OF.product(about(UNIT[axis], angle, place, roundings), result))
    return result


def about(axis: Sequence[Fraction], angle: Fraction, place: str, roundings: Roundings) -> Rotation:
    """The rotation about a unit vector, rad, with a rational sine and cosine close to those of the angle."""
    with precision(_BITS):
        exact = to_arb(angle)
        quarters = round(float(exact / (arb.pi() / 2)))
        rest = dyadic((exact - quarters * arb.pi() / 2).mid())
        tangent = dyadic((to_arb(rest) / 2).tan().mid())
    if abs(rest) <= SNAP:
        if abs(rest) > CLOSE:
            roundings.snapped[place] = max(abs(rest), roundings.snapped.get(place, ZERO))
        sine, cosine = ZERO, Fraction(1)
    else:
        roundings.note(place)
        t = _near(tangent)
        sine, cosine = 2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)
    for _ in range(quarters % 4):
        sine, cosine = cosine, -sine
    return _rotation(rotation(OF, axis, UNIT, sine, cosine))


def unit(vector: Triple, place: str, roundings: Roundings) -> Triple:
    """An exact unit vector along a vector that is not zero, or within 10⁻¹⁵ rad of it.

    Soundness: the answer has length exactly 1 whatever was rounded (stereographic projection).
    """
    square = sum((x * x for x in vector), ZERO)
    length = rational_root(square)
    if length is not None:
        x, y, z = (component / length for component in vector)
        return x, y, z
    roundings.note(place)
    scale = 10**60  # √square within a relative 10⁻⁴⁰
    whole = math.isqrt(square.numerator * square.denominator * scale**2)
    direction = [component * square.denominator * scale / whole for component in vector]
    pole = max(range(3), key=lambda i: abs(direction[i]))
    sign = 1 if direction[pole] > 0 else -1
    plane = [_near(x / (1 + sign * direction[pole])) for i, x in enumerate(direction) if i != pole]
    norm = plane[0] ** 2 + plane[1] ** 2
    result = [2 * x / (1 + norm) for x in plane]
    result.insert(pole, sign * (1 - norm) / (1 + norm))
    return result[0], result[1], result[2]


def _near(x: Fraction) -> Fraction:
    """The rational of the fewest digits within 10⁻¹⁶ of x."""
    digits = 1
    while abs(x.limit_denominator(10**digits) - x) > _STEP:
        digits += 1
    return x.limit_denominator(10**digits)


def tidy(rows: Sequence[Sequence[Fraction]]) -> Rotation:
    """The rotation itself, or where its entries have grown long one within 10⁻¹⁵ rad with shorter ones."""
    rotation = _rotation(rows)
    if all(entry.denominator < _LARGE for row in rotation for entry in row):
        return rotation
    return _from_quaternion(_quaternion(rotation))


def _quaternion(r: Rotation) -> tuple[int, int, int, int]:
    """A quaternion of whole numbers along the unit one; its largest component decides the formula."""
    trace = r[0][0] + r[1][1] + r[2][2]
    rows = [
        [1 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]],
        [r[2][1] - r[1][2], 1 + 2 * r[0][0] - trace, r[0][1] + r[1][0], r[0][2] + r[2][0]],
        [r[0][2] - r[2][0], r[0][1] + r[1][0], 1 + 2 * r[1][1] - trace, r[1][2] + r[2][1]],
        [r[1][0] - r[0][1], r[0][2] + r[2][0], r[1][2] + r[2][1], 1 + 2 * r[2][2] - trace],
    ]
    best = max(range(4), key=lambda i: rows[i][i])
    direction = [entry / rows[best][best] for entry in rows[best]]
    # a small q and p_i with |q x_i − p_i| ≤ 10⁻¹⁶ q, from a short vector of a lattice (LLL)
    fine, size = 10**16, 10**20
    others = [round(x * fine * size) for i, x in enumerate(direction) if i != best]
    lattice = [[size, *others], *([0, *(fine * size * (i == k) for k in range(3))] for i in range(3))]
    reduced = fmpz_mat(lattice).lll()
    for q in (*(int(reduced[row, 0]) // size for row in range(4)), 10**17):
        parts = [round(q * x) for x in direction]
        if q and all(abs(p - q * x) * 10**16 <= abs(q) for p, x in zip(parts, direction, strict=True)):
            break
    return parts[0], parts[1], parts[2], parts[3]


def _from_quaternion(q: tuple[int | Fraction, ...]) -> Rotation:
    w, x, y, z = (Fraction(part) for part in q)
    n = w * w + x * x + y * y + z * z
    rows = [
        [n - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), n - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), n - 2 * (x * x + y * y)],
    ]
    return _rotation([[entry / n for entry in row] for row in rows])


def _rotation(rows: Sequence[Sequence[Fraction]]) -> Rotation:
    return tuple(map(tuple, rows))


# --- From URDF links and joints to the bodies that the joints of one chain move.
#
# The links between two joints of the chain are rigid with each other; each is placed in the frame of the
# joint before it and brings its mass m, first moment m c and inertia, and their sums are exact.


@dataclass(frozen=True)
class _Pose:
    rotation: Rotation
    place: tuple[Fraction, ...]

    def then(self, rotation: Rotation, place: Sequence[Fraction]) -> _Pose:
        moved = OF.add(self.place, OF.apply(self.rotation, place))
        return _Pose(tidy(OF.product(self.rotation, rotation)), tuple(moved))


_HERE = _Pose(UNIT, ORIGIN)


def moved_bodies(
    tree: Tree, chain: tuple[UrdfJoint, ...], fixed: Mapping[str, Fraction], roundings: Roundings
) -> tuple[RigidLink, ...]:
    """The joints of the chain, base first, each with all that it moves up to the next one as one body."""
    # every link, and every joint of the chain, in the frame of the joint of the chain before it
    poses, joints = {tree.root: _HERE}, {}
    for joint in tree.downwards():
        turn = oriented(joint.turn, f"joint {joint.name}", roundings)
        pose = poses[joint.parent].then(turn, joint.xyz)
        value = fixed.get(joint.name)
        if joint in chain:
            joints[joint.name], pose = pose, _HERE
        elif value:
            axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
            where = f"joint {joint.name}, where it is held"
            slides = joint.kind == "prismatic"
            turn = UNIT if slides else about(axis, value, where, roundings)
            pose = pose.then(turn, OF.scaled(value, axis) if slides else ORIGIN)
        poses[joint.child] = pose
    result = []
    for joint, links in zip(chain, moved_links(tree, chain), strict=True):
        axis = unit(joint.axis, f"axis of joint {joint.name}", roundings)
        result.append(_body(joints[joint.name], axis, links, poses, roundings))
    return tuple(result)


def _body(
    joint: _Pose, axis: Triple, links: list[UrdfLink], poses: Mapping[str, _Pose], roundings: Roundings
) -> RigidLink:
    masses = []
    for link in links:
        pose = poses[link.name]
        masses.append((link.mass, OF.add(pose.place, OF.apply(pose.rotation, link.com))))
    mass = sum((m for m, _ in masses), ZERO)
    moment = OF.add(ORIGIN, *(OF.scaled(m, c) for m, c in masses))
    com = ORIGIN if mass == 0 else tuple(OF.scaled(1 / mass, moment))
    total = [[ZERO] * 3 for _ in range(3)]
    for link, (m, c) in zip(links, masses, strict=True):
        if any(link.inertia):
            turn = oriented(link.turn, f"inertia of link {link.name}", roundings)
            own = tidy(OF.product(poses[link.name].rotation, turn))
            total = OF.sum(total, OF.congruent(own, link.tensor))
        total = OF.sum(total, _point(m, OF.add(c, OF.scaled(Fraction(-1), com))))
    # an inertia that misses being positive semidefinite by the digits that a program printed is mended
    around = _point(mass, com)
    added = sum((total[i][i] + around[i][i] for i in range(3)), ZERO) * ROUNDED_INERTIA
    if added > 0 and not is_positive_semidefinite(total):
        mended = [[total[i][k] + added * (i == k) for k in range(3)] for i in range(3)]
        if is_positive_semidefinite(mended):
            roundings.mended += [link.name for link in links if not is_positive_semidefinite(link.tensor)]
            total = mended
    return RigidLink(axis, joint.place, mass, com, tuple(map(tuple, total)), joint.rotation)


def _point(m: Fraction, place: Sequence[Fraction]) -> list[list[Fraction]]:
    square = OF.dot(place, place)
    return [[m * (square * UNIT[i][k] - place[i] * place[k]) for k in range(3)] for i in range(3)]
