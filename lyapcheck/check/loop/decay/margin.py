"""By how much dV/dt is below 0: what is left of friction and stiffness beside what the proof needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.states import Arm


@dataclass(frozen=True, eq=False)
class Margin:
    """Shares of friction and stiffness that the proof of dV/dt < 0 does without.

    Args:
        loop: arm, controller and ε₀, without weights Λ; its friction and the parameters of M may range.
        friction: η, the share of the lower end of B, in (0, 1).
        stiffness: κ, the share of K_p, in (0, 1).
        split: t, the share of ηB that pays for the mixed terms ε h_i y_i.
        slack: s ≥ 0, the share of ηB that pays for disturbances; 0 where there are none.
        heaviest: u_i > 0, kg·m², of which M(q) ≼ diag(u) is shown elsewhere.
    """

    loop: ClosedLoop
    friction: Fraction
    stiffness: Fraction
    split: Fraction
    slack: Fraction
    heaviest: tuple[Fraction, ...]

    @property
    def viscous(self) -> tuple[Fraction, ...]:
        """b_i, N·m·s/rad: the lower ends of the diagonal of B."""
        return tuple(low for low, _ in self.loop.friction)

    @property
    def reduced(self) -> ClosedLoop:
        """What has to be proved: the same at (1 − η)b and (1 − κ)K_p − ¼ ε₀ Δ, b + Δ the upper ends of B.

        Friction from b to b + Δ adds δ_i y_i w_i ≥ −¼ ε² δ_i h_i², 0 ≤ δ_i ≤ Δ_i, and ε ≤ ε₀.
        """
        loop = self.loop
        rows = zip(loop.kp, loop.friction, strict=True)
        return replace(
            loop,
            arm=Arm(loop.arm.mass, tuple((1 - self.friction) * b for b in self.viscous)),
            kp=tuple((1 - self.stiffness) * k - loop.eps0 * (high - low) / 4 for k, (low, high) in rows),
            viscous=(),
        )

    @property
    def admissible(self) -> bool:
        """Whether sizes and signs are such that the argument applies."""
        loop = self.loop
        if loop.coupling:
            return False
        shares = 0 < self.friction < 1 and 0 < self.stiffness < 1
        parts = self.split > 0 and self.slack >= 0 and self.split + self.slack < 1
        heavy = len(self.heaviest) == loop.n and min(self.heaviest) > 0
        return shares and parts and heavy and loop.admissible
