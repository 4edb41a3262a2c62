"""For which arms a row of the report holds: all values of the ranges, or nominal numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.answers.robot.properties import PropertyResult
    from lyapcheck.robots import RobotModel

RANGES, NOMINAL = "all values of the ranges", "nominal numbers"


def uncertain(model: RobotModel) -> bool:
    """Whether the file gives a range to a number that the properties are about."""
    return any(number.ranged for number in (*model.parameters.values(), *model.viscous))


def extent(row: PropertyResult, model: RobotModel) -> str:
    """For which arms a decided row holds; empty where nothing is decided, and for an arm without ranges."""
    if row.finding.certificate is None or not uncertain(model):
        return ""
    return NOMINAL if row.over is None else RANGES


def together(ids: Sequence[str], every: Sequence[str]) -> str:
    """Some ids of a list, neighbours as a span: ``2.1, 2.3–2.5``."""
    spans: list[list[str]] = []
    for before, name in zip(["", *every], every, strict=False):
        if name in ids:
            if before in ids:
                spans[-1].append(name)
            else:
                spans.append([name])
    return ", ".join(f"{one[0]}–{one[-1]}" if len(one) > 2 else ", ".join(one) for one in spans)
