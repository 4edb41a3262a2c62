"""Where a joint may come to rest beside its goal.

At rest (11) is K_p h(e) + d = 0, so |h(e_i)| = |d_i|/k_pi. Each h rises from 0 to its peak, or for ever, and
is at least 1 beyond its peak: for d̄_i < k_pi all solutions lie where h rises.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import Member

BITS = 64


def rests_within(member: Member, ratio: Fraction, error: Fraction) -> bool:
    """Whether |h(x)| ≤ ratio is shown to imply |x| ≤ error, for a ratio d̄/k_p ≥ 0.

    Soundness: h(error) ≥ ratio > 0, and beyond it h rises further or is at least 1 > ratio. For ratio = 0 it
        is h(x) > 0 for x > 0 that matters.
    """
    if ratio >= 1 or error < 0:
        return False
    with precision(BITS):
        return ratio == 0 or bool(member.h(to_arb(error)) >= to_arb(ratio))


def balanced_at(member: Member, ratio: Fraction, error: Fraction) -> bool:
    """Whether |h(error)| ≤ ratio is shown."""
    with precision(BITS):
        return bool(abs(member.h(to_arb(error))) <= to_arb(ratio))
