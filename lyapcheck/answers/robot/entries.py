"""The M(q) that statements name by a digest, written out once for those who read them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.check.kinds.inertia import mass_entries, mass_text
from lyapcheck.claims.moving_arm import ranges_of
from lyapcheck.output.document import Bullets, Section
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.inertia import mass_of

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

READABLE = 2000
"""Characters beyond which nobody reads a matrix; certificates have it."""


def inertia_sections(model: RobotModel) -> list[Section]:
    """M(q) with its ranges and at the nominal numbers, where its statements do not have the entries."""
    result: dict[str, Section] = {}
    for robot in (model, model.fixed()):
        if robot.chain is not None and robot.n > FEW_JOINTS:
            continue
        mass, ranges = mass_of(robot), ranges_of(robot)
        entries, title = mass_entries(mass, ranges), mass_text(mass, ranges).removeprefix("the ")
        if entries[0] not in title and sum(map(len, entries)) <= READABLE:
            names = (f"p{k + 1} is {name}" for k, name in enumerate(robot.parameters))
            result[title] = Section(title, (Bullets((*entries, *names)),))
    return list(result.values())
