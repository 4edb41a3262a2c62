"""Putting the report of an arm together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from lyapcheck.check.certificate import Certificate
from lyapcheck.claims.certificates import file_name
from lyapcheck.constants import Constant, arm_constants
from lyapcheck.robot_report import certified as ends
from lyapcheck.robot_report import print_claims
from lyapcheck.robot_report.certified import Certified
from lyapcheck.robot_report.judged import judged
from lyapcheck.robot_report.properties import Property, properties
from lyapcheck.robots import RobotModel
from lyapcheck.verdicts import Exit, Verdict, exit_code

Progress = Callable[[float, str], None]
MAX_BOXES = 200_000
"""Over the square of the number of joints: the budget that takes a minute or so."""


@dataclass(frozen=True)
class RobotReport:
    """An arm with what was decided and certified about it, at its nominal parameters.

    Args:
        model: the arm.
        properties: 2.1 to 2.8.
        constants: from both sides, in floating point.
        prints: claims about C and g as the source prints them; they do not touch the arm, whose C and g
            follow from M and the potential.
        certified: by the name of a constant its ends that a certificate shows.
        certificates: of all that is decided, by file name.
    """

    model: RobotModel
    properties: tuple[Property, ...]
    constants: tuple[Constant, ...]
    prints: tuple[Property, ...] = ()
    certified: Mapping[str, Certified] = field(default_factory=dict)
    certificates: Mapping[str, Certificate] = field(default_factory=dict)

    @property
    def exit_code(self) -> Exit:
        """0 all properties proved, 1 one refuted, 3 one undecided."""
        return exit_code(row.verdict for row in self.properties)


def build(
    model: RobotModel, max_boxes: int | None = None, on_progress: Progress | None = None
) -> RobotReport:
    """Bound the constants of an arm and decide its properties.

    Args:
        model: the arm.
        max_boxes: budget of each constant; by default fewer for more joints, whose boxes cost more.
        on_progress: told the share of the work done.

    Soundness: what is called proved, refuted or certified is what a fresh process of the checker accepts.
    """
    budget = MAX_BOXES // model.n**2 if max_boxes is None else max_boxes
    constants = arm_constants(model, budget, on_progress=on_progress)
    if on_progress is not None:
        on_progress(1.0, "properties 2.1–2.8")
    decided, made = properties(model)
    positive = decided[0].verdict is Verdict.PROVED
    prints = print_claims.questions(model)
    answers = judged(model, [*prints, *ends.questions(model, constants)])
    about_print, about_constants = answers[: len(prints)], answers[len(prints) :]
    own = {
        file_name(row.question.id, None): row.certificate for row in answers if row.certificate is not None
    }
    return RobotReport(
        model,
        decided,
        constants,
        tuple(map(print_claims.as_property, about_print)),
        ends.certified(about_constants, positive),
        {**made, **own},
    )
