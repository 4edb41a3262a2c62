"""The four ε₀ of one gain set on one arm as data, and what the numbers say about each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.chain_decreasing import ChainDecreasing
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.loop.states import confirms_positive
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.check.loop.closed_loop import ClosedLoop
    from lyapcheck.control.gains import GainSet
    from lyapcheck.promise import Promise
    from lyapcheck.search.controlled_arm import ChainProof, ControlledArm, DecreaseProof
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

ROUNDED = Fraction(1, 10**8)
"""More than the end of (18) loses where it is rounded down, as a share of it."""
FINDINGS: Mapping[str, str] = {
    "published-refuted": (
        "(18) is refuted: it allows all ε₀ below its end, and the witness refutes a smaller one"
    ),
    "published-certified": "(18) allows no ε₀ above the certified one",
    "no-interval": (
        "the ε₀ without a failing state are not an interval: some that fail lie below others that do not"
    ),
}
"""What the numbers may say about each other, by the id of the rule that an annotation names."""


def eps0_of(promise: Promise | None) -> Fraction | None:
    """The ε₀ that a promise is about."""
    if promise is None:
        return None
    assert isinstance(promise.asked, Decreasing | ChainDecreasing)
    return promise.asked.eps0


@dataclass(frozen=True)
class Refutation:
    """The closure that a witness refutes, and the values of what is uncertain at the arm it is a state of."""

    loop: ClosedLoop
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]


@dataclass(frozen=True)
class FourEpsilons:
    """The four ε₀; ``None`` where there is none, with the reason under the same name in ``reasons``.

    Args:
        gains: the gain set.
        robot: name of the arm.
        published: the end of (18), rounded down.
        scalar: ε₀ of the scalar form, from norms.
        promise: that V falls with the largest ε₀ of which the checker accepted a proof.
        falsified: ε₀ of the witness.
        witness: the state that refutes ``falsified``.
        boxes: how many boxes branch and bound looked at.
        certified_by: which search proposed the proof behind ``certified``.
        proof: behind ``certified``, accepted by the checker.
        scalar_proof: behind ``scalar``, accepted by the checker; ``None`` where it accepted none.
        against: what ``witness`` refutes, and the arm it is a state of.
        weighted: a proof with weights Λ in y = w − εΛh, where one was asked for and found.
        weighted_promise: that V falls with these weights.
        ranges: whether this is about all values of what is uncertain about the arm, or the nominal ones.
        corner: the uncertain numbers of the arm that ``witness`` is about, by name.
        reasons: why a number is missing, and what to try.
        findings: what the numbers say about each other, one sentence each.
        assumptions: what is taken for granted about the arm.
        seed: of the sampled states.
        unvaried: the promise at the numbers of the file, where these lie within the ranges.
        outside: the numbers whose value in the file lies outside the ranges.
        uncertain: whether the arm has ranges of M, potential or friction, asked for or not.
    """

    gains: GainSet
    robot: str
    published: Fraction | None
    scalar: Fraction | None
    promise: Promise | None
    falsified: Fraction | None
    witness: RisingState | None
    boxes: int
    certified_by: str
    proof: DecreaseProof | ChainProof | None = None
    scalar_proof: DecreaseProof | ChainProof | None = None
    against: Refutation | None = None
    weighted: Weighted | None = None
    weighted_promise: Promise | None = None
    ranges: bool = False
    corner: Mapping[str, Fraction] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    seed: int = 0
    unvaried: Promise | None = None
    outside: tuple[str, ...] = ()
    uncertain: bool = False

    @property
    def certified(self) -> Fraction | None:
        """The ε₀ that is promised."""
        return eps0_of(self.promise)

    @property
    def name(self) -> str:
        """Of the gain set."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """Member of the family, if it has members."""
        return self.gains.m

    @property
    def scalar_grade(self) -> str | None:
        """``enclosure`` where ``scalar`` has a certificate, else ``no certificate``; ``None`` without it."""
        if self.scalar is None:
            return None
        return "no certificate" if self.scalar_proof is None else "enclosure"

    @property
    def extent(self) -> str:
        """For which arms the numbers are; empty where the arm has no ranges."""
        if self.ranges:
            return "for all values in its ranges"
        return "at its nominal numbers" if self.uncertain else ""

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified: 1 would leave nothing open."""
        if self.certified is None or not self.falsified:
            return None
        return self.certified / self.falsified


class Contradiction(RuntimeError):
    """A proved state refutes a proved ε₀: one of the two proofs is wrong, and nothing may be reported."""


def require_consistent(
    controlled: ControlledArm, witness: RisingState | None, claimed: Mapping[str, Fraction | None]
) -> None:
    """Raise `Contradiction` if the witness has dV/dt > 0 at an ε₀ that is claimed to be certified."""
    for name, eps0 in claimed.items():
        if witness is None or eps0 is None:
            continue
        if confirms_positive(controlled.arm, controlled.controller, eps0, witness.state):
            raise Contradiction(
                f"{controlled.gains.name}: the {name} ε₀ = {decimal_text(eps0)} is refuted by a proved state"
            )
        if name == "scalar" and eps0 >= witness.eps0:
            raise Contradiction(f"{controlled.gains.name}: the scalar ε₀ is not below a falsified one")


def findings(
    published: Fraction | None, certified: Fraction | None, witness: RisingState | None
) -> list[str]:
    """What the numbers say about each other, one sentence each."""
    result = []
    if published is not None and witness is not None and witness.eps0 < published:
        result.append("published-refuted")
    if published is not None and certified is not None and published * (1 + ROUNDED) <= certified:
        result.append("published-certified")
    if certified is not None and witness is not None and certified > witness.eps0:
        result.append("no-interval")
    return [FINDINGS[rule] for rule in result]
