"""What entries of U and Q_j cost, and the bounds that are chosen by it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck import load_robot, read_gain_file
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop.storage import Shown
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.error_boxes import ErrorBoxes, costs_at, smallest_at
from lyapcheck.search.link_bounds import fitted, link_bounds

F = Fraction
EXAMPLES = Path(__file__).parents[2] / "examples"


def controlled(name, m):
    gains = next(item for item in read_gain_file(EXAMPLES / f"{name}_gains.toml").gains if item.m == m)
    return ControlledArm(gains, load_robot(str(EXAMPLES / f"{name}.toml")))


def with_prices(prices):
    """Bounds that nothing shows: U, then Q_2, Q_3, …"""
    inertia, *rates = (Shown(tuple(row), ()) for row in prices)
    return LinkBounds((), inertia, tuple(rates), tuple(rates), "", "")


def test_costs_are_the_slopes_of_the_smallest_eigenvalue():
    arm = controlled("px100", 2)
    loop, n = arm.loop(F(4)), arm.n
    random = np.random.default_rng(3)
    b = [low for low, _ in loop.friction]
    prices = [[F(int(random.integers(5, 40)), 1000) * x for x in b] for _ in range(n)]
    errors = np.abs(random.normal(size=(1, n)))

    def smallest(row, column, change):
        moved = [list(line) for line in prices]
        moved[row][column] += change * b[column]
        return float(smallest_at(ErrorBoxes(loop, with_prices(moved)), errors)[0])

    costs, step = costs_at(ErrorBoxes(loop, with_prices(prices)), errors), F(1, 10**6)
    slopes = [
        [(smallest(row, i, -step) - smallest(row, i, step)) / float(2 * step) for i in range(n)]
        for row in range(n)
    ]
    assert costs == pytest.approx(np.array(slopes), rel=1e-2, abs=1e-6)


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
