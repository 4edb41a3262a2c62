"""The questions of a sweep: what one is, and its answer on one arm, as its command has it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck.check.certificate import digest_of
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_least
from lyapcheck.output.json import finite
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.simulate.task import PAPER_TASK, Task, task_for
from lyapcheck.verdicts import Exit, Verdict

if TYPE_CHECKING:
    from lyapcheck.certificate import Certificate
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

MOST = 16
"""Arms that a process keeps."""
Row = dict[str, Any]
COLUMNS: Mapping[str, str] = {
    "index": "integer",
    "question": "text",
    "robot": "text",
    "variation": "texts",
    "ask": "text",
    "name": "text",
    "family": "text",
    "m": "integer",
    "kp": "texts",
    "kv": "texts",
    "verdict": "text",
    "reason": "text",
    "margin": "number",
    "eps0": "text",
    "falsified": "text",
    "settling": "number",
    "certificates": "texts",
    "answer": "data",
}
"""The columns of a row, and what they hold; a cell that does not apply is empty."""
VERDICTS: Mapping[Exit, str] = {
    Exit.PROVED: Verdict.PROVED.value,
    Exit.REFUTED: Verdict.REFUTED.value,
    Exit.UNDECIDED: Verdict.UNDECIDED.value,
    Exit.INTERNAL: Verdict.ERROR.value,
}
"""What the exit codes of commands say."""
STEP = 45.0
"""Degrees, of every joint of an arm that the paper's experiment does not fit."""


@lru_cache(maxsize=MOST)
def arm(robot: str, variation: tuple[str, ...] = ()) -> tuple[RobotModel, str]:
    """The arm of a name or file, with ranges as ``--vary`` takes them, and the digest of all its numbers.

    Raises:
        InputError: no such arm, or a range of nothing that it has.
    """
    model = load(robot, vary=tuple(map(Vary.parsed, variation)))
    return model, store.exact(model)


@lru_cache(maxsize=MOST)
def limits(robot: str, variation: tuple[str, ...]) -> dict[str, Limits]:
    """Its limits by its name, as the gate takes them."""
    from lyapcheck.control.limits import limits_of

    return {robot: limits_of(arm(robot, variation)[0])}


@dataclass(frozen=True)
class Question:
    """A question about an arm, and a gain set where it is about one.

    Args:
        index: its place in the plan, from 0.
        robot: name or file of the arm.
        variation: ranges, as ``--vary`` takes them.
        gains: the gain set.
        ask: which question: a key of `OPTIONS`.
        options: what else it was asked with.
    """

    index: int
    robot: str
    variation: tuple[str, ...]
    gains: GainSet | None
    ask: str
    options: tuple[tuple[str, Any], ...] = ()

    @property
    def digest(self) -> str:
        """Of the arm with all its numbers, the gains and the options, whatever the gain set is called."""
        _, robot = arm(self.robot, self.variation)
        return digest_of({**self.data, "name": "", "robot": robot})

    @property
    def data(self) -> Row:
        """Its part of a row."""
        own: Row = {"robot": self.robot, "variation": list(self.variation), "ask": self.ask}
        own |= dict.fromkeys(("name", "family", "m", "kp", "kv", "condition"))
        if (gains := self.gains) is not None:
            own |= {"name": gains.name, "family": gains.family, "m": gains.m}
            own |= {key: list(map(decimal_text, getattr(gains, key))) for key in ("kp", "kv")}
            own["condition"] = list(gains.condition)
        options = {key: list(value) if isinstance(value, tuple) else value for key, value in self.options}
        return own | {"options": options}


@dataclass(frozen=True)
class Answered:
    """What came of a question.

    Args:
        row: its row, without certificates.
        certificates: by digest, as they are written to files.
    """

    row: Row
    certificates: Mapping[str, str] = field(default_factory=dict)


def answered(
    question: Question,
    verdict: str,
    data: Any,
    certificates: tuple[Certificate, ...] = (),
    reason: str = "",
    **cells: Any,
) -> Answered:
    """A row with its certificates.

    Args:
        question: what was asked.
        verdict: in the words of the command that answers it.
        data: what that command writes as JSON.
        certificates: behind the verdict.
        reason: why nothing was decided, where that is so.
        cells: of the other columns.
    """
    texts = {one.digest: one.text() for one in certificates}
    known = {"index": question.index, "question": question.digest, **question.data, **cells}
    known |= {"verdict": verdict, "reason": reason, "certificates": sorted(texts), "answer": finite(data)}
    return Answered({name: known.get(name) for name in COLUMNS}, texts)


def line_of(row: Row) -> str:
    """A row as one line of JSON, its columns in their order."""
    return json.dumps(row, ensure_ascii=False, allow_nan=False, separators=(",", ":")) + "\n"


def task_of(model: RobotModel, options: Mapping[str, Any]) -> Task:
    """From ``start`` to ``target``, in degrees: from home to the paper's goal, where nothing else is said.

    Raises:
        InputError: angles for another number of joints, or out of every range.
    """
    paper = PAPER_TASK.q_d if model.n == len(PAPER_TASK.q_d) else (math.radians(STEP),) * model.n
    target = tuple(map(math.radians, options["target"])) or paper
    start = tuple(map(math.radians, options["start"])) or (0.0,) * model.n
    return task_for(model.n, target, start, None, options["time"])


# --- Each question, answered as by its command.


OBSERVED = "observed"
"""What a run that breaks no promise is called: it proves nothing."""
SEEN = "seen"
"""What is called a sampled run with a limit cycle or a falling payload: it refutes nothing."""
MARGIN_DIGITS = 6
Options = Mapping[str, Any]


def _gate(questions: Sequence[Question], options: Options) -> Iterator[Answered]:
    """Whether each gain set is accepted, with the least margin as a share of its limit."""
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.answers.gate.certificates import running_certificates, whole
    from lyapcheck.answers.gate.judge import judged_sets
    from lyapcheck.control.conditions import UNDECIDED
    from lyapcheck.control.gains import GainFile
    from lyapcheck.control.sampling import loop_of_options

    robot, arms = questions[0].robot, limits(questions[0].robot, questions[0].variation)
    sets = tuple(replace(one.gains, index=k) for k, one in enumerate(questions) if one.gains is not None)
    loop = loop_of_options(dict(text.partition("=")[::2] for text in options["loop"]))
    file = GainFile("plan", robot, sets, loop=loop)
    results = judged_sets(file, None, options["condition"] or None, arms=arms, explained=0)
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


def _epsilon(question: Question, known: RobotModel, options: Options) -> Answered:
    """The four ε₀, over all ranges where there are some: ``proved`` if one is certified."""
    from lyapcheck.answers.epsilon import FIELDS
    from lyapcheck.answers.epsilon.compute import Options as Asked
    from lyapcheck.answers.epsilon.kept import certificates, kept_epsilon
    from lyapcheck.output.fields import data

    assert question.gains is not None
    asked = Asked(ranges=bool(known.varies), weights=False, **options)
    result = kept_epsilon(question.gains, known, asked)
    row = data(FIELDS, result)
    found = {"eps0": row["certified"], "falsified": row["falsified"]}
    reason = "" if result.proof else result.reasons.get("certified", "")
    made = tuple(certificates(result).values())
    verdict = _said(result.promise)
    return answered(question, verdict, row, made, reason, **found)


def _bounds(question: Question, known: RobotModel, options: Options) -> Answered:
    """The bounds at rest for the arm's dry friction, and the simulated time."""
    from lyapcheck.answers.bounds import certificates, compare, comparison_data
    from lyapcheck.control.sampling import record_of
    from lyapcheck.files.loop import NOTHING

    model, _ = arm(question.robot)
    varied = known if known.varies else None
    record = record_of(NOTHING, NOTHING, model.loop)
    assert question.gains is not None
    delta = math.nextafter(math.radians(options["delta"]), 0.0)
    result = compare(question.gains, model, task_of(model, options), delta, varied=varied, record=record)
    verdict, made = _said(result.promise if result.proved else None), tuple(certificates(result).values())
    if result.falls:
        verdict = VERDICTS[Exit.REFUTED]
    data = comparison_data(result)
    return answered(question, verdict, data, made, result.reason, settling=result.simulated_time)


def _said(promise: Any) -> str:
    return VERDICTS[Exit.UNDECIDED] if promise is None else str(promise.says(VERDICTS[Exit.PROVED]))


def _simulate(question: Question, known: RobotModel, options: Options) -> Answered:
    """One run, and one at each corner that is tried; the slowest of them counts. Observed, never proved."""
    from lyapcheck.answers.simulate.moved import moved, on_arms
    from lyapcheck.answers.simulate.runs import SetPointRuns
    from lyapcheck.control.sampling import record_of
    from lyapcheck.files.loop import NOTHING, LoopEntry
    from lyapcheck.robots.vary import corners
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.trial import experiment

    task, arms = task_of(known, options), ""
    others: tuple[tuple[str, RobotModel], ...] = ()
    assert question.gains is not None
    published = LoopEntry(period=Bench().period, delay=0) if options["experiment"] else NOTHING
    record = record_of(published, NOTHING, known.loop)
    mover = partial(simulate, stop=True) if record is None else partial(experiment, bench=Bench.of(record))
    if known.varies:
        tried, others = corners(known)
        arms = f"one arm in the ranges and {tried}"
    move = partial(mover, target_rad=task.q_d, start_rad=task.q0, velocity_rad=task.w0, T=task.T)
    runs, unfinished = moved(on_arms([question.gains], known, others), move)
    result = SetPointRuns(tuple(runs), tuple(unfinished), arms=arms)
    verdict = OBSERVED if result.exit_code is Exit.PROVED else VERDICTS[result.exit_code]
    verdict = SEEN if any(run.unrest is not None for run in runs) else verdict
    # nothing where one joint does not settle
    times = [math.nan if t is None else float(t) for run in runs for t in run.indices.settling]
    slowest = max(times) if times and all(map(math.isfinite, times)) else None
    return answered(question, verdict, result.data(), reason="; ".join(result.complaints()), settling=slowest)


def _robot(question: Question, known: RobotModel, options: Options) -> Answered:
    """Properties 2.1–2.8 and the constants of each arm: the worst verdict counts.

    Over a variation a property that is shown at nominal numbers only is undecided.
    """
    from lyapcheck.answers.robot import NOMINAL, build, extent

    report = build(known, options["max_boxes"])
    verdict, reason = VERDICTS[report.exit_code], ""
    nominal = [row.id for row in report.properties if known.varies and extent(row, known) == NOMINAL]
    if verdict == Verdict.PROVED.value and nominal:
        verdict, reason = Verdict.UNDECIDED.value, f"shown at {NOMINAL} only: {', '.join(nominal)}"
    elif report.exit_code in (Exit.UNDECIDED, Exit.INTERNAL):
        open_ = (row for row in report.properties if row.verdict.value == verdict)
        reason = "; ".join(f"{row.id}: {row.finding.reason}" for row in open_)
    return answered(question, verdict, report.data(), tuple(report.certificates.values()), reason)


TOGETHER = "gate"
"""A question of which many are asked together."""
WITHOUT_GAINS = ("robot",)
"""What is asked of an arm alone."""
OPTIONS: Mapping[str, Options] = {
    "bounds": {"delta": 1.0, "time": 10.0, "target": (), "start": ()},
    "epsilon": {"max_boxes": 100_000, "starts": 30},
    "gate": {"condition": (), "loop": ()},
    "robot": {"max_boxes": 2_000},
    "simulate": {"time": 5.0, "experiment": False, "target": (), "start": ()},
}
"""The questions, with what each may be asked with, and what holds where nothing is said."""
_ALONE: Mapping[str, Callable[[Question, RobotModel, Options], Answered]] = {
    "bounds": _bounds,
    "epsilon": _epsilon,
    "robot": _robot,
    "simulate": _simulate,
}


def answers(questions: Sequence[Question], jobs: int) -> list[Answered]:
    """The answers to questions that differ in their gains alone; ``jobs`` processes may share one."""
    first = questions[0]
    known, _ = arm(first.robot, first.variation)
    options = {**OPTIONS[first.ask], **dict(first.options), "jobs": jobs}
    if first.ask == TOGETHER:
        return list(_gate(questions, options))
    return [_ALONE[first.ask](one, known, options) for one in questions]
