"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.control.gains import GainSet
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Code, Figure, Paragraph, Section, Table
from lyapcheck.promise import GUARDED, promises_as_seen
from lyapcheck.search.certified import CertifiedEpsilon, certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.rest import resting
from tests.helpers.command import invoke

NEGATED = re.compile(r"\b(no|not|nothing|neither|none|cannot|un)\b[^.;:]*")
"""A sentence that something is not proved promises nothing."""
QUOTED = re.compile(r"`[^`]*`|--[\w-]+( [\w-]+)?")
"""Commands and options, whose names may be words of proof."""
FILES = {
    "pendulum.toml": 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [5]\nkv = [0.2]\n',
    "arm.toml": """
robot = "reyes-kelly2"
[[gains]]
name = "stiff"
m = 1
kp = [60, 9]
kv = [0.1, 0.1]
[[gains]]
name = "weak"
m = 2
kp = [60, 1.7]
kv = [0.1, 0.1]
""",
    "wave.toml": 'kind = "sine"\namplitude = [20, 30]\nfrequency = [0.5, 0.25]\n',
    "plan.toml": """
robots = ["reyes-kelly2"]
variations = [[], ["coulomb=-10%..+20%"]]
questions = ["epsilon", "bounds", "simulate"]
[[gains]]
name = "stiff"
m = 1
kp = [60, 9]
kv = [0.1, 0.1]
[epsilon]
max_boxes = 60
starts = 1
[bounds]
time = 0.1
target = [45, 90]
[simulate]
time = 0.1
target = [45, 90]
""",
}
EPSILON = ("epsilon", "pendulum.toml", "--starts", "2", "--max-boxes", "60")
BOUNDS = ("bounds", "arm.toml", "--target", "45,90", "--time", "0.1")
SIMULATE = ("simulate", "arm.toml", "--time", "0.2")
TARGET = ("--target", "45,90")
ASKED = {
    "epsilon": EPSILON,
    "epsilon over ranges": (*EPSILON, "--vary", "viscous=-20%..+20%"),
    "epsilon with weights": (*EPSILON, "--weights"),
    "bounds": BOUNDS,
    "bounds over ranges": (*BOUNDS, "--vary", "coulomb=-10%..+20%"),
    "bounds of nothing": ("bounds", "pendulum.toml", "--target", "45", "--time", "0.1"),
    "simulate": (*SIMULATE, *TARGET),
    "simulate what breaks a promise": (*SIMULATE, *TARGET, "--eps0", "100"),
    "simulate the experiment": (*SIMULATE, *TARGET, "--experiment"),
    "simulate over ranges": (*SIMULATE, *TARGET, "--vary", "viscous=-20%..+20%"),
    "simulate many": (*SIMULATE, *TARGET, "--runs", "3"),
    "simulate along a reference": (*SIMULATE, "--reference", "wave.toml"),
    "sweep": ("sweep", "plan.toml", "--jobs", "1", "--out", "sweep"),
}
COSTLY = ("epsilon with weights", "sweep")


@pytest.fixture(autouse=True)
def in_a_folder_with_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


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


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(words, marks=[pytest.mark.slow] * (name in COSTLY), id=name)
        for name, words in ASKED.items()
    ],
)
def test_every_word_of_proof_is_a_promise(words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    answers: list[Answer] = []
    written = Answer.written

    def kept(answer: Answer, *rest: Any, **more: Any) -> str:
        answers.append(answer)
        return written(answer, *rest, **more)

    monkeypatch.setattr(Answer, "written", kept)
    with promises_as_seen():
        done = invoke(*words)
        assert answers, done.stderr
        left = [text for answer in answers for text in said(answer) if words_of_proof(text)]
    assert not left


def test_a_proof_about_the_nominal_arm_answers_no_question_about_ranges(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def nominal(controlled: ControlledArm, *rest: Any, **more: Any) -> CertifiedEpsilon:
        return certified_epsilon(replace(controlled, ranges=False), *rest, **more)

    monkeypatch.setattr("lyapcheck.answers.epsilon.compute.certified_epsilon", nominal)
    done = invoke(*EPSILON, "--vary", "viscous=-20%..+20%")
    assert done.exit_code == 3
    assert done.stdout.startswith("? no ε₀ is certified for one")
    assert "what is proved does not answer the question" in " ".join(done.stdout.split())


def test_a_proof_about_less_friction_or_larger_errors_answers_no_question_of_bounds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def easier(gains: GainSet, dry: Sequence[Fraction]) -> JudgedStatement | None:
        return resting(gains, [Fraction(9, 10) * f for f in dry])

    words = (*BOUNDS, "--friction", "1,0.5")
    assert invoke(*words).exit_code == 0
    monkeypatch.setattr("lyapcheck.answers.bounds.compare.resting", easier)
    done = invoke(*words)
    assert done.exit_code == 3
    assert done.stdout.startswith("? not all errors at rest are proved")
    assert "what is proved does not answer the question (Resting.torque" in " ".join(done.stdout.split())


def test_the_words_are_found() -> None:
    assert words_of_proof("✓ accepted; at most 3.2°")
    assert not words_of_proof("no ε₀ is certified")
    assert not words_of_proof("use `gate --condition stable` or --stable")
