"""What holds of a proof script, for these gains on this arm? See ``lyapcheck check``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lyapcheck.answers.check.run import run_proof
from lyapcheck.answers.sweep.question import VERDICTS, Answered, Question, UncertainArm, answered
from lyapcheck.control.gains import GainFile
from lyapcheck.verdicts import Exit

OPTIONS = {"proof": "published.py", "only": ()}
MEMBER = "a proof script is about members of the hyperbolic family; give m"


def ask(question: Question, known: UncertainArm, options: Mapping[str, Any]) -> Answered:
    """Every claim of a script for each gain set, or those named: the worst verdict counts."""
    gains = question.gains
    assert gains is not None
    if gains.m is None:
        return answered(question, "undecided", None, reason=MEMBER)
    file = GainFile("plan", question.robot, (gains,))
    result = run_proof(options["proof"], (gains.m,), known.model, None, file, options["only"])
    verdict = VERDICTS[result.exit_code]
    names = [row.id for row in result.claims if row.verdict.value == verdict]
    reason = "" if result.exit_code is Exit.PROVED else f"{verdict}: {', '.join(names)}"
    return answered(question, verdict, result.data(), tuple(result.certificates.values()), reason)
