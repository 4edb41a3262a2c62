"""Certified bounds of a motion: how long it takes to come near the goal, and what disturbances can do to it.

The search chooses ε₀, the shares η and κ, the levels of V and λ; every bound is one of a statement
(``lyapcheck.check.kinds.settling``) that the checker has accepted.

References: ``reyes2019family`` (11), (12).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck._types import Progress, silent
from lyapcheck.check.kinds.decreasing import PositiveAndDecreasing
from lyapcheck.check.kinds.settling import FallingLevels, Settling
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.refusal import Refused
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.descent import Descent, descent
from lyapcheck.search.decay.digits import as_written, short_above, short_below
from lyapcheck.search.decay.heaviest import Heaviest, heaviest
from lyapcheck.search.decay.margins import MAX_BOXES, Attempt, attempts, candidates
from lyapcheck.search.decay.phases import Phases
from lyapcheck.search.decay.rest import resting
from lyapcheck.search.decay.results import DisturbanceBound, MotionWithProof, SettlingBound, accepted
from lyapcheck.search.decay.start import Start, start_of, torques_of
from lyapcheck.search.posture import unphysical

COARSE = 0.6
FINE = 0.93
"""Ratio of neighbouring levels, to compare margins and for the answer."""
NOT_FALLING = (
    "V was not shown to fall at all levels from the start down to the errors asked for; raise --delta"
)
TOO_LARGE = "the disturbance is too large beside k_pi and the friction: V is not shown to fall at any level"
NO_MARGIN = "no margin of dV/dt < 0 was proved"


def settling_bound(
    controlled: ControlledArm,
    e0: Sequence[float],
    w0: Sequence[float] | None = None,
    delta: float = math.radians(1.0),
    *,
    in_phases: bool = True,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> SettlingBound:
    """A certified time after which every |e_i| ≤ δ, whatever the posture.

    T = Σ (v_k − v_{k+1})/φ_k over levels of V from V at the start down to min k_pi U(δ).

    Args:
        controlled: gains and arm, at nominal numbers or over ranges.
        e0: (n,) q_d − q at the start, rad; it holds for all starts that are no farther, joint by joint.
        w0: (n,) rates at the start, rad/s, and likewise; rest if missing.
        delta: δ > 0, rad.
        in_phases: look for ever larger ε₀ as V falls, where the arm has few enough joints.
        max_boxes: the budget of each attempt at a proof.
        jobs: processes for the checker.
        on_progress: receives the share done.

    Raises:
        InputError: an unbounded h, ranges, or values that are not finite or of the wrong number.

    Soundness: for (11) at exactly the nominal numbers, or at all in the ranges; the checker has accepted it.

    References: ``reyes2019family`` (11), (12), (15).
    """
    start = start_of(controlled, e0, w0, delta)
    wanted = _Wanted(controlled, Disturbance.none(controlled.n), start, short_below(as_written(delta)))
    progress = on_progress or silent
    progress(0.0, "bounds of the inertia")
    shown, reason = None, _impossible(controlled)
    if not reason and in_phases:
        claim = Phases(controlled, start, wanted.goal or Fraction(0), max_boxes).found(progress)
        shown = claim if claim is not None and accepted(claim.statement, claim.proof, jobs) else None
    if not reason and shown is None:
        shown, reason = wanted.shown(max_boxes, jobs, progress)
    return SettlingBound.of(controlled, shown, reason, as_written(delta))


def disturbance_bound(
    controlled: ControlledArm,
    e0: Sequence[float],
    w0: Sequence[float] | None = None,
    torque: Sequence[Fraction | float] = (),
    dry: Sequence[Fraction | float] = (),
    *,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> DisturbanceBound:
    """A level of V, and with it errors, that every motion from a start comes down to under a disturbance.

    Args:
        controlled: gains and arm, at nominal numbers or over ranges.
        e0: (n,) q_d − q at the start, rad; it holds for all starts that are no farther, joint by joint.
        w0: (n,) rates at the start, rad/s, and likewise; rest if missing.
        torque: (n,) bounds of a torque of any sign, N·m; none if empty.
        dry: (n,) bounds of a torque that never helps the motion, as dry friction, N·m; none if empty.
        max_boxes: the budget of each attempt at a proof.
        jobs: processes for the checker.
        on_progress: receives the share done.

    Raises:
        InputError: as `settling_bound`, or bounds that are negative.

    Soundness: as `settling_bound`, for every absolutely continuous motion along which such a torque acts.

    References: ``reyes2019family`` (11), (12), (15).
    """
    start = start_of(controlled, e0, w0, 1.0)
    acting = Disturbance(torques_of(controlled, "torque", torque), torques_of(controlled, "dry", dry))
    wanted = _Wanted(controlled, acting, start, None)
    shown, reason, at_rest = None, _impossible(controlled), None
    if not reason:
        shown, reason = wanted.shown(max_boxes, jobs, on_progress or silent)
        at_rest = resting(controlled, acting.torque, acting.dry)
    return DisturbanceBound.of(controlled, shown, reason, acting.torque, acting.dry, at_rest)


@dataclass(frozen=True)
class _Wanted:
    """What is asked: errors to come below (the goal, rad), or without one the lowest level of V."""

    controlled: ControlledArm
    acting: Disturbance
    start: Start
    goal: Fraction | None

    def shown(self, max_boxes: int, jobs: int, progress: Progress) -> tuple[MotionWithProof | None, str]:
        """The best statement that the checker accepts, or why there is none."""
        progress(0.05, "margins by samples")
        heavy = heaviest(self.controlled)
        if heavy is None:
            return None, NO_MARGIN
        result = candidates(self.controlled, any(self.acting.torque))
        rows = ((self._worth(margin), margin.friction, margin) for margin in result)
        ranked = sorted((row for row in rows if row[0] < math.inf), key=lambda row: row[:2])
        if not ranked:
            return None, NO_MARGIN if not result else NOT_FALLING if self.goal is not None else TOO_LARGE
        for index, (_, friction, margin) in enumerate(ranked):
            progress(0.3 + 0.08 * index, f"proving a margin, η = {float(friction):g}")
            for attempt in attempts(self.controlled, margin, max_boxes):
                claim = self._claim(attempt, heavy)
                if claim is not None and accepted(claim.statement, claim.proof, jobs):
                    return claim, ""
        return None, f"{NO_MARGIN}; allow more boxes"

    def _worth(self, margin: Margin) -> float:
        """The time to the goal, or the level reached; infinite for none."""
        result = self._descent(margin, COARSE)
        return math.inf if result is None else float(result.level if self.goal is None else result.time)

    def _descent(self, margin: Margin, ratio: float) -> Descent | None:
        try:
            estimate = Estimate(margin, self.acting)
            return descent(estimate, self.controlled.family, self.start, self.goal, ratio)
        except ValueError:  # a level of V that allows errors beyond all bounds
            return None

    def _claim(self, attempt: Attempt, heavy: Heaviest) -> MotionWithProof | None:
        """What there is to be judged."""
        margin = attempt.margin
        result = self._descent(margin, FINE)
        if result is None:
            return None
        estimate, loop = Estimate(margin, self.acting), margin.loop
        largest, last = (_short(estimate.reach(level)) for level in (result.envelope[0][1], result.level))
        statement = Settling.about(
            loop,
            eps0=loop.eps0,
            torque=self.acting.torque,
            dry=self.acting.dry,
            errors_at_start=self.start[0],
            rates_at_start=self.start[1],
            envelope=result.envelope,
            largest_errors=largest,
            errors=last if self.goal is None else (self.goal,) * self.controlled.n,
        )
        proof = FallingLevels(
            margin.friction,
            margin.stiffness,
            margin.split,
            margin.slack,
            heavy.diagonal,
            heavy.proof,
            PositiveAndDecreasing(self.controlled.inertia_proof, attempt.by),
            result.slopes,
        )
        return MotionWithProof(statement, proof)


def _short(angles: Sequence[float]) -> tuple[Fraction, ...]:
    return tuple(short_above(Fraction(x)) for x in angles)


def _impossible(controlled: ControlledArm) -> str:
    """Why nothing is certified of an arm: its ranges have no bounds, or M(q) ≻ 0 is not proved over them."""
    try:
        at_corners(controlled.loop(Fraction(1)))
    except Refused as refusal:
        return f"no bounds over these ranges: {refusal}; vary fewer numbers, such as masses and friction"
    return unphysical(controlled)
