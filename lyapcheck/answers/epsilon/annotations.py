"""What was judged of a gain set's ε₀, at its line of the gain file."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from lyapcheck.answers.epsilon.consistency import FINDINGS
from lyapcheck.answers.epsilon.words import witness_text
from lyapcheck.answers.gain_place import gain_place
from lyapcheck.output.annotations import Annotation, Level

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon.four import FourEpsilons
    from lyapcheck.control.gains import GainFile

CERTIFIED, FALSIFIED = "certified", "falsified"
RULES = {
    CERTIFIED: "V > 0 and dV/dt < 0 at all states but the origin, for some ε₀ > 0",
    FALSIFIED: "a state with dV/dt > 0",
    **FINDINGS,
}


def annotations_of(result: FourEpsilons, file: GainFile | None) -> list[Annotation]:
    """Whether an ε₀ is certified; then, as remarks, what is falsified and what follows from the numbers."""
    about = partial(Annotation, group=result.name, **gain_place(file, result.gains)._asdict())
    level = Level.UNDECIDED if result.promise is None else Level.PASSED
    message = f"no ε₀ is certified: {result.reasons.get(CERTIFIED, '')}" if result.promise is None else ""
    outcome = [about(level=level, rule=CERTIFIED, rule_text=RULES[CERTIFIED], case="ε₀", message=message)]
    said = {} if result.witness is None else {FALSIFIED: f"falsified {witness_text(result.witness)}"}
    said |= {rule: text for rule, text in FINDINGS.items() if text in result.findings}
    outcome += [
        about(level=Level.REMARK, rule=rule, rule_text=RULES[rule], case="ε₀", message=text)
        for rule, text in said.items()
    ]
    return outcome
