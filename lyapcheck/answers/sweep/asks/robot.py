"""What is known of an arm? See ``lyapcheck robot``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lyapcheck.answers.robot import build
from lyapcheck.answers.robot.answer import NOMINAL, extent
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, UncertainArm, answered
from lyapcheck.verdicts import Verdict

OPTIONS = {"max_boxes": 20_000}


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """Properties 2.1–2.8 and the constants of each arm: the worst verdict counts.

    Over a variation a property that is shown at nominal numbers only is undecided.
    """
    report = build(known.model, options["max_boxes"])
    verdict = VERDICTS[report.exit_code]
    nominal = [row.id for row in report.properties if known.ranges and extent(row, known.model) == NOMINAL]
    if verdict == Verdict.PROVED.value and nominal:
        reason = f"shown at {NOMINAL} only: {', '.join(nominal)}"
        return answered(
            question,
            Verdict.UNDECIDED.value,
            report.data(),
            tuple(report.certificates.values()),
            reason,
        )
    open_ones = [
        f"{row.id}: {row.finding.reason}" for row in report.properties if row.verdict.value == verdict
    ]
    reason = "; ".join(open_ones) if verdict in ("undecided", "error") else ""
    return answered(question, verdict, report.data(), tuple(report.certificates.values()), reason)
