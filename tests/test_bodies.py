"""M is positive definite as the kinetic energy of the links, where determinants are too large."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.check.expressions.expression import Algebra, evaluate
from lyapcheck.claims import Lacking, bodies, leading_minors, matrix, positive_definite, run_proof, var
from lyapcheck.claims.procedures import propose
from lyapcheck.robots import RobotModel, load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.verdicts import Grade, Verdict

UR5 = str(Path(__file__).parent / "arms" / "ur5.urdf")
ARMS = ("pelican2", UR5)


def altered(arm: RobotModel, k: int, **changes: object) -> RobotModel:
    """The arm with the data of one link changed, and M as it was."""
    assert arm.chain is not None
    links = list(arm.chain.links)
    links[k] = replace(links[k], **changes)
    return replace(arm, chain=replace(arm.chain, links=tuple(links)))


@pytest.mark.parametrize("name", ARMS)
def test_energies_of_the_links_add_up_to_that_of_the_arm(name: str) -> None:
    """Against M in floating point, at random angles and rates."""
    arm = load(name)
    assert arm.chain is not None
    random = np.random.default_rng(3)
    q, w = random.normal(size=(2, arm.n))
    links = bodies(arm.chain, [var(f"w{i + 1}") for i in range(arm.n)])
    values = {f"{letter}{i + 1}": x for letter, row in (("q", q), ("w", w)) for i, x in enumerate(row)}
    found = sum(evaluate(link.energy.tree, values, _Floats()) for link in links)
    assert found == pytest.approx(w @ NumericModel(arm).mass(q) @ w, rel=1e-12)


class _Floats(Algebra):
    def number(self, value: Fraction) -> float:
        return float(value)

    def function(self, name: str, value: float) -> float:
        return float(getattr(np, name)(value))


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_of_links_has_a_positive_definite_M(name: str) -> None:
    decision = propose(positive_definite(load(name)))
    assert (decision.verdict, decision.grade) == (Verdict.PROVED, Grade.EXACT)


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
    assert propose(positive_definite(altered(load("pelican2"), 1, **changes))).verdict is Verdict.REFUTED


def test_a_link_without_a_moment_about_its_axis_proves_nothing() -> None:
    """A point mass on the axis of the last joint: M is singular there, and the energies do add up."""
    arm = load("pelican2")
    zero = Fraction(0)
    bare = altered(arm, 1, com=(zero,) * 3, inertia=((zero,) * 3,) * 3)
    parts = dict(positive_definite(bare).parts)
    assert propose(parts["moment about its axis positive 2"]).verdict is Verdict.REFUTED


def test_properties_of_a_six_joint_arm_are_decided_by_the_proof_script() -> None:
    result = run_proof("published.py", [1], UR5, only=["2.1", "2.2", "2.3", "2.4", "2.5", "2.6"])
    assert {row.id: row.verdict for row in result.claims} == dict.fromkeys(
        ("2.1", "2.2", "2.3", "2.4", "2.5", "2.6"), Verdict.PROVED
    )


def test_determinants_of_many_rows_are_not_tried() -> None:
    with pytest.raises(Lacking, match="5 rows"):
        leading_minors(matrix("a", 5))
