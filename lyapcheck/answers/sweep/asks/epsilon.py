"""How large may ε₀ be? See ``lyapcheck epsilon``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lyapcheck.answers.epsilon import Options, certificates, kept_epsilon
from lyapcheck.answers.epsilon.answer import FIELDS, exact
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, UncertainArm, answered
from lyapcheck.output.fields import data
from lyapcheck.verdicts import Exit

OPTIONS = {"max_boxes": 100_000, "starts": 30}


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """The four ε₀ of each gain set, over all ranges where there are some: ``proved`` if one is certified."""
    assert question.gains is not None
    asked = Options(ranges=bool(known.ranges), weights=False, **options)
    result = kept_epsilon(question.gains, known.model, asked)
    return answered(
        question,
        VERDICTS[Exit.UNDECIDED] if result.promise is None else result.promise.says(VERDICTS[Exit.PROVED]),
        data(FIELDS, result),
        tuple(certificates(result).values()),
        "; ".join(text for kind, text in result.reasons.items() if kind == "certified" and not result.proof),
        eps0=exact(result.certified),
        falsified=exact(result.falsified),
    )
