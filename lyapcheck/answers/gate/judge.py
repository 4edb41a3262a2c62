"""Judging gain sets by the conditions that the user wants to hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.folder import certificates_of
from lyapcheck.answers.gate.promises import NO_GROUNDS, GateQuestions, Grounds
from lyapcheck.check.kinds.constant import Constant, ExactNumbers
from lyapcheck.check.statement import Relation
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check, Conditions
from lyapcheck.control.gains import CERTIFICATES, DECIDING, KNOWN, RUNNING, GainFile, GainSet, deciding_for
from lyapcheck.control.judgement import judged_statement
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.control.sampling import LoopRecord, record_of
from lyapcheck.control.threshold import number
from lyapcheck.errors import argument_error
from lyapcheck.family.base import named
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck._types import Progress
    from lyapcheck.check.certificate import Certificate

BREAKS_19 = "breaks (19), stability proved otherwise"
"""What is said of a rejected set that its users may still want."""
DAMPED = "damped"
"""A joint with k_v = 0: it is rejected, as the theory asks for K_v > 0."""
GRAVITY = "gravity"
"""A stated bound that the arm itself breaks: it is rejected, whatever else decides."""
MOST_EXPLAINED = 300
"""Gain sets of a file of which more is found out than whether they pass."""


@dataclass(frozen=True)
class GateResult:
    """Result of the gate for one gain set. ``verdict`` follows from the deciding checks alone.

    Args:
        file: the file of the set.
        gains: the set.
        limits: of the arm.
        checks: of (10), (10p) and (19), of the certificates that decide, of the loop as it is run, and of
            stated bounds of gravity that the arm breaks.
        deciding: the conditions that must hold.
        strict: True counts undecided as a failure.
        otherwise: a proof of stability for gains that violate (19), if one was found.
        explained: True adds notes about the set to its checks.
        grounds: the promises on which the set is accepted, or why it is not.
        record: the sampled loop, or None without a rate.
    """

    file: GainFile
    gains: GainSet
    limits: Limits
    checks: tuple[Check, ...]
    deciding: tuple[str, ...] = DECIDING
    strict: bool = False
    otherwise: Check | None = None
    explained: bool = False
    grounds: Grounds = NO_GROUNDS
    record: LoopRecord | None = None

    @property
    def name(self) -> str:
        """The gain set's name."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """The member of the hyperbolic family."""
        return self.gains.m

    @cached_property
    def verdict(self) -> str:
        """``rejected`` if a deciding check is, else ``undecided`` if one is, else ``accepted``.

        Without a promise about the arm as it was given, checks that all pass are ``undecided``.
        """
        result = self.verdict_of((*self.deciding, GRAVITY, DAMPED, *self.broken))
        return UNDECIDED if result == ACCEPTED and not self.grounds.promises else result

    @property
    def saturates(self) -> bool:
        """Whether (10i) fails, so that nothing keeps a motor within its limit."""
        return self.verdict_of(("10i",)) == REJECTED

    @property
    def standing(self) -> str:
        """The verdict in words: what breaks nothing but (19), and is proved stable, is set apart."""
        others = tuple(name for name in self.deciding if name != "19")
        if self.verdict != REJECTED or self.stable is None or self.saturates or self.broken:
            return self.verdict
        return BREAKS_19 if not others or self.verdict_of(others) == ACCEPTED else self.verdict

    @property
    def rests_on(self) -> tuple[str, ...]:
        """What is taken for granted, in sentences."""
        return (*self.grounds.premises, *self.limits.assumptions)

    def says(self, words: str) -> str:
        """Words of proof about a set that is accepted.

        Raises:
            Refused: it is not.
        """
        return all_say(self.grounds.promises, words)

    @property
    def spoken(self) -> str:
        """The verdict as it may be said."""
        return self.says(self.verdict) if self.verdict == ACCEPTED else self.verdict

    @property
    def spoken_standing(self) -> str:
        """The standing as it may be said."""
        if self.standing == BREAKS_19 and self.stable is not None:
            return self.stable.own_promise.says(BREAKS_19)
        return self.spoken

    @cached_property
    def stable(self) -> Check | None:
        """The proof of stability with the larger ε₀, whatever (19) says; ``None`` without one.

        Soundness: it was accepted by ``lyapcheck.check.verify``.
        """
        known = [check for check in self.checks if check.id in CERTIFICATES and check.verdict == ACCEPTED]
        known += [] if self.otherwise is None else [self.otherwise]
        return max(known, key=lambda check: check.value or 0, default=None)

    def verdict_of(self, conditions: Sequence[str]) -> str:
        """The verdict that some of the conditions give together."""
        result = {check.verdict for check in self.checks if check.id in conditions}
        if REJECTED in result:
            return REJECTED
        return UNDECIDED if UNDECIDED in result or not result else ACCEPTED

    def failed(self, check: Check) -> bool:
        """Whether a check counts as a failure, and not as a warning."""
        return check.verdict == REJECTED or (self.strict and check.verdict == UNDECIDED)

    @property
    def failures(self) -> tuple[Check, ...]:
        """The deciding checks that were not accepted."""
        return tuple([check for check in self.checks if check.verdict != ACCEPTED and self.decides(check)])

    def decides(self, check: Check) -> bool:
        """Whether the verdict follows from a check."""
        return check.id in (*self.deciding, GRAVITY, DAMPED) or (
            check.id in self.broken and check.verdict == REJECTED
        )

    @property
    def broken(self) -> tuple[str, ...]:
        """What decides without being asked for, since it is rejected."""
        names = (GRAVITY, DAMPED, *RUNNING)
        return tuple(check.id for check in self.checks if check.id in names and check.verdict == REJECTED)


def judged_sets(
    gain_file: GainFile,
    robot: str | None = None,
    asked: Sequence[str] | None = None,
    strict: bool = False,
    arms: dict[str, Limits] | None = None,
    explained: int = MOST_EXPLAINED,
    on_progress: Progress | None = None,
    loop: LoopEntry = NOTHING,
) -> list[GateResult]:
    """The results of a file, in its order; more than whether they pass of the first so many.

    ``asked`` are conditions that go before those of the sets; see ``lyapcheck.control.gains``.

    See :func:`lyapcheck.gate` for the rest.
    """
    _require_known(asked or ())
    limits = limits_for(gain_file, robot, arms)
    own = NOTHING if limits.model is None else limits.model.loop
    record = record_of(loop, gain_file.loop, own)
    conditions: dict[tuple[str, int | None], Conditions] = {}
    deciding = [deciding_for(gains, asked) for gains in gain_file.gains]
    kept = certificates_of(gain_file)
    proved, rests_on = _certificates(gain_file, limits, deciding, on_progress, kept)
    if rests_on:
        limits = replace(limits, assumptions=(*limits.ranges, *limits.gravity_notes, *rests_on))
    broken = [Check(GRAVITY, one.joint, one.refuted, one.bound) for one in limits.refuted if one.own]
    results: list[GateResult] = []
    questions = GateQuestions(gain_file, limits)
    for gains, names, certificates in zip(gain_file.gains, deciding, proved, strict=True):
        key = gains.family, gains.m
        if key not in conditions:
            conditions[key] = Conditions(limits, named(*key).gamma)
        # what (P) shows is not said in one word
        more = (record is not None and record.within is not None) or len(results) < explained
        undamped = _undamped(gains)
        checks = (*broken, *undamped, *conditions[key].all(gains, names), *certificates)
        if not undamped and (record is not None or set(RUNNING) & set(names)):
            from lyapcheck.answers.running import running_checks

            least, searched = gain_file.bounds.viscous_min, more or not explained
            running = running_checks(gains, limits, record, least, names, checks, searched, kept)
            checks = (*checks, *running)
        asked_for = (*names, GRAVITY, DAMPED)
        passes = all(check.verdict == ACCEPTED for check in checks if check.id in asked_for)
        grounds = questions.grounds(gains, names, checks) if passes else NO_GROUNDS
        result = GateResult(gain_file, gains, limits, checks, names, strict, None, more, grounds, record)
        results.append(_looked_into(result, gain_file.bounds.viscous_min) if more else result)
    return results


def _undamped(gains: GainSet) -> list[Check]:
    """A check that is refuted for each joint with k_v = 0."""
    positive = [Constant(Relation(("num", "0"), "<", number(kv))) for kv in gains.kv]
    return [
        Check(DAMPED, i, judged_statement(positive[i], [ExactNumbers()]), kv)
        for i, kv in enumerate(gains.kv)
        if kv == 0
    ]


def _looked_into(result: GateResult, viscous_min: Fraction | None) -> GateResult:
    """The same, with a proof of stability where (19) fails and none was asked for."""
    model = result.limits.model
    known = result.stable is not None or result.verdict_of((DAMPED,)) == REJECTED
    if known or model is None or result.verdict_of(("19",)) != REJECTED:
        return result
    from lyapcheck.answers.gate.otherwise import proved_otherwise

    return replace(result, otherwise=proved_otherwise(result.gains, model, viscous_min, result.limits.varied))


def _require_known(deciding: Sequence[str]) -> None:
    unknown = [name for name in deciding if name not in KNOWN]
    if unknown:
        raise argument_error(
            "conditions", ", ".join(unknown), "names no condition", f"use some of: {', '.join(KNOWN)}"
        )


def _certificates(
    gain_file: GainFile,
    limits: Limits,
    deciding: Sequence[Sequence[str]],
    on_progress: Progress | None,
    kept: Sequence[Certificate],
) -> tuple[list[tuple[Check, ...]], tuple[str, ...]]:
    """The checks of the certificates that decide, for each gain set, and what they take for granted."""
    wanted = [[name for name in CERTIFICATES if name in names] for names in deciding]
    if not any(wanted):
        return [()] * len(gain_file.gains), ()
    from lyapcheck._types import part, silent
    from lyapcheck.answers.gate.prover import Prover

    prover = Prover(limits.model, gain_file.bounds.viscous_min, limits.varied, kept)
    checks: list[tuple[Check, ...]] = []
    step, number = 1 / sum(map(len, wanted)), 0
    for gains, own in zip(gain_file.gains, wanted, strict=True):
        found = []
        for name in own:
            advance = part(
                on_progress or silent, number * step, (number + 1) * step, f"{gains.name}: {name} certificate"
            )
            found.append(prover.check(name, gains, advance))
            number += 1
        checks.append(tuple(found))
    return checks, prover.assumptions
