"""Words for extreme results: every answer in every format, with numbers and names that nobody expects."""

import csv
import io
import json
import re
from random import Random
from xml.etree import ElementTree

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from lyapcheck.answers.table import Table
from lyapcheck.output.answer import JUDGED_FORMATS, Answer
from tests.helpers.command import invoke, lyapcheck
from tests.helpers.redrawn import redrawn
from tests.helpers.urdf_texts import generic

pytestmark = pytest.mark.usefixtures("in_this_process")

GAINS = """robot = "pendulum1"
[[gains]]
name = "a"
m = 1
kp = [3]
kv = [0.05]
[[gains]]
name = "b"
m = 2
kp = [3]
kv = [2]
"""
PLAN = 'robots = ["pendulum1"]\nquestions = ["gate"]\n' + GAINS.partition("\n")[2]
SINE = 'kind = "sine"\namplitude = [10]\nfrequency = [2]\n'
SHORT = "--target 10 --time 0.1"
QUICK = {
    "gate": "gate g.toml",
    "tune": "tune pendulum1 --m 1,2",
    "simulate": f"simulate g.toml {SHORT}",
    "starts": f"simulate g.toml {SHORT} --runs 2",
    "table": "table --m 1,2 --digits 6",
    "check": "check scalar.py --m 1 --only h.odd",
    "robot": "robot pendulum1 --max-boxes 20",
}
SLOW = {
    "proof": "gate g.toml --condition 10i --condition scalar",
    "bench": "tune pendulum1 --m 1 --overshoot 5 --settle 3",
    "bounds": f"bounds g.toml {SHORT}",
    "epsilon": "epsilon g.toml --max-boxes 20 --starts 1",
    "tracking": "simulate g.toml --reference sine.toml --time 0.2",
    "export": "export g.toml --out c --rate 1000",
    "derive": "derive --m 1 --n 1",
    "explain": "explain 2.1",
    "sweep": "sweep plan.toml --out swept",
    "recheck": "recheck proofs --format csv",
    "ranges": "robot buap3 --max-boxes 20",
}
NO_NUMBER = re.compile(r"(?<![\w/.])[+-]?(?:nan|NaN|inf|Infinity)(?![\w(])|\bNone\b")


def refuse(text):
    raise ValueError(f"{text} is no JSON")


def strict(text):
    json.loads(text, parse_constant=refuse)


CHECKS = {
    "json": strict,
    "sarif": strict,
    "junit": ElementTree.fromstring,
    "csv": lambda text: list(csv.reader(io.StringIO(text), strict=True)),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("extremes")
    for name, text in {"g.toml": GAINS, "plan.toml": PLAN, "sine.toml": SINE}.items():
        (place / name).write_text(text)
    return place


def answer_of(words, folder, monkeypatch):
    """What a command finds."""
    answers = []
    monkeypatch.chdir(folder)
    written = Answer.written
    if words.startswith("recheck"):
        invoke(*["gate", "g.toml", "--certificates", "proofs"])
    with monkeypatch.context() as patch:
        patch.setattr(Answer, "written", lambda one, *form: (answers.append(one), written(one, *form))[1])
        done = invoke(*words.split())
    assert answers, done.stderr or done.exception
    return answers[-1]


def hold(answer):
    """Written in every format, without a word for what is no number."""
    for form in JUDGED_FORMATS:
        text = answer.written(form)
        found = [text[max(0, one.start() - 60) : one.end() + 20] for one in NO_NUMBER.finditer(text)]
        assert not found, (form, found[:2])
        CHECKS.get(form, str)(text)


def drawn(answer, examples, most):
    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=True,
        phases=(Phase.generate,),
        suppress_health_check=list(HealthCheck),
    )
    @given(st.integers(0, 2**32))
    def with_other_results(seed):
        hold(redrawn(answer, Random(seed).choice, most))

    with_other_results()


@pytest.mark.parametrize("name", QUICK)
def test_answers_have_words_for_extreme_results(name, folder, monkeypatch):
    drawn(answer_of(QUICK[name], folder, monkeypatch), 6, 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", QUICK | SLOW)
def test_answers_have_words_for_many_more(name, folder, monkeypatch):
    """Up to 300 results, of one and of three joints."""
    drawn(answer_of((QUICK | SLOW)[name], folder, monkeypatch), 40, 300)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words", ["gate twelve.toml", "tune twelve.urdf --m 1", f"simulate twelve.toml {SHORT}"]
)
def test_twelve_joints_have_words(words, folder, monkeypatch):
    (folder / "twelve.urdf").write_text(generic(12))
    gains = f'[[gains]]\nname = "a"\nm = 1\nkp = {[0.1] * 12}\nkv = {[0.01] * 12}\n'
    (folder / "twelve.toml").write_text('robot = "twelve.urdf"\n' + gains)
    goal = ",".join(["10"] * 12)
    drawn(answer_of(words.replace("--target 10", f"--target {goal}"), folder, monkeypatch), 10, 3)


@pytest.mark.parametrize("fault", ["document", "data"])
def test_a_fault_in_the_wording_costs_no_data(fault, folder, monkeypatch):
    def broken(answer):
        raise ZeroDivisionError(answer.schema)

    monkeypatch.chdir(folder)
    monkeypatch.setattr(Table, fault, broken)
    done = lyapcheck("table", "--m", "2", "--format", "text" if fault == "document" else "json")
    assert done.returncode == 4
    assert "internal error: ZeroDivisionError" in done.stderr
    shown = json.loads(done.stdout)
    assert shown["schema"] == "lyapcheck/table/1"
    assert "digits" in shown["data"]
