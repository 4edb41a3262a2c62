"""Bounds of the errors at states of rest, tight to six digits, as the checker accepts them.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.control.resting import rest_error
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.results import AtRest, accepted


def resting(controlled: ControlledArm, torque: Sequence[Fraction], dry: Sequence[Fraction]) -> AtRest | None:
    """Bounds of |e_i| at rest under |d_i| ≤ ``torque`` and dry friction; none where no joint has one.

    With dry friction alone every motion ends there; with a torque of any sign it is about states of rest.
    """
    gains = controlled.gains
    kp = tuple(gains.kp)
    held = tuple(a + b for a, b in zip(torque, dry, strict=True))
    errors = tuple(rest_error(gains.family, gains.m, d / k) for d, k in zip(held, kp, strict=True))
    if all(x is None for x in errors):
        return None
    shown = AtRest(Resting(gains.family, gains.m, kp, held, errors), AtBounds())
    if not any(torque):
        whole = ComesToRest.about(controlled.loop(Fraction(1)), dry=held, errors=errors)
        shown = AtRest(whole, EnergyFalls(controlled.inertia_proof))
    return shown if accepted(shown.statement, shown.proof) else None
