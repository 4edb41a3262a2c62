"""What was judged, case by case: for systems that run checks and show the outcome at a line of a file."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Level(StrEnum):
    """How a case came out."""

    PASSED = "passed"
    FAILED = "failed"
    UNDECIDED = "undecided"
    REMARK = "remark"
    """Not a case: something that a reader of the others should know."""


@dataclass(frozen=True)
class Annotation:
    """One case.

    Args:
        level: how it came out.
        rule: the id of what was asked, the same wherever it is asked.
        rule_text: what was asked, in words or as a formula.
        group: what the case belongs to, such as a gain set.
        case: what distinguishes it there, such as a joint; with group and rule the same from run to run.
        message: what is wrong and what to do; empty where the case passed.
        path: the file it is about.
        line, column: the place there, from 1; 0 where there is none.
    """

    level: Level
    rule: str
    rule_text: str
    group: str
    case: str
    message: str
    path: str = ""
    line: int = 0
    column: int = 0

    @property
    def subject(self) -> str:
        """The group and the case."""
        return ": ".join(part for part in (self.group, self.case) if part)
