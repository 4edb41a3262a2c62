"""Whether an arm can be one at all: M(q) ≻ 0, or the posture at which it is not."""

from __future__ import annotations

from fractions import Fraction
from math import degrees

from lyapcheck.check.kinds.inertia import MassAbove, PostureWitness
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.search.controlled_arm import ControlledArm


def not_positive(controlled: ControlledArm) -> str:
    """Why nothing is certified of an arm whose M(q) ≻ 0 is not proved over its ranges; empty where it is."""
    from lyapcheck.claims.procedures.inertia import find_mass_above

    loop = controlled.loop(Fraction(1))
    try:
        at_corners(loop)
    except Refused as refusal:
        return f"no bounds over these ranges: {refusal}; vary fewer numbers, such as masses and friction"
    statement = MassAbove(loop.arm.mass, loop.parameters, Fraction(0))
    try:
        if verify(statement, controlled.inertia_proof).verdict == "proved":
            return ""
    except Refused:
        pass
    result = find_mass_above(statement)
    if result.is_proof:
        return ""
    if not isinstance(result.proof, PostureWitness):
        return (
            f"M(q) is not shown to be positive definite at every q; check the inertia "
            f"of {controlled.model.name}"
        )
    posture = ", ".join(f"{degrees(x):.4g}°" for x in result.proof.q)
    return (
        f"M(q) is not positive definite at q = ({posture}), so V is no energy; "
        f"correct the inertia of {controlled.model.name}"
    )
