"""What ``lyapcheck bounds`` says of certified bounds beside a run."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.bounds.answer import Comparisons
from lyapcheck.answers.bounds.compare import BoundsComparison, compare
from lyapcheck.answers.epsilon import epsilon
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.errors import InputError
from lyapcheck.output.document import Section, Table
from lyapcheck.output.formats import JudgedFormat
from lyapcheck.robots import load
from lyapcheck.robots.vary import Vary
from lyapcheck.simulate.task import Task

F = Fraction
FILE = read_gain_file(paper_gain_file("table2_shoulder_elbow"))
TASK = Task((math.pi / 4, math.pi / 2), (0.0, 0.0), (0.0, 0.0), 0.5)


def both_bounds(gains: GainSet) -> BoundsComparison:
    return compare(
        gains, load("reyes-kelly2"), TASK, math.radians(10), (0.1, 0.05), (0.0, 0.0), max_boxes=2_000
    )


@pytest.fixture(scope="module")
def sound() -> BoundsComparison:
    """A gain set with both bounds."""
    return both_bounds(FILE.gains[0])


@pytest.fixture(scope="module")
def compared(sound: BoundsComparison) -> Comparisons:
    """The same beside one whose h is too flat for a time to be found, which takes ten seconds."""
    second = FILE.gains[1]
    flat = GainSet(second.name, 60, second.kp, second.kv, index=second.index)
    return Comparisons((sound, both_bounds(flat)), FILE)


@pytest.mark.slow
def test_the_first_line_says_whether_all_is_certified(compared: Comparisons) -> None:
    sound, flat = compared.results
    assert (sound.certified, flat.certified) == (True, False)
    assert compared.document().title == "? the bounds of 1 of 2 gain sets are certified on reyes-kelly2"
    alone, without = str(Comparisons((sound,))), str(Comparisons((flat,)))
    assert alone.startswith("✓ tau_m1 on reyes-kelly2: every |e_i| ≤ 10° for good within ")
    assert without.startswith("? tau_m2 on reyes-kelly2: no settling time is certified")
    assert Comparisons((sound, sound)).document().title.startswith("✓ the bounds of all 2 gain sets")


@pytest.mark.slow
def test_what_is_shown_is_never_below_what_is_certified(sound: BoundsComparison) -> None:
    settling = sound.settling
    times, errors = Comparisons((sound,), FILE).document().blocks[:2]
    assert isinstance(times, Table)
    assert isinstance(errors, Section)
    assert settling.time is not None
    assert settling.time <= F(times.rows[0][1].removesuffix(" s")) <= settling.time * F(1001, 1000)
    table, phases = (block for block in errors.blocks if isinstance(block, Table))
    assert phases.heads[1] == "ε₀"
    assert table.heads[:2] == ("joint", "on the way")
    assert [row[0] for row in table.rows] == ["shoulder", "elbow"]
    for row, angle in zip(table.rows, settling.largest_errors, strict=True):
        assert math.degrees(angle) <= float(row[1].removesuffix("°")) <= 1.001 * math.degrees(angle)


@pytest.mark.slow
def test_bounds_are_judged_one_by_one_at_the_line_of_the_gain_set(compared: Comparisons) -> None:
    settling, disturbed, missing, *_ = compared.annotations()
    assert [one.level for one in (settling, disturbed, missing)] == ["passed", "passed", "undecided"]
    assert [one.rule for one in (settling, disturbed, missing)] == ["settling", "disturbed", "settling"]
    reason = compared.results[1].settling.reason
    assert reason in missing.message
    assert reason in " ".join(str(compared).split())
    lines = Path(FILE.path).read_text(encoding="utf-8").splitlines()
    for one in (settling, missing):
        assert lines[one.line - 1 : one.line + 1] == ["[[gains]]", f'name = "{one.group}"']


@pytest.mark.slow
def test_without_a_rate_at_the_goal_it_says_so() -> None:
    asked = (load("reyes-kelly2"), TASK, math.radians(10), (), (0.0, 0.0))
    result = Comparisons((compare(FILE.gains[1], *asked, max_boxes=4_000),))
    assert result.results[0].certified
    assert [one.rule for one in result.annotations()] == ["settling", "disturbed", "no-rate"]
    assert "no exponential rate" in str(result)
    assert "disturbed, under" not in str(result)


@pytest.mark.slow
@pytest.mark.parametrize("name", JudgedFormat)
def test_every_format_is_the_same_bytes_each_time(compared: Comparisons, name: str) -> None:
    assert compared.written(name) == compared.written(name)
    assert (r"tau\_m2" if name == "latex" else "tau_m2") in compared.written(name)


@pytest.mark.slow
def test_a_record_is_a_gain_set(compared: Comparisons) -> None:
    sound, flat = compared.records()
    assert (sound["name"], flat["name"]) == ("tau_m1", "tau_m2")
    assert sound["settling"]["time"] >= float(compared.results[0].settling.time or 0)
    assert flat["settling"]["time"] is None
    assert "-0.0" not in compared.written("csv")


@pytest.mark.slow
def test_ranges_are_told_beside_what_holds_at_nominal_numbers() -> None:
    """Friction up to 30 % lower: proved of every arm between, and what that costs."""
    arm, ranges = "reyes-kelly2", (Vary.parsed("viscous=-30%..+0%"),)
    asked = (load(arm), TASK, math.radians(10), (), (0.0, 0.0))
    result = compare(FILE.gains[0], *asked, max_boxes=2_000, varied=(load(arm, vary=ranges), ranges))
    assert result.certified
    assert result.settling.shown is not None
    assert all(low < high for low, high in result.settling.shown.statement.viscous)
    assert result.varies == ("viscous=-30%..0%",)
    assert result.unvaried is not None
    assert result.unvaried.settling.time is not None
    assert (result.settling.time or 0) > result.unvaried.settling.time
    text = " ".join(str(Comparisons((result,))).split())
    for part in ("with viscous=-30%..0%", "cost of the ranges", "at nominal numbers", "constant in time"):
        assert part in text
    assert (
        result.settling.shown.statement.text()
        == Comparisons((result,)).data()["results"][0]["settling"]["statement"]
    )


def test_an_arm_without_viscous_friction_is_refused_with_what_is_known() -> None:
    """It was an internal error: nothing divides by the friction before this is said."""
    bare = load("reyes-kelly2")
    bare = replace(bare, viscous=(bare.viscous[0], replace(bare.viscous[1], value=F(0))))
    said = r"no viscous friction at elbow.*gate --condition lasalle"
    with pytest.raises(InputError, match=said):
        epsilon(FILE.gains[0], bare)
    with pytest.raises(InputError, match=said):
        compare(FILE.gains[0], bare, TASK, 0.1, max_boxes=1)
