"""Theorems about closed loops as data: none that an arm of one or two joints disproves is proved."""

from dataclasses import replace
from random import Random

import pytest

from tests.statement_fuzz.generators import draw
from tests.statement_fuzz.generators.stability import theorems
from tests.statement_fuzz.judge import judge
from tests.statement_fuzz.oracle.kinds import objection
from tests.statement_fuzz.subject import Stable, decide

MANY = 120


@pytest.mark.slow
def test_changed_theorems_have_no_faults():
    judged = [judge(draw(7, index, "Stable"), index) for index in range(MANY)]
    assert [one.text() for one in judged if one.fault] == []
    false = sum(objection(one.made.statement, k) is not None for k, one in enumerate(judged))
    assert false > MANY // 10
    assert any(one.verdict == "proved" for one in judged)


@pytest.mark.slow
def test_what_the_oracle_objects_to_is_undecided():
    """Theorems as shipped: those that it objects to are there to be refused."""
    for index, statement in enumerate(theorems()):
        if objection(statement, index) is not None:
            assert decide(statement).verdict.value == "undecided"


def turned(statement):
    """The same with the opposite torque."""
    argument = statement.argument
    torque = ("scale", ("num", "-1"), argument.system.torque)
    return Stable(replace(argument, system=replace(argument.system, torque=torque)))


@pytest.mark.slow
def test_the_oracle_objects_to_the_opposite_torque():
    for index, statement in enumerate(theorems()):
        assert objection(turned(statement), index) is not None, statement.text()


def test_the_oracle_objects_to_nothing_without_gains():
    """The torque of gravity alone holds the arm wherever it is."""
    statement = next(
        one for one in theorems() if one.argument.theorem == "LaSalle" and not one.argument.where
    )
    system = statement.argument.system
    held = replace(system, torque=("sum", ("vec", "gd"), ("vec", "dg")), friction="positive")
    found = objection(Stable(replace(statement.argument, system=held)), Random(3).randrange(100))
    assert found is not None
    assert "rests at" in found.place
