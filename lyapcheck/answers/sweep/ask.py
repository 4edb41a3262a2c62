"""Asking the questions of a sweep, in whatever process: each by the answer of the command of its name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from itertools import groupby

from lyapcheck.answers.sweep.arms import arm
from lyapcheck.answers.sweep.question import Answered, Question, answered
from lyapcheck.errors import InputError
from lyapcheck.extensions import modules
from lyapcheck.libraries import missing

PACKAGE = "lyapcheck.answers.sweep.asks"
ERROR = "error"
LIGHT = "gate"
"""A question of which many are asked together."""
TOGETHER = 100
"""So many of them: a worker is handed work for a tenth of a second at least."""

Batch = tuple[Question, ...]


def names() -> tuple[str, ...]:
    """The questions that can be asked: a file each."""
    return modules(import_module(PACKAGE).__path__)


def batches(questions: Iterable[Question]) -> Iterator[Batch]:
    """What is handed to a worker at once: a few questions in the order of the plan, one heavy one at most."""
    batch: list[Question] = []
    for question in questions:
        batch.append(question)
        if question.ask != LIGHT or len(batch) == TOGETHER:
            yield tuple(batch)
            batch = []
    if batch:
        yield tuple(batch)


def ask(batch: Sequence[Question], jobs: int = 1) -> list[Answered]:
    """What comes of some questions, in their order; what cannot be asked has the verdict ``error``.

    Args:
        batch: the questions.
        jobs: processes that may share one of them; they change no answer.
    """
    result: list[Answered] = []
    for (name, _, _, _), group in groupby(
        batch, key=lambda one: (one.ask, one.robot, one.variation, one.options)
    ):
        asked = list(group)
        try:
            result += _asked(name, asked, jobs)
        except Exception:
            result += [_alone(name, one, jobs) for one in asked]
    return result


def _asked(name: str, questions: Sequence[Question], jobs: int) -> list[Answered]:
    """Questions that differ in their gains alone."""
    module, first = import_module(f"{PACKAGE}.{name}"), questions[0]
    known = arm(first.robot, first.variation)
    options = {**module.OPTIONS, **dict(first.options), "jobs": jobs}
    if name == LIGHT:
        return list(module.ask(questions, known, options))
    return [module.ask(one, known, options) for one in questions]


def _alone(name: str, question: Question, jobs: int) -> Answered:
    """One question for itself, whatever it raises: the others must not be lost with it."""
    try:
        return _asked(name, [question], jobs)[0]
    except ImportError as error:
        lack = missing(error)  # which all the others lack, too
        if lack is not None:
            raise lack from None
        return failed(question, f"{type(error).__name__}: {error}")
    except InputError as error:
        return failed(question, "; ".join(map(str, error.problems)))
    except Exception as error:
        return failed(question, f"{type(error).__name__}: {error}")


def failed(question: Question, reason: str) -> Answered:
    """The row of a question that could not be asked."""
    return answered(question, ERROR, None, reason=reason)
