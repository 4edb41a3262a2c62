"""M is positive definite as the kinetic energy of the links: which links show it, and which do not."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.kinds.inertia import Links, MassAbove
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import run_proof
from lyapcheck.robots import RobotModel, load
from lyapcheck.search.closed_loop import mass_of, mass_proof, remember
from lyapcheck.verdicts import Verdict

pytestmark = pytest.mark.usefixtures("in_this_process")

UR5 = str(Path(__file__).parents[2] / "examples" / "ur5.urdf")
ARMS = ("pelican2", UR5)


def links_of(arm: RobotModel) -> Links:
    """The links as a proof."""
    remember(arm)
    proof = mass_proof(mass_of(arm.fixed()))
    assert isinstance(proof, Links)
    return proof


def positive(arm: RobotModel) -> MassAbove:
    """M(q) ≻ 0."""
    return MassAbove(mass_of(arm.fixed()), (), Fraction(0))


def with_link(proof: Links, k: int, **changes: object) -> Links:
    """The proof with the data of one link changed."""
    links = list(proof.links)
    links[k] = replace(links[k], **changes)  # type: ignore[arg-type]
    return Links(tuple(links))


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_of_links_has_a_positive_definite_M(name: str) -> None:
    """Exactly: the energies of the links add up to that of the arm, and the first that moves is positive."""
    arm = load(name)
    accepted = verify(positive(arm), links_of(arm))
    assert (accepted.verdict, accepted.grade) == ("proved", "exact")


@pytest.mark.parametrize(
    "changes",
    [
        {"mass": Fraction(-1)},
        {"mass": Fraction(5)},
        {"inertia": ((Fraction(1), Fraction(0), Fraction(0)),) * 3},
        {"axis": (Fraction(1), Fraction(0), Fraction(0))},
        {"origin": (Fraction(1), Fraction(0), Fraction(0))},
    ],
)
def test_links_that_M_does_not_come_from_prove_nothing(changes: dict[str, object]) -> None:
    arm = load("pelican2")
    with pytest.raises(Refused):
        verify(positive(arm), with_link(links_of(arm), 1, **changes))


def test_fewer_links_or_those_of_a_bound_above_0_prove_nothing() -> None:
    arm = load("pelican2")
    with pytest.raises(Refused, match="one joint and real body"):
        verify(positive(arm), Links(links_of(arm).links[:1]))
    with pytest.raises(Refused, match="energies give no number"):
        verify(replace(positive(arm), low=Fraction(1, 1000)), links_of(arm))


def test_a_link_without_a_moment_about_its_axis_proves_nothing() -> None:
    """A point mass on the axis of the last joint: M is singular there, and the links do make it."""
    arm = load("pelican2")
    zero = Fraction(0)
    proof = with_link(links_of(arm), 1, com=(zero,) * 3, inertia=((zero,) * 3,) * 3)
    assert not proof.links[1].about_axis
    with pytest.raises(Refused):
        verify(positive(arm), proof)


@pytest.mark.slow
def test_properties_of_a_six_joint_arm_are_decided_by_the_proof_script() -> None:
    result = run_proof("published.py", [1], UR5, only=["2.1", "2.2", "2.3", "2.4", "2.5", "2.6"])
    assert {row.id: row.verdict for row in result.claims} == dict.fromkeys(
        ("2.1", "2.2", "2.3", "2.4", "2.5", "2.6"), Verdict.PROVED
    )
