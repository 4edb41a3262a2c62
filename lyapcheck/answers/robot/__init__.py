"""What is known of an arm: properties 2.1–2.8, certified constants, and the numbers all of it rests on."""

from __future__ import annotations

from dataclasses import replace

from lyapcheck._types import Progress
from lyapcheck.answers.check.run import proposed_proof
from lyapcheck.answers.robot.answer import RobotReport
from lyapcheck.answers.robot.certified import bound_questions, certified
from lyapcheck.answers.robot.properties import IDS, answered, certificates, print_questions, properties
from lyapcheck.check.verify import each_once
from lyapcheck.claims.decision import file_name, judge_afresh
from lyapcheck.constants import arm_constants
from lyapcheck.robots import RobotModel
from lyapcheck.verdicts import Verdict

MAX_BOXES = 200_000
"""Over the square of the number of joints: the budget that takes a minute or so."""


def build(
    model: RobotModel, max_boxes: int | None = None, on_progress: Progress | None = None
) -> RobotReport:
    """Bound the constants of an arm and decide its properties.

    Args:
        model: the arm.
        max_boxes: budget of each constant; by default fewer for more joints, whose boxes cost more.
        on_progress: receives the share of the work done.

    Soundness: what is called proved, refuted or certified is what a fresh process of the checker accepts.
    """
    budget = MAX_BOXES // model.n**2 if max_boxes is None else max_boxes
    # searches ask the rules about what they find, property 2.6 about the bound of k_c; no verdict comes of it
    with each_once():
        constants = arm_constants(model, budget, on_progress=on_progress)
        if on_progress is not None:
            on_progress(1.0, "properties 2.1–2.8")
        proposed = proposed_proof("published.py", [1], model, only=IDS)
    prints, bounds = list(print_questions(model)), list(bound_questions(model, constants))
    made = certificates(model, [*prints, *bounds])
    # one process for all, in which what several rest on is judged once
    judged = judge_afresh({**proposed.certificates, **made})
    decided, of_properties = properties(model, proposed.result(judged))
    positive = decided[0].verdict is Verdict.PROVED
    about_prints, about_bounds = answered(model, prints, made, judged), answered(model, bounds, made, judged)
    own = {
        file_name(row.id, None): row.certificate
        for row in [*about_prints, *about_bounds]
        if row.certificate is not None
    }
    shown = (replace(row, id=row.id.removeprefix("printed ")) for row in about_prints)
    return RobotReport(
        model,
        decided,
        constants,
        tuple(shown),
        certified(about_bounds, positive),
        {**of_properties, **own},
    )
