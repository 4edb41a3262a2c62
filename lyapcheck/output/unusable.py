"""The answer of a command whose input cannot be used: its problems, in every format that a program reads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lyapcheck.errors import Problem
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document


class Unusable(Answer):
    """Problems and nothing else."""

    def __init__(self, command: str, problems: Sequence[Problem]) -> None:
        self.schema = f"lyapcheck/{command}/problems/1"  # type: ignore[misc]
        self.problems = tuple(problems)

    def document(self) -> Document:
        """A sentence a problem."""
        return Document("! the input cannot be used", (Bullets(tuple(map(str, self.problems))),))

    def data(self) -> dict[str, Any]:
        """No results; what every format of a program adds is ``problems``."""
        return {"results": []}

    def records(self) -> list[dict[str, Any]]:
        """A row a problem."""
        return [problem.data() for problem in self.problems]
