"""What was found about a gain set, put together with all that follows from it."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck import asked
from lyapcheck.answers.epsilon.four import Refutation, findings, require_consistent
from lyapcheck.answers.epsilon.result import EpsilonResult
from lyapcheck.promise import Promise, promised
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import RisingState
from lyapcheck.search.proof import DecreaseProof
from lyapcheck.search.weights import Weighted

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots.plant import Plant


def put_together(
    controlled: ControlledArm,
    at: ControlledArm,
    witness: RisingState | None,
    *,
    published: Fraction | None,
    scalar: Fraction | None,
    proof: DecreaseProof | None,
    scalar_proof: DecreaseProof | None,
    weighted: Weighted | None,
    reasons: Mapping[str, str],
    **more: Any,
) -> EpsilonResult:
    """What was found about a gain set, with all that follows from it.

    Args:
        controlled: gains and arm.
        at: the arm, within its ranges, that the witness is about.
        witness: of ``at``.
        published, scalar: of `EpsilonResult`.
        proof, scalar_proof, weighted: as they were found; only what answers the question is kept.
        reasons: why a number is missing, and why one of these is not kept.
        more: what else it takes that does not follow from these.

    Raises:
        Contradiction: the witness refutes a certificate.
    """
    question = controlled.gains, controlled.model, controlled.ranges
    reasons, kinds = (
        dict(reasons),
        {"certified": proof, "weighted": None if weighted is None else weighted.proof},
    )
    promises: dict[str, Promise | None] = {}
    for name, one in kinds.items():
        promises[name], why = answers(one, *question)
        reasons |= {name: why} if why else {}
    promise, by_norms = promises["certified"], answers(scalar_proof, *question)[0]
    certified = None if promise is None or proof is None else proof.loop.eps0
    require_consistent(at, witness, {"scalar": scalar, "certified": certified})
    return EpsilonResult(
        gains=controlled.gains,
        robot=controlled.model.name,
        published=published,
        scalar=scalar,
        promise=promise,
        falsified=None if witness is None else witness.eps0,
        witness=witness,
        proof=None if promise is None else proof,
        scalar_proof=None if by_norms is None else scalar_proof,
        weighted=None if promises["weighted"] is None else weighted,
        weighted_promise=promises["weighted"],
        reasons=reasons,
        against=_refutation(controlled, at, witness),
        ranges=controlled.ranges,
        uncertain=any(x.ranged for x in (*controlled.model.parameters.values(), *controlled.model.viscous)),
        corner=_corner(at) if controlled.ranges else {},
        findings=tuple(findings(published, certified, witness)),
        **more,
    )


def answers(
    proof: DecreaseProof | None, gains: GainSet, model: Plant, ranges: bool
) -> tuple[Promise | None, str]:
    """The promise that V falls with the ε₀ and the weights of a proof, or why it is none.

    The question is about the arm as it was given: with all its ranges, or at its nominal numbers.
    """
    if proof is None or proof.judged is None:
        return None, ""
    number, weights = proof.loop.eps0, proof.loop.coupling
    question = asked.decreasing(gains, model, number, weights, nominal=not ranges)
    return promised(question, proof.judged)


def _refutation(
    controlled: ControlledArm, at: ControlledArm, witness: RisingState | None
) -> Refutation | None:
    """What the witness refutes; ``None`` for an unbounded h, of which there are no such certificates."""
    if witness is None or not controlled.family.bounded:
        return None
    values = tuple(number.value for number in at.model.parameters.values()) if controlled.ranges else ()
    return Refutation(controlled.loop(witness.eps0), at.arm.viscous, values)


def _corner(controlled: ControlledArm) -> dict[str, Fraction]:
    """The values of everything about the arm that has a range."""
    joints = zip(controlled.model.joints, controlled.model.viscous, strict=True)
    friction = {f"viscous friction of {joint}": number for joint, number in joints}
    numbers = {**controlled.model.parameters, **friction}
    return {name: number.value for name, number in numbers.items() if number.ranged}
