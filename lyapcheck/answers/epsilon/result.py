"""The four ε₀ of one gain set on one arm, with what stands behind each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.check.loop import Closure
    from lyapcheck.search.falsify import Witness
    from lyapcheck.search.proof import Proof
    from lyapcheck.search.weights import Weighted


@dataclass(frozen=True)
class Refutation:
    """The closure that a witness refutes, and the values of what is uncertain at the arm it is a state of."""

    closure: Closure
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]


@dataclass(frozen=True)
class EpsilonResult:
    """The four ε₀; ``None`` where there is none, with the reason under the same name in ``reasons``.

    Args:
        name: of the gain set.
        m: member of the family, if it has members.
        robot: name of the arm.
        published: the end of (18), rounded down.
        scalar: ε₀ of the scalar form, from norms.
        certified: the largest ε₀ of which the checker accepted a proof.
        falsified: ε₀ of the witness.
        witness: the state that refutes ``falsified``.
        boxes: how many boxes branch and bound looked at.
        certified_by: which search proposed the proof behind ``certified``.
        proof: behind ``certified``, accepted by the checker.
        scalar_proof: behind ``scalar``, accepted by the checker; ``None`` where norms alone prove less.
        against: what ``witness`` refutes, and the arm it is a state of.
        weighted: a proof with weights Λ in y = w − εΛh, where one was asked for and found.
        ranges: whether this is about all values of what is uncertain about the arm, or the nominal ones.
        corner: the uncertain numbers of the arm that ``witness`` is about, by name.
        reasons: why a number is missing, and what to try.
        findings: what the numbers say about each other, one sentence each.
        assumptions: what is taken for granted about the arm.
        seed: of the sampled states.
    """

    name: str
    m: int | None
    robot: str
    published: Fraction | None
    scalar: Fraction | None
    certified: Fraction | None
    falsified: Fraction | None
    witness: Witness | None
    boxes: int
    certified_by: str
    proof: Proof | None = None
    scalar_proof: Proof | None = None
    against: Refutation | None = None
    weighted: Weighted | None = None
    ranges: bool = False
    corner: Mapping[str, Fraction] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    seed: int = 0

    @property
    def scalar_grade(self) -> str | None:
        """``enclosure`` where ``scalar`` has a certificate, else ``no certificate``; ``None`` without it."""
        if self.scalar is None:
            return None
        return "no certificate" if self.scalar_proof is None else "enclosure"

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified: 1 would leave nothing open."""
        if self.certified is None or self.falsified is None:
            return None
        return self.certified / self.falsified
