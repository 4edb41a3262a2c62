"""Whether an arm can be one at all: M(q) ≻ 0, or the posture at which it is not."""

from __future__ import annotations

from fractions import Fraction
from math import degrees

from lyapcheck.check.kinds.inertia import MassAbove, PostureWitness
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.search.setting import Setting


def not_positive(setting: Setting) -> str:
    """Why nothing is certified of an arm whose M(q) ≻ 0 is not proved; empty where it is."""
    from lyapcheck.claims.procedures.inertia import find_mass_above

    statement = MassAbove(setting.arm.mass, (), Fraction(0))
    try:
        if verify(statement, setting.inertia_proof).verdict == "proved":
            return ""
    except Refused:
        pass
    found = find_mass_above(statement)
    if found.is_proof:
        return ""
    if not isinstance(found.proof, PostureWitness):
        return (
            f"M(q) is not shown to be positive definite at every q; check the inertia of {setting.model.name}"
        )
    posture = ", ".join(f"{degrees(x):.4g}°" for x in found.proof.q)
    return (
        f"M(q) is not positive definite at q = ({posture}), so V is no energy; "
        f"correct the inertia of {setting.model.name}"
    )
