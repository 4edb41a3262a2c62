"""Gains as a computer runs them, on an arm of which the controller does not know all that pulls at it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.running.holds import HOLDS, HoldsCheck, falls, holds_checks, holds_sentences
from lyapcheck.answers.running.sampled import SAMPLED, AsRun, SampledCheck
from lyapcheck.control.conditions import ACCEPTED, REJECTED, Check
from lyapcheck.control.sampling import LoopRecord

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult

NO_PERIOD = "no period is known: add rate = … under [loop], or --rate"
INFINITE = "no [loop] gives a rate: judged for an infinite rate, as in (11)"


def running_checks(
    run: AsRun, deciding: Sequence[str] = (), others: Sequence[Check] = (), searched: bool = True
) -> tuple[Check, ...]:
    """The one place where an arm, gains and a record become statements that are judged.

    Args:
        run: all three; without a period an infinite rate is meant.
        deciding: conditions that must hold, whether the record speaks of them or not.
        others: the checks of (10i) and (10p), of which one has to pass for `sampled` to count.
        searched: whether to look for a refutation of what is not shown.
    """
    checks: list[Check] = []
    if run.record.period is not None:
        passed = [[one.verdict == ACCEPTED for one in others if one.id == name] for name in ("10i", "10p")]
        checks.append(run.check(any(each and all(each) for each in passed), searched))
    elif SAMPLED in deciding:
        checks.append(Check(SAMPLED, reason=NO_PERIOD))
    if HOLDS in deciding or not run.record.knows_gravity:
        checks += holds_checks(run.gains, run.limits.model, run.record, run.limits.room)
    return tuple(checks)


SUPPOSED = LoopRecord(period=Fraction(1, 1000))
"""What is supposed where no rate is known: one sample late, velocities by differences."""


def runs_of(result: GateResult) -> tuple[Check, ...]:
    """The checks of the loop of a result of the gate; without a rate what periods a supposed one serves."""
    known = tuple(check for check in result.checks if check.id in (SAMPLED, HOLDS))
    if any(check.id == SAMPLED for check in known):
        return known
    record = replace(SUPPOSED if result.record is None else result.record, period=SUPPOSED.period)
    run = AsRun(result.gains, result.limits, record, result.file.bounds.viscous_min)
    check = running_checks(run, (), result.checks)[0]
    return (replace(check, named=False) if isinstance(check, SampledCheck) else check, *known)


def running_sentences(
    checks: Sequence[Check], joints: Sequence[str], told: Sequence[Check] = ()
) -> list[str]:
    """What these checks show and refute, and why one does neither, unless that was told."""
    runs = [check for check in checks if check.id in (SAMPLED, HOLDS)]
    said = [text for one in runs if isinstance(one, SampledCheck) for text in one.sentences(one in told)]
    said += holds_sentences(runs, joints)
    fallen = [one for one in runs if isinstance(one, HoldsCheck) and one.verdict == REJECTED]
    said += [falls(one, joints) for one in fallen if one not in told]
    said += [f"({check.id}) {check.reason}" for check in runs if check.reason and check not in told]
    return said


def unstable_alone(checks: Sequence[Check]) -> str:
    """That the loop is unstable but for what acts on it; empty where that is not shown."""
    return next(
        (text for one in checks if isinstance(one, SampledCheck) and (text := one.unstable_alone)), ""
    )


def open_as_run(checks: Sequence[Check], unstable: bool = True) -> str:
    """Which of these is not decided, or for some starts only, for a headline; empty where none is.

    Args:
        checks: of a gain set.
        unstable: whether `unstable_alone` is said as well.
    """
    narrow = [f"{one.id} {one.narrow} only" for one in checks if one.narrow]
    open_ = dict.fromkeys(check.id for check in checks if check.id in (SAMPLED, HOLDS) and check.reason)
    alone = [text] if unstable and (text := unstable_alone(checks)) else []
    return "; ".join([*narrow, *([f"open: {', '.join(open_)}"] if open_ else []), *alone])
