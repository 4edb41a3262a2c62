"""Arms whose M(q) is too long to be written out: right angles of four digits on seven joints."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck import epsilon, robots
from lyapcheck.answers.gate import gate
from lyapcheck.claims import run_proof
from lyapcheck.control.gains import one_gain_set, read_gain_file
from lyapcheck.control.gravity import computed_bounds
from lyapcheck.family import named
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.command import invoke

LINK = """\
<link name="l{i}"><inertial><origin xyz="0.0{i} 0.02 0.05"/><mass value="{m}"/>
<inertia ixx="0.012" iyy="0.012" izz="0.007" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j{i}" type="revolute"><parent link="l{before}"/><child link="l{i}"/>
<origin xyz="0.01 0.12 0.09" rpy="{turn} 0 0"/><axis xyz="0 0 1"/>
<limit effort="60" velocity="2"/><dynamics damping="0.1{i}" friction="0.2"/></joint>
"""


def arm(folder: Path, first: str) -> str:
    turns = [first] + ["1.5708", "-1.5708"] * 3
    links = (LINK.format(i=i, before=i - 1, m=3 - 0.3 * i, turn=turn) for i, turn in enumerate(turns, 1))
    (folder / "arm.urdf").write_text(f'<robot name="a"><link name="l0"/>{"".join(links)}</robot>')
    gains = ", ".join(["0.5"] * 7)
    text = f'robot = "arm.urdf"\n[[gains]]\nname = "g"\nm = 1\nkp = [{gains}]\nkv = [{gains}]\n'
    (folder / "g.toml").write_text(text)
    return str(folder / "arm.urdf")


@pytest.mark.parametrize(("first", "most"), [("0", 0), ("3.1416", 1e-3), ("0.5", 60)])
def test_gravity_about_a_nearly_vertical_first_axis_is_what_it_is(
    tmp_path: Path, first: str, most: float
) -> None:
    import numpy as np

    model = robots.load(arm(tmp_path, first))
    bounds = computed_bounds(model)
    q = np.random.default_rng(1).uniform(-3, 3, (2000, 7))
    reached = np.abs(NumericModel(model).gravity(q)).max(axis=0)
    assert all(own <= float(bound) for own, bound in zip(reached, bounds, strict=True))
    assert bounds[0] <= Fraction(most)


def test_such_an_arm_is_proved_stable_and_told_how_it_swings(tmp_path: Path) -> None:
    arm(tmp_path, "0")
    (result,) = answer = gate(tmp_path / "g.toml", None, ["10p", "lasalle"])
    assert result.verdict == "accepted"
    assert "estimated damping ratio, at the posture of most inertia: j1 0." in " ".join(str(answer).split())
    proofs = str(tmp_path / "proofs")
    command = ("gate", str(tmp_path / "g.toml"), "--condition", "lasalle", "--certificates", proofs)
    assert invoke(*command).exit_code == invoke("recheck", proofs).exit_code == 0


@pytest.mark.slow
def test_such_an_arm_has_a_certified_epsilon_and_v_falls_with_it(tmp_path: Path) -> None:
    import numpy as np

    model = robots.load(arm(tmp_path, "0"))
    known = one_gain_set(tmp_path / "g.toml")
    certified = epsilon(known, model).certified
    assert certified is not None
    gains = [*map(float, known.kp)], [*map(float, known.kv)]
    lyapunov = LyapunovNumeric(model, named("hyperbolic", 1), *gains, float(certified))
    q, e, w = np.random.default_rng(2).normal(size=(3, 3000, 7)) * np.array([2.0, 2.0, 0.5])[:, None, None]
    assert lyapunov.rate(q, e, w).max() < 0
    proofs = str(tmp_path / "proofs")
    command = ("gate", str(tmp_path / "g.toml"), "--condition", "scalar", "--certificates", proofs)
    assert invoke(*command).exit_code == invoke("recheck", proofs).exit_code == 0


@pytest.mark.slow
def test_claims_of_norms_are_proved_along_the_links_and_those_of_M_in_full_are_open(tmp_path: Path) -> None:
    """Where one statement needs M(q) written out, the others of its script are decided."""
    own, gains = arm(tmp_path, "0"), read_gain_file(tmp_path / "g.toml")
    only = ["arm.properties", "arm.M", "arm.C", "arm.theta"]
    rows = {row.id: row for row in run_proof("scalar.py", (1,), own, gains=gains, only=only).claims}
    assert [rows[name].verdict.value for name in only] == ["undecided", "proved", "proved", "proved"]
    assert "too many to write out" in rows["arm.properties"].decision.reason
