"""The certificates of bounds: the settling time, what a disturbance leaves, and states of rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.files.names import file_stem

if TYPE_CHECKING:
    from lyapcheck.answers.bounds.compare import BoundsComparison
    from lyapcheck.check.statement import Proof, Statement

PROOF = "bounds"


def certificates(result: BoundsComparison) -> dict[str, Certificate]:
    """Certificates by file name; what nothing was accepted of has none."""
    settling, left = result.settling, result.disturbance
    made: dict[str, tuple[str, Statement, Proof]] = {}
    if settling.shown is not None:
        says = f"every |e_i| comes below {float(settling.delta):.6g} rad for good"
        made["settling"] = says, settling.shown.statement, settling.shown.proof
    if left.shown is not None:
        says = "what torques and dry friction within bounds leave of the errors"
        made["disturbed"] = says, left.shown.statement, left.shown.proof
    if left.resting is not None:
        says = (
            "every motion comes to rest so near"
            if left.comes_to_rest
            else "how far from the goal it can rest"
        )
        made["resting"] = says, left.resting.statement, left.resting.proof
    return {
        f"{file_stem(settling.name)}.{kind}.json": _certificate(result, kind, *parts)
        for kind, parts in made.items()
    }


def _certificate(
    result: BoundsComparison, kind: str, says: str, statement: Statement, proof: Proof
) -> Certificate:
    bound, n = result.settling, len(result.task.q_d)
    about = About(f"{bound.name}.{kind}", f"{says}: {bound.name} on {bound.robot}", bound.m, n, PROOF)
    return Certificate(about, statement, "proved", "enclosure", proof)
