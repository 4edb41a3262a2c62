"""Putting the report of an arm together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lyapcheck.constants import Constant, arm_constants
from lyapcheck.robot_report.print_claims import print_claims
from lyapcheck.robot_report.properties import Property, properties
from lyapcheck.robots import RobotModel
from lyapcheck.verdicts import Exit, exit_code

Progress = Callable[[float, str], None]
MAX_BOXES = 200_000
"""Over the square of the number of joints: the budget that takes a minute or so."""
SMALL = 3
"""Up to so many joints the paper's script decides in seconds."""


@dataclass(frozen=True)
class RobotReport:
    """An arm with what was decided and certified about it, at its nominal parameters.

    Args:
        model: the arm.
        properties: 2.1 to 2.8.
        constants: from both sides.
        prints: claims about C and g as the source prints them; they do not touch the arm, whose C and g
            follow from M and the potential.
    """

    model: RobotModel
    properties: tuple[Property, ...]
    constants: tuple[Constant, ...]
    prints: tuple[Property, ...] = ()

    @property
    def exit_code(self) -> Exit:
        """0 all properties proved, 1 one refuted, 3 one undecided."""
        return exit_code(row.verdict for row in self.properties)


def build(
    model: RobotModel, max_boxes: int | None = None, on_progress: Progress | None = None
) -> RobotReport:
    """Certify the constants of an arm and decide its properties.

    Args:
        model: the arm.
        max_boxes: budget of each constant; by default fewer for more joints, whose boxes cost more.
        on_progress: told the share of the work done.
    """
    budget = MAX_BOXES // model.n**2 if max_boxes is None else max_boxes
    constants = arm_constants(model, budget, on_progress=on_progress)
    if on_progress is not None:
        on_progress(1.0, "properties 2.1–2.8")
    decided = properties(model, constants, by_script=model.n <= SMALL)
    return RobotReport(model, decided, constants, print_claims(model))
