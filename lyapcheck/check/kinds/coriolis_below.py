"""C(q, x) of one arm whose M(q) is written out: how large it is at most.

References: ``reyes2019family``, Property 2.6.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.inertia import BoundedAbove, OfArm, PostureWitness, dot, require_posture
from lyapcheck.check.loop import symbols
from lyapcheck.check.loop.control_points import require_points
from lyapcheck.check.loop.field import MOST_BOXES
from lyapcheck.check.loop.head import DEGREE
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, rule

MOST_JOINTS, MOST_ANGLES = 4, 3
"""Joints, and those of them whose angles enter M(q)."""


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


@dataclass(frozen=True)
class ProductsOfRates(Proof):
    """Relations of the products of rates with which control points show the bound; untrusted.

    Args:
        relations: see `lyapcheck.check.loop.head.relation`, at each of the nodes of the angles that enter.
        start: control points of each of these angles to begin with.
        halvings: the angle, counted from 0, whose step is halved next.
    """

    rule = "products of rates"
    relations: tuple[tuple[Fraction, ...], ...]
    start: tuple[int, ...]
    halvings: tuple[int, ...]


@rule(CoriolisBelow, ProductsOfRates)
def by_products(statement: CoriolisBelow, proof: ProductsOfRates) -> Accepted:
    """Soundness: 2 zᵀC(q, x)x ≤ κ(‖z‖² + ‖x‖⁴) gives ‖C(q, x)x‖ ≤ κ‖x‖²; see `ChainCoriolisBelow`."""
    inertia, n = statement.symmetric, statement.joints
    require(not statement.parameters, "parameters", len(statement.parameters), "must be none")
    require(2 <= n <= MOST_JOINTS, "joints", n, f"must be from 2 to {MOST_JOINTS}")
    there = symbols.Symbols(inertia)
    angles = len(there.angles)
    require(1 <= angles <= MOST_ANGLES, "angles", angles, f"must be from 1 to {MOST_ANGLES}")
    require(there.degree <= DEGREE, "degree", there.degree, f"must be at most {DEGREE}")
    require_points(proof.start, proof.halvings, there.degree, angles)
    shown = symbols.shows(there, statement.high, proof.relations, proof.start, proof.halvings)
    require(shown, "relations", "", "do not show the bound")
    return Accepted("proved", "enclosure")
