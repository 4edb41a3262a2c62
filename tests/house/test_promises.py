"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.answers.check import ProofResult
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Code, Figure, Paragraph, Section, Table
from lyapcheck.promise import GUARDED, promises_as_seen
from tests.helpers.command import invoke

ROOT = Path(__file__).parents[2]
NEGATED = re.compile(r"\b(no|not|nothing|neither|none|cannot|un)\b[^.;:]*")
"""A sentence that something is not proved promises nothing."""
QUOTED = re.compile(r"`[^`]*`|--[\w-]+( [\w-]+)?|“[^”]*”")
"""Commands and options, whose names may be words of proof, and the words of an author."""
ASKED = {
    "robot": ["robot", "pendulum1"],
    "robot with ranges": ["robot", "buap3"],
    "table": ["table", "--m", "1:3", "--robot", "buap3", "--asymptotics"],
    "check": ["check", "scalar.py", "--m", "1"],
}


def said(answer: Answer) -> Iterator[str]:
    """What an answer says in words: no heads of columns, no keys, no code, no names that a script gives."""
    names = named(answer)
    yield from (text for text in _said(answer) if text not in names)


def named(answer: Answer) -> set[str]:
    """Names of claims and of parts of a proof, and words of its author."""
    rows = answer.claims if isinstance(answer, ProofResult) else ()
    return {name for row in rows for name in (row.id, row.section, row.comment, *row.uses)}


def _said(answer: Answer) -> Iterator[str]:
    document = answer.document()
    yield document.title
    yield from texts(document.body)
    for one in answer.annotations():
        yield one.message
    yield from values(answer.data())


def texts(blocks: tuple[Block, ...]) -> Iterator[str]:
    for block in blocks:
        if isinstance(block, Paragraph):
            yield block.text
        elif isinstance(block, Bullets):
            yield from block.items
        elif isinstance(block, Table):
            yield block.caption
            for row in block.rows:
                yield from row
        elif isinstance(block, Section):
            yield block.title
            yield from texts(block.blocks)
        elif isinstance(block, Figure):
            yield block.caption
        else:
            assert isinstance(block, Code)


def values(data: Any) -> Iterator[str]:
    if isinstance(data, str):
        yield data
    elif isinstance(data, dict):
        for value in data.values():
            yield from values(value)
    elif isinstance(data, (list, tuple)):
        for value in data:
            yield from values(value)


def words_of_proof(text: str) -> list[str]:
    """The guarded words of a text that promise something."""
    return GUARDED.findall(NEGATED.sub("", QUOTED.sub("", text)))


@pytest.mark.parametrize("words", ASKED.values(), ids=list(ASKED))
def test_every_word_of_proof_is_a_promise(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    answers: list[Answer] = []
    written = Answer.written
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(
        Answer, "written", lambda answer, *form: (answers.append(answer), written(answer, *form))[1]
    )
    with promises_as_seen():
        done = invoke(*words)
        assert answers, done.stderr
        left = [text for answer in answers for text in said(answer) if words_of_proof(text)]
    assert not left


def test_the_words_are_found() -> None:
    assert words_of_proof("✓ accepted; at most 3.2°")
    assert not words_of_proof("no ε₀ is certified")
    assert not words_of_proof("use `gate --condition stable` or --stable")
