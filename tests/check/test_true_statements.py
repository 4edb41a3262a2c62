"""No rule refutes a true statement: for each rule, statements of which each hypothesis in turn is necessary.

The arena has certificates ``true.tru.*`` of statements that are true because of one hypothesis, with a proof
that refutes what is left without it; that false statement stands in ``without_hypothesis.json``. A rule that
forgets the hypothesis fails here.
"""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import rule_for, verify
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.arena.run import ARENA
from tests.helpers.committed import read
from tests.helpers.stated import outcome

FALSE = json.loads(Path(__file__).with_name("without_hypothesis.json").read_text(encoding="utf-8"))
OF_ARMS = (
    "Mass",
    "Coriolis",
    "Gravity",
    "Chain",
    "Decreasing",
    "Damping",
    "Resting",
    "Sampled",
    "AllOf",
    "GateAccepted",
)
"""Kinds that the search is asked about elsewhere, since it takes longer for them."""


CASES = {path.name[9:-5]: read(f"bad/{path.stem}") for path in (ARENA / "bad").glob("true.tru.*.json")}
ARMS = {path.name[9:-5]: read(f"bad/{path.stem}") for path in (ARENA / "bad").glob("arms.tru.*.json")}


def test_what_a_hypothesis_makes_true_is_refuted_neither_by_the_proof_nor_by_the_search():
    assert [name for name, case in CASES.items() if outcome(*case) == "refuted"] == []
    asked = {k: true for k, (true, _) in CASES.items() if not type(true).__name__.startswith(OF_ARMS)}
    assert len(asked) > 40
    assert [k for k, true in asked.items() if propose(true).verdict is Verdict.REFUTED] == []


def test_without_the_hypothesis_the_same_proof_refutes_and_every_rule_that_refutes_has_such_a_case():
    """The arena has a refutation by each."""
    assert FALSE.keys() == CASES.keys()
    false = {name: from_json(Statement, data, "statement") for name, data in FALSE.items()}
    assert [name for name, one in false.items() if outcome(one, CASES[name][1]) != "refuted"] == []
    here = {rule_for(type(one), type(CASES[name][1])) for name, one in false.items()}
    for path in (ARENA / "good").glob("**/*.json"):
        if json.loads(path.read_text(encoding="utf-8"))["verdict"] == "refuted":
            statement, proof = read(path.relative_to(ARENA).with_suffix(""))
            assert rule_for(type(statement), type(proof)) in here, path.name


def test_parts_about_two_arms_are_refused_together():
    assert len(ARMS) > 10
    for both, proofs in ARMS.values():
        assert isinstance(both, AllOf)
        assert isinstance(proofs, EveryPart)
        for (name, part), proof in zip(both.parts, proofs.parts, strict=True):
            twice = AllOf(((name, part), (f"{name} again", part)))
            assert outcome(part, proof) == outcome(twice, EveryPart((proof, proof))) == "proved"
        said = r"part 2.* has another .* than part 1: state what is about another arm"
        with pytest.raises(Refused, match=said):
            verify(both, proofs)
        assert propose(both).verdict is Verdict.UNDECIDED


def test_an_argument_for_one_arm_says_which_arm_it_is():
    path = next((ARENA / "good").glob("*sca.arm.stable.m1*"))
    stable, _ = read(path.relative_to(ARENA) / "0")
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
