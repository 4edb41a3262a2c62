"""The ε₀ that need no search: the end of (18), and that of the scalar form, from norms."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.loop.closed_loop import certifies
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.constants import robot_bounds
from lyapcheck.files.decimals import significant_down
from lyapcheck.lyapunov.scalar import RobotBounds, published_limit, scalar_form, sharp_form
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof
from lyapcheck.search.link_bounds import linked_proof
from lyapcheck.search.scalar_program import ScalarResult, scalar_epsilon

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.family.base import FamilyConstants


_DIGITS = 9


def by_forms(controlled: ControlledArm) -> tuple[Fraction | None, ScalarResult, dict[str, str]]:
    """The published ε₀, the scalar one, and why one of them is missing; no search.

    Over ranges both are about all arms in them, as what is certified is.
    """
    gain_set, constants = controlled.gains, controlled.family.constants()
    bounds = _bounds(controlled)
    published, reason = _published(gain_set, constants, bounds)
    if controlled.ranges and reason:
        reason = reason.replace("(19) fails,", "(19) fails in the ranges,")
    # over ranges only the checker's coarse form is at hand where h is bounded
    sharp = scalar_epsilon(sharp_form(gain_set, constants, bounds))
    scalar = _scalar(controlled, bounds) or sharp
    return published, scalar, {"published": reason, "scalar": scalar.reason}


def proof_of(controlled: ControlledArm, eps0: Fraction | None) -> DecreaseProof | None:
    """The proof of the scalar ε₀ by norms alone or by bounds along the links, if the checker accepts it."""
    if eps0 is None or not controlled.family.bounded:
        return None
    loop = controlled.loop(eps0)
    by_norms = certifies(loop.tail, eps0)
    proof = controlled.proof(loop, BoxTree(".")) if by_norms else linked_proof(controlled, eps0)
    return None if proof is None else proof.accepted()


def _bounds(controlled: ControlledArm) -> RobotBounds:
    """Bounds of the arm; over ranges those of all arms in them, the worst end of each.

    Where M itself ranges, these are the checker's coarse ones: sharp ones would be asked at every corner.
    """
    model = controlled.model
    if not controlled.ranges:
        return robot_bounds(model)
    ends = [number.bounds for number in model.viscous]
    low, high = min(low for low, _ in ends), max(high for _, high in ends)
    if any(number.ranged for number in model.parameters.values()):
        inertia = controlled.loop(Fraction(1)).inertia
        return RobotBounds(inertia.largest_row, root_above(inertia.squares_of_symbols), low, high)
    return replace(robot_bounds(model), viscous_min=low, viscous_max=high)


def _scalar(controlled: ControlledArm, bounds: RobotBounds) -> ScalarResult | None:
    """The scalar form of what the setting is about; ``None`` where h is unbounded."""
    if not controlled.family.bounded:
        return None
    if controlled.ranges:
        return scalar_epsilon(controlled.loop(Fraction(1)).tail)
    form = scalar_form(controlled.gains, controlled.family.constants(), bounds)
    return None if form is None else scalar_epsilon(form)


def _published(
    gain_set: GainSet, constants: FamilyConstants, bounds: RobotBounds
) -> tuple[Fraction | None, str]:
    """The end of (18), rounded down, or why there is none."""
    if constants.gamma is None:
        return None, "(18) needs a bounded h, and the linear one has no γ"
    limit = published_limit(gain_set, constants, bounds)
    if limit is None:
        return None, "(19) fails, so that (18) is empty; lower the gains k_v to below λmin(B)/(√n γ)"
    return significant_down(limit.lower, _DIGITS), ""
