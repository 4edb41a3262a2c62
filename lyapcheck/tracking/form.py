"""How fast V must fall under (21): dV/dt ≤ −[a b] Θ' [a b]ᵀ with a = ‖h(e)‖, b = ‖w‖ and v_d = sup ‖q̇_d‖.

    θ'11 = ε (k − ε k_c v_d),   θ'12 = −½ ε (d + k_c v_d + ε c),   θ'22 = β − ε c,   ε = ε₀/(1 + ‖e‖)

with k, β, c, d of ``lyapcheck.lyapunov.scalar``; at v_d = 0 it is that form. The inequality holds for every
ε₀ > 0 and is proved in ``proofs/tracking.py``; where Θ' is positive definite as well, V falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array
from lyapcheck.check.loop.scalar import ScalarForm
from lyapcheck.constants import robot_constants
from lyapcheck.constants.bounds import robot_bounds
from lyapcheck.files.decimals import round_down
from lyapcheck.lyapunov.scalar import scalar_form

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm


HALVINGS = 48
DIGITS = 9
"""Significant digits of an ε₀."""


@dataclass(frozen=True)
class TrackingForm:
    """Θ' with rational numbers on the safe side: the form of (11), and ``turn`` = k_c v_d."""

    still: ScalarForm
    turn: Fraction

    def certifies(self, eps0: Fraction) -> bool:
        """Whether Θ'(ε) ≻ 0 for every ε in (0, ε₀].

        Soundness: θ'11/ε and θ'22 fall as ε grows, and where both are positive so does det Θ'/ε =
        (k − ε k_c v_d) θ'22 − ¼ ε (d + k_c v_d + ε c)²; so the signs at ε₀ decide.
        """
        form = self.still
        corner, low = form.stiffness - eps0 * self.turn, form.friction - eps0 * form.drift
        side = form.cross + self.turn + eps0 * form.drift
        return eps0 > 0 and corner > 0 and low > 0 and 4 * corner * low > eps0 * side**2

    def largest(self) -> Fraction | None:
        """The largest ε₀ that ``certifies``, rounded down to nine digits; none where there is none."""
        form = self.still
        if form.friction <= 0 or form.stiffness <= 0:
            return None
        high = 4 * form.stiffness * form.friction / (form.cross + self.turn) ** 2
        low = Fraction(0)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if self.certifies(middle) else (low, middle)
        short = _short(low) if low else low
        return short if self.certifies(short) else None

    def promised(self, eps0: float, r: Array, a: Array, b: Array) -> Array:
        """−[a b] Θ' [a b]ᵀ at states of given ‖e‖, ‖h(e)‖ and ‖w‖, W; in doubles."""
        k, beta, c, d, turn = map(
            float, (self.still.stiffness, self.still.friction, self.still.drift, self.still.cross, self.turn)
        )
        eps = eps0 / (1.0 + r)
        corner, side, low = eps * (k - eps * turn), -eps / 2 * (d + turn + eps * c), beta - eps * c
        return np.asarray(-(corner * a * a + 2.0 * side * a * b + low * b * b))


def tracking_form(controlled: ControlledArm, speed: Fraction) -> TrackingForm | None:
    """Θ' of a controller on an arm at a bound v_d of ‖q̇_d‖ in rad/s; none where h is unbounded.

    Soundness: β_M and k_c are outside bounds at the arm's nominal numbers, v_d is what it is given.
    """
    still = scalar_form(controlled.gains, controlled.family.constants(), robot_bounds(controlled.model))
    return None if still is None else TrackingForm(still, robot_constants(controlled.model).k_c.upper * speed)


def _short(value: Fraction) -> Fraction:
    places = DIGITS
    while value * 10**places < 10 ** (DIGITS - 1):
        places += 1
    return round_down(value, places)
