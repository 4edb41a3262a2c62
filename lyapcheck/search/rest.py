"""Bounds of the errors at states of rest, tight to six digits, as the checker accepts them.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.control.judgement import JudgedStatement, judged_statement, rest_error

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet


def resting(gains: GainSet, dry: Sequence[Fraction]) -> JudgedStatement | None:
    """Bounds of |e_i| at every state of rest under dry friction, N·m; none where no joint has one."""
    errors = tuple(rest_error(gains.family, gains.m, f / k) for f, k in zip(dry, gains.kp, strict=True))
    if all(x is None for x in errors):
        return None
    statement = Resting(gains.family, gains.m, tuple(gains.kp), tuple(dry), errors)
    judged = judged_statement(statement, [AtBounds()])
    return judged if judged.shown == "proved" else None
