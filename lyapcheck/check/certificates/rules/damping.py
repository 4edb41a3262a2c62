"""Whether a bound on K_v is needed for dV/dt < 0: against it, gains that break the bound and have dV/dt < 0.

References: ``reyes2019family`` (19).
"""

from __future__ import annotations

from lyapcheck.check.certificates.proofs import DampingAbove
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.statements import DampingBelow
from lyapcheck.check.certificates.verify import Accepted, require_proved, rule, verify, weakest


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
