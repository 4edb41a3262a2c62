"""Stability of gains that break (19), by proofs that cost milliseconds and load nothing heavy.

    scalar   dV/dt < 0 at every state but the origin, from norms of M and C alone, with some ε₀
    lasalle  M(q) ≻ 0. With the energy as V, dV/dt = −wᵀK_v h(w) − wᵀB w ≤ 0, and where it stays 0 the arm
             rests, so K_p h(e) = 0 and e = 0: the origin is globally asymptotically stable for all positive
             gains

References: (11)-(15) of reyes2019family; LaSalle's theorem, khalil2002nonlinear, corollary 4.2.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.asked import decreasing, definite, viscous_of
from lyapcheck.control.conditions import ACCEPTED, Check
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.errors import InputError
from lyapcheck.promise import promised
from lyapcheck.robots.dynamics import FEW_JOINTS

if TYPE_CHECKING:
    from lyapcheck.check.statement import Ends
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

SCALAR, LASALLE = "scalar", "lasalle"
MOST_TERMS = 2000
"""Terms of M(q): the proof for an arm with more takes seconds, and is left to those who ask for it."""


def proved_otherwise(
    gains: GainSet, model: RobotModel, viscous_min: Fraction | None, ranges: bool = False
) -> Check | None:
    """The first of both that the checker proves; ``None`` where neither is, or the arm is large.

    Args:
        gains: a set that breaks (19).
        model: the arm.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
        ranges: for all values of what is uncertain about the arm, and not for the nominal ones.

    Soundness: that of ``lyapcheck.check.verify``; that M(q) ≻ 0 is enough is LaSalle's theorem, cited.
    """
    if unknown_function(gains) or (ranges and model.n > FEW_JOINTS):
        return None
    if not small(model.fixed()):
        result = lasalle(model, False) if model.fixed().chain is not None else None
        return result if result is not None and result.verdict == ACCEPTED else None
    arm = model if ranges else model.fixed()
    result = _scalar(gains, arm, viscous_min, ranges)
    if result is None or result.verdict != ACCEPTED:
        result = lasalle(model, ranges)
    return result if result.verdict == ACCEPTED else None


def unknown_function(gains: GainSet) -> str:
    """Why nothing is known of the h of a gain set, as that x h(x) > 0; empty where the checker knows h."""
    from lyapcheck.family.base import named

    family = named(gains.family, gains.m)
    if not family.bounded:  # PD: h(x) = x
        return "" if family.name == "linear" else f"the checker knows no function {family.name!r}"
    try:
        _ = family.checked
    except InputError as error:
        return str(error)
    return ""


def small(fixed: RobotModel) -> bool:
    """Whether M(q) of an arm without parameters is short enough for what must cost next to nothing."""
    from lyapcheck.robots.dynamics import TooManyTerms

    try:
        return sum(len(entry) for row in fixed.mass for entry in row) <= MOST_TERMS
    except TooManyTerms:
        return False


def friction_of(model: RobotModel, viscous_min: Fraction | None, ranges: bool) -> tuple[Ends, ...] | None:
    """Every B between a λmin(B) that replaces the arm's and the most of its own; ``None`` where none does."""
    if viscous_min is None:
        return None
    most = (number.bounds[1] if ranges else number.value for number in model.viscous)
    return tuple((viscous_min, max(viscous_min, own)) for own in most)


def _scalar(gains: GainSet, arm: RobotModel, viscous_min: Fraction | None, ranges: bool) -> Check | None:
    from lyapcheck.family.base import named
    from lyapcheck.search.controlled_arm import closed_loop_of, mass_proof, remember
    from lyapcheck.search.scalar_program import norm_proof

    if not named(gains.family, gains.m).bounded:
        return None
    remember(arm)
    loop = closed_loop_of(gains, arm, Fraction(1), ranges=ranges)
    friction = friction_of(arm, viscous_min, ranges)
    if friction is not None:
        loop = replace(loop, viscous=friction)
    proof, _ = norm_proof(loop, mass_proof(arm.mass_terms))
    if proof is None:
        return None
    judged = judged_statement(proof.statement, [proof.certificate])
    return decided(SCALAR, gains, arm, proof.loop.eps0, judged, viscous_min, ranges)


def decided(
    name: str,
    gains: GainSet,
    arm: RobotModel,
    eps0: Fraction,
    judged: JudgedStatement,
    viscous_min: Fraction | None,
    ranges: bool,
) -> Check:
    """The check of a proof that V falls: accepted where it is about the arm that was asked about."""
    asked = replace(
        decreasing(gains, arm, eps0, nominal=not ranges),
        viscous=viscous_of(arm, viscous_min, nominal=not ranges),
    )
    promise, reason = promised(asked, judged)
    if promise is None:
        return Check(name, reason=judged.reason or reason)
    return Check(name, judgement=judged, value=eps0, promise=promise)


def lasalle(model: RobotModel, ranges: bool) -> Check:
    """Whether M(q) ≻ 0 is proved of an arm, for all values of its parameters or for the nominal ones."""
    asked = definite(model if ranges else model.fixed())
    judged = positive(model if ranges else model.fixed())
    promise, reason = promised(asked, judged)
    if promise is None:
        return Check(LASALLE, reason=judged.reason or reason)
    return Check(LASALLE, judgement=judged, promise=promise)


@lru_cache(maxsize=8)
def positive(arm: RobotModel) -> JudgedStatement:
    """What the checker says of M(q) ≻ 0."""
    from lyapcheck.check.kinds.chain import ChainAbove, OwnMoments
    from lyapcheck.check.kinds.inertia import MassAbove
    from lyapcheck.robots.dynamics import TooManyTerms
    from lyapcheck.search.controlled_arm import mass_proof, remember

    try:
        mass = arm.mass_terms
    except TooManyTerms:
        if arm.chain is None:
            raise
        return judged_statement(ChainAbove(arm.chain.links, Fraction(0)), [OwnMoments()])
    remember(arm)
    ranges = arm.ranges
    return judged_statement(MassAbove(mass, ranges, Fraction(0)), [mass_proof(mass)])
