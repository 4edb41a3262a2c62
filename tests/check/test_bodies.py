"""M is positive definite as the kinetic energy of the links: which links show it, and which do not."""

from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.kinds.inertia import Links, MassAbove
from lyapcheck.check.verify import verify
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import mass_proof, remember

pytestmark = pytest.mark.usefixtures("in_this_process")

UR5 = str(Path(__file__).parents[2] / "examples" / "ur5.urdf")
ARMS = ("pelican2", UR5)


def links_of(arm):
    """The links as a proof."""
    remember(arm)
    proof = mass_proof(arm.fixed().mass_terms)
    assert isinstance(proof, Links)
    return proof


def positive(arm):
    """M(q) ≻ 0."""
    return MassAbove(arm.fixed().mass_terms, (), Fraction(0))


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_of_links_has_a_positive_definite_M(name):
    """Exactly: the energies of the links add up to that of the arm, and the first that moves is positive."""
    arm = load(name)
    accepted = verify(positive(arm), links_of(arm))
    assert (accepted.verdict, accepted.grade) == ("proved", "exact")
