"""What theory promises of the tracking scheme (21) before a run begins: torques, and how fast V falls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from operator import mul

import numpy as np
from flint import fmpq_mpoly

from lyapcheck._types import Array
from lyapcheck.check.loop import ScalarForm
from lyapcheck.check.loop.states import State, value
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.constants import robot_bounds, robot_constants
from lyapcheck.files.decimals import significant_down
from lyapcheck.lyapunov.scalar import scalar_form
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.trig import to_terms
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.reference import BITS, Suprema, above

# --- How much torque (21) can ask of each motor, for all times and all motions from one start.
#
#     |τ_i| ≤ γ (k_pi + k_vi) + Σ_j sup|M_ij| sup|q̈_dj| + κ_i (v_d + b̄) v_d + sup|g_i| + b_i sup|q̇_di|
#
# where κ_i is k_c, or √(Σ_jk sup c_ijk²) if that is smaller, and b̄ bounds ‖w‖ = ‖q̇ − q̇_d‖: with ε₀ = 0 V is
# ½ wᵀMw + Σ k_pi U(e_i), which never grows under (21), so ‖w‖ ≤ b̄ = √(2 V(0)/λmin(M)). With q_d at rest
# this is the bound (9), joint by joint.

Row = tuple[Fraction, ...]


@dataclass(frozen=True)
class TorqueBounds:
    """What bounds the motions from one start, exact."""

    total: Row
    """(n,) of each |τ_i|, N·m."""
    error_rate: Fraction
    """b̄ ≥ ‖q̇ − q̇_d‖ at all times, rad/s."""


def torque_bounds(
    controlled: ControlledArm, suprema: Suprema, q: Sequence[float], e: Sequence[float], w: Sequence[float]
) -> TorqueBounds | None:
    """The bounds for motions from one state; none where h is unbounded or λmin(M) > 0 is not known.

    Args:
        controlled: controller and arm, at nominal numbers.
        suprema: of the reference.
        q: (n,) start in rad.
        e: (n,) q_d(0) − q.
        w: (n,) q̇ − q̇_d(0), rad/s.
    """
    gamma, constants = controlled.family.constants().gamma, robot_constants(controlled.model)
    least = constants.lambda_min.lower
    if gamma is None or least <= 0:
        return None
    start = State(*(tuple(map(Fraction, part)) for part in (q, e, w)))
    with precision(BITS):
        stored = value(controlled.arm, controlled.controller, Fraction(0), start, BITS)
        spin = above((2 * stored / to_arb(least)).sqrt())
    top, fixed, n = gamma.upper, controlled.fixed, controlled.n
    kappa = [constants.k_c.upper] * n
    if n <= FEW_JOINTS:
        sizes = [[_size(entry, n) for row in layer for entry in row] for layer in fixed.christoffel]
        with precision(BITS):
            roots = [above(to_arb(sum((x * x for x in row), Fraction(0))).sqrt()) for row in sizes]
        kappa = [min(pair) for pair in zip(kappa, roots, strict=True)]
    product = (suprema.speed + spin) * suprema.speed
    parts = (
        [top * (p + v) for p, v in zip(controlled.gains.kp, controlled.gains.kv, strict=True)],
        [
            sum((_size(x, n) * a for x, a in zip(row, suprema.acceleration, strict=True)), Fraction(0))
            for row in fixed.mass
        ],
        [k * product for k in kappa],
        [_size(entry, n) for entry in fixed.gravity],
        map(mul, controlled.arm.viscous, suprema.rate),
    )
    return TorqueBounds(tuple(sum(column, Fraction(0)) for column in zip(*parts, strict=True)), spin)


def _size(poly: fmpq_mpoly, n: int) -> Fraction:
    """At least how large an entry of M, g or C can be at any angles.

    It is a sum of harmonics a cos(k·q) + b sin(k·q), and at most Σ (a² + b²)^½ in size.
    """
    pairs = harmonics(to_terms(poly), n).values()
    return sum(
        (max(abs(a), abs(b)) if not a or not b else root_above(a * a + b * b) for a, b in pairs), Fraction(0)
    )


# --- How fast V must fall under (21): dV/dt ≤ −[a b] Θ' [a b]ᵀ with a = ‖h(e)‖, b = ‖w‖ and v_d = sup ‖q̇_d‖.
#
#     θ'11 = ε (k − ε k_c v_d),   θ'12 = −½ ε (d + k_c v_d + ε c),   θ'22 = β − ε c,   ε = ε₀/(1 + ‖e‖)
#
# with k, β, c, d of ``lyapcheck.lyapunov.scalar``; at v_d = 0 it is that form. The inequality holds for every
# ε₀ > 0 and is proved in ``proofs/tracking.py``; where Θ' is positive definite as well, V falls.


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
        short = significant_down(low, DIGITS) if low else low
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


# --- All of it for one run.


SHARE = Fraction(1, 2)
"""ε₀ as a share of the largest one for which Θ' is positive definite: there the form is singular."""
UNBOUNDED = "h is unbounded, and Θ' needs its bound γ"
NO_EPS0 = "no ε₀ > 0 makes Θ' positive definite; λmin(B) and λmin(K_p) must be positive"


@dataclass(frozen=True)
class Promise:
    """What theory says of a run before it begins, at nominal numbers, by bounds without certificates."""

    suprema: Suprema
    largest: Fraction | None
    """The largest ε₀ for which Θ' is positive definite at v_d; none where there is none."""
    falls: bool
    """Whether Θ' is positive definite at the ε₀ watched, so that dV/dt < 0 away from e = ė = 0."""
    torque: TorqueBounds | None
    """Bounds of each |τ_i|; none for an unbounded controller."""
    reason: str = ""
    """Why there is no ε₀."""
