"""What was found about a gain set, put together with all that follows from it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from lyapcheck.answers.epsilon.consistency import findings, require_consistent
from lyapcheck.answers.epsilon.four import Refutation
from lyapcheck.answers.epsilon.result import EpsilonResult
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import RisingState
from lyapcheck.search.proof import DecreaseProof


def put_together(
    controlled: ControlledArm,
    at: ControlledArm,
    witness: RisingState | None,
    *,
    published: Fraction | None,
    scalar: Fraction | None,
    proof: DecreaseProof | None,
    **more: Any,
) -> EpsilonResult:
    """What was found about a gain set, with all that follows from it.

    Args:
        controlled: gains and arm.
        at: the arm, within its ranges, that the witness is about.
        witness: of ``at``.
        published, scalar, proof: of `EpsilonResult`.
        more: what else it takes that does not follow from these.

    Raises:
        Contradiction: the witness refutes a certificate.
    """
    certified = None if proof is None else proof.loop.eps0
    require_consistent(at, witness, {"scalar": scalar, "certified": certified})
    return EpsilonResult(
        gains=controlled.gains,
        robot=controlled.model.name,
        published=published,
        scalar=scalar,
        certified=certified,
        falsified=None if witness is None else witness.eps0,
        witness=witness,
        proof=proof,
        against=_refutation(controlled, at, witness),
        ranges=controlled.ranges,
        uncertain=any(x.ranged for x in (*controlled.model.parameters.values(), *controlled.model.viscous)),
        corner=_corner(at) if controlled.ranges else {},
        findings=tuple(findings(published, certified, witness)),
        **more,
    )


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
