"""What entries of U and Q_j cost, and the bounds that are chosen by it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck import load_robot, read_gain_file
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.link_bounds import fitted, link_bounds

F = Fraction
EXAMPLES = Path(__file__).parents[2] / "examples"


def controlled(name, m):
    gains = next(item for item in read_gain_file(EXAMPLES / f"{name}_gains.toml").gains if item.m == m)
    return ControlledArm(gains, load_robot(str(EXAMPLES / f"{name}.toml")))


@pytest.mark.slow
def test_bounds_that_are_fitted_allow_more_on_five_joints_of_the_ur5(tmp_path):
    text = (EXAMPLES / "ur5.urdf").read_text(encoding="utf-8")
    five, _, _ = text.partition('<joint name="wrist_3_joint"')
    (tmp_path / "ur5.urdf").write_text(f"{five}</robot>\n", encoding="utf-8")
    arm_file, _, _ = (
        (EXAMPLES / "ur5.toml").read_text(encoding="utf-8").partition('[[joints]]\nname = "wrist_3')
    )
    (tmp_path / "ur5.toml").write_text(arm_file, encoding="utf-8")
    whole = controlled("ur5", 2)
    gains = replace(whole.gains, kp=whole.gains.kp[:5], kv=whole.gains.kv[:5])
    arm = ControlledArm(gains, load_robot(str(tmp_path / "ur5.toml")))
    falsified = F("1.704707")
    plain = link_bounds(arm)
    assert plain is not None
    bounds, failing = fitted(arm, plain, falsified)
    assert failing > F(87, 100) * falsified
    loop = arm.loop(F(85, 100) * falsified)
    found = ErrorBoxes(loop, bounds).covered(40_000)
    assert found.proved
