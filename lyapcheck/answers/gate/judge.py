"""Judging gain sets by the conditions that the user wants to hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from lyapcheck._types import Progress, part, silent
from lyapcheck.answers.gate.promises import NO_GROUNDS, Grounds, grounds
from lyapcheck.answers.gate.stability import Prover
from lyapcheck.check.kinds.constant import Constant, ExactNumbers
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check, Conditions
from lyapcheck.control.gains import CERTIFICATES, DECIDING, KNOWN, RUNNING, GainFile, GainSet, deciding_for
from lyapcheck.control.judgement import judged_statement
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.control.sampling import UNSAID, LoopRecord, record_of
from lyapcheck.control.threshold import number
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.family.base import named
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.check.certificate import Certificate
    from lyapcheck.robots import ArmLike

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

    def __repr__(self) -> str:
        return f"<GateResult: {self.name}, {self.verdict}>"

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
    robot: ArmLike | None = None,
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
    unknown = ", ".join(name for name in asked or () if name not in KNOWN)
    if unknown:
        use = f"use some of: {', '.join(KNOWN)}"
        raise argument_error("conditions", unknown, "names no condition", use)
    limits = limits_for(gain_file, robot, arms)
    own = NOTHING if limits.model is None else limits.model.loop
    record = record_of(loop, gain_file.loop, own)
    conditions: dict[tuple[str, int | None], Conditions] = {}
    deciding = [deciding_for(gains, asked) for gains in gain_file.gains]
    kept, least = certificates_of(gain_file), gain_file.bounds.viscous_min
    prover = Prover(limits.model, least, limits.varied, kept)
    proved = _certificates(gain_file, prover, deciding, on_progress or silent)
    if any(proved) and limits.model is not None:
        granted = (*limits.ranges, *limits.gravity_notes, *prover.assumptions)
        limits = replace(limits, assumptions=granted)
    broken = [Check(GRAVITY, one.joint, one.refuted, one.bound) for one in limits.refuted if one.own]
    results: list[GateResult] = []
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
            from lyapcheck.answers.running.sampled import AsRun

            run = AsRun(gains, limits, record or UNSAID, least, kept)
            checks = (*checks, *running_checks(run, names, checks, more or not explained))
        asked_for = (*names, GRAVITY, DAMPED)
        passes = all(check.verdict == ACCEPTED for check in checks if check.id in asked_for)
        known = grounds(gains, limits, gain_file.bounds, names, checks) if passes else NO_GROUNDS
        result = GateResult(gain_file, gains, limits, checks, names, strict, None, more, known, record)
        # what breaks (19) may still be stable
        told = result.stable is not None or result.verdict_of((DAMPED,)) == REJECTED
        if more and not told and result.verdict_of(("19",)) == REJECTED:
            result = replace(result, otherwise=prover.otherwise(gains))
        results.append(result)
    return results


def _undamped(gains: GainSet) -> list[Check]:
    """A check that is refuted for each joint with k_v = 0."""
    positive = [Constant(Relation(("num", "0"), "<", number(kv))) for kv in gains.kv]
    return [
        Check(DAMPED, i, judged_statement(positive[i], [ExactNumbers()]), kv)
        for i, kv in enumerate(gains.kv)
        if kv == 0
    ]


def _certificates(
    gain_file: GainFile, prover: Prover, deciding: Sequence[Sequence[str]], progress: Progress
) -> list[tuple[Check, ...]]:
    """The checks of the proofs of stability that decide, for each gain set."""
    wanted = [[name for name in CERTIFICATES if name in names] for names in deciding]
    count, done = sum(map(len, wanted)), 0
    checks: list[tuple[Check, ...]] = []
    for gains, own in zip(gain_file.gains, wanted, strict=True):
        found = []
        for name in own:
            about = f"{gains.name}: {name} certificate"
            found.append(prover.check(name, gains, part(progress, done / count, (done + 1) / count, about)))
            done += 1
        checks.append(tuple(found))
    return checks


def certificates_of(file: GainFile) -> tuple[Certificate, ...]:
    """The certificates of the folder of a gain file, not yet judged; what is no certificate is left out.

    Raises:
        InputError: the folder cannot be read, or has no ``.json`` file.
    """
    if file.certificates is None:
        return ()
    from lyapcheck.check import kinds
    from lyapcheck.check.certificate import certificate_of
    from lyapcheck.check.recheck import Unreadable, content, gather

    kinds.load()
    try:
        documents = gather([file.certificates])
    except Unreadable as error:
        place = None if file.document is None else file.document.place(("certificates",))
        line, rule = None if place is None else place.line, error.problems[0][1]
        repair = "write the certificates there with gate … --certificates DIR, or remove the key"
        raise InputError(Problem(file.path, line, "certificates", file.certificates, rule, repair)) from None
    found = []
    for one in documents:
        try:
            found.append(certificate_of(content(one.path))[0])
        except (Refused, OSError, ValueError, RecursionError):  # certificates of other versions, other files
            continue
    return tuple(found)
