"""False statements are never proved: planted faults, and that the suite would see an unsound prover."""

from __future__ import annotations

from dataclasses import replace

import pytest

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.claims import (
    Constant,
    Implies,
    Relation,
    Statement,
    any_vector,
    implies,
    positive,
    var,
)
from lyapcheck.verdicts import Verdict
from tests.refutations.mutations import RULES, faults_of
from tests.refutations.report import markdown, summary
from tests.refutations.statements import Part, parts
from tests.refutations.suite import FEW, LEAST, MANY, outcomes, planted, verdict_of, wrongly_proved

x, a, b, v = var("x"), var("a"), var("b"), any_vector("v")


@pytest.mark.slow
def test_there_are_enough_faults_of_every_kind() -> None:
    assert len(planted(MANY).false) >= LEAST
    assert {fault.kind for fault in planted(MANY).false} == set(RULES)


@pytest.mark.slow
def test_there_are_faults_of_every_kind_that_an_unsound_procedure_takes_for_true() -> None:
    assert {fault.kind for fault in planted(FEW).false} >= set(SUSPECT)


@pytest.mark.slow
def test_no_false_statement_is_proved() -> None:
    result = outcomes(planted(MANY).false)
    assert wrongly_proved(result) == []
    assert Verdict.ERROR not in {outcome.verdict for outcome in result}
    assert sum(outcome.verdict is Verdict.REFUTED for outcome in result) > 0.8 * len(result)


def credulous(statement: Statement) -> Verdict:
    """Proves everything."""
    return Verdict.PROVED


def blind_to_strictness(statement: Statement) -> Verdict:
    """Takes < in what is claimed for ≤."""
    if isinstance(statement, Implies) and statement.conclusion.strict:
        statement = replace(statement, conclusion=_weak(statement.conclusion))
    elif hasattr(statement, "relation"):
        statement = replace(statement, relation=_weak(statement.relation))
    return verdict_of(statement)


def _weak(relation: Relation) -> Relation:
    return replace(relation, operator="<=")


def blind_to_constants(statement: Statement) -> Verdict:
    """Compares the symbols of products of norms and forgets their constants."""
    if isinstance(statement, BoundEveryN):
        statement = replace(statement, right=("mul", ("num", "1000000"), statement.right))
    return verdict_of(statement)


def blind_to_digits(statement: Statement) -> Verdict:
    """Takes numbers that differ by a hundredth for equal."""
    if isinstance(statement, Constant):
        left, right = statement.relation.left, statement.relation.right
        raised = ("mul", ("num", "101/100"), right)
        statement = Constant(replace(statement.relation, left=left, right=raised))
    return verdict_of(statement)


@pytest.mark.slow
@pytest.mark.parametrize("unsound", [credulous, blind_to_strictness, blind_to_constants])
def test_an_unsound_procedure_is_caught(unsound: object) -> None:
    suspects = [f for f in planted(FEW).false if f.kind in SUSPECT]
    assert wrongly_proved(outcomes(suspects, by=unsound))  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_procedure_that_takes_near_numbers_for_equal_is_caught() -> None:
    suspects = [fault for fault in planted(MANY).false if fault.kind in SUSPECT]
    assert wrongly_proved(outcomes(suspects, by=blind_to_digits))


SUSPECT = ("strict for weak", "factor of two", "√n missing", "constant rounded the wrong way")


@pytest.mark.slow
def test_the_suite_sees_one_proof_too_many() -> None:
    """A verdict that is wrong for a single fault turns up, by the name of that fault."""
    target = planted(FEW).false[7]

    def nearly_sound(statement: Statement) -> Verdict:
        return Verdict.PROVED if statement == target.statement else Verdict.REFUTED

    assert wrongly_proved(outcomes(planted(FEW).false, by=nearly_sound)) == [target.name]


@pytest.mark.slow
def test_what_is_proved_of_the_proofs_is_not_broken_by_the_oracle() -> None:
    """Two opinions on the statements as they stand: proved here, a failing point there, cannot both be."""
    for part in parts():
        if part.where in planted(FEW).broken:
            assert verdict_of(part.statement) is not Verdict.PROVED, part.where


def test_faults_change_one_place_and_keep_to_the_names_of_the_statement() -> None:
    part = Part("example", "1", "", implies(positive("gamma", "b"), (var("gamma") < b,), var("gamma") <= b))
    faults = faults_of(part)
    assert {fault.kind for fault in faults} >= {"≥ for ≤", "strict for weak", "hypothesis dropped"}
    assert all(fault.statement != part.statement for fault in faults)
    assert not [fault for fault in faults if "rho" in str(fault.statement)]


@pytest.mark.slow
def test_the_same_input_gives_the_same_report() -> None:
    result = outcomes(planted(FEW).false, by=credulous)
    text = markdown(planted(FEW), result)
    assert text == markdown(planted(FEW), outcomes(planted(FEW).false, by=credulous))
    assert summary(result) in text
    assert f"| {len(result)} |" not in text.splitlines()[0]
