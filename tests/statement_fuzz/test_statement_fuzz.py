"""Random statements are never proved though false or undefined, and never refuted without a reason."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.claims import Constant, Relation
from lyapcheck.verdicts import Verdict
from tests.helpers.shares import but, one_in
from tests.oracle import confirms, known, objection
from tests.statement_fuzz.__main__ import judged
from tests.statement_fuzz.generators import GENERATORS, TRUE, draw, names
from tests.statement_fuzz.generators.loops import theorems
from tests.statement_fuzz.judge import FALSE_REFUSED, decide, judge

FEW, MANY = 40, 500
PLAIN = ("ForAll", "Constant", "Implies", "Identity", "EveryN", "ForSmall", "Agrees")
OF_ARMS = (
    *("MassAbove", "MassBelow", "CoriolisBelow", "GravityBelow", "Decreasing"),
    *("Property", "Resting", "DampingBelow"),
)
BY_POINTS = OF_ARMS[:5]


@pytest.fixture(scope="module")
def few():
    """Of a seed without a flow: a single one takes ten seconds, and the slow tests have many."""
    return judged(range(FEW), 10)


def test_random_statements_have_no_faults(few):
    assert few.faults == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 6))
def test_many_random_statements_have_no_faults(seed):
    assert judged(range(MANY), seed).faults == []


@pytest.mark.slow
@settings(suppress_health_check=list(HealthCheck))
@given(kind=st.sampled_from(PLAIN), random=st.randoms(use_true_random=False))
def test_a_statement_that_hypothesis_makes_has_no_fault(kind, random):
    """The same generators, so that a fault comes back as small as Hypothesis can make it."""
    names()
    one = judge(GENERATORS[kind][1](random))
    assert one.fault == "", one.text()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["Altered", "Planted", "Stable"])
def test_certificates_and_theorems_with_something_changed_have_no_faults(kind):
    result = [judge(draw(12, k, kind), k) for k in range(40 if kind == "Altered" else 120)]
    assert [one.text() for one in result if one.fault] == []
    assert {one.verdict for one in result} >= {"proved", "refuted" if kind == "Planted" else FALSE_REFUSED}


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [("Flow", 40), ("Squares", 60), ("Steps", 20), ("OfAPart", 20)])
def test_systems_squares_steps_and_parts_have_no_faults(kind, count):
    result = [judge(draw(13, k, kind), k) for k in range(count)]
    assert [one.text() for one in result if one.fault] == []
    assert kind not in ("Flow", "Squares") or "proved" in {one.verdict for one in result}


def test_statements_are_neither_all_plain_nor_all_hopeless(few):
    assert {"proved", "refuted", "undecided"} <= {verdict for _, verdict in few.verdicts}
    assert {kind for kind, _ in few.verdicts} >= {"ForAll", "Constant", "Implies", "Identity", "EveryN"}


@pytest.mark.slow
def test_every_kind_that_is_written_has_an_oracle():
    written = {type(draw(0, 0, kind).statement).__name__ for kind in names()}
    assert written - {"Altered"} <= known()
    assert set(OF_ARMS) <= written


def test_a_decision_without_end_is_a_fault(monkeypatch):
    def endless(statement):
        while True:
            pass

    monkeypatch.setattr("tests.statement_fuzz.judge.SECONDS", 0.05)
    monkeypatch.setattr("tests.statement_fuzz.judge.PATIENCE", 0.04)
    assert "no decision" in judge(draw(0, 0), 0, by=endless).fault


def test_a_seed_and_an_index_give_the_same_statement():
    assert [draw(3, k) for k in range(50)] == [draw(3, k) for k in range(50)]
    assert draw(3, 0) != draw(4, 0)


# That the instrument sees what it is for --------------------------------------------------------------------


def credulous(statement):
    """Proves everything."""
    return SimpleNamespace(verdict=Verdict.PROVED, method="faith", reason="", witness=None)


def contrary(statement):
    """Refutes everything, at 1."""
    point = dict.fromkeys(("x", "y", "v", "a", "b", "c", "d", "x1", "q1", "q2", "n"), "1")
    return SimpleNamespace(verdict=Verdict.REFUTED, method="doubt", reason="", witness={"point": point})


def stubborn(statement):
    """Raises."""
    raise RuntimeError("no")


@pytest.mark.parametrize("wrong", [credulous, contrary, stubborn])
def test_an_unsound_procedure_is_caught(wrong):
    result = [judge(draw(5, k), k, by=wrong) for k in range(30)]
    assert sum(bool(one.fault) for one in result) > 5


@pytest.mark.parametrize("kind", PLAIN)
def test_each_kind_has_objections(kind):
    assert any(judge(draw(6, k, kind), 0, by=credulous).fault for k in range(60))


@pytest.mark.parametrize("kind", but(["MassAbove"], OF_ARMS))
def test_the_oracle_sees_by_itself_what_is_false_of_arms(kind):
    made = [draw(6, k, kind) for k in range(60)]
    result = [bool(judge(replace(one, truth=None), k, by=credulous).fault) for k, one in enumerate(made)]
    assert sum(result) >= 3
    for one, objected in zip(made, result, strict=True):
        if one.truth is not None:
            assert objected is (one.truth != TRUE), one


@pytest.mark.parametrize("kind", one_in(3, BY_POINTS))
def test_a_witness_against_an_arm_is_one_only_where_it_stands(kind):
    tried = ((one.statement, decide(one.statement)) for one in (draw(8, k, kind) for k in range(60)))
    statement, result = next(pair for pair in tried if pair[1].verdict is Verdict.REFUTED)
    point = result.witness["point"]
    assert confirms(statement, point)
    assert not confirms(statement, {name: value for name, value in point.items() if name != "q1"})
    for bound, value in (("high", Fraction(10**40)), ("low", Fraction(0)), ("printed", ())):
        if hasattr(statement, bound):
            weaker = replace(statement, **{bound: value})
            assert confirms(weaker, point) is (objection(weaker, 0) is not None)


def half_of_coriolis(statement):
    """Takes C for half of what it is."""
    return decide(replace(statement, high=statement.high * Fraction(5, 2)))


def too_much_friction(statement):
    """Takes friction for more than it is."""
    return decide(replace(statement, viscous=tuple((abs(b) + 1, abs(c) + 1) for b, c in statement.viscous)))


def blind_to_strictness(statement):
    """Takes < for ≤."""
    r = statement.relation
    return decide(replace(statement, relation=Relation(r.left, "<=", r.right)))


@pytest.mark.parametrize(
    ("kind", "blind", "family", "count"),
    [
        (CoriolisBelow, half_of_coriolis, "", 40),
        (Decreasing, too_much_friction, "friction that may be negative", 60),
        (Constant, blind_to_strictness, "equal numbers", 300),
    ],
)
def test_a_procedure_that_does_not_see_something_is_caught(kind, blind, family, count):
    made = (replace(draw(7, k, kind.__name__), truth=None) for k in range(count))
    assert any(judge(one, k, by=blind).fault for k, one in enumerate(made) if family in one.family)


def turned(statement):
    """The same with the opposite torque."""
    argument = statement.argument
    torque = ("scale", ("num", "-1"), argument.system.torque)
    return Stable(replace(argument, system=replace(argument.system, torque=torque)))


@pytest.mark.slow
def test_the_oracle_objects_to_theorems_only_where_they_are_refused_and_to_the_opposite_torque():
    for index, statement in enumerate(theorems()):
        if objection(statement, index) is not None:
            assert decide(statement).verdict.value == "undecided"
        assert objection(turned(statement), index) is not None, statement.text()


def test_the_oracle_objects_to_nothing_without_gains():
    """The torque of gravity alone holds the arm wherever it is."""
    shipped = (one.argument for one in theorems())
    argument = next(one for one in shipped if one.theorem == "LaSalle" and not one.where)
    torque = ("sum", ("vec", "gd"), ("vec", "dg"))
    held = replace(argument.system, torque=torque, friction="positive")
    assert "rests at" in objection(Stable(replace(argument, system=held)), 3).place
