"""One question of a sweep, about an arm that a process reads once, and what came of it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck.check.certificate import digest_of
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots import load
from lyapcheck.robots.vary import Vary
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


@dataclass(frozen=True)
class UncertainArm:
    """An arm with its uncertainties.

    Args:
        model: the arm.
        ranges: what varies.
        digest: of all its numbers.
        limits: by its name, as the gate takes them; read when it is first asked.
    """

    model: RobotModel
    ranges: tuple[Vary, ...]
    digest: str
    limits: dict[str, Limits] = field(default_factory=dict)


@lru_cache(maxsize=MOST)
def arm(robot: str, variation: tuple[str, ...] = ()) -> UncertainArm:
    """The arm of a name or file, with ranges as ``--vary`` takes them.

    Raises:
        InputError: no such arm, or a range of nothing that it has.
    """
    ranges = tuple(map(Vary.parsed, variation))
    model = load(robot, vary=ranges)
    return UncertainArm(model, ranges, store.exact(model))


@dataclass(frozen=True)
class Question:
    """A question about an arm, and a gain set where it is about one.

    Args:
        index: its place in the plan, from 0.
        robot: name or file of the arm.
        variation: ranges, as ``--vary`` takes them.
        gains: the gain set.
        ask: which question: a key of ``asks.OPTIONS``.
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
        return digest_of({**self.data, "name": "", "robot": arm(self.robot, self.variation).digest})

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
    known |= {"verdict": verdict, "reason": reason, "certificates": sorted(texts), "answer": data}
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
