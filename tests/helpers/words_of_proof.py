"""Words of proof in answers: those left once promises say *seen* are not from a promise."""

import re
from contextlib import contextmanager

from lyapcheck.answers.check import ProofResult
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Code, Equation, Figure, Paragraph, Section, Table
from lyapcheck.promise import Promise
from tests.helpers.command import invoke

GUARDED = re.compile(r"\b(proved|certified|accepted|at most|at least|every|stable)\b", re.IGNORECASE)
"""Words that only a promise may say about an arm, its gains or its motions."""
NEGATED = re.compile(r"\b(no|not|nothing|neither|none|cannot|un)\b[^.;:]*")
"""A sentence that something is not proved promises nothing."""
QUOTED = re.compile(r"`[^`]*`|--[\w-]+( [\w-]+)?|“[^”]*”")
"""Commands and options, whose names may be words of proof, and the words of an author."""


@contextmanager
def promises_as_seen():
    """Have promises say *seen*, which shows every other way to a word of proof."""
    says = Promise.says
    Promise.says = lambda promise, words: GUARDED.sub("seen", words)
    try:
        yield
    finally:
        Promise.says = says


def left_over(words, monkeypatch):
    """What the answers of a command say of proof beside their promises."""
    answers = []
    written = Answer.written

    def kept(answer, *rest, **more):
        answers.append(answer)
        return written(answer, *rest, **more)

    monkeypatch.setattr(Answer, "written", kept)
    with promises_as_seen():
        done = invoke(*words)
        assert answers, done.stderr
        return [text for answer in answers for text in said(answer) if words_of_proof(text)]


def words_of_proof(text):
    """The guarded words of a text that promise something."""
    return GUARDED.findall(NEGATED.sub("", QUOTED.sub("", text)))


def said(answer):
    """What an answer says in words: no heads of columns, no keys, no code, no names that a script gives."""
    names = named(answer)
    yield from (text for text in _said(answer) if text not in names)


def named(answer):
    """Names of claims and of parts of a proof, and words of its author."""
    rows = answer.claims if isinstance(answer, ProofResult) else ()
    return {name for row in rows for name in (row.id, row.kind, row.section, row.comment, *row.uses)}


def _said(answer):
    document = answer.document()
    yield document.title
    yield from texts(document.body)
    for one in answer.annotations():
        yield one.message
    yield from values(answer.data())


def texts(blocks):
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
            assert isinstance(block, (Code, Equation))


def values(data):
    if isinstance(data, str):
        yield data
    elif isinstance(data, dict):
        for value in data.values():
            yield from values(value)
    elif isinstance(data, (list, tuple)):
        for value in data:
            yield from values(value)
