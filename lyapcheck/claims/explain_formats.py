"""An explanation as text, JSON, Markdown and HTML."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import asdict
from textwrap import fill

from lyapcheck.claims.explain import SHOWN_MEMBER, Explanation, Part
from lyapcheck.notebook import html_paragraph, html_table
from lyapcheck.output.escapes import markdown_text

SCHEMA = "lyapcheck/explain/1"
WIDTH = 100
INDENT = 10


def text(found: Explanation) -> str:
    """Plain text, a paragraph a question."""
    lines = [_paragraph(found.id, _words(found))]
    for label, answers in _answers(found):
        lines += [_paragraph("" if number else label, answer) for number, answer in enumerate(answers)]
    return "\n".join(lines) + "\n"


def as_json(found: Explanation) -> str:
    """JSON of the schema ``lyapcheck/explain/1``."""
    data = asdict(found)
    for key in ("uses", "used_by"):
        data[key] = [{"id": known, "says": says} for known, says in data[key]]
    data |= {"shown_for_m": SHOWN_MEMBER, "run": _command(found)}
    return json.dumps({"schema": SCHEMA, **data}, ensure_ascii=False, indent=2) + "\n"


def markdown(found: Explanation) -> str:
    """A heading and a list."""
    lines = [f"## {markdown_text(found.id)}: {markdown_text(_words(found))}", ""]
    for label, answers in _answers(found):
        lines += [f"- **{label}** {markdown_text(' '.join(line.split()))}" for line in answers]
    return "\n".join(lines) + "\n"


def html(found: Explanation) -> str:
    """A table of questions and answers."""
    rows = [(label, " ".join(line.split())) for label, lines in _answers(found) for line in lines]
    return (
        html_paragraph(f"{found.id}: {_words(found)}")
        + "\n"
        + html_table(("question", "answer"), rows)
        + "\n"
    )


def _words(found: Explanation) -> str:
    """What the author calls it; what is decided stands below, rendered from data."""
    return f"“{found.says}” (the author's words)"


def renderer(name: str) -> Callable[[Explanation], str]:
    """The function that writes an explanation in a format."""
    return {"text": text, "json": as_json, "markdown": markdown}[name]


def _answers(found: Explanation) -> list[tuple[str, list[str]]]:
    """The questions in the order a reader asks them."""
    source = f" of {found.reference}" if found.reference else ""
    where = f"{found.place}{source}" if found.place else "not in the paper's text"
    return [
        ("where", [f"{where}; claimed in {found.script}"]),
        ("uses", _listed(found.uses)),
        ("used by", [", ".join(known for known, _ in found.used_by) or "no other claim"]),
        ("asks", _asked(found)),
        ("decided", list(found.procedures) or ["not for this arm and these gains"]),
        ("run", [_command(found)]),
    ]


def _listed(claims: Iterable[tuple[str, str]]) -> list[str]:
    return [f"{known}: {says}" for known, says in claims] or ["no other claim"]


def _asked(found: Explanation) -> list[str]:
    if found.lacking:
        return [found.lacking]
    return [*([f"for {found.case}:"] if found.case else []), *map(_part, found.parts)]


def _part(part: Part) -> str:
    name = f"{part.name}: " if part.name else ""
    return f"{name}{part.says or 'as said above, in data too long to print'} [{part.kind}]"


def _command(found: Explanation) -> str:
    return f"lyapcheck check {found.script} --only {found.id}"


def _paragraph(label: str, content: str) -> str:
    """Wrapped beside its label; the items of a list stay apart."""
    pieces = [piece for block in content.split("\n\n") for piece in _pieces(block)]
    lead = label.ljust(INDENT - 1) + " "
    return "\n".join(
        fill(
            " ".join(piece.split()),
            WIDTH,
            initial_indent=" " * INDENT if number else lead,
            subsequent_indent=" " * (INDENT + 2 if piece.startswith("- ") else INDENT),
        )
        for number, piece in enumerate(pieces)
    )


def _pieces(block: str) -> list[str]:
    """The items of a list, or the paragraph as a whole."""
    if not block.startswith("- "):
        return [block]
    return [f"- {item}" for item in block[2:].split("\n- ")]
