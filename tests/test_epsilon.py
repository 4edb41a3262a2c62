"""The four ε₀ of a gain set, and the command that prints them."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lyapcheck.admissible.compute import epsilon, round_down
from lyapcheck.admissible.consistency import Contradiction, require_consistent
from lyapcheck.admissible.formats import FORMATS, renderer
from lyapcheck.admissible.result import EpsilonResult
from lyapcheck.check.loop.states import confirms_positive
from lyapcheck.cli.main import build_app
from lyapcheck.control import GainSet, paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.robots import load
from lyapcheck.search.setting import Setting

F = Fraction
ARM = load("reyes-kelly2")
SETS = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains


@pytest.fixture(scope="module", params=[0, 1], ids=["m1", "m2"])
def case(request: pytest.FixtureRequest) -> tuple[GainSet, EpsilonResult]:
    return SETS[request.param], epsilon(SETS[request.param], ARM, starts=6, max_boxes=8_000)


def test_the_four_are_in_order(case: tuple[GainSet, EpsilonResult]) -> None:
    _, found = case
    assert found.scalar is not None
    assert found.certified is not None
    assert found.falsified is not None
    assert 0 < found.scalar <= found.certified <= found.falsified
    assert found.ratio == found.certified / found.falsified
    assert found.ratio > F(9, 10)


def test_witness_replays_and_does_not_reach_the_certified(case: tuple[GainSet, EpsilonResult]) -> None:
    gains, found = case
    setting = Setting(gains, ARM)
    assert found.witness is not None
    assert found.certified is not None
    assert confirms_positive(setting.arm, setting.controller, found.witness.eps0, found.witness.state)
    assert not confirms_positive(setting.arm, setting.controller, found.certified, found.witness.state)


def test_a_planted_certificate_raises_the_alarm(case: tuple[GainSet, EpsilonResult]) -> None:
    gains, found = case
    setting = Setting(gains, ARM)
    assert found.falsified is not None
    require_consistent(setting, found.witness, {"certified": found.certified, "scalar": found.scalar})
    with pytest.raises(Contradiction, match="certified"):
        require_consistent(setting, found.witness, {"certified": found.falsified * 2})
    with pytest.raises(Contradiction, match="scalar"):
        require_consistent(setting, found.witness, {"scalar": found.falsified})


@pytest.mark.parametrize("name", FORMATS)
def test_formats_are_pure(case: tuple[GainSet, EpsilonResult], name: str) -> None:
    _, found = case
    first = renderer(name)([found], None)
    assert first == renderer(name)([found], None)
    assert found.name in first
    assert "seconds" not in first
    assert "seconds" in renderer(name)([found], [1.5])


def test_json_numbers_are_exact_strings(case: tuple[GainSet, EpsilonResult]) -> None:
    _, found = case
    document = json.loads(renderer("json")([found], None))
    assert document["schema"] == "lyapcheck/epsilon/1"
    row = document["results"][0]
    for kind in ("published", "scalar", "certified", "falsified"):
        expected = getattr(found, kind)
        assert row[kind] is None if expected is None else F(row[kind]) == expected
    assert found.witness is not None
    assert [F(x) for x in row["witness"]["w"]] == list(found.witness.state.w)
    low, high = (F(row["witness"]["rate"][end]) for end in ("lower", "upper"))
    assert 0 < low <= found.witness.rate.lower <= found.witness.rate.upper <= high


def test_missing_numbers_are_shown_with_their_reason(case: tuple[GainSet, EpsilonResult]) -> None:
    _, found = case
    nothing = replace(
        found, certified=None, falsified=None, witness=None, reasons={"certified": "budget spent"}
    )
    assert nothing.ratio is None
    row = json.loads(renderer("json")([nothing], None))["results"][0]
    assert row["certified"] is None
    assert row["ratio"] is None
    assert row["reasons"] == {"certified": "budget spent"}
    assert "no certified ε₀: budget spent." in renderer("text")([nothing], None)


def test_pd_has_no_published_number() -> None:
    found = epsilon(
        GainSet("pd", None, (F(60), F(5)), (F(2), F(1)), "linear"), ARM, starts=6, max_boxes=20_000
    )
    assert found.published is None
    assert "γ" in found.reasons["published"]
    assert found.witness is not None


def test_gains_that_break_19_have_an_empty_18() -> None:
    found = epsilon(GainSet("strong", 1, (F(60), F(5)), (F(3), F(3))), ARM, starts=4, max_boxes=2_000)
    assert found.published is None
    assert "(19)" in found.reasons["published"]


@pytest.mark.parametrize(("value", "digits", "expected"), [("0.12345679", 3, "0.123"), ("0.5", 9, "0.5")])
def test_round_down(value: str, digits: int, expected: str) -> None:
    assert round_down(F(value), digits) == F(expected)


def run(*arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(build_app(("epsilon", "table")), ["epsilon", *arguments])
    if isinstance(result.exception, InputError):
        return 2, str(result.exception)
    return result.exit_code, result.stdout


def test_command_prints_the_same_bytes_twice() -> None:
    arguments = (
        str(paper_gain_file("table2_shoulder_elbow")),
        "--m",
        "2",
        "--starts",
        "3",
        "--max-boxes",
        "500",
        "--format",
        "json",
    )
    first, second = run(*arguments), run(*arguments)
    assert first == second
    assert first[0] == 0
    assert [row["m"] for row in json.loads(first[1])["results"]] == [2]


def test_gains_for_another_arm_are_refused_with_a_repair() -> None:
    code, text = run(str(paper_gain_file("table2")), "--robot", "reyes-kelly2")
    assert code == 2
    assert text.count("\n") == 2
    assert "3 joints" in text
    assert "choose an arm of 3 joints" in text


def test_missing_arm_and_missing_member_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "gains.toml"
    path.write_text('[[gains]]\nname = "a"\nm = 1\nkp = [1, 1]\nkv = [1, 1]\n')
    assert run(str(path))[0] == 2
    code, text = run(str(path), "--robot", "reyes-kelly2", "--m", "4")
    assert code == 2
    assert "choose from 1" in text


def test_a_spent_budget_is_undecided() -> None:
    path = str(paper_gain_file("table2_shoulder_elbow"))
    code, text = run(path, "--m", "2", "--starts", "3", "--max-boxes", "1")
    assert code in (0, 3)
    assert "scalar certificate" in text or "certified" in text
