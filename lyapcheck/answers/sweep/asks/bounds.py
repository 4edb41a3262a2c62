"""How long does a motion take, and what do disturbances leave? See ``lyapcheck bounds``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from lyapcheck.answers.bounds.certificates import certificates
from lyapcheck.answers.bounds.compare import compare
from lyapcheck.answers.bounds.data import above, comparison_data
from lyapcheck.answers.sweep.arms import UncertainArm, arm
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, answered
from lyapcheck.answers.sweep.tasks import task_of
from lyapcheck.verdicts import Exit

OPTIONS = {"delta": 1.0, "time": 5.0, "max_boxes": 20_000, "target": (), "start": ()}


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """The certified settling time of each gain set, and what its arm's dry friction leaves."""
    varied = (known.model, known.ranges) if known.ranges else None
    model = arm(question.robot).model
    assert question.gains is not None
    task = task_of(model, options)
    delta = math.nextafter(math.radians(options["delta"]), 0.0)
    budget = {"max_boxes": options["max_boxes"], "jobs": options["jobs"]}
    result = compare(question.gains, model, task, delta, varied=varied, **budget)
    return answered(
        question,
        VERDICTS[Exit.PROVED if result.certified else Exit.UNDECIDED],
        comparison_data(result),
        tuple(certificates(result).values()),
        "" if result.certified else result.settling.reason or result.disturbance.reason,
        settling=result.simulated_time,
        settling_certified=above(result.settling.time),
    )
