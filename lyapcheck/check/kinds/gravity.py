"""The torque of gravity of one arm: how large it is at most, and whether it is the slope of a potential.

References: ``reyes2019family``, Property 2.8.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.identity import Compared, Gap
from lyapcheck.check.kinds.inertia import (
    BoundedAbove,
    PostureWitness,
    dot,
    polynomial_text,
    potential_text,
    require_polynomials,
    require_posture,
    variable_names,
    written_out,
)
from lyapcheck.check.loop.chain import RigidLink, lever_bound, pulls
from lyapcheck.check.loop.field import MOST_BOXES, Arithmetic, Field, Value, size_of, value_at
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Uncertain, by_parameters, mixed, slope
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Monomials, Proof
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class GravityBelow(BoundedAbove):
    """√Σ g_i(q)² <= high over the g_i given, for all angles and parameters; N·m."""

    joints: int
    gravity: tuple[Monomials, ...]
    parameters: tuple[Ends, ...]
    high: Fraction

    def require_well_formed(self) -> None:
        require(len(self.gravity) > 0, "gravity", "", "must have an entry")
        require_polynomials(self.gravity, self.joints, self.parameters)
        require(self.high >= 0, "high", self.high, "must not be negative")

    @property
    def entries(self) -> list[Uncertain]:
        return [by_parameters(entry, self.joints) for entry in self.gravity]

    def at(self, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> list[arb]:
        return [value_at(entry, q, parameters) for entry in self.entries]

    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        """Whether Σ g_i² < high² throughout, by boxes that are cut until they show it."""
        square = to_arb(self.high * self.high)

        def shows(values: list[Value], of: Arithmetic) -> bool:
            rest = of.value(square)
            for value in values:
                rest = rest - of.square(value)
            return of.positive(rest)

        return Field(self.entries, self.joints, self.parameters).throughout(shows, most)

    def square_by_sizes(self) -> Fraction:
        """No g_i is larger than the sizes of its harmonics together."""
        return sum((size_of(g, self.parameters) ** 2 for g in self.entries), Fraction(0))

    def excess(self, at: PostureWitness) -> arb:
        """Σ g_i² − high²."""
        require_posture(at, self.joints, self.parameters)
        values = self.at(at.q, at.parameters)
        return dot(values, values) - to_arb(self.high**2)

    def text(self) -> str:
        size = "‖g(q)‖" if len(self.gravity) > 1 else "|g(q)|"
        about = gravity_text(self.gravity, self.joints, self.parameters)
        return f"{size} ≤ {number_text(self.high)} for all q, with {about}"


@dataclass(frozen=True)
class Levers(Proof):
    """Gravity pulls at one joint, from 0, no harder than masses times distances from its axis.

    ``links`` have their masses where every parameter is 0, ``shares`` those for one unit of each, ``fall`` is
    the acceleration of free fall in the base frame, m/s²; for ``along`` see `lever_bound`.
    """

    rule = "levers"
    links: tuple[RigidLink, ...]
    shares: tuple[tuple[Fraction, ...], ...]
    fall: tuple[Fraction, ...]
    joint: int
    along: tuple[int, ...]

    def bound(self, parameters: Sequence[Ends]) -> Fraction:
        """What it shows, as |g_i| ≤ |part where all are 0| + Σ |p| |part of p|."""
        sizes = [Fraction(1), *(max(abs(low), abs(high)) for low, high in parameters)]
        rows = zip(sizes, self.weighed(), strict=True)
        return sum(
            (size * lever_bound(row, self.fall, self.joint, self.along) for size, row in rows), Fraction(0)
        )

    def weighed(self) -> list[tuple[RigidLink, ...]]:
        others = [zip(self.links, row, strict=True) for row in self.shares]
        return [self.links, *(tuple(replace(link, mass=mass) for link, mass in row) for row in others)]


@rule(GravityBelow, Levers)
def by_levers(statement: GravityBelow, proof: Levers) -> Accepted:
    """Soundness: g_i is affine in the parameters, each part that of links; see `lever_bound`."""
    n, count = statement.joints, len(statement.parameters)
    sizes = {len(proof.links), *map(len, proof.shares)} == {n} and len(proof.shares) == count
    fits = sizes and len(proof.fall) == 3 and all(link.fits for link in proof.links)
    require(fits, "links", len(proof.links), f"must be {n} joints and bodies, with masses for each parameter")
    require(0 <= proof.joint < n, "joint", proof.joint, f"must be from 0 to {n - 1}")
    require(len(statement.gravity) == 1, "gravity", len(statement.gravity), "must be of one joint")
    (torque,) = statement.gravity
    require(all(sum(p[2 * n :]) <= 1 for p, _ in torque), "parameters", count, "enter g as products")
    for k, links in enumerate(proof.weighed()):
        one = tuple(int(k == 1 + j) for j in range(count))
        part = tuple((p[: 2 * n], c) for p, c in torque if p[2 * n :] == one)
        require(pulls(links, proof.fall, proof.joint, part), "links", k, "do not make this g")
    reached = proof.bound(statement.parameters)
    require(reached <= statement.high, "levers", reached, f"are above {statement.high}")
    return Accepted("proved", "exact")


def gravity_text(gravity: tuple[Monomials, ...], n: int, parameters: tuple[Ends, ...]) -> str:
    """g(q) written out, or its digest."""
    names = variable_names(n, len(parameters))
    entries = [
        f"g{i + 1 if len(gravity) > 1 else ''} = {polynomial_text(g, names)}" for i, g in enumerate(gravity)
    ]
    return written_out(entries, f"{len(gravity)} torques of {n} joints", gravity, parameters)


@dataclass(frozen=True)
class GravityOfPotential(Compared):
    """g(q) is the gradient of the potential energy, for all angles and parameters."""

    gravity: tuple[Monomials, ...]
    potential: Monomials
    parameters: tuple[Ends, ...]

    def require_well_formed(self) -> None:
        require_polynomials((*self.gravity, self.potential), self.joints, self.parameters)

    @property
    def joints(self) -> int:
        return len(self.gravity)

    def gaps(self) -> Iterator[Gap]:
        potential = by_parameters(self.potential, self.joints)
        for i, entry in enumerate(self.gravity):
            gap = mixed([(1, by_parameters(entry, self.joints)), (-1, slope(potential, i))])
            yield f"g{i + 1}", (), gap

    def text(self) -> str:
        potential = potential_text(self.potential, self.joints, len(self.parameters), "potential")
        about = gravity_text(self.gravity, self.joints, self.parameters)
        return f"g(q) is the gradient of U(q), for all q, with {potential}, {about}"
