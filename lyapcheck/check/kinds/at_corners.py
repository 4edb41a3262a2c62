"""Proofs over ranges of M's parameters by one proof for each corner, where M is affine in each of them.

M and dV/dt at one state then are affine in each parameter too: M is a mean of its values at the corners, and
dV/dt is nowhere above the largest of its values there.

References: ``reyes2019family`` (11), (15).
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.kinds.inertia import MassAbove
from lyapcheck.check.loop.corners import masses_at_corners
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest


@dataclass(frozen=True)
class MassAtCorners(Proof):
    """Proofs of M(q) − low·I ≻ 0, one for each corner of the ranges, in the order of ``corners_of``."""

    rule = "M at corners"
    each: tuple[Proof, ...]


@rule(MassAbove, MassAtCorners)
def mass_by_corners(statement: MassAbove, proof: MassAtCorners) -> Accepted:
    """Soundness: at one posture M is a mean of its values at the corners, and so is xᵀ(M − low·I)x."""
    require(bool(statement.parameters), "parameters", "", "must be there")
    corners = masses_at_corners(statement.mass, statement.parameters)
    require(len(proof.each) == len(corners), "corners", len(proof.each), f"must be {len(corners)}")
    at = (MassAbove(mass, (), statement.low) for mass in corners)
    grades = [require_proved(one, by, "M at a corner") for one, by in zip(at, proof.each, strict=True)]
    return Accepted("proved", weakest(grades))
