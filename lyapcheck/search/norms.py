"""An ε₀ from norms of M and C alone: the checker's own bounds propose it, a tree of one leaf proves it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.search.proof import DecreaseProof
from lyapcheck.search.scalar_program import scalar_epsilon

if TYPE_CHECKING:
    from lyapcheck.check.kinds.at_corners import MassAtCorners
    from lyapcheck.check.kinds.inertia import Bisection, Links
    from lyapcheck.check.loop.closed_loop import ClosedLoop
    from lyapcheck.check.statement import Ends
    from lyapcheck.search.controlled_arm import ControlledArm

REFUSED = "the checker accepted no proof"
UNBOUNDED = "h is unbounded, and the checker needs its bound γ"


def norm_epsilon(
    controlled: ControlledArm, viscous: tuple[Ends, ...] | None = None
) -> tuple[DecreaseProof | None, str]:
    """A proof that the checker has accepted, or why there is none.

    Args:
        controlled: gains and arm.
        viscous: the range of each diagonal entry of B that replaces the arm's, N·m·s/rad.
    """
    if not controlled.family.bounded:
        return None, UNBOUNDED
    loop = controlled.loop(Fraction(1))
    if viscous is not None:
        loop = replace(loop, viscous=viscous)
    proof, reason = norm_proof(loop, controlled.inertia_proof)
    if proof is None:
        return None, reason
    accepted = proof.accepted()
    return accepted, REFUSED if accepted is None else reason


def norm_proof(
    loop: ClosedLoop, inertia: Bisection | Links | MassAtCorners
) -> tuple[DecreaseProof | None, str]:
    """A proof that the checker has yet to judge, for a closed loop whose ε₀ is to be found.

    Args:
        loop: the loop.
        inertia: what shows M(q) ≻ 0.
    """
    result = scalar_epsilon(loop.tail)
    if result.eps0 is None:
        return None, result.reason
    return DecreaseProof(replace(loop, eps0=result.eps0), BoxTree("."), inertia), ""
