"""The measure of prose finds the faults that it is for, and no text of the project is worse than recorded."""

import json

import pytest

from tests.house.prose import LIMITS, RECORD, faults, measure, paragraphs, texts, worse

CLEAN = (
    "The gate accepts the gains. Run `lyapcheck tune`.\n\n| what is | no prose |\n\n```\nwhat is code\n```\n"
)


def test_plain_sentences_have_no_fault():
    assert worse(measure(CLEAN), {}) == {}
    assert len(paragraphs(CLEAN)) == 1


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("What is taken is judged by the checker.", "hits"),
        ("The table has bounds beside the numbers.", "hits"),
        ("The gate accepts it; the arm stops.", "joined"),
        ("The arm " + "slowly " * 30 + "stops.", "long"),
        (" ".join(["The arm moves to the goal and stops there because friction"] * 2) + " acts.", "words"),
    ],
)
def test_each_kind_of_fault_is_found(text, kind):
    assert kind in worse(measure(text), {})


def test_a_recorded_text_may_only_get_better():
    text = "What is taken is judged by the checker."
    assert worse(measure(text), {"hits": 1}) == {}
    assert worse(measure(f"{text} {text}"), {"hits": 1}) == {"hits": 2}


def test_a_fault_is_listed_with_its_words():
    assert list(faults("The table has bounds beside the numbers.")) == [("beside", "next to, compared with")]


def test_no_text_is_worse_than_its_record():
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    assert not [name for name in record if name.endswith(".md")], "pages meet the limits"
    found = {name: worse(measure(text), record.get(name, {})) for name, text in texts().items()}
    assert {name: bad for name, bad in found.items() if bad} == {}
    assert set(LIMITS) == set(measure(""))
