"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from pathlib import Path

import pytest

from tests.helpers.words_of_proof import left_over, words_of_proof

ROOT = Path(__file__).parents[2]
ASKED = {
    "robot": ["robot", "pendulum1"],
    "robot with ranges": ["robot", "buap3"],
    "table": ["table", "--m", "1:3", "--robot", "buap3", "--asymptotics"],
    "check": ["check", "scalar.py", "--m", "1"],
    "derive": ["derive", "--m", "1,2", "--n", "2"],
}


@pytest.mark.parametrize("words", ASKED.values(), ids=list(ASKED))
def test_every_word_of_proof_is_a_promise(words, monkeypatch):
    assert not left_over(words, monkeypatch)


def test_the_words_are_found():
    assert words_of_proof("✓ accepted; at most 3.2°")
    assert not words_of_proof("no ε₀ is certified")
    assert not words_of_proof("use `gate --condition stable` or --stable")
