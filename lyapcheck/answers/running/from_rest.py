"""Whether gains bring an arm to each goal from rest, at exactly one period: (P), where (S) does not show it.

References: ``lyapcheck.check.kinds.sampled_from_rest``.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.folder import shown_by
from lyapcheck.asked import sampled_from_rest, viscous_of
from lyapcheck.check.kinds.sampled_from_rest import FARTHEST, MOST_DELAY, SampledFromRest
from lyapcheck.control.judgement import judged_statement
from lyapcheck.control.sampling import ONE
from lyapcheck.errors import PACKAGES, installed, repair
from lyapcheck.files.decimals import decimal_text
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.check.certificate import Certificate
    from lyapcheck.check.statement import Statement
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel

UNTRIED = "--within 90 or within = 90 under [loop] looks for a proof from rest, at exactly this period"
TANH = (("tanh", None), ("hyperbolic", 1))
SEARCHES = ("numpy", "scipy", "cvxpy", "clarabel")


def shown_from_rest(
    gains: GainSet,
    arm: RobotModel | None,
    record: LoopRecord,
    low: Fraction | None,
    kept: Sequence[Certificate] = (),
) -> tuple[Promise | None, str]:
    """That these gains bring the arm, in its ranges, to each goal at exactly the period; or why not.

    Its dry friction is left out; ``low``, N·m·s/rad, replaces its λmin(B). Starts are at rest with
    each |e_i| ≤ ``within`` of the record; without it nothing is looked for but the widest of ``kept``.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    unfit, within = _unfit(gains, arm, record), record.within
    if kept and arm is not None and record.period is not None and not unfit:
        known = shown_by(kept, lambda stated: _asked(gains, arm, record, low, stated))
        widest = max(known, key=lambda pair: pair[0].asked.within, default=None)  # type: ignore[attr-defined]
        if widest is not None:
            return widest[0], ""
    if within is None or unfit or arm is None or record.period is None:
        return None, unfit if within is not None else "" if unfit else UNTRIED
    if lacking := next((one for one in SEARCHES if not installed(one)), ""):
        return None, f"(P) takes {PACKAGES[lacking]}, which is not installed; {repair(lacking)}"
    from lyapcheck.search.sampled_energy import falling_energy

    try:
        asked = sampled_from_rest(gains, record, arm, within)
    except TooManyTerms:
        return None, "M(q) of these links is too long to be written out, which (P) asks for"
    asked = replace(asked, viscous=viscous_of(arm, low))
    proof = falling_energy(asked)
    if proof is None:
        return None, f"(P) finds no proof from rest within {decimal_text(within)}° over the ranges of the arm"
    return promised(asked, judged_statement(asked, [proof]))


def _asked(
    gains: GainSet,
    arm: RobotModel,
    record: LoopRecord,
    low: Fraction | None,
    stated: Statement,
) -> Statement | None:
    """The question from within so many degrees, or from as many as a statement has."""
    if not isinstance(stated, SampledFromRest):
        return None
    try:
        asked = sampled_from_rest(gains, record, arm, record.within or stated.within)
    except TooManyTerms:
        return None
    return replace(asked, viscous=viscous_of(arm, low))


def _unfit(gains: GainSet, arm: RobotModel | None, record: LoopRecord) -> str:
    """Why (P) does not speak of this loop; empty where it does."""
    rules = {
        "asks for the arm itself: name one with robot = …": arm is not None,
        f"speaks of arms to {FEW_JOINTS} joints": arm is None or arm.n <= FEW_JOINTS,
        "speaks of h = tanh, m = 1": (gains.family, gains.m) in TANH,
        "speaks of differences without a filter": (record.velocity, record.filter) == ("difference", ONE),
        "speaks of constant intervals: longest must be the period": record.longest in (None, record.period),
        f"speaks of delays to {MOST_DELAY} samples": record.delay <= MOST_DELAY,
        "supposes that the controller knows g(q)": record.knows_gravity,
        f"speaks of starts to {FARTHEST}° from the goal": record.within is None
        or 0 < record.within <= FARTHEST,
    }
    return next((f"(P) {rule}" for rule, fits in rules.items() if not fits), "")
