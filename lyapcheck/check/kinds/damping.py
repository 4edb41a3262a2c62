"""Whether a bound on K_v is needed for dV/dt < 0: against it, gains that break the bound and have dV/dt < 0.

References: ``reyes2019family`` (19).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text, number_text
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.of_loop import OfLoop
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import OfTerms, Proof, Relation
from lyapcheck.check.verify import Accepted, require_proved, rule, verify, weakest


@dataclass(frozen=True)
class DampingBelow(OfLoop, OfTerms):
    """For all κ > 0 and ε₀ > 0: where dV/dt < 0 at every state but the origin, κ λmax(K_v) < bound.

    The gains are K_p and κ K_v; V is that of (13).
    """

    bound: Tree

    def with_damping(self, factor: Fraction, eps0: Fraction) -> Decreasing:
        """That dV/dt < 0 at one κ and one ε₀."""
        kv = tuple(factor * k for k in self.kv)
        arm = (self.mass, self.viscous, self.parameters)
        return Decreasing(*arm, self.family, self.m, self.kp, kv, eps0, ())

    def below(self, factor: Fraction) -> Constant:
        """That κ λmax(K_v) < bound at one κ."""
        return Constant(Relation(("num", str(factor * max(self.kv))), "<", self.bound))

    def require_well_formed(self) -> None:
        """K_v above 0, and an expression without variables."""
        super().require_well_formed()
        require(all(k > 0 for k in self.kv), "kv", self.kv, "must be positive")
        require_expressions([self.bound], [])

    def terms(self) -> list[tuple[Tree, Domain]]:
        """The bound."""
        return [(self.bound, {})]

    def text(self) -> str:
        """The statement in one line."""
        return (
            "for all κ > 0 and ε₀ > 0: if M(q) ≻ 0 and dV/dt < 0 at every state but the origin, for "
            f"{self.gains_text(' and κ K_v with K_v')}, then "
            f"κ·{number_text(max(self.kv))} < {expression_text(self.bound)}; {self.mass_text()}"
        )


@dataclass(frozen=True)
class DampingAbove(Proof):
    """κ and ε₀ with dV/dt < 0 everywhere (``decreasing``) while κ λmax(K_v) < bound fails (``numbers``)."""

    rule = "damping above the bound"
    factor: Fraction
    eps0: Fraction
    numbers: Proof
    decreasing: Proof


@rule(DampingBelow, DampingAbove)
def by_gains(statement: DampingBelow, proof: DampingAbove) -> Accepted:
    """Soundness: one κ and one ε₀, with a proof that dV/dt < 0 and a refutation of the bound."""
    require(proof.factor > 0, "factor", proof.factor, "must be positive")
    numbers = verify(statement.below(proof.factor), proof.numbers)
    require(numbers.verdict == "refuted", "bound", numbers.verdict, "must be refuted")
    decreasing = require_proved(
        statement.with_damping(proof.factor, proof.eps0), proof.decreasing, "dV/dt < 0"
    )
    return Accepted("refuted", weakest([numbers.grade, decreasing]))
