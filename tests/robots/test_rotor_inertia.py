"""Rotor inertia: M(q) + diag(J) for the J at the joints, everywhere that M is used."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.chain import ChainAbove, OfLinks, OwnMoments
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.constants import arm_constants
from lyapcheck.errors import InputError
from lyapcheck.lyapunov import graph
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.urdf_texts import generic

J = (Fraction(1, 2), Fraction(0), Fraction("0.3"), Fraction("0.02"))
JOINTS = '[[joints]]\nname = "{}"\nrotor_inertia = {}\n'


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[robots.RobotModel, robots.RobotModel]:
    """A skew chain of four joints without rotors, and with them."""
    folder = tmp_path_factory.mktemp("rotor")
    (folder / "arm.urdf").write_text(generic(4, seed=4))
    bare = robots.load(folder / "arm.urdf")
    tables = "".join(JOINTS.format(name, float(j)) for name, j in zip(bare.joints, J, strict=True))
    (folder / "arm.toml").write_text(f'title = "Arm"\nurdf = "arm.urdf"\n{tables}')
    return bare, robots.load(folder / "arm.toml")


@pytest.mark.parametrize("name", ["pelican2", "reyes-kelly2", "buap3"])
def test_links_and_printed_models(tmp_path: Path, name: str) -> None:
    """By the reader: the same file with a line more in each table of a joint."""
    text = robots.arm_file(name).read_text()
    bare = robots.load(name)
    for joint in bare.joints:
        text = text.replace(
            f'name = "{joint}"', f'name = "{joint}"\nrotor_inertia = {{ rotor = 2e-5, gear = 100 }}'
        )
    file = tmp_path / "arm.toml"
    file.write_text(text)
    compare(bare, robots.load(file), [Fraction("0.2")] * bare.n)


def test_a_urdf_arm(pair: tuple[robots.RobotModel, robots.RobotModel]) -> None:
    compare(*pair, J)


def compare(
    bare: robots.RobotModel, arm: robots.RobotModel, J: tuple[Fraction, ...] | list[Fraction]
) -> None:
    rng = np.random.default_rng(1)
    q, w = rng.uniform(-3, 3, (5, bare.n)), rng.uniform(-2, 2, (5, bare.n))
    plain, own = NumericModel(bare), NumericModel(arm)
    np.testing.assert_allclose(own.mass(q), plain.mass(q) + np.diag([float(j) for j in J]), atol=1e-14)
    np.testing.assert_allclose(own.coriolis(q, w), plain.coriolis(q, w), atol=1e-14)
    np.testing.assert_allclose(own.gravity(q), plain.gravity(q), atol=1e-13)
    angles = ca.SX.sym("q", bare.n)
    node = ca.Function("M", [angles], [graph.matrix(graph.at_angles(arm, angles).mass())])
    np.testing.assert_allclose(np.array(node(q[0])), own.mass(q[0]), atol=1e-13)


@pytest.mark.parametrize("name", ["lambda_min", "lambda_max"])
def test_certified_ends_hold_the_rotors(pair: tuple[robots.RobotModel, robots.RobotModel], name: str) -> None:
    """Each side of the enclosure: a state reaches one, a certificate shows the other."""
    arm = pair[1]
    (result,) = arm_constants(arm, names=[name])
    masses = NumericModel(arm).mass(np.random.default_rng(2).uniform(-3.2, 3.2, (20_000, 4)))
    seen = np.linalg.eigvalsh(masses)
    extreme = float(seen.min() if name == "lambda_min" else seen.max())
    low, high = map(float, (result.enclosure.lower, result.enclosure.upper))
    outer, inner = (low, high) if name == "lambda_min" else (high, low)
    assert low <= high
    assert outer <= extreme if name == "lambda_min" else extreme <= outer
    assert inner == pytest.approx(extreme, rel=0.02)
    assert outer == pytest.approx(extreme, rel=0.1)
    shown = result.shown
    assert shown is not None
    assert isinstance(shown.statement, OfLinks)
    assert verify(shown.statement, shown.proof).verdict == "proved"
    links = tuple(replace(link, rotor=Fraction(0)) for link in shown.statement.links)
    if name == "lambda_min":  # the forms lean on the rotors
        with pytest.raises(Refused):
            verify(replace(shown.statement, links=links), shown.proof)


def test_a_rotor_alone_makes_M_definite(pair: tuple[robots.RobotModel, robots.RobotModel]) -> None:
    """A link without moment about its axis is refused, and accepted with a rotor."""
    chain = pair[0].chain
    assert chain is not None
    nothing = tuple((Fraction(0),) * 3 for _ in range(3))
    point = replace(chain.links[-1], inertia=nothing, com=(Fraction(0),) * 3)
    with pytest.raises(Refused):
        verify(ChainAbove((*chain.links[:-1], point), Fraction(0)), OwnMoments())
    turned = replace(point, rotor=Fraction(1, 100))
    assert verify(ChainAbove((*chain.links[:-1], turned), Fraction(0)), OwnMoments()).verdict == "proved"
    with pytest.raises(Refused):
        verify(
            ChainAbove((*chain.links[:-1], replace(point, rotor=Fraction(-1, 100))), Fraction(0)),
            OwnMoments(),
        )


def test_certificates_name_a_rotor_only_where_there_is_one(
    pair: tuple[robots.RobotModel, robots.RobotModel],
) -> None:
    bare, arm = (ChainAbove(one.chain.links, Fraction(0)) for one in pair if one.chain is not None)
    assert "rotor" not in json.dumps(to_json(bare)) + repr(bare)
    assert bare.text() != arm.text()
    written = to_json(arm)
    assert [link.get("rotor") for link in written["links"]] == ["1/2", None, "3/10", "1/50"]
    assert from_json(ChainAbove, written, "statement") == arm
    written["links"][1]["rotor"] = "0"  # one way to write it
    with pytest.raises(Refused, match="must be left out"):
        from_json(ChainAbove, written, "statement")


BROKEN = [
    ("-0.1", "must be zero or positive"),
    ("{ rotor = 1e-5 }", "is missing"),
    ("{ rotor = 1e-5, gear = 0 }", "must be positive"),
    ("{ rotor = 1e-5, gear = 50, teeth = 3 }", "is not a known key"),
    ("{ rotor = 1e-5, gear = { value = 5, low = 4, high = 6 } }", "must be exact"),
    ('"0.1"', "must be a finite decimal"),
]


@pytest.mark.parametrize(("text", "rule"), BROKEN)
def test_what_is_no_rotor_inertia_is_told(tmp_path: Path, text: str, rule: str) -> None:
    (tmp_path / "arm.urdf").write_text(generic(1, seed=1))
    name = robots.load(tmp_path / "arm.urdf").joints[0]
    file = tmp_path / "arm.toml"
    file.write_text(f'title = "Arm"\nurdf = "arm.urdf"\n{JOINTS.format(name, text)}')
    with pytest.raises(InputError, match=rule):
        robots.load(file)
