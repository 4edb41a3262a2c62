"""P over boxes in doubles, by ranges and by middles and slopes, against its values at states."""

from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.robots import load
from lyapcheck.search.boxes import Interval, positive_definite
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import SchurProblem, _Boxes
from tests.helpers.schur import schur_of

F = Fraction
ROUNDING = 1e-12


def holds(x, value, size=1.0):
    return np.all((x.lo <= value + ROUNDING * size) & (value - ROUNDING * size <= x.hi))


def boxes_and_states(random, sides, count):
    """Boxes of all sizes, each with a state in it."""
    low, width = random.uniform(-2.5, 2.5, (count, sides)), 10.0 ** random.uniform(-3, 0.3, (count, 1))
    boxes = np.stack([low, low + width], axis=1)
    return boxes, low + random.uniform(size=(count, sides)) * width


def test_no_indefinite_matrix_is_positive_definite():
    random = np.random.default_rng(7)
    for _ in range(300):
        a = random.normal(size=(3, 3))
        a = a @ a.T - np.eye(3) * random.choice([0.0, 0.01, 1.0])
        radius = random.choice([0.0, 1e-3, 0.1])
        shown = positive_definite(
            [[Interval(np.array(x - radius), np.array(x + radius)) for x in row] for row in a]
        )
        assert not shown or np.linalg.eigvalsh(a)[0] > radius
        assert shown or radius or np.linalg.eigvalsh(a)[0] < 1e-6
    undefined = Interval(np.array([np.nan, -np.inf]), np.array([np.nan, np.inf]))
    assert not positive_definite([[undefined]]).any()


@pytest.mark.parametrize(("robot", "file"), [("reyes-kelly2", "table2_shoulder_elbow"), ("buap3", "table2")])
def test_P_at_every_state_lies_in_its_ranges(robot, file):
    gains, random = read_gain_file(paper_gain_file(file)).gains[1], np.random.default_rng(8)
    case = ControlledArm(gains, load(robot))
    problem = SchurProblem(case.loop(F(1, 20)))
    first, n = problem.first, problem.loop.n
    boxes, states = boxes_and_states(random, first + n, 60)
    ranges = _Boxes(problem, boxes).P()
    for k, state in enumerate(states):
        q = np.zeros(n)
        q[list(problem.loop.angles)] = state[:first]
        exact = schur_of(case.model, case.gains, 0.05, q, state[first:])
        for i in range(n):
            for j in range(i + 1):
                x = ranges[i][j]
                assert holds(Interval(x.lo[k], x.hi[k]), exact[i, j])
