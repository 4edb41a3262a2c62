"""What every answer can say of itself, and the formats by name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

from lyapcheck import output
from lyapcheck.extensions import defining
from lyapcheck.output.document import Bullets, Document
from lyapcheck.output.escapes import document_text

if TYPE_CHECKING:
    from lyapcheck.errors import Problem
    from lyapcheck.output.text import View

# --- What was judged, case by case: for systems that run checks and show the outcome at a line of a file.


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


OF_JUDGEMENTS = ("github", "junit", "sarif")
"""What only systems read that run checks."""
JUDGED_FORMATS = defining("render", output.__path__)
"""All that ``output`` has: for answers with verdicts."""
FORMATS = tuple(name for name in JUDGED_FORMATS if name not in OF_JUDGEMENTS)
"""What every answer can be written in."""
DOCUMENTS = ("markdown", "html", "latex")
"""Formats of the document alone."""


class Answer(ABC):
    """An answer to a question, ready for every format.

    ``print`` shows it as in a terminal, a notebook as HTML.
    """

    schema: ClassVar[str]
    """Name and version of its JSON, such as ``lyapcheck/gate/1``."""
    problems: Sequence[Problem] = ()
    """Input that could not be used; the rest was."""

    def __init_subclass__(cls, **settings: Any) -> None:
        super().__init_subclass__(**settings)
        cls.__repr__ = Answer.__repr__  # type: ignore[method-assign]  # that of a dataclass fills the screen

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.document().title}>"

    @abstractmethod
    def document(self) -> Document:
        """For people."""

    @abstractmethod
    def data(self) -> dict[str, Any]:
        """For programs: strings, numbers, lists and dicts; exact numbers as decimal strings."""

    def records(self) -> Sequence[Mapping[str, Any]]:
        """The rows of its CSV: one a result, or what is natural for it; one row in all without results."""
        data = self.data()
        rows: Sequence[Mapping[str, Any]] = data.get("results", [data])
        return rows

    def annotations(self) -> Sequence[Annotation]:
        """For systems that run checks; none where nothing is judged."""
        return ()

    def written(self, format: str, view: View | None = None) -> str:  # noqa: A002
        """The answer in a format, the same bytes for the same answer.

        Its ``render`` gets the answer; those of ``text`` and ``DOCUMENTS`` only the document of the answer.

        Args:
            format: a value of `JUDGED_FORMATS`: a file of ``output``.
            view: how much of a text is shown, how wide, whether in colour, and what the next command keeps.
        """
        renderer = import_module(f"lyapcheck.output.{format}")
        if format not in ("text", *DOCUMENTS):
            return document_text(renderer.render(self))
        whole = self.document()
        if view is not None and whole.next:
            whole = replace(whole, next=view.following(whole.next))
        if format == "text":
            shown: str = renderer.render(whole, view)
            return shown
        return document_text(renderer.render(whole))

    def __str__(self) -> str:
        return self.written("text").rstrip("\n")

    def _repr_html_(self) -> str:
        return self.written("html")


class Unusable(Answer):
    """The answer of a command whose input cannot be used: its problems, for every format of a program."""

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
