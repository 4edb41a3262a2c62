"""Random statements are never proved though false or undefined, and never refuted without a reason."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from lyapcheck.claims import Constant, Implies, Relation, expr, for_all, identity, positive, sqrt, var
from lyapcheck.verdicts import Verdict
from tests.helpers.shares import one_in
from tests.statement_fuzz.__main__ import main
from tests.statement_fuzz.generators import TRUE, Made, draw, names
from tests.statement_fuzz.judge import Judged, judge
from tests.statement_fuzz.oracle.kinds import confirms, known, objection
from tests.statement_fuzz.report import markdown
from tests.statement_fuzz.run import Run, Tally, run
from tests.statement_fuzz.subject import CoriolisBelow, Decreasing, decide

FEW = 40
MANY = 800

x = var("x")


def faults(tally: Tally) -> str:
    """What to read where there are faults."""
    return "\n".join(f"{index}: {judged.text()}" for index, judged in tally.faults[:10])


@pytest.fixture(scope="module")
def few() -> Tally:
    return run(0, range(FEW))


def test_random_statements_have_no_faults(few: Tally) -> None:
    assert not few.faults, faults(few)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 6))
def test_many_random_statements_have_no_faults(seed: int) -> None:
    tally = run(seed, range(MANY))
    assert not tally.faults, faults(tally)


def test_statements_are_neither_all_plain_nor_all_hopeless(few: Tally) -> None:
    verdicts = {verdict for _, verdict in few.verdicts}
    assert {"proved", "refuted", "undecided"} <= verdicts
    assert {kind for kind, _ in few.verdicts} >= {"ForAll", "Constant", "Implies", "Identity", "EveryN"}


@pytest.mark.slow
def test_every_kind_that_is_written_has_an_oracle() -> None:
    written = {type(draw(0, 0, kind).statement).__name__ for kind in names()}
    assert written <= known()
    assert set(OF_ARMS) <= written


def test_a_decision_without_end_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(statement: Any) -> Any:
        while True:
            pass

    monkeypatch.setattr("tests.statement_fuzz.judge.SECONDS", 0.05)
    assert "no decision" in judge(draw(0, 0), 0, by=endless).fault


def test_a_seed_and_an_index_give_the_same_statement() -> None:
    assert [draw(3, k) for k in range(50)] == [draw(3, k) for k in range(50)]
    assert draw(3, 0) != draw(4, 0)


# That the instrument sees what it is for -------------------------------------------------------------------


def credulous(statement: Any) -> Any:
    """Proves everything."""
    return SimpleNamespace(verdict=Verdict.PROVED, method="faith", reason="", witness=None)


def contrary(statement: Any) -> Any:
    """Refutes everything, at 1."""
    names = ("x", "y", "v", "a", "b", "c", "d", "x1", "q1", "q2")
    point = dict.fromkeys(names, "1")
    return SimpleNamespace(verdict=Verdict.REFUTED, method="doubt", reason="", witness={"point": point})


def stubborn(statement: Any) -> Any:
    """Raises."""
    raise RuntimeError("no")


@pytest.mark.parametrize("wrong", [credulous, contrary, stubborn])
def test_an_unsound_procedure_is_caught(wrong: Any) -> None:
    result = [judge(draw(5, k), k, by=wrong) for k in range(30)]
    assert sum(bool(one.fault) for one in result) > 5


@pytest.mark.parametrize(
    "kind", ["ForAll", "Constant", "Implies", "Identity", "EveryN", "ForSmall", "Agrees"]
)
def test_each_kind_has_objections(kind: str) -> None:
    made = (draw(6, k, kind) for k in range(60))
    assert any(judge(one, 0, by=credulous).fault for one in made)


OF_ARMS = (
    *("MassAbove", "MassBelow", "CoriolisBelow", "GravityBelow", "MassSymmetric", "CoriolisAtRest"),
    *("RateOfMass", "RateLessTwiceCoriolis", "CoriolisTorque", "GravityOfPotential", "Decreasing"),
    *("Property", "Resting", "DampingBelow"),
)
BY_POINTS = OF_ARMS[:11]
PROPOSED = ("ByLargerKv", "ByLinks")


@pytest.mark.slow
@pytest.mark.parametrize("kind", PROPOSED)
def test_what_a_proof_was_not_made_for_is_proved_only_where_it_is_true(kind: str) -> None:
    made = [draw(12, k, kind) for k in range(25)]
    result = [judge(one, k) for k, one in enumerate(made)]
    assert not [one.text() for one in result if one.fault]
    assert {one.verdict for one in result} >= {"proved", "undecided, and not true"}
    assert sum(bool(judge(one, k, by=credulous).fault) for k, one in enumerate(made)) >= 1


@pytest.mark.slow
def test_certificates_with_something_changed_are_accepted_only_where_they_are_true() -> None:
    result = [judge(draw(12, k, "Altered"), k) for k in range(25)]
    assert not [one.text() for one in result if one.fault]
    assert "undecided, and not true" in {one.verdict for one in result}


@pytest.mark.parametrize("kind", one_in(4, OF_ARMS))
def test_the_oracle_sees_by_itself_what_is_false_of_arms(kind: str) -> None:
    made = [draw(6, k, kind) for k in range(60)]
    result = [bool(judge(replace(one, truth=None), k, by=credulous).fault) for k, one in enumerate(made)]
    assert sum(result) >= 3
    for one, objected in zip(made, result, strict=True):
        if one.truth is not None:
            assert objected is (one.truth != TRUE), one


@pytest.mark.parametrize("kind", one_in(3, BY_POINTS))
def test_a_witness_against_an_arm_is_one_only_where_it_stands(kind: str) -> None:
    decided = ((one.statement, decide(one.statement)) for one in (draw(8, k, kind) for k in range(60)))
    statement, result = next(pair for pair in decided if pair[1].verdict is Verdict.REFUTED)
    assert confirms(statement, result.witness)
    moved = {name: value for name, value in result.witness["point"].items() if name != "q1"}
    assert not confirms(statement, {"point": moved})
    for bound, value in (("high", Fraction(10**40)), ("low", Fraction(0)), ("printed", ())):
        if hasattr(statement, bound):
            weaker = replace(statement, **{bound: value})
            assert confirms(weaker, result.witness) is (objection(weaker, 0) is not None)


def blind_to_a_factor(statement: Any) -> Any:
    """Takes C for half of what it is."""
    if isinstance(statement, CoriolisBelow):
        return decide(replace(statement, high=statement.high * Fraction(5, 2)))
    return decide(statement)


def test_a_coriolis_matrix_of_half_the_size_is_caught() -> None:
    result = (judge(draw(7, k, "CoriolisBelow"), k, by=blind_to_a_factor) for k in range(40))
    assert any(one.verdict == "proved" and one.fault for one in result)


def blind_to_friction(statement: Any) -> Any:
    """Takes friction for more than it is."""
    if isinstance(statement, Decreasing):
        more = tuple((abs(b) + 1, abs(c) + 1) for b, c in statement.viscous)
        return decide(replace(statement, viscous=more))
    return decide(statement)


def test_friction_that_is_not_there_is_caught() -> None:
    made = [draw(9, k, "Decreasing") for k in range(60)]
    lacking = [replace(one, truth=None) for one in made if one.family == "friction that may be negative"]
    assert any(judge(one, 0, by=blind_to_friction).fault.startswith("false") for one in lacking)


def blind_to_strictness(statement: Any) -> Any:
    """Takes < for ≤."""
    if isinstance(statement, Constant):
        r = statement.relation
        return decide(replace(statement, relation=Relation(r.left, "<=", r.right)))
    return decide(statement)


def test_a_procedure_that_takes_strict_for_weak_is_caught() -> None:
    result = (judge(draw(7, k, "Constant"), k, by=blind_to_strictness) for k in range(300))
    assert any("equal numbers" in one.made.family and one.fault for one in result)


NO_FAULTS = {
    "an identity": identity((x + 1) ** 2, x**2 + 2 * x + 1),
    "equality at an end": for_all(x**2 - 1 >= 0, 1),
    "a pole outside": for_all(1 / x > 0, 0, open_low=True),
    "a pole of even order outside": for_all(1 / (x - 1) ** 2 > 0, 1, open_low=True),
    "roots": Constant(sqrt(2) * sqrt(3) <= sqrt(6)),
    "a false hypothesis": Implies(positive("a"), ((var("a") < 0),), var("a") < -1),
    "a divisor that is positive": Implies(positive("a", "b"), (), expr(0) < 1 / (var("a") + var("b"))),
}
OBJECTIONABLE = {
    "an identity": (identity((x + 1) ** 2, x**2 + 3 * x + 1), "false"),
    "equality at an end": (for_all(x**2 - 1 > 0, 1), "false"),
    "a pole inside": (for_all(1 / x**2 > 0, -1, 1), "undefined"),
    "a pole at an irrational number": (for_all(1 / (x**3 - 2) ** 2 > -1, 0, 2), None),
    "a simple pole there": (for_all((x**3 - 2) / (x**3 - 2) > 0, 0, 2), "undefined"),
    "a double pole at a root": (for_all(1 / (x**2 - 2) ** 2 > -1, 0, 2), "undefined"),
    "roots": (Constant(sqrt(2) * sqrt(3) < sqrt(6)), "false"),
    "a millionth": (for_all(x / (1 + x**2) <= "0.499999"), "false"),
    "a hypothesis on which nothing rests": (
        Implies(positive("a"), (1 / (var("a") - 1) < 0,), expr(0) < 1),
        "undefined",
    ),
}


@pytest.mark.parametrize("name", NO_FAULTS)
def test_the_oracle_has_no_objection_to_what_is_true(name: str) -> None:
    assert all(objection(NO_FAULTS[name], seed) is None for seed in range(5))


@pytest.mark.parametrize("name", OBJECTIONABLE)
def test_the_oracle_objects_to_what_is_not(name: str) -> None:
    statement, what = OBJECTIONABLE[name]
    result = objection(statement, 0)
    assert (result.what if result else None) == what


def test_a_witness_is_a_point_of_the_domain_where_all_is_defined() -> None:
    claim = for_all((x - 5) / (x - 5) > x, 0, 10)
    assert confirms(claim, {"point": {"x": "7"}})
    assert not confirms(claim, {"point": {"x": "5"}})
    assert not confirms(claim, {"point": {"x": "11"}})
    assert not confirms(claim, {"point": {"x": "1/2"}})


def test_an_unknown_kind_is_no_problem() -> None:
    assert objection(SimpleNamespace(), 0) is None
    assert confirms(SimpleNamespace(), {"point": {}}) is None


# How faults are told ---------------------------------------------------------------------------------------


def test_the_page_has_the_counts_and_the_faults() -> None:
    tally = Tally()
    made = Made(Constant(expr(2) < 1), "by hand")
    tally.enter(17, Judged(made, "proved", "false at every point", "faith"))
    text = markdown([Run(3, None, tally)])
    assert "1 statements: 1 proved; 1 faults." in text
    assert "| 3 | all kinds | 1 |" in text
    assert "- 17: Constant, by hand: proved (faith), but false at every point" in text


def test_a_recorded_fault_stands_beside_what_is_said_of_its_statement_today() -> None:
    tally = Tally()
    false = Made(Constant(expr(2) < 1), "by hand")
    tally.enter(17, Judged(false, "proved", "false at every point", "faith"))
    text = markdown([Run.of(json.loads(json.dumps(Run(3, None, tally).data())))])
    assert "proved (faith), but false at every point" in text
    assert "Today: refuted, and nothing is against it." in text


@pytest.mark.slow
def test_the_command_counts_and_writes_its_page(tmp_path: Any, capsys: Any) -> None:
    page = tmp_path / "page.md"
    code = main(["--statements", "20", "--seed", "2", "--only", "BoundEveryN", "--report", str(page)])
    assert code == 0
    assert "20 statements" in capsys.readouterr().out
    assert "| BoundEveryN | 20 |" in page.read_text(encoding="utf-8")


def test_a_record_goes_on_where_it_ended(tmp_path) -> None:
    record, page = tmp_path / "r.json", tmp_path / "r.md"
    both = ["--seed", "5", "--record", str(record), "--report", str(page), "--only", "Constant"]
    assert main(["--statements", "30", *both]) == 0
    assert main(["--statements", "50", *both]) == 0
    whole = run(5, range(50), "Constant")
    assert [Run.of(one) for one in json.loads(record.read_text())] == [Run(5, "Constant", whole)]
    assert page.read_text() == markdown([Run(5, "Constant", whole)])
    assert main(["--statements", "10", *both[2:], "--seed", "6"]) == 0
    assert [one["seed"] for one in json.loads(record.read_text())] == [5, 6]
