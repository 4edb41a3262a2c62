"""The questions of a sweep: each is answered of some gain sets on one arm, as its command answers it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from lyapcheck.answers.sweep.question import (
    VERDICTS,
    Answered,
    Question,
    UncertainArm,
    answered,
    arm,
    task_of,
)
from lyapcheck.output.digits import at_least
from lyapcheck.verdicts import Exit, Verdict

OBSERVED = "observed"
"""What a run that breaks no promise is called: it proves nothing."""
MEMBER = "a proof script is about members of the hyperbolic family; give m"
MARGIN_DIGITS = 6
Options = Mapping[str, Any]


def _gate(questions: Sequence[Question], known: UncertainArm, options: Options) -> Iterator[Answered]:
    """Whether each gain set is accepted, with the least margin as a share of its limit."""
    from lyapcheck.answers.gate.answer import GateAnswer
    from lyapcheck.answers.gate.certificates import running_certificates, whole
    from lyapcheck.answers.gate.judge import judged_sets
    from lyapcheck.control.conditions import UNDECIDED
    from lyapcheck.control.gains import GainFile
    from lyapcheck.control.limits import arm_limits, varied_limits
    from lyapcheck.control.sampling import loop_of_options

    robot, ranges = questions[0].robot, known.ranges
    if not known.limits:
        known.limits[robot] = varied_limits(robot, ranges) if ranges else arm_limits(robot)
    sets = tuple(replace(one.gains, index=k) for k, one in enumerate(questions) if one.gains is not None)
    loop = loop_of_options(dict(text.partition("=")[::2] for text in options["loop"]))
    asked = None, options["condition"] or None, options["gamma"]
    results = judged_sets(GainFile("plan", robot, sets, loop=loop), *asked, arms=known.limits, explained=0)
    rows = GateAnswer(results).data()["results"]
    for question, result, data in zip(questions, results, rows, strict=True):
        undecided = [check.reason for check in result.failures if check.verdict == UNDECIDED]
        reason = next(iter([*undecided, result.grounds.missing]), "") if result.verdict == UNDECIDED else ""
        shares = [
            check.margin / abs(check.limit.lower)
            for check in result.checks
            if check.id in result.deciding
            and check.margin is not None
            and check.limit is not None
            and check.limit.lower != 0
        ]
        margin = float(at_least(min(shares), MARGIN_DIGITS)) if shares else None
        made = (*running_certificates(result), *filter(None, [whole(result)]))
        yield answered(question, result.spoken, data, made, reason, margin=margin)


def _epsilon(question: Question, known: UncertainArm, options: Options) -> Answered:
    """The four ε₀, over all ranges where there are some: ``proved`` if one is certified."""
    from lyapcheck.answers.epsilon import Options as Asked
    from lyapcheck.answers.epsilon import certificates, kept_epsilon
    from lyapcheck.answers.epsilon.answer import FIELDS, exact
    from lyapcheck.output.fields import data

    assert question.gains is not None
    asked = Asked(ranges=bool(known.ranges), weights=False, **options)
    result = kept_epsilon(question.gains, known.model, asked)
    found = {"eps0": exact(result.certified), "falsified": exact(result.falsified)}
    reason = "" if result.proof else result.reasons.get("certified", "")
    made = tuple(certificates(result).values())
    verdict = _said(result.promise)
    return answered(question, verdict, data(FIELDS, result), made, reason, **found)


def _bounds(question: Question, known: UncertainArm, options: Options) -> Answered:
    """The bounds at rest for the arm's dry friction, and the simulated time."""
    from lyapcheck.answers.bounds import certificates, compare, comparison_data

    model = arm(question.robot).model
    varied = (known.model, known.ranges) if known.ranges else None
    assert question.gains is not None
    delta = math.nextafter(math.radians(options["delta"]), 0.0)
    result = compare(question.gains, model, task_of(model, options), delta, varied=varied)
    verdict, made = _said(result.promise if result.proved else None), tuple(certificates(result).values())
    data = comparison_data(result)
    return answered(question, verdict, data, made, result.reason, settling=result.simulated_time)


def _said(promise: Any) -> str:
    return VERDICTS[Exit.UNDECIDED] if promise is None else str(promise.says(VERDICTS[Exit.PROVED]))


def _simulate(question: Question, known: UncertainArm, options: Options) -> Answered:
    """One run, and one at each corner that is tried; the slowest of them counts. Observed, never proved."""
    from lyapcheck.answers.simulate.runs import SetPointRuns
    from lyapcheck.answers.simulate.simulation import Unfinished
    from lyapcheck.robots.vary import corners, corners_text
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.run import PromiseBroken, Run, SimulationFailed
    from lyapcheck.simulate.trial import experiment

    gains, task = question.gains, task_of(known.model, options)
    assert gains is not None
    mover = experiment if options["experiment"] else partial(simulate, stop=True)
    runs: list[Run] = []
    unfinished: list[Unfinished] = []
    cases, arms = [(gains, known.model)], ""
    if known.ranges:
        ends = corners(known.model, known.ranges)
        arms = f"one arm in the ranges and {corners_text(known.model, known.ranges)}"
        cases += [(replace(gains, name=f"{gains.name}: {what}"), model) for what, model in ends]
    for one, model in cases:
        try:
            runs.append(mover(one, model, task.q_d, task.q0, task.w0, task.T))
        except SimulationFailed as failure:
            if not isinstance(failure, PromiseBroken):
                unfinished.append(Unfinished(one.name, failure.reason))
            runs += [] if failure.partial is None else [failure.partial]
    result = SetPointRuns(tuple(runs), tuple(unfinished), arms=arms)
    verdict = OBSERVED if result.exit_code is Exit.PROVED else VERDICTS[result.exit_code]
    # nothing where one joint does not settle
    times = [math.nan if t is None else float(t) for run in runs for t in run.indices.settling]
    slowest = max(times) if times and all(map(math.isfinite, times)) else None
    return answered(question, verdict, result.data(), reason="; ".join(result.complaints()), settling=slowest)


def _robot(question: Question, known: UncertainArm, options: Options) -> Answered:
    """Properties 2.1–2.8 and the constants of each arm: the worst verdict counts.

    Over a variation a property that is shown at nominal numbers only is undecided.
    """
    from lyapcheck.answers.robot import build
    from lyapcheck.answers.robot.answer import NOMINAL, extent

    report = build(known.model, options["max_boxes"])
    verdict, reason = VERDICTS[report.exit_code], ""
    nominal = [row.id for row in report.properties if known.ranges and extent(row, known.model) == NOMINAL]
    if verdict == Verdict.PROVED.value and nominal:
        verdict, reason = Verdict.UNDECIDED.value, f"shown at {NOMINAL} only: {', '.join(nominal)}"
    elif report.exit_code in (Exit.UNDECIDED, Exit.INTERNAL):
        open_ = (row for row in report.properties if row.verdict.value == verdict)
        reason = "; ".join(f"{row.id}: {row.finding.reason}" for row in open_)
    return answered(question, verdict, report.data(), tuple(report.certificates.values()), reason)


def _check(question: Question, known: UncertainArm, options: Options) -> Answered:
    """Every claim of a script, or those named: the worst verdict counts."""
    from lyapcheck.answers.check.run import run_proof
    from lyapcheck.control.gains import GainFile

    gains = question.gains
    assert gains is not None
    if gains.m is None:
        return answered(question, VERDICTS[Exit.UNDECIDED], None, reason=MEMBER)
    file = GainFile("plan", question.robot, (gains,))
    result = run_proof(options["proof"], (gains.m,), known.model, None, file, options["only"])
    verdict = VERDICTS[result.exit_code]
    names = [row.id for row in result.claims if row.verdict.value == verdict]
    reason = "" if result.exit_code is Exit.PROVED else f"{verdict}: {', '.join(names)}"
    return answered(question, verdict, result.data(), tuple(result.certificates.values()), reason)


TOGETHER = "gate"
"""A question of which many are asked together."""
WITHOUT_GAINS = ("robot",)
"""What is asked of an arm alone."""
OPTIONS: Mapping[str, Options] = {
    "bounds": {"delta": 1.0, "time": 10.0, "target": (), "start": ()},
    "check": {"proof": "published.py", "only": ()},
    "epsilon": {"max_boxes": 100_000, "starts": 30},
    "gate": {"condition": (), "gamma": "true", "loop": ()},
    "robot": {"max_boxes": 20_000},
    "simulate": {"time": 5.0, "experiment": False, "target": (), "start": ()},
}
"""The questions, with what each may be asked with, and what holds where nothing is said."""
_ALONE: Mapping[str, Callable[[Question, UncertainArm, Options], Answered]] = {
    "bounds": _bounds,
    "check": _check,
    "epsilon": _epsilon,
    "robot": _robot,
    "simulate": _simulate,
}


def asked(questions: Sequence[Question], jobs: int) -> list[Answered]:
    """The answers to questions that differ in their gains alone; ``jobs`` processes may share one."""
    first = questions[0]
    known = arm(first.robot, first.variation)
    options = {**OPTIONS[first.ask], **dict(first.options), "jobs": jobs}
    if first.ask == TOGETHER:
        return list(_gate(questions, known, options))
    return [_ALONE[first.ask](one, known, options) for one in questions]
