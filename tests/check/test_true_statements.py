"""No rule refutes a true statement: for each rule, statements of which each hypothesis in turn is necessary.

Each case has a statement that is true because of one hypothesis, a proof that refutes what is left without
it, and that false statement, which the same proof does refute. A rule that forgets the hypothesis fails here.
"""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import rule_for, verify
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.arena.run import ARENA
from tests.arena.truths import CASES, arms, on_entries, on_points, on_small_values, together


def outcome(statement: Statement, proof: Proof) -> str:
    try:
        return verify(statement, proof).verdict
    except Refused:
        return "refused"


@pytest.mark.parametrize("name", CASES)
def test_what_a_hypothesis_makes_true_is_not_refuted(name: str) -> None:
    true, _, proof = CASES[name]
    assert outcome(true, proof) in ("refused", "proved")


@pytest.mark.parametrize("name", CASES)
def test_without_the_hypothesis_the_same_proof_refutes(name: str) -> None:
    _, false, proof = CASES[name]
    assert outcome(false, proof) == "refuted"


@pytest.mark.parametrize("name", [*on_points(), *on_entries(), *on_small_values()])
def test_nor_does_the_search_refute_what_is_true(name: str) -> None:
    true, _, _ = CASES[name]
    assert propose(true).verdict is not Verdict.REFUTED


def test_every_rule_that_refutes_has_such_cases() -> None:
    """The arena has a refutation by each."""
    here = {rule_for(type(false), type(proof)) for _, false, proof in CASES.values()}
    for path in (ARENA / "good").glob("**/*.json"):
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["verdict"] == "refuted":
            statement = from_json(Statement, data["statement"], "statement")
            proof = from_json(Proof, data["proof"], "proof")
            assert rule_for(type(statement), type(proof)) in here, path.name


ARMS = arms()


@pytest.mark.parametrize("name", ARMS)
def test_parts_about_two_arms_are_refused_together(name: str) -> None:
    parts = ARMS[name]
    for statement, proof in parts:
        assert outcome(statement, proof) == "proved"
        assert outcome(*together((statement, proof), (statement, proof))) == "proved"
    both, proofs = together(*parts)
    with pytest.raises(
        Refused, match=r"part 2.* has another .* than part 1: state what is about another arm"
    ):
        verify(both, proofs)
    assert propose(both).verdict is Verdict.UNDECIDED


def test_an_argument_for_one_arm_says_which_arm_it_is() -> None:
    path = next((ARENA / "good").glob("*sca.arm.stable.m1*"))
    data = json.loads((path / "0.json").read_text(encoding="utf-8"))
    stable = from_json(Statement, data["statement"], "statement")
    assert isinstance(stable, StableArm)
    AllOf((("a", stable), ("b", stable))).require_well_formed()
    rubbed = (*stable.arm.viscous[1:], stable.arm.viscous[0])
    for fact, arm in (
        ("M", replace(stable.arm, mass=stable.arm.mass[::-1])),
        ("B", replace(stable.arm, viscous=rubbed)),
        ("potential", replace(stable.arm, potential=())),
    ):
        with pytest.raises(Refused, match=f"has another {fact} than a"):
            AllOf((("a", stable), ("b", replace(stable, arm=arm)))).require_well_formed()
