"""What is known of an arm, as one answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lyapcheck.answers.robot.data import constant_data, property_data, report_data
from lyapcheck.answers.robot.facts import ArmFacts
from lyapcheck.answers.robot.page import evidence, page
from lyapcheck.answers.robot.properties import PropertyResult
from lyapcheck.output.annotations import Annotation, Level
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document
from lyapcheck.verdicts import Exit, Verdict, exit_code

LEVELS = {Verdict.PROVED: Level.PASSED, Verdict.REFUTED: Level.FAILED}
ROW_KEYS = ("id", "verdict", "grade", "statement", "method", "reason")


@dataclass(frozen=True)
class RobotReport(ArmFacts, Answer):
    """What is known of an arm as an answer; see `ArmFacts` for what it has."""

    schema = "lyapcheck/robot/1"

    @property
    def exit_code(self) -> Exit:
        """0 all properties proved, 1 one refuted, 3 one undecided."""
        return exit_code(row.verdict for row in self.properties)

    def document(self) -> Document:
        """Properties, constants, joints, every number with its source, and what is assumed."""
        return page(self)

    def data(self) -> dict[str, Any]:
        """``properties: [{id, verdict, …}], constants: [{name, lower, upper, …}], joints, numbers, …``."""
        return report_data(self)

    def records(self) -> list[dict[str, Any]]:
        """A row a property, a claim about the print, and a constant; ``kind`` says which."""
        judged = [("property", row) for row in self.properties] + [("print", row) for row in self.prints]
        entries = [(kind, property_data(row)) for kind, row in judged]
        rows = [{"kind": kind, **{key: row[key] for key in ROW_KEYS}} for kind, row in entries]
        for constant in self.constants:
            result = constant_data(self, constant)
            kept = {key: result[key] for key in ("unit", "certified", "numeric", "gap", "q")}
            rows.append({"kind": "constant", "id": result["name"], **kept, "x": result["x"] or []})
        return rows

    def annotations(self) -> list[Annotation]:
        """A case a property; a refuted claim about the print is a remark."""
        result = [self._annotation(row, LEVELS.get(row.verdict, Level.UNDECIDED)) for row in self.properties]
        wrong = [row for row in self.prints if row.verdict is not Verdict.PROVED]
        return [*result, *(self._annotation(row, Level.REMARK) for row in wrong)]

    def _annotation(self, row: PropertyResult, level: Level) -> Annotation:
        said = "" if level is Level.PASSED else f"{row.word}: {row.statement}; {evidence(row)}"
        rule = row.id.replace(" ", "-") if level is not Level.REMARK else f"print-{row.id.replace(' ', '-')}"
        return Annotation(level, rule, row.finding.says(row.statement), self.model.name, "", said, self.path)
