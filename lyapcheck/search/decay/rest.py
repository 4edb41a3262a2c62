"""Bounds of the errors at states of rest, tight to six digits, as the checker accepts them.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from lyapcheck.check.kinds.resting import AtBounds, Resting, rests_within
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.check.numbers.members import Member, member
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.digits import short_above
from lyapcheck.search.decay.results import AtRest, accepted

HALVINGS = 50
FARTHEST = 2**10
"""rad: larger bounds are as good as none."""


def resting(controlled: ControlledArm, torque: Sequence[Fraction], dry: Sequence[Fraction]) -> AtRest | None:
    """Bounds of |e_i| at rest under |d_i| ≤ ``torque`` and dry friction; none where no joint has one.

    With dry friction alone every motion ends there; with a torque of any sign it is about states of rest.
    """
    gains = controlled.gains
    h, kp = member(gains.family, gains.m), tuple(gains.kp)
    held = tuple(a + b for a, b in zip(torque, dry, strict=True))
    errors = tuple(_error(h, d / k) for d, k in zip(held, kp, strict=True))
    if all(x is None for x in errors):
        return None
    shown = AtRest(Resting(gains.family, gains.m, kp, held, errors), AtBounds())
    if not any(torque):
        whole = ComesToRest.about(controlled.loop(Fraction(1)), dry=held, errors=errors)
        shown = AtRest(whole, EnergyFalls(controlled.inertia_proof))
    return shown if accepted(shown.statement, shown.proof) else None


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
    rounded = short_above(high)
    return rounded if rests_within(h, ratio, rounded) else None
