"""What statements about the motions of every arm in some ranges share."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.check.granted import TORQUE
from lyapcheck.check.kinds.inertia import Mass, require_mass
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends


def require_arm(mass: Mass, parameters: tuple[Ends, ...], viscous: Sequence[Ends]) -> int:
    """The joints n of an arm with ranges for its parameters and the diagonal of B.

    Raises:
        Refused: M is no square matrix of polynomials, a range is empty, or B is of another size.
    """
    require_mass(mass, parameters)
    n = len(mass)
    require(len(viscous) == n, "viscous", len(viscous), f"must be {n}, one a joint")
    for low, high in viscous:
        require(low <= high, "range", f"[{low}, {high}]", "is empty")
    return n


def of_arm(parameters: Sequence[Ends], viscous: Sequence[Ends]) -> tuple[str, str]:
    """What ties such numbers to a robot under the controller (6)."""
    exact = all(low == high for low, high in (*parameters, *viscous))
    arm = (
        "exactly this M(q), C by Christoffel symbols, and exactly this B"
        if exact
        else "this M(q), C by Christoffel symbols, and B, whose ranges hold its numbers, constant in time"
    )
    return f"the robot is (1) with {arm}", TORQUE
