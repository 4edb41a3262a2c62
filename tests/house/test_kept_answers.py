"""ε₀ and constants of an arm from the store: the same answer, judged again, and never believed."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from lyapcheck import store
from lyapcheck.answers.epsilon import EpsilonResult, epsilon, kept
from lyapcheck.answers.epsilon.certificates import certificates
from lyapcheck.answers.epsilon.kept import kept_epsilon
from lyapcheck.answers.robot import kept as kept_arm
from lyapcheck.answers.robot.kept import kept_constants
from lyapcheck.control.gains import GainSet
from lyapcheck.robots import RobotModel, load
from lyapcheck.robots.vary import Vary

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


@pytest.fixture(scope="module", params=[False, True], ids=["nominal", "ranges"])
def asked(request: pytest.FixtureRequest) -> tuple[RobotModel, bool, EpsilonResult]:
    """An arm, and its ε₀ computed once for all tests."""
    vary = (Vary.parsed("viscous=-10%..+10%"),) if request.param else ()
    model = load("pendulum1", vary=vary)
    result = epsilon(GAINS, model, ranges=request.param, **BUDGET)
    assert result.certified is not None
    assert result.witness is not None
    return model, request.param, result


def test_epsilon_is_found_again(monkeypatch: pytest.MonkeyPatch, asked: Any) -> None:
    model, ranges, first = asked
    monkeypatch.setattr(kept, "epsilon", lambda *gains, **budget: first)
    assert kept_epsilon(GAINS, model, ranges=ranges, **BUDGET) is first
    monkeypatch.setattr(kept, "epsilon", never)
    again = kept_epsilon(GAINS, model, ranges=ranges, **BUDGET)
    assert again.data() == first.data()
    texts = [{name: one.text() for name, one in certificates(result).items()} for result in (first, again)]
    assert texts[0] == texts[1]
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, model, ranges=ranges, max_boxes=301, starts=2)
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, load("pendulum1"), ranges=not ranges, **BUDGET)


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
    store.put(kept.question(GAINS, model, ranges=ranges, **BUDGET), kept.written(first))
    monkeypatch.setattr(kept, "epsilon", lambda *gains, **budget: first)
    assert kept_epsilon(GAINS, model, ranges=ranges, **BUDGET) is not first
    rewritten(place, change)
    result = kept_epsilon(GAINS, model, ranges=ranges, **BUDGET)
    assert result.data() == first.data()


def test_constants_of_an_arm_are_found_again(monkeypatch: pytest.MonkeyPatch) -> None:
    first = kept_constants(load("reyes-kelly2"), 500, None)
    monkeypatch.setattr(kept_arm, "arm_constants", never)
    assert kept_constants(load("reyes-kelly2"), 500, None) == first
