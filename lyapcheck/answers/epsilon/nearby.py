"""ε₀ where speeds, errors or both are limited: certified and falsified, and the motions that keep within.

References: ``reyes2019family`` (12), (13).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck._types import Progress, part
from lyapcheck.answers.epsilon.consistency import require_consistent
from lyapcheck.answers.epsilon.options import Options, StateLimits
from lyapcheck.check.kinds.nearby import DecreasingNearby
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.errors import argument_error
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.corners import falsify_corners
from lyapcheck.search.nearby import SHARES, NearbyArm, NearbyProof, falsify_nearby, with_motions
from lyapcheck.search.posture import unphysical

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.search.falsify import RisingState

BITS = 64
GUESS = 100
"""The ceiling where nothing is falsified."""


@dataclass(frozen=True)
class NearbyResult:
    """ε₀ at the states within limits alone; ``None`` where there is none.

    Args:
        limits: of speed and of error.
        certified: the largest ε₀ of which the checker accepted a proof.
        falsified: the smallest ε₀ that a state within the limits refutes.
        proof: behind ``certified``.
        witness: behind ``falsified``.
        against: what ``witness`` refutes.
        viscous: friction of the arm that it is a state of, N·m·s/rad.
        parameters: of that arm.
        boxes: how many the search looked at.
        reason: why ``certified`` is missing or not larger.
        from_rest: rad; a motion from rest with every |e_i(0)| at most that keeps within the limits.
    """

    limits: StateLimits
    certified: Fraction | None
    falsified: Fraction | None
    proof: NearbyProof | None
    witness: RisingState | None
    against: DecreasingNearby | None
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    boxes: int
    reason: str
    from_rest: Fraction | None

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified."""
        if self.certified is None or self.falsified is None:
            return None
        return self.certified / self.falsified

    @property
    def energy(self) -> Fraction | None:
        """J: motions that start with at most that keep within the limits."""
        return None if self.proof is None else self.proof.stated.energy


def nearby(
    gain_set: GainSet,
    model: RobotModel,
    limits: StateLimits,
    everywhere: Fraction | None,
    options: Options,
    on_progress: Progress,
) -> NearbyResult:
    """ε₀ within limits; ``everywhere`` is the ε₀ certified at all states.

    Raises:
        InputError: the limits are for another number of joints.
        Contradiction: the witness refutes the proof.

    Soundness: as for ``epsilon``: ``proof`` was accepted by the checker, and the witness is proved.
    """
    ranges = options.ranges
    controlled = ControlledArm(gain_set, model, ranges)
    for name in ("speeds", "errors"):
        count = len(getattr(limits, name))
        if count not in (0, controlled.n):
            raise argument_error(name, count, f"must be {controlled.n}, one a joint", "give one a joint")
    if not controlled.family.bounded:
        return _nothing(limits, "h is unbounded: the checker needs its γ")
    near = NearbyArm.of(controlled, limits.speeds, limits.errors)

    def look(arm: NearbyArm, progress: Progress) -> RisingState | None:
        return falsify_nearby(arm, seed=options.seed, on_progress=progress)

    first = part(on_progress, 0, 0.4, "within limits: ")
    at, witness = falsify_corners(near, look, first) if ranges else (near, look(near, first))
    reason = unphysical(controlled)
    ceiling = Fraction(GUESS) if witness is None else witness.eps0
    shares = sorted({*SHARES, *([] if everywhere is None else [everywhere / ceiling])})
    budget, below = 0 if reason else options.max_boxes, [share for share in shares if share < 1]
    rest = part(on_progress, 0.4, 1, "within limits: ")
    largest = certified_epsilon(near, ceiling, budget, options.jobs, options.seconds, rest, below)
    proof = largest.proof
    if isinstance(proof, NearbyProof):
        proof = with_motions(near, proof, options.jobs)
    require_consistent(at, witness, {"certified": largest.eps0})
    energy = proof.stated.energy if isinstance(proof, NearbyProof) else None
    return NearbyResult(
        limits=limits,
        certified=largest.eps0,
        falsified=None if witness is None else witness.eps0,
        proof=proof if isinstance(proof, NearbyProof) else None,
        witness=witness,
        against=None if witness is None else near.statement(witness.eps0),
        viscous=at.arm.viscous,
        parameters=tuple(number.value for number in at.model.parameters.values()) if ranges else (),
        boxes=largest.looked_at,
        reason=reason or largest.reason,
        from_rest=None if energy is None else _from_rest(gain_set, energy),
    )


def _nothing(limits: StateLimits, reason: str) -> NearbyResult:
    return NearbyResult(limits, None, None, None, None, None, (), (), 0, reason, None)


def _from_rest(gain_set: GainSet, energy: Fraction) -> Fraction | None:
    """The largest multiple of 0.001 rad at which Σ k_pi U is shown to be at most the energy."""
    known = member(gain_set.family, gain_set.m)
    low, high = 0, 1
    with precision(BITS):

        def fits(thousandths: int) -> bool:
            stored = known.potential(to_arb(Fraction(thousandths, 1000)))
            return bool(to_arb(sum(gain_set.kp, Fraction(0))) * stored <= to_arb(energy))

        while fits(high):
            low, high = high, 2 * high
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if fits(middle) else (low, middle)
    return Fraction(low, 1000) if low else None
