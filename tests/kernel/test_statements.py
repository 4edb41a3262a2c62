"""What Coq is asked is printed from a certificate: all of its data, nothing else, byte for byte."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from lyapcheck.check.certificate import Certificate, certificate_of
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.statement import Relation
from lyapcheck.kernel import theorem_file
from lyapcheck.kernel.statements import proposition, shown
from lyapcheck.kernel.terms import NotPrinted, expression, identifier, rational
from tests.helpers.shares import one_in

HERE = Path(__file__).parent
GOOD = HERE.parent / "arena" / "good"
OWN = HERE / "certificates"
"""A few more, of claims that the arena has not."""
GOLDEN = HERE / "statements.txt"
"""To be read by a person: each claim in the checker's words, and below it what Coq is asked."""


@cache
def certificates() -> list[tuple[str, Certificate]]:
    """The committed certificates by their places."""
    return [
        (path.relative_to(folder).as_posix(), certificate_of(path.read_bytes())[0])
        for folder in (GOOD, OWN)
        for path in sorted(folder.rglob("*.json"))
    ]


def page() -> str:
    """All pairs, each statement once."""
    lines: dict[str, None] = {}
    for _, one in certificates():
        try:
            theorem_file(one)
        except NotPrinted:
            continue
        asked = shown(one.statement, one.proof, one.verdict)
        member = f" (m = {one.claim.m})" if one.claim.m else ""
        lines[f"{one.claim.id}{member} {one.verdict}: {one.statement.text()}\n    {asked}\n"] = None
    return "\n".join(lines)


@pytest.mark.slow
def test_what_coq_is_asked_is_what_is_written_down() -> None:
    assert page() == GOLDEN.read_text(encoding="utf-8")


def test_every_number_of_a_statement_is_in_the_theorem() -> None:
    relation = Relation(("h", 7, ("var", "x")), "<=", ("num", "4115/226"))
    asked = shown(
        ForAll(relation, Fraction(-3, 4), None, open_low=True), certificates()[0][1].proof, "proved"
    )
    assert asked == "forall v_x : R, ((-3 / 4) < v_x) -> ((h 7 v_x) <= (4115 / 226))"


def numbers_changed(value: object) -> object:
    """The same statement with another number in it, the first that there is."""
    if isinstance(value, Relation):
        return replace(value, right=("add", value.right, ("num", "1/7")))
    return value


@pytest.mark.parametrize(
    "place", one_in(2, ["pub.7g.m1.json", "pub.T2.pd.base.json", "pub.17a.json", "pub.18.json"])
)
def test_another_number_is_another_theorem(place: str) -> None:
    one = dict(certificates())[place]
    name = "conclusion" if hasattr(one.statement, "conclusion") else "relation"
    other = replace(one.statement, **{name: numbers_changed(getattr(one.statement, name))})
    assert shown(other, one.proof, one.verdict) != shown(one.statement, one.proof, one.verdict)


def test_the_tracking_scheme_is_printed_of_its_own_torque_alone() -> None:
    one = dict(certificates())["21.m1.json"].statement
    assert isinstance(one, Stable)
    system = one.argument.system
    assert proposition(one) == "forall n : nat, every_robot_tracks n 1"
    *rest, last = system.torque
    assert last == ("apply", ("diag", "B"), ("vec", "dqd"))
    less = replace(one, argument=replace(one.argument, system=replace(system, torque=tuple(rest))))
    with pytest.raises(NotPrinted, match="neither"):
        proposition(less)


def test_an_arm_that_tracks_is_printed_with_the_velocity_of_its_goal() -> None:
    one = dict(certificates())["arm.21.m1.json"].statement
    assert isinstance(one, StableArm)
    assert proposition(one).endswith(" (117843957 # 3355443200)%Q (2 # 1)%Q")
    without = tuple(pair for pair in one.numbers if pair[0] != "vd")
    with pytest.raises(NotPrinted, match="any velocity"):
        proposition(replace(one, numbers=without))


def test_a_coriolis_matrix_that_is_printed_is_not_taken_for_that_of_christoffel() -> None:
    with pytest.raises(NotPrinted, match="a printed Coriolis matrix"):
        proposition(dict(certificates())["ext.RateOfMass.printed.json"].statement)


def test_every_number_of_gains_on_a_computer_is_in_the_theorem() -> None:
    of_bounds, of_potential = (
        dict(certificates())[f"{name}.sam.json"].statement for name in ("printed", "potential")
    )
    assert isinstance(of_bounds, SampledStable)
    assert isinstance(of_potential, SampledStable)
    third = (Fraction(1, 3),) * 3
    changes = {
        "m": 2,
        "delay": 1,
        "conclusion": "rest",
        "taps": third,
        "period": third[0],
        "stretch": 3 * third[0] + 1,
    }
    changes |= dict.fromkeys(("kp", "kv", "viscous_min", "k_g"), third)
    asked = {proposition(replace(of_bounds, **{name: value})) for name, value in changes.items()}  # type: ignore[arg-type]
    assert len(asked | {proposition(of_bounds)}) == len(changes) + 1
    others = {"potential": (((1, 0, 1), Fraction(1)),), "parameters": ((Fraction(1), Fraction(9)),)}
    asked = {proposition(replace(of_potential, **{name: value})) for name, value in others.items()}  # type: ignore[arg-type]
    assert len(asked | {proposition(of_potential)}) == 3
    with pytest.raises(NotPrinted, match="a chain of links"):
        proposition(dict(certificates())["links.sam.json"].statement)


def test_a_letter_of_a_certificate_is_not_taken_for_the_vector_of_a_norm() -> None:
    one = dict(certificates())["ext.norms.json"]
    diagonal = ((("diag", "x"),), ("num", "2"))
    asked = shown(replace(one.statement, norms=(diagonal,)), one.proof, "proved")
    assert "forall x : vec, norm n (fun i => (v_x i * x i)) <= 2 * norm n x" in asked
    matrix = ((("mat", "v_"),), ("num", "2"))
    asked = shown(replace(one.statement, norms=(matrix,)), one.proof, "proved")
    assert "forall x : vec, norm n (apply_ n v_v_5f_ x) <= 2 * norm n x" in asked


@pytest.mark.parametrize("name", ["x. Admitted", "x)(", "forall", "α", "x′", "h", "(*", "e_1", "e1"])
def test_no_name_of_a_variable_is_a_word_of_coqs(name: str) -> None:
    printed = identifier(name)
    assert printed.startswith("v_")
    assert printed.replace("_", "").isalnum()
    assert printed.isascii()


def test_different_names_are_different_identifiers() -> None:
    names = ["e_1", "e1", "e", "e_", "e′", "ε", "_3b5_", "e_5f_1", "e__1"]
    assert len({identifier(name) for name in names}) == len(names)


def test_an_operation_that_coqs_reals_do_not_have_is_not_printed() -> None:
    with pytest.raises(NotPrinted, match="sech"):
        expression(("sech", ("var", "x")))


@pytest.mark.parametrize(
    ("value", "text"), [("-1/2", "(-1 / 2)"), ("3", "3"), ("-3", "(-3)"), ("7/3", "(7 / 3)")]
)
def test_numbers_bind_tightly(value: str, text: str) -> None:
    assert rational(Fraction(value)) == text
