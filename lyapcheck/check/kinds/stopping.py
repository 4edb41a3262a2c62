"""Under dry friction every motion comes to rest, and how far from the goal at most: without (19).

The energy E = ½ wᵀMw + Σ k_pi U(e_i) falls by wᵀBw + wᵀK_v h(w) + wᵀφ ≥ wᵀBw, so that w is bounded, and with
it ẇ, and ∫ wᵀBw dt is finite: w → 0 by Barbalat's lemma. Over one second e and q then hardly move, and
M(q)ẇ = K_p h(e) − φ + o(1) integrates to o(1): |k_pi h(e_i)| comes below each number above f_i. Where
f_i < k_pi that leaves |e_i| at most where |h| ≤ f_i/k_pi, as h rises there and is at least 1 beyond its peak.

References: ``reyes2019family`` (7), (11); ``khalil2002nonlinear`` for Barbalat's lemma.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.text import angles_text, list_text
from lyapcheck.check.kinds.of_loop import OfLoop
from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, verify, weakest


@dataclass(frozen=True)
class ComesToRest(OfLoop, Total):
    """Every solution of (11) with a torque −φ, φ_i w_i ≥ 0, has w → 0 and lim sup |e_i| ≤ ``errors``.

    ``dry`` bounds each |φ_i|, N·m; ``errors`` are in rad, ``None`` bounds nothing.
    """

    dry: tuple[Fraction, ...]
    errors: tuple[Fraction | None, ...]

    @property
    def resting(self) -> Resting:
        """That states of rest are so near."""
        return Resting(self.family, self.m, self.kp, self.dry, self.errors)

    def require_well_formed(self) -> None:
        """One number a joint; gains and B above 0."""
        super().require_well_formed()
        self.require_one_a_joint("dry", "errors")
        for subject, least in (("viscous", min(self.viscous)[0]), ("kv", min(self.kv))):
            require(least > 0, subject, least, "must be positive")
        self.resting.require_well_formed()

    @property
    def granted(self) -> tuple[str, ...]:
        """What ties the numbers to a robot."""
        return (
            *super().granted,
            "dry friction opposes each joint's motion, or holds it, with at most the torque stated",
            "no other torque acts",
        )

    def text(self) -> str:
        """The statement in one line."""
        return (
            "every absolutely continuous solution of (11) with a torque −φ on its right, "
            f"|φ_i| ≤ {list_text(self.dry)} N·m and φ_i w_i ≥ 0 (dry friction), comes to rest, w → 0, with "
            f"lim sup |e_i| ≤ {angles_text(self.errors)}; for {self.gains_text()} and {self.mass_text()}"
        )


@dataclass(frozen=True)
class EnergyFalls(Proof):
    """A proof of M(q) ≻ 0; the checker takes h at each bound."""

    rule = "falling energy"
    inertia: Proof


@rule(ComesToRest, EnergyFalls)
def by_energy(statement: ComesToRest, proof: EnergyFalls) -> Accepted:
    """Soundness: the argument above; M(q) is a polynomial in sines and cosines, so M ≻ 0 holds uniformly."""
    positive = require_proved(statement.mass_positive, proof.inertia, "M ≻ 0")
    near = require_proved(statement.resting, AtBounds(), "states of rest")
    return Accepted("proved", weakest([positive, near]))


@rule(ComesToRest, RestWitness)
def by_rest(statement: ComesToRest, proof: RestWitness) -> Accepted:
    """Soundness: at rest there, φ = K_p h(e) is within its bounds and holds the joint for ever."""
    found = verify(statement.resting, proof)
    require(found.verdict == "refuted", "states of rest", found.verdict, "must be refuted")
    return found
