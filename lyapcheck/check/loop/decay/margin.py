"""By how much dV/dt is below 0: what is left of friction and stiffness beside what the proof needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.radial import BITS, Parts, RadialBounds
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.numbers.balls import precision


@dataclass(frozen=True, eq=False)
class Margin:
    """Shares of friction and stiffness that the proof of dV/dt < 0 does without.

    Args:
        loop: arm, controller and ε₀, without parameters, ranges and weights Λ.
        friction: η, the share of B, in (0, 1).
        stiffness: κ, the share of K_p, in (0, 1).
        split: t, the share of ηB that pays for the mixed terms ε h_i y_i.
        slack: s ≥ 0, the share of ηB that pays for disturbances; 0 where there are none.
        inertia: weights d_i with d_i² ≤ b_i, and the tree of λmax(D⁻¹MD⁻¹) ≤ μ; no cuts are needed.
    """

    loop: ClosedLoop
    friction: Fraction
    stiffness: Fraction
    split: Fraction
    slack: Fraction
    inertia: RadialBounds

    @property
    def reduced(self) -> ClosedLoop:
        """What has to be proved: the same at (1 − η)B and (1 − κ)K_p."""
        loop = self.loop
        return replace(
            loop,
            arm=Arm(loop.arm.mass, _scaled(loop.arm.viscous, 1 - self.friction)),
            kp=_scaled(loop.kp, 1 - self.stiffness),
        )

    @property
    def admissible(self) -> bool:
        """Whether sizes and signs are such that the argument applies."""
        loop = self.loop
        if loop.parameters or loop.viscous or loop.coupling:
            return False
        shares = 0 < self.friction < 1 and 0 < self.stiffness < 1
        parts = self.split > 0 and self.slack >= 0 and self.split + self.slack < 1
        return shares and parts and loop.admissible and self._weights_fit()

    def inertia_shown(self) -> bool:
        """Whether λmax(D⁻¹MD⁻¹) ≤ μ is shown."""
        with precision(BITS):
            return Parts(self.loop, self.inertia).inertia_shown()

    def _weights_fit(self) -> bool:
        weights, angles = self.inertia.weights, self.inertia.angles
        joints = len(set(angles)) == len(angles) and set(angles) <= set(range(self.loop.n))
        below = len(weights) == self.loop.n and all(
            d > 0 and d * d <= b for d, b in zip(weights, self.loop.arm.viscous, strict=True)
        )
        return below and joints and self.inertia.inertia > 0


def _scaled(diagonal: Sequence[Fraction], factor: Fraction) -> tuple[Fraction, ...]:
    return tuple(factor * x for x in diagonal)
