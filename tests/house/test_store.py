"""What is kept between runs: found again, whole or not at all, and judged anew."""

import gzip
import json

import pytest

from lyapcheck import store
from lyapcheck.answers.check import run as runs
from lyapcheck.claims import run_proof
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.arena.attacks import encoded, sealed
from tests.arena.run import ARENA

QUESTION = {"what": "<is it>"}


@pytest.fixture(autouse=True)
def place(monkeypatch, tmp_path):
    """A store of this test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(store.OFF)
    return tmp_path / "lyapcheck" / store.ANSWERS


def test_an_answer_is_found_under_its_question_alone():
    assert store.take(QUESTION) is None
    store.put(QUESTION, {"answer": ["λ", 1]})
    assert store.take(QUESTION) == {"answer": ["λ", 1]}
    assert store.take({"what": "another"}) is None


def test_another_version_asks_anew(monkeypatch):
    store.put(QUESTION, [1])
    monkeypatch.setattr(store, "source_digest", lambda: "another")
    assert store.take(QUESTION) is None


def test_nothing_is_taken_or_kept_where_it_is_off(monkeypatch, place):
    store.put(QUESTION, [1])
    monkeypatch.setenv(store.OFF, "1")
    assert store.take(QUESTION) is None
    store.put({"what": "more"}, [2])
    assert len(list(place.iterdir())) == 1


@pytest.mark.usefixtures("in_this_process")
def test_a_proof_is_found_again_and_judged_again(monkeypatch):
    first = run_proof("published.py", (1,), only=("7a",))

    def searched(statement):
        raise AssertionError("it was searched for again")

    monkeypatch.setattr(runs, "propose", searched)
    again = run_proof("published.py", (1,), only=("7a",))
    assert again.data() == first.data()
    assert again.claims[0].verdict is Verdict.PROVED


def of_another_statement(answer):
    """A true one, with its own digest."""
    text = (ARENA / "good" / "pub.12.json").read_text(encoding="utf-8")
    answer["certificates"]["search"] = text


def of_another_proof(answer):
    other = json.loads(answer["certificates"]["search"])
    other["proof"] = {"rule": "normal form"}
    answer["certificates"]["search"] = encoded(sealed(other)).decode()


def of_another_verdict(answer):
    other = json.loads(answer["certificates"]["search"])
    answer["certificates"]["search"] = encoded(sealed(other | {"verdict": "refuted"})).decode()


def no_text(answer):
    answer["beside"]["reason"] = {"no": "text"}


def no_witness(answer):
    answer["beside"]["witness"] = [3]


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    "change", [of_another_statement, of_another_proof, of_another_verdict, no_text, no_witness]
)
def test_a_proof_that_was_exchanged_is_searched_for_again(monkeypatch, place, change):
    """Even one whose own digest is right: the checker does not trust where it comes from."""
    first = run_proof("published.py", (1,), only=("7a",))
    asked = []
    for path in place.iterdir():
        answer = json.loads(gzip.decompress(path.read_bytes()[:-32]))
        change(answer)
        store.keep(store.ANSWERS, path.name, gzip.compress(json.dumps(answer).encode()))
    monkeypatch.setattr(runs, "propose", lambda statement: asked.append(statement) or propose(statement))
    assert run_proof("published.py", (1,), only=("7a",)).data() == first.data()
    assert asked
