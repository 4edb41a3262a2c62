"""How large may ε₀ be? See ``lyapcheck epsilon``."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.answers.epsilon.certificates import certificates
from lyapcheck.answers.epsilon.data import result_data
from lyapcheck.answers.epsilon.kept import kept_epsilon
from lyapcheck.answers.epsilon.options import Options
from lyapcheck.answers.epsilon.words import exact
from lyapcheck.answers.sweep.arms import arm
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, answered
from lyapcheck.verdicts import Exit

OPTIONS = {"max_boxes": 100_000, "starts": 30}


def ask(questions: Sequence[Question], jobs: int) -> list[Answered]:
    """The four ε₀ of each gain set, over all ranges where there are some: ``proved`` if one is certified."""
    return [_asked(one, jobs) for one in questions]


def _asked(question: Question, jobs: int) -> Answered:
    known, options = arm(question.robot, question.variation), {**OPTIONS, **dict(question.options)}
    assert question.gains is not None
    asked = Options(jobs=jobs, ranges=bool(known.ranges), **options)
    result = kept_epsilon(question.gains, known.model, asked)
    return answered(
        question,
        VERDICTS[Exit.UNDECIDED if result.certified is None else Exit.PROVED],
        result_data(result),
        tuple(certificates(result).values()),
        "; ".join(text for kind, text in result.reasons.items() if kind == "certified" and not result.proof),
        eps0=exact(result.certified),
        falsified=exact(result.falsified),
    )
