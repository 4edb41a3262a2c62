"""The torque of gravity of one arm: how large it is at most, and whether it is the slope of a potential.

References: ``reyes2019family``, Property 2.8.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.compared import Compared, Gap, mixed
from lyapcheck.check.kinds.inertia import (
    BoundedAbove,
    PostureWitness,
    dot,
    polynomial_text,
    require_polynomials,
    require_posture,
    variable_names,
    written_out,
)
from lyapcheck.check.loop.arithmetic import Arithmetic
from lyapcheck.check.loop.field import MOST_BOXES, Field, Value, size_of, value_at
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Uncertain, by_parameters, derivative
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Monomials


@dataclass(frozen=True)
class GravityBelow(BoundedAbove):
    """√Σ g_i(q)² <= high over the g_i given, for all angles and parameters; N·m."""

    joints: int
    gravity: tuple[Monomials, ...]
    parameters: tuple[Ends, ...]
    high: Fraction

    def require_well_formed(self) -> None:
        """Polynomials, and a bound that is not negative."""
        require(len(self.gravity) > 0, "gravity", "", "must have an entry")
        require_polynomials(self.gravity, self.joints, self.parameters)
        require(self.high >= 0, "high", self.high, "must not be negative")

    @property
    def entries(self) -> list[Uncertain]:
        """The g_i."""
        return [by_parameters(entry, self.joints) for entry in self.gravity]

    def at(self, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> list[arb]:
        """The g_i in balls at one posture."""
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
        """``‖(g1, …)‖ ≤ high …``."""
        size = "‖g(q)‖" if len(self.gravity) > 1 else "|g(q)|"
        about = gravity_text(self.gravity, self.joints, self.parameters)
        return f"{size} ≤ {number_text(self.high)} for all q, with {about}"


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
        """Polynomials."""
        require_polynomials((*self.gravity, self.potential), self.joints, self.parameters)

    @property
    def joints(self) -> int:
        """As many as entries."""
        return len(self.gravity)

    def gaps(self) -> Iterator[Gap]:
        """g_i − ∂U/∂q_i."""
        potential = by_parameters(self.potential, self.joints)
        for i, entry in enumerate(self.gravity):
            slope = {power: derivative(part, i) for power, part in potential.items()}
            yield f"g{i + 1}", (), mixed([(1, by_parameters(entry, self.joints)), (-1, slope)])

    def text(self) -> str:
        """``g(q) is the gradient of U(q) …``."""
        names = variable_names(self.joints, len(self.parameters))
        potential = written_out(
            [f"U = {polynomial_text(self.potential, names)}"], "potential", self.potential, ()
        )
        about = gravity_text(self.gravity, self.joints, self.parameters)
        return f"g(q) is the gradient of U(q), for all q, with {potential}, {about}"
