"""The scalar certificate, checked in rational arithmetic.

With a = ‖h(e)‖ and b = ‖w‖ the derivative of V is at most −[a b] Θ'(ε) [a b]ᵀ with

    θ'11 = ε k,   θ'22 = β − ε c,   θ'12 = −½ ε (d + ε c),   ε = ε₀/(1 + ‖e‖) in (0, ε₀],

where k = λmin(K_p), β = λmin(B), and c, d are the bounds of ``lyapcheck.lyapunov.scalar``.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class ScalarForm:
    """The four numbers of Θ': ``stiffness`` k, ``friction`` β, ``drift`` c and ``cross`` d, all rational."""

    stiffness: Fraction
    friction: Fraction
    drift: Fraction
    cross: Fraction

    def margin(self, eps: Fraction) -> Fraction:
        """det Θ'(ε)/ε = k (β − ε c) − ¼ ε (d + ε c)²."""
        return (
            self.stiffness * (self.friction - eps * self.drift)
            - eps * (self.cross + eps * self.drift) ** 2 / 4
        )


def certifies(form: ScalarForm, eps0: Fraction) -> bool:
    """Whether Θ'(ε) ≻ 0 for every ε in (0, ε₀].

    Soundness: k, β > 0 and c, d ≥ 0 make det Θ'(ε)/ε fall as ε grows, so its sign at ε₀ decides; there
    k (β − ε₀ c) > 0 follows, and θ'11 = ε k > 0: Sylvester's criterion.
    """
    signs = form.stiffness > 0 and form.friction > 0 and form.drift >= 0 and form.cross >= 0
    return signs and eps0 > 0 and form.margin(eps0) > 0
