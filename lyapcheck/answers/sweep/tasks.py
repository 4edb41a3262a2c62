"""The motion that the questions about motions are about."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lyapcheck.simulate.task import PAPER_TASK, Task, task_for

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

STEP = 45.0
"""Degrees, of every joint of an arm that the paper's experiment does not fit."""


def task_of(model: RobotModel, options: Mapping[str, Any]) -> Task:
    """From ``start`` to ``target``, in degrees: from home to the paper's goal, where nothing else is said.

    Raises:
        InputError: angles for another number of joints, or out of every range.
    """
    paper = PAPER_TASK.q_d if model.n == len(PAPER_TASK.q_d) else (math.radians(STEP),) * model.n
    target = tuple(map(math.radians, options["target"])) or paper
    start = tuple(map(math.radians, options["start"])) or (0.0,) * model.n
    return task_for(model.n, target, start, None, options["time"])
