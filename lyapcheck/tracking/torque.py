"""How much torque (21) can ask of each motor, for all times and all motions from one start.

    |τ_i| ≤ γ (k_pi + k_vi) + Σ_j sup|M_ij| sup|q̈_dj| + κ_i (v_d + b̄) v_d + sup|g_i| + b_i sup|q̇_di|

where κ_i is k_c, or √(Σ_jk sup c_ijk²) if that is smaller, and b̄ bounds ‖w‖ = ‖q̇ − q̇_d‖: with ε₀ = 0 V is
½ wᵀMw + Σ k_pi U(e_i), which never grows under (21), so ‖w‖ ≤ b̄ = √(2 V(0)/λmin(M)). With q_d at rest this is
the bound (9), joint by joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.loop.states import State, value
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.constants import robot_constants
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.simulate.entries import coriolis_squares, gravity_sizes, mass_sizes
from lyapcheck.tracking.reference.base import BITS, above

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm
    from lyapcheck.tracking.reference import Suprema

Row = tuple[Fraction, ...]


@dataclass(frozen=True)
class TorqueBounds:
    """Bounds of |τ_i|, N·m, and their parts, each (n,) and exact."""

    feedback: Row
    """γ (k_pi + k_vi)."""
    inertia: Row
    """M q̈_d."""
    coriolis: Row
    """C(q, q̇) q̇_d."""
    gravity: Row
    friction: Row
    """B q̇_d."""
    error_rate: Fraction
    """b̄ ≥ ‖q̇ − q̇_d‖ at all times, rad/s."""

    @property
    def total(self) -> Row:
        """The bound of each |τ_i|."""
        parts = (self.feedback, self.inertia, self.coriolis, self.gravity, self.friction)
        return tuple(sum(column, Fraction(0)) for column in zip(*parts, strict=True))


def torque_bounds(
    controlled: ControlledArm, suprema: Suprema, q: Sequence[float], e: Sequence[float], w: Sequence[float]
) -> TorqueBounds | None:
    """The bounds for motions from one state; none where h is unbounded or λmin(M) > 0 is not known.

    Args:
        controlled: controller and arm, at nominal numbers.
        suprema: of the reference.
        q: (n,) start in rad.
        e: (n,) q_d(0) − q.
        w: (n,) q̇ − q̇_d(0), rad/s.
    """
    gamma, constants = controlled.family.constants().gamma, robot_constants(controlled.model)
    least = constants.lambda_min.lower
    if gamma is None or least <= 0:
        return None
    start = State(*(tuple(map(Fraction, part)) for part in (q, e, w)))
    with precision(BITS):
        stored = value(controlled.arm, controlled.controller, Fraction(0), start, BITS)
        spin = above((2 * stored / to_arb(least)).sqrt())
    top = gamma.upper
    product = (suprema.speed + spin) * suprema.speed
    return TorqueBounds(
        feedback=tuple(top * (p + v) for p, v in zip(controlled.gains.kp, controlled.gains.kv, strict=True)),
        inertia=tuple(
            sum((m * a for m, a in zip(row, suprema.acceleration, strict=True)), Fraction(0))
            for row in mass_sizes(controlled.fixed)
        ),
        coriolis=tuple(k * product for k in _coriolis_rows(controlled, constants.k_c.upper)),
        gravity=gravity_sizes(controlled.fixed),
        friction=tuple(b * v for b, v in zip(controlled.arm.viscous, suprema.rate, strict=True)),
        error_rate=spin,
    )


def _coriolis_rows(controlled: ControlledArm, k_c: Fraction) -> Row:
    """κ_i with |(C(q, x) y)_i| ≤ κ_i ‖x‖ ‖y‖ for all q, kg·m²."""
    if controlled.n > FEW_JOINTS:
        return (k_c,) * controlled.n
    with precision(BITS):
        return tuple(min(k_c, above(to_arb(square).sqrt())) for square in coriolis_squares(controlled.fixed))
