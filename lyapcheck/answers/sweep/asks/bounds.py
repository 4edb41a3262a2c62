"""How far from the goal does dry friction let an arm rest? See ``lyapcheck bounds``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from lyapcheck.answers.bounds import certificates, compare, comparison_data
from lyapcheck.answers.sweep.question import (
    VERDICTS,
    Answered,
    Question,
    UncertainArm,
    answered,
    arm,
    task_of,
)
from lyapcheck.verdicts import Exit

OPTIONS = {"delta": 1.0, "time": 10.0, "target": (), "start": ()}


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """The bounds at rest of each gain set, for its arm's dry friction, and the simulated time."""
    varied = (known.model, known.ranges) if known.ranges else None
    model = arm(question.robot).model
    assert question.gains is not None
    task = task_of(model, options)
    delta = math.nextafter(math.radians(options["delta"]), 0.0)
    result = compare(question.gains, model, task, delta, varied=varied)
    return answered(
        question,
        VERDICTS[Exit.UNDECIDED]
        if result.promise is None or not result.proved
        else result.promise.says(VERDICTS[Exit.PROVED]),
        comparison_data(result),
        tuple(certificates(result).values()),
        result.reason,
        settling=result.simulated_time,
    )
