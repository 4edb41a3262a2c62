"""Do the gains hold the conditions? See ``lyapcheck gate``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from lyapcheck.answers.gate.answer import GateAnswer
from lyapcheck.answers.gate.certificates import running_certificates, whole
from lyapcheck.answers.gate.judge import GateResult, judged_sets
from lyapcheck.answers.sweep.question import Answered, Question, UncertainArm, answered
from lyapcheck.control.conditions import UNDECIDED
from lyapcheck.control.gains import GainFile
from lyapcheck.control.limits import arm_limits, varied_limits
from lyapcheck.control.sampling import loop_of_options
from lyapcheck.output.digits import at_least

OPTIONS: dict[str, Any] = {"condition": (), "gamma": "true", "loop": ()}
DIGITS = 6


def ask(questions: Sequence[Question], known: UncertainArm, options: Mapping[str, Any]) -> list[Answered]:
    """Whether each gain set is accepted, with the least margin as a share of its limit."""
    robot, ranges = questions[0].robot, known.ranges
    if not known.limits:
        known.limits[robot] = varied_limits(robot, ranges) if ranges else arm_limits(robot)
    sets = tuple(replace(one.gains, index=k) for k, one in enumerate(questions) if one.gains is not None)
    said = dict(text.partition("=")[::2] for text in options["loop"])
    file = GainFile("plan", robot, sets, loop=loop_of_options(said))
    asked = options["condition"] or None
    results = judged_sets(file, None, asked, options["gamma"], arms=known.limits, explained=0)
    return [
        _answered(question, result, data)
        for question, result, data in zip(
            questions, results, GateAnswer(results).data()["results"], strict=True
        )
    ]


def _answered(question: Question, result: GateResult, data: dict[str, object]) -> Answered:
    undecided = [check.reason for check in result.failures if check.verdict == UNDECIDED]
    reason = next(iter([*undecided, result.grounds.missing]), "") if result.verdict == UNDECIDED else ""
    certificate = whole(result)
    made = [*running_certificates(result), *([] if certificate is None else [certificate])]
    return answered(question, result.spoken, data, tuple(made), reason, margin=_margin(result))


def _margin(result: GateResult) -> float | None:
    """The least (limit − value)/limit of what decides, rounded down; below 0 where a condition is broken."""
    shares = [
        check.margin / abs(check.limit.lower)
        for check in result.checks
        if check.id in result.deciding
        and check.margin is not None
        and check.limit is not None
        and check.limit.lower != 0
    ]
    return float(at_least(min(shares), DIGITS)) if shares else None
