"""Coq's kernel itself: what it accepts, what it refuses, and what is said where there is no Coq."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from lyapcheck.answers.recheck import _copied
from lyapcheck.check.certificate import Certificate, certificate_of
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.constant import Agrees
from lyapcheck.check.kinds.decreasing import BoxTree, Decreasing, PositiveAndDecreasing, StateWitness
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.inertia import MassBelow
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.loop.field import BrokenTree
from lyapcheck.check.recheck import gather, recheck
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.errors import InputError
from lyapcheck.extensions import shipped
from lyapcheck.kernel import (
    HEAD,
    Coq,
    CoqRefused,
    Kernel,
    axioms_of,
    golden,
    judged,
    sources,
    theorem_file,
)
from lyapcheck.kernel.gate import sampled_script
from lyapcheck.kernel.statements import proposition
from tests.helpers.committed import read
from tests.helpers.once import once
from tests.kernel.test_statements import GOOD, OWN

needs_coq = pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc")


def test_without_coqc_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from lyapcheck.cli.main import main

    place = str(GOOD / "pub.7g.m1.json")
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.setattr("sys.argv", ["lyapcheck", "recheck", "--kernel", place])
    with pytest.raises(SystemExit) as ended:
        main()
    out, err = capsys.readouterr()
    assert ended.value.code == 2
    assert out == ""
    assert "there is no coqc" in err
    assert "apt-get install --no-install-recommends coq libcoq-interval" in err


def test_a_folder_that_cannot_take_the_files_is_named(tmp_path: Path) -> None:
    (tmp_path / "from" / "library").mkdir(parents=True)
    (tmp_path / "to").mkdir()
    (tmp_path / "to" / "library").write_text("something else")
    with pytest.raises(InputError, match="has something else under a name"):
        _copied(str(tmp_path / "from"), tmp_path / "to")


def test_nothing_of_the_library_is_left_out_or_assumed() -> None:
    forbidden = re.compile(r"\b(Admitted|admit|Axioms?|Parameters?|Conjecture|bypass_check|Unset)\b")
    assert {path.name for path in FORMAL.glob("*.v")} == {*sources(), "Headlines.v"}
    assert not [name for name in sources() if forbidden.search((FORMAL / name).read_text(encoding="utf-8"))]


def test_the_golden_lists_are_coqs_and_no_longer() -> None:
    assert golden("real") == {
        "ClassicalDedekindReals.sig_forall_dec",
        "ClassicalDedekindReals.sig_not_dec",
        "Classical_Prop.classic",
        "FunctionalExtensionality.functional_extensionality_dep",
    }
    modules = {name.rpartition(".")[0] for name in golden("float") - golden("real")}
    assert modules == {"PrimInt63", "Uint63", "PrimFloat", "FloatAxioms"}


def test_axioms_are_read_line_by_line() -> None:
    assert axioms_of("Closed under the global context\n") == set()
    assert axioms_of("Axioms:\nA.b : nat\nC.long\n  : forall n,\n    n = n\n") == {"A.b", "C.long"}
    with pytest.raises(CoqRefused, match="is assumed"):
        axioms_of("Axioms:\nfoo is assumed to be guarded.\n")
    with pytest.raises(CoqRefused, match="Section Variables"):
        axioms_of("Section Variables:\nx : nat\n")


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, CompletedProcess[str]]:
    """What the command says, and its files, where compiled files of something else had been before."""

    def made() -> tuple[Path, CompletedProcess[str]]:
        place = tmp_path_factory.mktemp("shown")
        library = place / "library"
        library.mkdir()
        for name in sources():
            shutil.copy(FORMAL / name, library)
            (library / name).with_suffix(".vo").write_bytes(b"compiled from something else")
        command = ["lyapcheck", "recheck", "--kernel", "--kernel-files", str(place), "--format", "json"]
        file = str(GOOD / "ext.V-is-positive-definite.json")
        return place, subprocess.run(
            [sys.executable, "-m", *command, file], capture_output=True, text=True, check=False
        )

    return once(tmp_path_factory, "kernel", made)


@pytest.fixture(scope="module")
def folder(shown: tuple[Path, CompletedProcess[str]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for Coq, with the library that the command has compiled."""
    place = tmp_path_factory.mktemp("kernel")
    shutil.copytree(shown[0] / "library", place / "library")
    return place


def asked(folder: Path, *places: str) -> dict[str, Kernel]:
    outcome = recheck(gather([GOOD / place for place in places]))
    return {one.file: one for one in judged(outcome, folder, 600, lambda note: None)}


@needs_coq
@pytest.mark.slow
def test_the_kernel_accepts_what_the_small_checker_does_and_says_on_which_axioms(folder: Path) -> None:
    result = asked(
        folder, "pub.7g.m1.json", "ext.V-is-positive-definite.json", "pub.17a.json", "pub.2.8.json"
    )
    assert {file: one.axioms for file, one in result.items()} == {
        "pub.7g.m1.json": "float",
        "ext.V-is-positive-definite.json": "real",
        "pub.17a.json": "float",
        "pub.2.8.json": "",
    }
    assert (
        result["pub.2.8.json"].reason
        == "there is no theorem of Coq's for statements of the kind GravityBelow"
    )


@needs_coq
@pytest.mark.slow
def test_the_kernel_refuses_what_is_false(folder: Path) -> None:
    """Theorems with one number changed, behind the back of the small checker."""
    ours = Coq(folder, 600)
    head = "Require Import Lyapcheck.Certificates.\nOpen Scope R_scope.\n"
    true = "Theorem claim : forall x, Rabs (h 2 x) <= 10536 / 10000. Proof. prove_h_at_most. Qed."
    ours.accept("true_one", head + true)
    for false in (true.replace("10536", "10535"), true.replace("h 2", "h 3")):
        with pytest.raises(CoqRefused):
            ours.accept("false_one", head + false)


def faulty(one: Certificate) -> dict[str, Certificate]:
    """The certificate of an ε₀ with one thing wrong in each."""
    statement, proof = one.statement, one.proof
    assert isinstance(statement, Decreasing)
    assert isinstance(proof, PositiveAndDecreasing)
    assert isinstance(proof.rate, BoxTree)
    tree = proof.rate.tree
    heavier = tuple(
        tuple(tuple((powers, 3 * c) for powers, c in entry) for entry in row) for row in statement.mass
    )
    statements = {
        "a wrong number": replace(statement, viscous=((Fraction(1, 10),) * 2, statement.viscous[1])),
        "a false ε₀": replace(statement, eps0=Fraction(9, 10)),
        "the M of another arm": replace(statement, mass=heavier),
    }
    trees = {"a cut tree": tree[: len(tree) // 2], "a longer tree": tree + "."}
    return {name: replace(one, statement=false) for name, false in statements.items()} | {
        name: replace(one, proof=replace(proof, rate=BoxTree(cut))) for name, cut in trees.items()
    }


FORMAL = shipped("formal")
ONE = certificate_of((OWN / "reyes-kelly2.m1.certified.json").read_bytes())[0]


@pytest.mark.parametrize("name", faulty(ONE))
def test_the_small_checker_refuses_planted_faults(name: str) -> None:
    with pytest.raises((Refused, BrokenTree)):
        verify(faulty(ONE)[name].statement, faulty(ONE)[name].proof)


STATE = certificate_of((OWN / "reyes-kelly2.m1.falsified.json").read_bytes())[0]


def faulty_state() -> dict[str, Certificate]:
    """The certificate of a refuted ε₀ with one thing wrong in each."""
    statement, proof = STATE.statement, STATE.proof
    assert isinstance(statement, Decreasing)
    assert isinstance(proof, StateWitness)
    lighter = tuple(
        tuple(tuple((powers, c / 3) for powers, c in entry) for entry in row) for row in statement.mass
    )
    return {
        "an ε₀ that is certified": replace(STATE, statement=replace(statement, eps0=Fraction(4, 5))),
        "the M of another arm": replace(STATE, statement=replace(statement, mass=lighter)),
        "a wrong number": replace(STATE, proof=replace(proof, w=(-proof.w[0], proof.w[1]))),
    }


@pytest.mark.parametrize("name", faulty_state())
def test_the_small_checker_refuses_faults_planted_in_a_state(name: str) -> None:
    with pytest.raises(Refused):
        verify(faulty_state()[name].statement, faulty_state()[name].proof)


@needs_coq
@pytest.mark.slow
def test_a_state_against_an_eps0_is_a_theorem_of_coqs_and_planted_faults_are_none(folder: Path) -> None:
    ours = Coq(folder, 600)
    ours.accept("state", theorem_file(STATE))
    printed = ours.accept("asked_state", "Require Printed.state.\nPrint Assumptions Printed.state.claim.\n")
    assert axioms_of(printed) <= golden("float")
    for false in map(theorem_file, faulty_state().values()):
        with pytest.raises(CoqRefused):
            ours.accept("fault", false)


@needs_coq
@pytest.mark.slow
def test_a_certified_eps0_is_a_theorem_of_coqs_and_planted_faults_are_none(folder: Path) -> None:
    ours = Coq(folder, 600)
    ours.accept("certified", theorem_file(ONE))
    printed = ours.accept("asked", "Require Printed.certified.\nPrint Assumptions Printed.certified.claim.\n")
    assert axioms_of(printed) <= golden("float")
    for false in map(theorem_file, faulty(ONE).values()):
        with pytest.raises(CoqRefused):
            ours.accept("fault", false)


def less(one: Certificate) -> Certificate:
    """The certificate with a hundredth less on the right, of its first part if it has several."""
    statement, proof = one.statement, one.proof
    if isinstance(statement, AllOf):
        assert isinstance(proof, EveryPart)
        statement, proof = statement.parts[0][1], proof.parts[0]
    if isinstance(statement, Implies):
        end = statement.conclusion
        false = replace(statement, conclusion=replace(end, right=("mul", ("num", "99/100"), end.right)))
        return replace(one, statement=false, proof=proof)
    assert isinstance(statement, BoundEveryN | EveryN)
    return replace(
        one, statement=replace(statement, right=("mul", ("num", "99/100"), statement.right)), proof=proof
    )


@needs_coq
@pytest.mark.slow
@pytest.mark.parametrize("name", ["ext.norms", "pub.12", "arc.share"])
def test_statements_for_every_n_and_implications_are_theorems_of_coqs_and_false_ones_are_none(
    folder: Path, name: str
) -> None:
    one = certificate_of((GOOD / f"{name}.json").read_bytes())[0]
    ours = Coq(folder, 600)
    ours.accept("every_n", theorem_file(one))
    with pytest.raises(CoqRefused):
        ours.accept("false_every_n", theorem_file(less(one)))


DEFINED = """h dh U gamma rho L vec norm Arm certified every_robot_is_stable
V_positive_definite V_radially_unbounded only_equilibrium
every_robot_tracks certified_tracking V_bounded_below V_bounded_above equilibrium_of_tracking
M_above M_below C_below M_symmetric C_at_rest M_rate_by_C M_rate_less_2C"""
REALS = {
    "Rabs": "Rbasic_fun.Rabs",
    "sqrt": "R_sqrt.sqrt",
    "exp": "Rtrigo_def.exp",
    "ln": "Rpower.ln",
    "sin": "Rtrigo_def.sin",
    "cos": "Rtrigo_def.cos",
    "tan": "Rtrigo1.tan",
    "asin": "Ratan.asin",
    "acos": "Ratan.acos",
    "atan": "Ratan.atan",
    "sinh": "Rtrigo_def.sinh",
    "cosh": "Rtrigo_def.cosh",
    "tanh": "Rtrigo_def.tanh",
    "PI": "Rtrigo1.PI",
}


@needs_coq
@pytest.mark.slow
def test_names_of_statements_are_those_of_the_page_of_definitions_and_of_coqs_reals(folder: Path) -> None:
    """Other files of the library have vectors and norms of their own."""
    places = {name: f"Lyapcheck.Definitions.{name}" for name in DEFINED.split()}
    places |= {name: f"Coq.Reals.{place}" for name, place in REALS.items()}
    checks = (f"Check (eq_refl : @eq _ {name} {place}).\n" for name, place in places.items())
    Coq(folder, 600).accept("names", HEAD + "".join(checks))


@needs_coq
@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "buap3.m1.stable",
        "arms.all.m1",
        "7a.m2",
        "h.odd.m2",
        "19n.m2",
        "21.m1",
        "21.loop.m1",
        "arm.21.m1",
        "2.1",
    ],
)
def test_claims_of_the_table_are_theorems_of_coqs(folder: Path, name: str) -> None:
    one = certificate_of((OWN / f"{name}.json").read_bytes())[0]
    Coq(folder, 600).accept("one_of_the_table", theorem_file(one))


def false_ones() -> dict[str, Certificate]:
    """Statements with one number changed, so that they are false."""
    arm = certificate_of((OWN / "arm.21.m1.json").read_bytes())[0]
    heavy, small, printed = (
        certificate_of((GOOD / f"{name}.json").read_bytes())[0]
        for name in ("pub.2.2", "ext.small-shared", "pub.T2.pdkv.base")
    )
    assert isinstance(arm.statement, StableArm)
    assert isinstance(heavy.statement, MassBelow)
    assert isinstance(small.statement, ForSmall)
    assert isinstance(printed.statement, Agrees)
    faster = tuple((name, 200 if name == "vd" else value) for name, value in arm.statement.numbers)
    conclusion = replace(small.statement.conclusion, right=("mul", ("num", "-2"), ("var", "t")))
    return {
        "a goal too fast for this ε₀": replace(arm, statement=replace(arm.statement, numbers=faster)),
        "a bound below the norm of M": replace(heavy, statement=replace(heavy.statement, high=Fraction(3))),
        "a leading term below 0": replace(small, statement=replace(small.statement, conclusion=conclusion)),
        "a printed number of its own": replace(printed, statement=replace(printed.statement, printed="0.5")),
    }


@needs_coq
@pytest.mark.slow
@pytest.mark.parametrize("name", false_ones())
def test_false_statements_of_the_table_are_no_theorems_of_coqs(folder: Path, name: str) -> None:
    with pytest.raises(CoqRefused):
        Coq(folder, 600).accept("false_of_the_table", theorem_file(false_ones()[name]))


@needs_coq
@pytest.mark.slow
def test_gains_on_a_computer_are_theorems_of_coqs_and_those_beyond_the_border_are_none(folder):
    ours = Coq(folder, 600)
    for name in ("printed", "printed-border", "printed-rest", "potential"):
        ours.accept("runs", theorem_file(certificate_of((GOOD / f"{name}.sam.json").read_bytes())[0]))
    for name in (
        "equality",
        "late",
        "own-bound-alone",
        "taps-that-cancel",
        "range",
        "low-k_g",
        "an-angle-twice",
    ):
        statement, proof = read(f"bad/{name}.sam")
        shown, _ = read(f"good/{'printed' if statement.k_g else 'potential'}.sam")
        script = sampled_script(shown, proof)
        with pytest.raises(CoqRefused, match="eq_refl"):
            ours.accept(
                "runs_not", f"{HEAD}Theorem claim : {proposition(statement)}.\nProof.\n{script}\nQed.\n"
            )


@needs_coq
@pytest.mark.slow
def test_an_axiom_of_its_own_is_no_proof(folder):
    ours = Coq(folder, 600)
    ours.accept("cheat", "Theorem claim : 0 = 1. Admitted.\n")
    printed = ours.accept("ask", "Require Printed.cheat.\nPrint Assumptions Printed.cheat.claim.\n")
    assert not axioms_of(printed) <= golden("float")


@needs_coq
@pytest.mark.slow
def test_the_command_shows_it_and_believes_no_file_that_is_there(
    shown: tuple[Path, CompletedProcess[str]],
) -> None:
    place, done = shown
    assert done.returncode == 0, done.stderr
    (row,) = json.loads(done.stdout)["certificates"]
    assert row["grade"] == "kernel"
    assert row["kernel"]["theorem"] == "V_positive_definite 1"
    assert list((place / "printed").glob("c_*.v"))
    assert (place / "library" / "Definitions.vo").stat().st_size > 1000
