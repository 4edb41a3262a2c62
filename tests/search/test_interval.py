"""P over boxes in doubles, by ranges and by middles and slopes, against its values at states."""

from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.check.loop.field import ball
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.check.numbers.members import member
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.family import named
from lyapcheck.robots import load, trig
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.boxes import Interval, of_sides, positive_definite, unit_vector
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import Reach, SchurProblem, _Boxes
from tests.helpers.schur import schur_of
from tests.helpers.shares import one_in

F = Fraction
ROUNDING = 1e-12
FUNCTIONS = [("hyperbolic", m) for m in (1, 2, 7)] + [
    (name, None) for name in ("arctan", "algebraic", "tanh")
]


def holds(x, value, size=1.0):
    return np.all((x.lo <= value + ROUNDING * size) & (value - ROUNDING * size <= x.hi))


def boxes_and_states(random, sides, count):
    """Boxes of all sizes, each with a state in it."""
    low, width = random.uniform(-2.5, 2.5, (count, sides)), 10.0 ** random.uniform(-3, 0.3, (count, 1))
    boxes = np.stack([low, low + width], axis=1)
    return boxes, low + random.uniform(size=(count, sides)) * width


@pytest.mark.parametrize(("name", "m"), FUNCTIONS)
def test_ranges_hold_h_and_its_slope(name, m):
    random, function = np.random.default_rng(m), member(name, m)
    boxes, states = boxes_and_states(random, 3, 500)
    ranges = of_sides(lambda side: (function.h(ball(side)), function.dh(ball(side))))
    h, dh = ranges(Interval(boxes[:, 0], boxes[:, 1]))
    assert h.lo.shape == states.shape
    assert holds(h, named(name, m).h(states))
    assert holds(dh, named(name, m).dh(states), 4 * (m or 1))
    # the ranges are tight: some box has both ends among its values at a fine grid
    grid = named(name, m).dh(np.linspace(boxes[0, 0], boxes[0, 1], 4001))
    assert np.allclose([dh.lo[0], dh.hi[0]], [grid.min(axis=0), grid.max(axis=0)], atol=1e-5)


@pytest.mark.parametrize("robot", one_in(2, ["buap3", "reyes-kelly2"]))
def test_polynomials_reach_what_they_say(robot):
    model, random = load(robot).fixed(), np.random.default_rng(5)
    entries = [harmonics(trig.to_terms(entry), model.n) for row in model.mass for entry in row]
    reach = Reach(entries, model.n)
    boxes, states = boxes_and_states(random, model.n, 2000)
    ends = reach.on(boxes.mean(axis=1), 0.5 * (boxes[:, 1] - boxes[:, 0]))
    assert holds(Interval(*ends), NumericModel(model).mass(states).reshape(len(states), -1), 10)
    # a turn and a half around the whole circle reaches all values, and no more than the sizes
    whole = reach.on(np.zeros((1, model.n)), np.full((1, model.n), 9.0))
    assert np.all(whole[1] <= np.abs(reach._coefficients).sum(axis=0) * (1 + 1e-8))


def test_the_unit_vector_holds_every_direction_of_a_box():
    boxes, states = boxes_and_states(np.random.default_rng(6), 3, 3000)
    unit = unit_vector([Interval(boxes[:, 0, k], boxes[:, 1, k]) for k in range(3)])
    for k, x in enumerate(unit):
        assert holds(x, states[:, k] / np.linalg.norm(states, axis=1))
    zero = unit_vector([Interval(np.zeros(1), np.ones(1)), Interval(-np.ones(1), np.ones(1))])
    assert [float(end[0]) for x in zero for end in (x.lo, x.hi)] == [0.0, 1.0, -1.0, 1.0]


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
