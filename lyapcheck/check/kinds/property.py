"""What Lyapunov's method asks of a closed loop and of V, each property by itself, for systems that are data.

- an equilibrium: nothing moves at the origin;
- the only one: ė = −w, so w = 0 at rest; there xᵀ(M ẇ) >= χ for some x, with χ positive definite in sizes
  that see all other states, so that M ẇ = 0 nowhere else;
- positive definite, radially unbounded: V = 0 at the origin, and V >= φ, positive definite in sizes that see
  every state and grow with it without end;
- decrescent: V <= Φ, a form in sizes without time, which all vanish at the origin;
- continuously differentiable: V is made of letters that are, with s only beside what vanishes with e.

References: ``khalil2002nonlinear``, chapter 4; ``kelly2005control``, chapters 2 and 4.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.stability import (
    ByObligations,
    by_argument,
    energy_text,
    granted_of,
    loop_text,
)
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Statement, Total
from lyapcheck.check.systems import obligations as parts
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.verify import Accepted, rule

EQUILIBRIUM = "the origin is the only equilibrium"
AN_EQUILIBRIUM = "the origin is an equilibrium"
POSITIVE = "V is positive definite"
UNBOUNDED = "V is radially unbounded"
DECRESCENT = "V is decrescent"
SMOOTH = "V is continuously differentiable"
Part = Callable[[Argument], parts.Named]
DEFINITE = (parts.energy_at_origin, parts.functions, parts.above)
PROPERTIES: dict[str, tuple[Part, ...]] = {
    EQUILIBRIUM: (parts.origin, parts.functions, parts.at_rest),
    AN_EQUILIBRIUM: (parts.origin, parts.functions),
    POSITIVE: DEFINITE,
    UNBOUNDED: DEFINITE,
    DECRESCENT: (parts.functions, parts.below),
    SMOOTH: (parts.functions,),
}
"""For each property the obligations of the argument that it follows from."""


@dataclass(frozen=True)
class Property(Total):
    """A property of the system, or of V, of an argument; what else the argument says is not said here."""

    name: str
    argument: Argument

    def require_well_formed(self) -> None:
        """Refuse a property that the argument has no form for."""
        argument = self.argument
        require(self.name in PROPERTIES, "property", self.name, "is not one that the checker knows")
        argument.require_well_formed()
        fits = {
            EQUILIBRIUM: argument.rest is not None and argument.seen(argument.rate) == {"w"},
            DECRESCENT: argument.upper is not None,
        }.get(self.name, True)
        require(fits, "argument", argument.theorem, f"has no form from which “{self.name}” follows")
        definite = self.name not in (POSITIVE, UNBOUNDED) or argument.cascade is None
        require(definite, "argument", argument.theorem, "has a V that need not see e")
        still = self.name not in (EQUILIBRIUM, AN_EQUILIBRIUM) or not argument.system.disturbed
        require(still, "argument", argument.theorem, "has an unknown torque, under which nothing is at rest")

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """What the property follows from, by name."""
        for part in PROPERTIES[self.name]:
            yield from part(self.argument)

    @property
    def granted(self) -> tuple[str, ...]:
        """What holds of the arm and of the letters."""
        return granted_of(self.argument)

    def text(self) -> str:
        """The property, of which system and of which V."""
        argument = self.argument
        energy, says = energy_text(argument), ""
        if self.name == EQUILIBRIUM and argument.rest is not None:
            against, form = argument.rest.against, argument.rest.form.tree
            says = f", as ({expression_text(against)})·M dw/dt ≥ {expression_text(form)} where w = 0,"
        elif self.name in (POSITIVE, UNBOUNDED):
            says = f": {energy}, by V ≥ φ = {expression_text(argument.lower.tree)},"
        elif self.name == DECRESCENT and argument.upper is not None:
            says = f": {energy}, by V ≤ Φ = {expression_text(argument.upper.tree)},"
        elif self.name == SMOOTH:
            says = f": {energy},"
        return f"{self.name}{says} {loop_text(argument)}"


@rule(Property, ByObligations)
def by_parts(statement: Property, proof: ByObligations) -> Accepted:
    """Soundness: see the head of this file."""
    return by_argument(statement.argument, statement.obligations(), proof)
