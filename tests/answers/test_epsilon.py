"""The four ε₀ of a gain set, and the command that prints them."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import cvxpy as cp
import pytest

from lyapcheck.answers.epsilon import EpsilonResults
from lyapcheck.answers.epsilon.compute import Contradiction, by_forms, epsilon, findings, require_consistent
from lyapcheck.check.loop.states import confirms_positive
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.output.answer import FORMATS, Level
from lyapcheck.output.digits import at_least
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.vary import corners
from lyapcheck.search.controlled_arm import ControlledArm
from tests.helpers.command import invoke
from tests.helpers.shares import but, one_in

F = Fraction
ARM = load("reyes-kelly2")
SETS = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains


PROGRAMS = []
"""The solvers of the convex programs that CVXPY was asked for."""


@pytest.fixture(scope="module", params=but((0,), (0, 1)), ids=["m1", "m2"])
def case(request):
    PROGRAMS.clear()
    solve = cp.Problem.solve

    def recorded(problem, *args, **options):
        PROGRAMS.append(options.get("solver"))
        return solve(problem, *args, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cp.Problem, "solve", recorded)
        result = epsilon(SETS[request.param], ARM, starts=6, max_boxes=8_000)
    return SETS[request.param], result


def test_weights_are_searched_by_convex_programs(case):
    assert PROGRAMS
    assert {str(solver).upper() for solver in PROGRAMS} == {"CLARABEL"}


def test_the_four_are_in_order(case):
    _, result = case
    assert result.scalar is not None
    assert result.certified is not None
    assert result.falsified is not None
    assert 0 < result.scalar <= result.certified <= result.falsified
    assert result.ratio == result.certified / result.falsified
    assert result.ratio > F(9, 10)


def test_witness_replays_and_does_not_reach_the_certified(case):
    gains, result = case
    controlled = ControlledArm(gains, ARM)
    assert result.witness is not None
    assert result.certified is not None
    assert confirms_positive(controlled.arm, controlled.controller, result.witness.eps0, result.witness.state)
    assert not confirms_positive(
        controlled.arm, controlled.controller, result.certified, result.witness.state
    )


def test_a_planted_certificate_raises_the_alarm(case):
    gains, result = case
    controlled = ControlledArm(gains, ARM)
    assert result.falsified is not None
    require_consistent(controlled, result.witness, {"certified": result.certified, "scalar": result.scalar})
    with pytest.raises(Contradiction, match="certified"):
        require_consistent(controlled, result.witness, {"certified": result.falsified * 2})
    with pytest.raises(Contradiction, match="scalar"):
        require_consistent(controlled, result.witness, {"scalar": result.falsified})


@pytest.mark.parametrize("name", FORMATS)
def test_seconds_are_there_where_they_were_asked_for(case, name):
    timed = EpsilonResults((replace(case[1], seconds=1.5),))
    assert "seconds" in timed.written(name)
    assert timed.data()["results"][0]["seconds"] == 1.5
    assert "seconds" not in case[1].data()["results"][0]


def test_the_first_line_says_what_is_certified(case):
    _, result = case
    none = replace(result, promise=None, proof=None, reasons={"certified": "budget spent"})
    title, shown = result.document().title, at_least(Fraction(result.data()["results"][0]["certified"]))
    assert title == f"✓ ε₀ = {shown} is certified for {result.name} on {ARM.name}"
    assert none.document().title.startswith("? no ε₀ is certified")
    both = EpsilonResults((result, none)).document().title
    assert both == f"? 1 of 2 gain sets have a certified ε₀ on {ARM.name}"
    assert str(result).startswith(title)


def test_what_is_certified_passes_and_what_is_falsified_is_a_remark(case):
    _, result = case
    file = read_gain_file(paper_gain_file("table2_shoulder_elbow"))
    none = replace(result, promise=None, reasons={"certified": "budget spent"})
    passed, witness = EpsilonResults((result,), file).annotations()
    undecided, *_ = EpsilonResults((none,), file).annotations()
    assert (passed.level, passed.rule, passed.message) == (Level.PASSED, "certified", "")
    assert (undecided.level, undecided.message) == (Level.UNDECIDED, "no ε₀ is certified: budget spent")
    assert (witness.level, witness.rule) == (Level.REMARK, "falsified")
    assert "dV/dt > " in witness.message
    lines = Path(file.path).read_text(encoding="utf-8").splitlines()
    for one in (passed, witness, undecided):
        assert (one.path, one.group) == (file.path, result.name)
        assert lines[one.line - 1] == "[[gains]]"
        assert lines[one.line] == f'name = "{result.name}"'


@pytest.mark.parametrize(
    ("published", "certified", "rules"),
    [(10**9, None, {"published-refuted"}), (F(1, 10**9), F(1, 10**8), {"published-certified"})],
)
def test_what_the_numbers_say_of_each_other_is_a_remark_of_its_own_rule(case, published, certified, rules):
    _, result = case
    said = tuple(findings(F(published), certified, result.witness))
    remarks = [one for one in replace(result, findings=said).annotations() if one.level is Level.REMARK]
    assert {one.rule for one in remarks} == {"falsified", *rules}
    assert f"- {said[0]}" in " ".join(str(replace(result, findings=said)).split())


def test_json_numbers_are_exact_strings(case):
    _, result = case
    document = json.loads(result.written("json"))
    assert document["schema"] == "lyapcheck/epsilon/1"
    row = document["results"][0]
    for kind in ("published", "scalar", "certified", "falsified"):
        expected = getattr(result, kind)
        assert row[kind] is None if expected is None else F(row[kind]) == expected
    assert result.witness is not None
    assert [F(x) for x in row["witness"]["w"]] == list(result.witness.state.w)
    low, high = (F(row["witness"]["rate"][end]) for end in ("lower", "upper"))
    assert 0 < low <= result.witness.rate.lower <= result.witness.rate.upper <= high


def run(*arguments):
    result = invoke("epsilon", *arguments)
    if isinstance(result.exception, InputError):
        return 2, str(result.exception)
    return result.exit_code, result.stdout


def test_missing_arm_and_missing_member_are_refused(tmp_path):
    path = tmp_path / "gains.toml"
    path.write_text('[[gains]]\nname = "a"\nm = 1\nkp = [1, 1]\nkv = [1, 1]\n')
    assert run(str(path))[0] == 2
    code, text = run(str(path), "--robot", "reyes-kelly2", "--m", "4")
    assert code == 2
    assert "choose from 1" in text


@pytest.mark.parametrize(
    ("vary", "outside"),
    one_in(
        4,
        [
            ("viscous=-30%..-10%", ["pivot_viscous"]),
            ("pivot_viscous=1..2", ["pivot_viscous"]),
            ("viscous=5%..5%", ["pivot_viscous"]),
            ("viscous=-20%..+20%", []),
        ],
    ),
)
def test_the_arm_of_the_file_is_spoken_of_only_where_it_is_in_the_ranges(tmp_path, vary, outside):
    path = tmp_path / "gains.toml"
    text = 'robot = "pendulum1"\n[[gains]]\nname = "a"\nm = 1\nkp = [5]\nkv = [2]\n[bounds]\nviscous_min=9\n'
    path.write_text(text)
    words = ("epsilon", str(path), "--starts", "1", "--max-boxes", "1", "--no-store", "--vary", vary)
    text = invoke(*words).stdout
    (data,) = json.loads(invoke(*words, "--format", "json").stdout)["results"]
    assert data["outside"] == outside
    assert (data["unvaried"] is None) == bool(outside)
    assert ("nominal" in text) == (not outside)
    assert "viscous_min of the gain file does not count here" in text
    assert ("own value lies outside the range of pivot_viscous" in text) == bool(outside)
    assert "pendulum1, for all values in its ranges" in text.splitlines()[0]


def test_the_published_number_over_ranges_is_about_all_arms_in_them():
    """It is above that of no corner; where (19) fails at the least friction, there is none."""
    varies = (Vary.parsed("viscous=-30%..30%"),)
    arm = load("reyes-kelly2", vary=varies)
    weak, strong = (
        ControlledArm(GainSet("own", 1, (F(60), F(5)), (F(kv),) * 2), arm, ranges=True)
        for kv in ("0.01", "0.1")
    )
    published = by_forms(weak)[0]
    assert published is not None
    for _, corner in corners(arm)[1]:
        there = by_forms(ControlledArm(weak.gains, corner))[0]
        assert there is not None
        assert published <= there
    nominal, _, _ = by_forms(replace(strong, ranges=False))
    result, _, reasons = by_forms(strong)
    assert nominal is not None
    assert result is None
    assert "(19) fails in the ranges" in reasons["published"]


def test_the_published_number_is_smaller_where_the_inertia_ranges():
    case = ControlledArm(read_gain_file(paper_gain_file("table2")).gains[0], load("buap3"), ranges=True)
    ranged, nominal = (by_forms(replace(case, ranges=ranges))[0] for ranges in (True, False))
    assert 0 < (ranged or 0) < (nominal or 0)
