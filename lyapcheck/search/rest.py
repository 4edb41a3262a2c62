"""Bounds of the errors at states of rest, tight to six digits, as the checker accepts them.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.resting import AtBounds, Resting, rests_within
from lyapcheck.check.numbers.members import Member, member
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.files.decimals import significant_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet

HALVINGS = 50
FARTHEST = 2**10
"""rad: larger bounds are as good as none."""
DIGITS = 6


def resting(gains: GainSet, dry: Sequence[Fraction]) -> JudgedStatement | None:
    """Bounds of |e_i| at every state of rest under dry friction, N·m; none where no joint has one."""
    h = member(gains.family, gains.m)
    errors = tuple(_error(h, f / k) for f, k in zip(dry, gains.kp, strict=True))
    if all(x is None for x in errors):
        return None
    statement = Resting(gains.family, gains.m, tuple(gains.kp), tuple(dry), errors)
    judged = judged_statement(statement, [AtBounds()])
    return judged if judged.shown == "proved" else None


def _error(h: Member, ratio: Fraction) -> Fraction | None:
    """The least error that |h| ≤ ratio is shown to imply, nearly."""
    low, high = Fraction(0), Fraction(1)
    if rests_within(h, ratio, low):
        return low
    while not rests_within(h, ratio, high):
        low, high = high, 2 * high
        if high > FARTHEST:
            return None
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if rests_within(h, ratio, middle) else (middle, high)
    rounded = significant_up(high, DIGITS)
    return rounded if rests_within(h, ratio, rounded) else None
