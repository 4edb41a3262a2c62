"""ε₀ and constants of an arm from the store: the same answer, judged again, and never believed."""

from __future__ import annotations

import copy
import gzip
import json
from collections.abc import Callable
from dataclasses import fields
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from lyapcheck import store
from lyapcheck.answers.epsilon import EpsilonResult, epsilon, kept
from lyapcheck.answers.epsilon.certificates import certificates
from lyapcheck.answers.epsilon.kept import kept_epsilon
from lyapcheck.answers.epsilon.options import Options
from lyapcheck.answers.robot import kept as kept_arm
from lyapcheck.answers.robot.kept import kept_constants
from lyapcheck.check.judging import certificate_of
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.kernel.record import GRADE, accepted_before
from lyapcheck.report import kept as kept_report
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.gain_rows import EpsilonRow
from lyapcheck.report.jobs import rounded
from lyapcheck.report.subject import Subject
from lyapcheck.robots import RobotModel, load
from lyapcheck.robots.vary import Vary
from tests.arena.attacks import encoded, sealed
from tests.arena.run import ARENA
from tests.helpers.shares import one_in

GAINS = GainSet("one", 1, (Fraction(1, 2),), (Fraction(1, 10),))
BUDGET: dict[str, Any] = {"max_boxes": 300, "starts": 2}


@pytest.fixture(autouse=True)
def place(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.delenv(store.OFF)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "lyapcheck" / store.ANSWERS


def never(*arguments: Any, **options: Any) -> None:
    raise AssertionError("it was computed again")


def rewritten(place: Path, change: Callable[[Any], None]) -> None:
    """All that is kept, changed by someone who knows how it is sealed."""
    for path in place.iterdir():
        answer = json.loads(gzip.decompress(path.read_bytes()[:-32]))
        change(answer)
        store.keep(store.ANSWERS, path.name, gzip.compress(json.dumps(answer).encode()))


@cache
def computed(ranges: bool) -> tuple[RobotModel, bool, EpsilonResult]:
    """An arm, and its ε₀ computed once for all tests."""
    vary = (Vary.parsed("viscous=-10%..+10%"),) if ranges else ()
    model = load("pendulum1", vary=vary)
    result = epsilon(GAINS, model, ranges=ranges, **BUDGET)
    assert result.certified is not None
    assert result.witness is not None
    return model, ranges, result


@pytest.fixture(params=one_in(2, [False, True]), ids=["nominal", "ranges"])
def asked(request: pytest.FixtureRequest) -> tuple[RobotModel, bool, EpsilonResult]:
    return computed(request.param)


def test_epsilon_is_found_again(monkeypatch: pytest.MonkeyPatch, asked: Any) -> None:
    model, ranges, first = asked
    monkeypatch.setattr(kept, "four", lambda *asked: first)
    assert kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET)) is first
    monkeypatch.setattr(kept, "four", never)
    again = kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET))
    assert again.data() == first.data()
    texts = [{name: one.text() for name, one in certificates(result).items()} for result in (first, again)]
    assert texts[0] == texts[1]
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, model, Options(ranges=ranges, max_boxes=301, starts=2))
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, load("pendulum1"), Options(ranges=not ranges, **BUDGET))


@pytest.mark.parametrize(
    "change",
    [
        lambda answer: answer["proof"].update(eps0="1000"),
        lambda answer: answer["proof"]["proof"]["rate"].update(tree="0."),
        lambda answer: answer["witness"].update(eps0="1/1000"),
        lambda answer: answer["witness"]["state"].update(w=["0"]),
        lambda answer: answer["witness"]["arm"].update(viscous=["1000"]),
        lambda answer: answer.update(scalar="1000", published="1000"),
        lambda answer: answer["reasons"].update(scalar="there is none", published="(19) fails"),
        lambda answer: answer.pop("reasons"),
    ],
)
def test_an_epsilon_that_was_exchanged_is_asked_again(
    monkeypatch: pytest.MonkeyPatch, place: Path, asked: Any, change: Callable[[Any], None]
) -> None:
    model, ranges, first = asked
    store.put(kept.question(GAINS, model, Options(ranges=ranges, **BUDGET)), kept.written(first))
    monkeypatch.setattr(kept, "four", lambda *asked: first)
    assert kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET)) is not first
    rewritten(place, change)
    result = kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET))
    assert result.data() == first.data()


PATH = "certificates/published/one.json"


@pytest.fixture(scope="module")
def reported() -> tuple[Subject, dict[str, Any]]:
    """A report of one claim and one ε₀ as it is kept; reports have no ranges."""
    result = computed(ranges=False)[2]
    paths = {f"certificates/epsilon/{name}": one.text() for name, one in certificates(result).items()}
    files = {path: text for path, text in paths.items() if ".scalar." not in path}
    files[PATH] = (ARENA / "good" / "pub.12.json").read_text(encoding="utf-8")
    with kept_report._judging({PATH: files[PATH]}) as judged:
        answer = judged()[json.loads(files[PATH])["digest"]]
    row: dict[str, Any] = {field.name: () for field in fields(ClaimRow)} | {"witness": None, "evidence": {}}
    row |= {name: value for name, value in answer.items() if name in row}
    shown, _ = certificate_of(files[PATH].encode())
    if accepted_before(shown.statement, shown.proof, shown.verdict):
        row["grade"] = GRADE
    ends = {
        kind: rounded(getattr(result, kind), up=kind == "falsified") for kind in ("certified", "falsified")
    }
    own = {path.split(".")[-2]: path for path in files if path != PATH}
    shown_row = dict.fromkeys(field.name for field in fields(EpsilonRow)) | {"assumptions": (), "reasons": {}}
    rest: dict[str, Any] = dict.fromkeys(("others", "runs", "cells"), ())
    rest |= {"small": {}, "figures": {}, "sensitivity": None}
    kept = {**rest, "claims": [row], "epsilon": [shown_row | {"name": "one", "certificates": own, **ends}]}
    gains = GainFile("gains.toml", "pendulum1", (GAINS,))
    return Subject("pendulum1", (1,), (gains,), own=True), {**kept, "certificates": files}


def of_another_statement(kept: dict[str, Any]) -> None:
    """Another true one, x·y = x·y, under the id and by the rule of the claim."""
    other = json.loads(kept["certificates"][PATH])
    product = ["dot", ["vec", "x"], ["vec", "y"]]
    other["statement"] |= {"left": product, "right": product, "rates": [], "given": [], "symmetric": []}
    kept["certificates"][PATH] = encoded(sealed(other)).decode()
    kept["claims"][0]["digest"] = sealed(other)["digest"]


def of_other_gains(kept: dict[str, Any]) -> None:
    kept["epsilon"][0]["name"] = "two"


def of_less_granted(kept: dict[str, Any]) -> None:
    kept["claims"][0]["granted"] = ["nothing"]


@pytest.mark.slow
def test_a_report_is_found_again(reported: Any) -> None:
    subject, kept = reported
    assert kept_report.read(copy.deepcopy(kept), subject) is not None


@pytest.mark.slow
@pytest.mark.parametrize("change", [of_another_statement, of_other_gains, of_less_granted])
def test_a_report_that_was_exchanged_is_made_anew(reported: Any, change: Callable[[Any], None]) -> None:
    subject, kept = reported
    change(changed := copy.deepcopy(kept))
    assert kept_report.read(changed, subject) is None


def test_constants_of_an_arm_are_found_again(monkeypatch: pytest.MonkeyPatch) -> None:
    first = kept_constants(load("reyes-kelly2"), 500, None)
    monkeypatch.setattr(kept_arm, "arm_constants", never)
    assert kept_constants(load("reyes-kelly2"), 500, None) == first
