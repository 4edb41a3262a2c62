"""What does the closed loop do? See ``lyapcheck simulate``: floating point, observed and never proved."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from lyapcheck.answers.simulate.runs import SetPointRuns
from lyapcheck.answers.simulate.simulation import Unfinished
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, UncertainArm, answered, task_of
from lyapcheck.robots.vary import corners, corners_text
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.run import PromiseBroken, Run, SimulationFailed
from lyapcheck.simulate.trial import experiment
from lyapcheck.verdicts import Exit

OPTIONS = {"time": 5.0, "experiment": False, "target": (), "start": ()}
OBSERVED = "observed"
"""What a run that breaks no promise is called: it proves nothing."""


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """One run of each gain set, and one at each corner that is tried; the slowest of them counts."""
    gains, task = question.gains, task_of(known.model, options)
    assert gains is not None
    way = (task.q_d, task.q0, task.w0, task.T)
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
            runs.append(mover(one, model, *way))
        except SimulationFailed as failure:
            if not isinstance(failure, PromiseBroken):
                unfinished.append(Unfinished(one.name, failure.reason))
            runs += [] if failure.partial is None else [failure.partial]
    result = SetPointRuns(tuple(runs), tuple(unfinished), arms=arms)
    verdict = OBSERVED if result.exit_code is Exit.PROVED else VERDICTS[result.exit_code]
    return answered(
        question, verdict, result.data(), reason="; ".join(result.complaints()), settling=_slowest(runs)
    )


def _slowest(runs: Sequence[Run]) -> float | None:
    """s: when the last joint of the slowest run has settled; nothing where one does not."""
    times = [math.nan if t is None else float(t) for run in runs for t in run.indices.settling]
    return max(times) if times and all(map(math.isfinite, times)) else None
