"""Where an arm may come to rest beside its goal.

At rest (11) is K_p h(e) + d = 0, so |h(e_i)| = |d_i|/k_pi. Each h rises from 0 to its peak, or for ever, and
is at least 1 beyond its peak: for d̄_i < k_pi all solutions lie where h rises.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import arb

from lyapcheck.check.loop import Closure
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import Member

BITS = 64
HALVINGS = 50
FARTHEST = 2.0**10
"""rad: larger bounds are as good as none."""


def rest_errors(closure: Closure, torque: Sequence[Fraction]) -> tuple[float | None, ...]:
    """Bounds of |e_i| in rad at every state of rest under torques |d_i| ≤ ``torque``.

    Returns:
        a joint's bound; ``None`` where the torque is not below k_pi, so that h may never balance it.
    """
    with precision(BITS):
        ratios = (d / k for d, k in zip(torque, closure.kp, strict=True))
        return tuple(_rest(closure.member, ratio) for ratio in ratios)


def _rest(member: Member, ratio: Fraction) -> float | None:
    """X with h(X) ≥ ratio; for ratio < 1 then h > ratio beyond X as well."""
    if ratio >= 1:
        return None
    if ratio == 0:
        return 0.0
    goal = to_arb(ratio)
    low, high = 0.0, 1.0
    while not member.h(arb(high)) >= goal:
        low, high = high, 2 * high
        if high > FARTHEST:
            return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if member.h(arb(middle)) >= goal else (middle, high)
    return high
