"""The gate's answer: which gain sets hold the conditions, and what to change where they do not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lyapcheck.answers.gate.friction import friction_lines, held
from lyapcheck.answers.gate.judge import GateResult
from lyapcheck.answers.gate.remarks import remarks
from lyapcheck.answers.gate.words import FIELDS, RULES, Row, advices, exact
from lyapcheck.answers.running import running_sentences
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Document
from lyapcheck.output.fields import data
from lyapcheck.verdicts import Exit

LEVELS = {ACCEPTED: Level.PASSED, REJECTED: Level.FAILED, UNDECIDED: Level.UNDECIDED}


class GateAnswer(tuple[GateResult, ...], Answer):
    """The results of gain sets, in the order of their files."""

    schema = "lyapcheck/gate/1"

    @property
    def exit_code(self) -> Exit:
        """1 if any set is rejected, else 3 if any is undecided, else 0; strictly, undecided leads to 1."""
        result = {REJECTED if any(map(one.failed, one.failures)) else one.verdict for one in self}
        if REJECTED in result:
            return Exit.REFUTED
        return Exit.UNDECIDED if UNDECIDED in result or not result else Exit.PROVED

    def document(self) -> Document:
        """One gain set with its deciding checks, or a row a set."""
        from lyapcheck.answers.gate.document import document

        return document(self)

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, verdict, checks: [...]}]``, numbers as decimal strings, limits enclosed."""
        return {"results": [_data(result) for result in self]}

    def records(self) -> list[dict[str, Any]]:
        """A row a check."""
        return [
            {"name": result.name, "m": result.m, **data(FIELDS, Row(result, check))}
            for result in self
            for check in result.checks
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set, at the first gain that breaks a condition."""
        return [annotation for result in self for annotation in _annotations(result)]


def _data(result: GateResult) -> dict[str, Any]:
    stable = result.stable
    return {
        "name": result.name,
        "file": result.file.path,
        "family": result.gains.family,
        "m": result.m,
        "verdict": result.spoken,
        "standing": result.spoken_standing,
        "deciding": list(result.deciding),
        "strict": result.strict,
        "loop": None if result.record is None else result.record.text,
        "stable_otherwise": None if stable is None else {"condition": stable.id, "eps0": exact(stable)},
        "remarks": remarks(result),
        "assumptions": list(result.rests_on),
        "checks": [data(FIELDS, Row(result, check)) for check in result.checks],
    }


def _annotations(result: GateResult) -> Iterator[Annotation]:
    """One case for the set; where it passes, also what dry friction makes of its gains."""
    first = next(iter(result.failures), None)
    place = result.file.place(result.gains, *(() if first is None else (RULES[first.id].key, first.joint)))
    level = LEVELS[result.verdict]
    if result.strict and level is Level.UNDECIDED:
        level = Level.FAILED
    head = [] if result.standing in LEVELS else [result.spoken_standing]
    known = [*head, *advices(result), *(() if result.stable is None else remarks(result)[:1])]

    def said(level: Level, rule: str, text: str, message: str) -> Annotation:
        at = (0, 0) if place is None else (place.line, place.column)
        return Annotation(level, rule, text, result.name, "", message, result.file.path, *at)

    asked = "the gains meet " + ", ".join(f"({name})" for name in result.deciding)
    yield said(level, "gate", asked, "; ".join(known) if level is not Level.PASSED else "")
    model = result.limits.model
    stuck = list(held(result.gains, model)) if model is not None and level is Level.PASSED else []
    if model is not None and stuck:
        lines = friction_lines(result.gains, model, stuck)[: len(stuck)]
        yield said(Level.REMARK, "dry-friction", "γ k_p exceeds the dry friction", "; ".join(lines))
    run = running_sentences(result.checks, result.limits.joints) if level is Level.PASSED else []
    if run:
        yield said(Level.REMARK, "loop", "the loop as a computer runs it", "; ".join(run))
