"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Code, Figure, Paragraph, Section, Table
from lyapcheck.promise import GUARDED, promises_as_seen
from tests.helpers.command import invoke

ROOT = Path(__file__).parents[2]
NEGATED = re.compile(r"\b(no|not|nothing|neither|none|cannot|un)\b[^.;:]*")
"""A sentence that something is not proved promises nothing."""
QUOTED = re.compile(r"`[^`]*`|--[\w-]+( [\w-]+)?")
"""Commands and options, whose names may be words of proof."""
ASKED = {
    "gate": ["gate", "proofs/table2.toml"],
    "gate, a proof for the arm": ["gate", "proofs/table2.toml", "--condition", "10i", "--condition", "scalar"],
    "gate over ranges": ["gate", "proofs/table2.toml", "--vary", "viscous=-30%..+30%"],
    "tune": ["tune", "buap3", "--m", "1"],
    "epsilon": ["epsilon", "proofs/table2.toml", "--m", "1", "--max-boxes", "2000"],
    "bounds": ["bounds", "proofs/table2.toml"],
    "simulate": ["simulate", "proofs/table2.toml", "--time", "1"],
    "simulate the experiment": ["simulate", "proofs/table2.toml", "--time", "1", "--experiment"],
    "robot": ["robot", "pendulum1"],
    "robot with ranges": ["robot", "buap3"],
}


def said(answer: Answer) -> Iterator[str]:
    """What an answer says in words: no heads of columns, no keys, no code."""
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
        Answer, "written", lambda answer, *args, **kw: (answers.append(answer), written(answer, *args, **kw))[1]
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
