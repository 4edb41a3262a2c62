"""dV/dt < 0 at every state but the origin, for an arm given by its links, from three bounds.

``Decreasing`` asks for M(q) written out, which some arms of seven joints have too many terms for.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.text import diagonal_text, number_text
from lyapcheck.check.judgement import TORQUE
from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainCoriolisBelow, OfLinks
from lyapcheck.check.loop.closed_loop import ScalarForm, certifies, scalar_form
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Proof
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest


@dataclass(frozen=True)
class ChainDecreasing(OfLinks):
    """M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin, for every friction in the ranges.

    V of (13) is then positive definite and radially unbounded, so that the origin is globally asymptotically
    stable by Lyapunov's direct method (``kelly2005control``, chapter 2).

    ``viscous`` is the range of each diagonal entry of B, N·m·s/rad; ``family`` and ``m`` name h; ``kp`` and
    ``kv`` are in N·m; ``eps0`` is ε₀.
    """

    viscous: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction

    def require_well_formed(self) -> None:
        super().require_well_formed()
        n = len(self.links)
        for subject in ("viscous", "kp", "kv"):
            size = len(getattr(self, subject))
            require(size == n, subject, size, f"must be {n}, one a joint")
        for low, high in self.viscous:
            require(low <= high, "range", f"[{low}, {high}]", "is empty")

    @property
    def granted(self) -> tuple[str, ...]:
        arm = (
            "the links of the statement, C by Christoffel symbols, and B within its ranges, constant in time"
        )
        return f"the robot is (1) with {arm}", TORQUE

    def text(self) -> str:
        function = self.family if self.m is None else f"{self.family}_{self.m}"
        friction = ", ".join(
            number_text(low) if low == high else f"{number_text(low)} … {number_text(high)}"
            for low, high in self.viscous
        )
        return (
            "M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin, which is therefore globally "
            f"asymptotically stable by Lyapunov's direct method: B = diag({friction}), h = {function}, "
            f"K_p = {diagonal_text(self.kp)}, K_v = {diagonal_text(self.kv)}, ε₀ = {number_text(self.eps0)}, "
            f"{self.over}"
        )

    def form(self, largest: Fraction, coriolis: Fraction) -> ScalarForm:
        """Θ' of the arm with ‖M(q)‖ ≤ largest and ‖C(q, x)y‖ ≤ coriolis ‖x‖ ‖y‖."""
        known = member(self.family, self.m)
        return scalar_form(known, self.kp, self.kv, self.viscous, largest, coriolis)


@dataclass(frozen=True)
class ChainNorms(Proof):
    """Proofs of M(q) ≻ 0, of ‖M(q)‖ ≤ ``largest`` and of ‖C(q, x)y‖ ≤ ``coriolis`` ‖x‖ ‖y‖, kg·m²."""

    rule = "norms along the links"
    positive: Proof
    largest: Fraction
    below: Proof
    coriolis: Fraction
    rates: Proof


@rule(ChainDecreasing, ChainNorms)
def by_norms(statement: ChainDecreasing, proof: ChainNorms) -> Accepted:
    """Soundness: three statements about the links by proofs of their own; then `scalar_form`."""
    links = statement.links
    gains = min(*statement.kp, *statement.kv)
    require(gains > 0, "gains", gains, "must be positive")
    grades = [
        require_proved(ChainAbove(links, Fraction(0)), proof.positive, "M ≻ 0"),
        require_proved(ChainBelow(links, proof.largest), proof.below, "the bound of ‖M‖"),
        require_proved(ChainCoriolisBelow(links, proof.coriolis), proof.rates, "the bound of ‖C‖"),
    ]
    form = statement.form(proof.largest, proof.coriolis)
    require(certifies(form, statement.eps0), "ε₀", statement.eps0, "is not shown by these bounds")
    return Accepted("proved", weakest(grades))
