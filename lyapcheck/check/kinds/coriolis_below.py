"""C(q, x) of one arm whose M(q) is written out: how large it is at most.

References: ``reyes2019family``, Property 2.6.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.inertia import BoundedAbove, OfArm, PostureWitness, dot, require_posture
from lyapcheck.check.loop.field import MOST_BOXES
from lyapcheck.check.numbers.balls import to_arb


@dataclass(frozen=True)
class CoriolisBelow(OfArm, BoundedAbove):
    """‖C(q, x)y‖ <= high ‖x‖ ‖y‖ for the C of Christoffel symbols, all q, x, y and parameters; kg·m²."""

    high: Fraction

    def text(self) -> str:
        """``‖C(q, x)y‖ ≤ high ‖x‖ ‖y‖ …``."""
        bound = f"‖C(q, x)y‖ ≤ {number_text(self.high)} ‖x‖ ‖y‖"
        return f"{bound} for all x, y, {self.over}; C by Christoffel symbols"

    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        """See :meth:`Inertia.coriolis_below`, for a positive bound."""
        return self.high > 0 and self.symmetric.coriolis_below(self.high, most)

    def square_by_sizes(self) -> Fraction:
        """See :meth:`Inertia.squares_of_symbols`."""
        return self.symmetric.squares_of_symbols

    def excess(self, at: PostureWitness) -> arb:
        """‖C(q, x)y‖² − high² ‖x‖² ‖y‖²; no norm is negative."""
        require_posture(at, self.joints, self.parameters)
        x, y = self.vector("x", at.x), self.vector("y", at.y)
        turned = self.symmetric.coriolis(at.q, at.parameters, x, y)
        return dot(turned, turned) - to_arb(max(self.high, Fraction(0))) ** 2 * dot(x, x) * dot(y, y)
