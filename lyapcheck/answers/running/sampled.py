"""Whether gains are stable as a computer runs them, for which periods this is shown, and for which refuted.

    (S)  b_i > r L k_vi Σ|f_j| + (½ + d) r T (ρ k_pi + Γ_i)   shows it for each T up to a largest one
    (P)  an energy falls from rest within so many degrees     shows it at one T, where it is asked for
    (R)  motions near one goal grow from sample to sample     refutes it at one T

These ends are no bracket: (S) serves whatever the inertia, (R) sees h'(0). (S) and (P) suppose that no motor
saturates, and so count together with (10i) or (10p) only. Where dry friction or unknown gravity acts (S)
shows that the arm comes to rest, not that this is the goal.

References: (6), (11) of reyes2019family; ``lyapcheck.check.kinds.sampled_from_rest`` for (P).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.asked import sampled, sampled_from_rest, viscous_of
from lyapcheck.check.judgement import MOST_CORNERS
from lyapcheck.check.kinds.sampled_from_rest import FARTHEST, MOST_DELAY, SampledFromRest
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.conditions import REJECTED, Check
from lyapcheck.control.judgement import JudgedStatement, judged_statement, shown_by
from lyapcheck.control.sampling import (
    ONE,
    UNSAID,
    LoopRecord,
    judged_sampled,
    largest_periods,
    require_sampled,
    time_text,
)
from lyapcheck.errors import without
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, exact_decimal, significant_down
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.check.certificate import Certificate
    from lyapcheck.check.kinds.sampled import SampledStable
    from lyapcheck.check.statement import Statement
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

SAMPLED = "sampled"
LOWPASS = "lowpass is no filter of finitely many taps: give its taps, cut off where they are small"
SATURATES = "({}) supposes that no motor saturates: it counts together with (10i) or (10p) only"
STEPS = "({}) speaks of exact readings: leave encoder out of the loop, and simulate with it"
DRY = "(P) speaks of an arm without dry friction"
UNTRIED = "--within 90 looks for a proof from rest, at exactly this period"
DIGITS = 9
"""Of the largest period in data."""
LONGEST = 20
"""Times the period asked: how far a refuted one is looked for."""


@dataclass(frozen=True, repr=False)
class SampledCheck(Check):
    """`Check` of all joints, named after the tightest: its value is the period, its limit the largest, in s.

    Args:
        record: how the controller runs.
        up_to: that the largest period shown, and each shorter one, will do; ``None`` where none is shown.
        refuted: that stability is refuted at a period, of the arm without dry friction or unknown gravity.
        rests: whether it is shown that the arm comes to rest, not that it does so at the goal.
        named: whether the period of the record is one that somebody asked about.
        counts: whether (10i) or (10p) holds.
        from_rest: that the arm, but for its dry friction, comes to each goal from rest at exactly the period.
        nominal: whether that is shown at the nominal inertia of an arm with ranges, not over these.
    """

    record: LoopRecord = UNSAID
    up_to: Promise | None = None
    refuted: JudgedStatement | None = None
    rests: bool = False
    named: bool = True
    counts: bool = True
    from_rest: Promise | None = None
    nominal: bool = False

    @property
    def narrow(self) -> str:
        """From where and at which period it is accepted, where not from everywhere at each shorter one."""
        return "" if self.promise is None else self._from_where

    @property
    def _from_where(self) -> str:
        """The period, the starts and the inertia of what (P) shows; empty where it shows nothing."""
        if self.from_rest is None:
            return ""
        asked: SampledFromRest = self.from_rest.asked  # type: ignore[assignment]
        of_arm = ", at the nominal inertia" if self.nominal else ""
        return f"at exactly {time_text(asked.period)}, from rest within {decimal_text(asked.within)}°{of_arm}"

    @property
    def most(self) -> Fraction | None:
        """The largest period that is shown, s."""
        return None if self.up_to is None else self._asked.period

    @property
    def _asked(self) -> SampledStable:
        assert self.up_to is not None
        asked: SampledStable = self.up_to.asked  # type: ignore[assignment]
        return asked

    @property
    def unstable_alone(self) -> str:
        """That the loop as it is asked about is refuted but for what acts on it; empty where it is not."""
        if self.refuted is None or not self.rests or not self.named:
            return ""
        period: Fraction = self.refuted.proof.period  # type: ignore[union-attr]
        asked = self.record.period
        known = asked is not None and period <= asked
        return f"unstable at {time_text(period)} without dry friction or unknown gravity" if known else ""

    def sentences(self, told: bool) -> list[str]:
        """What is shown and what is refuted of the periods, unless a rejection was told."""
        said, inside = [], "" if self.counts else ", while no motor saturates, which nothing shows"
        if self.up_to is not None and self.most is not None:
            covered = self.named and self.record.period is not None and self.record.period <= self.most
            words = f"as run ({self.record.text if covered else self.record.how}): "
            # (S) bounds the intervals of each period by a multiple of it, not by one time
            r = self._asked.stretch
            apart = f", no interval above {decimal_text(r)} times it" if r > 1 else ""
            end = f"with exact readings for every period up to {time_text(self.most)}{apart}{inside}"
            said.append(self.up_to.says(f"{words}{'comes to rest' if self.rests else 'it is stable'} {end}"))
        if self.from_rest is not None:
            without = ", without the dry friction of the arm" if self.rests else ""
            words = f"as run ({self.record.how}): proved {self._from_where}, to come to the goal"
            said.append(self.from_rest.says(f"{words}{without}{inside}"))
        if self.refuted is not None and not (told and self.verdict == REJECTED):
            said.append(unstable_text(self.refuted, self.rests))
        return said


def unstable_text(refuted: JudgedStatement, alone: bool) -> str:
    """At which period and posture stability is refuted."""
    from lyapcheck.check.kinds.sampled_unstable import GrowingMotion

    proof = refuted.proof
    if not isinstance(proof, GrowingMotion):
        return "unstable"
    place = ", ".join(f"{float(x):g}" for x in proof.goal)
    without = " without dry friction and with all gravity known" if alone else ""
    some = ", of an arm in its ranges" if proof.parameters else ""
    return f"unstable at {time_text(proof.period)}{without}, at the goal q_d = ({place})°{some}"


@dataclass(frozen=True)
class AsRun:
    """Gains on an arm, as a computer runs them.

    Args:
        gains: the controller.
        limits: of the arm; without its model any serial revolute arm with these bounds of gravity is meant.
        record: how a computer runs it.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
        kept: certificates that are judged before anything is searched.
    """

    gains: GainSet
    limits: Limits
    record: LoopRecord
    viscous_min: Fraction | None
    kept: Sequence[Certificate] = ()

    def check(self, inside: bool, searched: bool = True) -> SampledCheck:
        """Are these gains stable, run in this way, with the period of the record?

        Args:
            inside: whether (10i) or (10p) is accepted, so that no motor saturates.
            searched: whether to look for a refutation where nothing is shown.

        Soundness: that of ``lyapcheck.check.verify``.
        """
        record, arm = self.record, self.limits.model
        known = SampledCheck(SAMPLED, value=record.period, record=record, counts=inside)
        try:
            asked = self.question()
        except ValueError as error:
            return replace(known, reason=str(error))
        most, joint, why = largest(asked, self.limits.joints)
        known = replace(known, joint=joint, rests=asked.conclusion == "rest")
        if most is not None:
            shown = judged_sampled(replace(asked, period=most[0]))
            up_to, why_not = promised(replace(asked, period=most[0]), shown)
            fits = exact_decimal(decimal_text(significant_down(most[0], DIGITS)))
            known = replace(known, limit=Enclosure(most[1], most[1]), up_to=up_to, largest_admissible=fits)
            if up_to is not None and asked.period <= most[0]:
                promise, _ = promised(asked, shown)
                if promise is not None and inside and record.encoder is None:
                    return replace(known, judgement=shown, promise=promise)
                return replace(known, reason=(SATURATES if record.encoder is None else STEPS).format("S"))
            why = why_not or f"(S) shows no period above {time_text(most[0])}"
        refuted, missing = _refuted(asked, arm) if searched else (None, "")
        if refuted is not None and not known.rests and refuted.proof.period <= asked.period:  # type: ignore[union-attr]
            return replace(known, judgement=refuted, refuted=refuted)
        promise, lacks = self.from_rest(arm)
        nominal = promise is None and arm is not None and bool(arm.parameters) and not self.limits.varied
        if nominal and arm is not None:
            promise, _ = self.from_rest(arm.fixed())
        known = replace(known, refuted=refuted, from_rest=promise, nominal=nominal)
        if promise is not None and known.counts and not known.rests and record.encoder is None:
            known = replace(known, promise=promise, judgement=promise.shown)  # type: ignore[arg-type]
            known = replace(known, joint=None, limit=None, largest_admissible=None)
            why = missing = ""
        elif promise is not None:
            lacks = DRY if known.rests else (SATURATES if record.encoder is None else STEPS).format("P")
        return replace(known, reason="; ".join(filter(None, (why, missing, lacks))))

    def question(self) -> SampledStable:
        """The statement that is asked about, at the period of the record.

        Raises:
            ValueError: (S) does not speak of such a loop or such an h; it says why.
        """
        gains, limits = self.gains, self.limits
        if self.record.lowpass is not None:
            raise ValueError(LOWPASS)
        family = named(gains.family, gains.m)
        if not family.bounded:
            raise ValueError("h is unbounded, of which (S) does not speak")
        _ = family.checked
        loop = require_sampled(self.record)
        arm, bare = limits.model, [limits.viscous_min or Fraction(0)] * limits.n
        goal = "goal" if loop.knows_gravity and (arm is None or not arm.dry) else "rest"
        least = bare if arm is None else [low for low, _ in viscous_of(arm, self.viscous_min)]
        try:
            return sampled(gains, loop, least, arm, limits.gravity, goal)
        except TooManyTerms:
            return sampled(gains, loop, least, None, limits.gravity, goal)

    # --- (P): from rest within so many degrees, at exactly one period.

    def from_rest(self, arm: RobotModel | None) -> tuple[Promise | None, str]:
        """That these gains bring an arm, in its ranges, to each goal at exactly the period; or why not.

        Its dry friction is left out. Starts are at rest with each |e_i| ≤ ``within`` of the record; without
        it nothing is looked for but the widest of ``kept``.

        Soundness: that of ``lyapcheck.check.verify``.
        """
        unfit, within = _unfit(arm, self.record), self.record.within
        if arm is None or unfit:
            return None, unfit if within is not None else ""
        answers = shown_by(self.kept, lambda stated: self._from_rest(arm, stated))
        widest = max(answers, key=lambda pair: pair[0].asked.within, default=None)  # type: ignore[attr-defined]
        if widest is not None:
            return widest[0], ""
        lacks = without("(P) takes", "numpy", "scipy", "cvxpy", "clarabel") if within is not None else UNTRIED
        if lacks or within is None:
            return None, lacks
        from lyapcheck.search.controlled_arm import chains_of
        from lyapcheck.search.sampled_energy import falling_energy

        asked = self._from_rest(arm)
        if asked is None:
            return None, "M(q) of these links is too long to be written out, which (P) asks for"
        proof = falling_energy(asked, chains_of(arm, arm.ranges) if _few_corners(arm) else ())
        if proof is None:
            ranging = any(low < high for low, high in (*asked.viscous, *asked.parameters))
            over = " over the ranges of the arm" if ranging else ""
            return None, f"(P) finds no proof from rest within {decimal_text(within)}°{over}"
        return promised(asked, judged_statement(asked, [proof]))

    def _from_rest(self, arm: RobotModel, stated: Statement | None = None) -> SampledFromRest | None:
        """The question from within so many degrees, or from as many as a statement has."""
        within = self.record.within
        if stated is not None:
            if not isinstance(stated, SampledFromRest):
                return None
            within = within or stated.within
        assert within is not None
        try:
            return sampled_from_rest(self.gains, self.record, arm, within, self.viscous_min)
        except TooManyTerms:
            return None


def largest(
    asked: SampledStable, joints: Sequence[str]
) -> tuple[tuple[Fraction, Fraction] | None, int | None, str]:
    """The largest period to state and the supremum of those shown, s; the tightest joint; or why not."""
    ends = largest_periods(asked)
    short = [i for i, end in enumerate(ends) if end <= 0]
    if short:
        names = ", ".join(joints[i] for i in short)
        return None, short[0], f"(S) shows no period: L k_v is not below the friction of {names}"
    most = min(ends)
    stated = significant_down(most, 4)
    if stated == most:  # (S) is strict
        stated = significant_down(most * Fraction(9999, 10000), 4)
    return (max(stated, asked.period) if asked.period < most else stated, most), ends.index(most), ""


def _refuted(asked: SampledStable, arm: RobotModel | None) -> tuple[JudgedStatement | None, str]:
    """What refutes stability at the period asked, else at a longer one; or what is missing to look for it."""
    if asked.k_g or arm is None:
        return None, ""
    if lacking := without("to refute it takes", "numpy", "scipy"):
        return None, lacking
    from lyapcheck.search.sampled import refuted_at, smallest_refuted

    goal = replace(asked, conclusion="goal")
    proof = refuted_at(goal, goal.period, arm)
    if proof is None:
        goal = replace(goal, period=LONGEST * goal.period)
        proof = smallest_refuted(goal, asked.period, arm)
    return (None, "") if proof is None else (judged_statement(goal, [proof]), "")


def _few_corners(arm: RobotModel) -> bool:
    return bool(2 ** sum(low < high for low, high in arm.ranges) <= MOST_CORNERS)


def _unfit(arm: RobotModel | None, record: LoopRecord) -> str:
    """Why (P) does not speak of this loop; empty where it does."""
    rules = {
        "asks for the arm itself: name one with robot = …": arm is not None,
        f"asks for the links of an arm of more than {FEW_JOINTS} joints": arm is None
        or arm.n <= FEW_JOINTS
        or isinstance(arm.dynamics, Chain),
        f"asks for at most {MOST_CORNERS} corners of the ranges of so many joints": arm is None
        or arm.n <= FEW_JOINTS
        or _few_corners(arm),
        "speaks of differences without a filter": (record.velocity, record.filter) == ("difference", ONE),
        "speaks of constant intervals: longest must be the period": record.longest in (None, record.period),
        f"speaks of delays to {MOST_DELAY} samples": record.delay <= MOST_DELAY,
        "supposes that the controller knows g(q)": record.knows_gravity,
        f"speaks of starts to {FARTHEST}° from the goal": record.within is None
        or 0 < record.within <= FARTHEST,
    }
    return next((f"(P) {rule}" for rule, fits in rules.items() if not fits), "")
