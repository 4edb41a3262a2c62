"""P by its middle and slopes over a box: it holds every state's P, and shows nothing that is false."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from flint import arb

from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.check.loop.proof import proves
from lyapcheck.check.loop.schur import CentredEvaluator, Evaluator, of_error, triangle
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.members import member
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.kernel.arms import _finer
from lyapcheck.robots import load
from lyapcheck.search.certified import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import SchurProblem

F = Fraction
FUNCTIONS = [("hyperbolic", m) for m in (1, 2, 3, 6)] + [
    ("arctan", None),
    ("algebraic", None),
    ("tanh", None),
]
WORST = (-0.116792403, 0.747532357, -0.702554689)
"""Near (q_2, e) of the state that refutes ε₀ = 0.9263773 for m = 2."""


def loop_of(robot, file, index, eps0, ranges=False):
    gains = read_gain_file(paper_gain_file(file)).gains[index]
    return ControlledArm(gains, load(robot), ranges).loop(F(eps0))


TWO = loop_of("reyes-kelly2", "table2_shoulder_elbow", 1, "0.9")
CASES = {
    "n = 2": TWO,
    "weights": replace(TWO, coupling=(F(1), F(1, 2))),
    "another function": replace(TWO, family="arctan", m=None),
    "n = 3": loop_of("buap3", "table2", 2, "0.1"),
    "ranges": loop_of("buap3", "table2", 1, "0.05", ranges=True),
}


@pytest.mark.parametrize("name", CASES)
def test_every_state_of_a_box_has_the_P_of_middle_and_slopes(name):
    case, random = CASES[name], np.random.default_rng(3)
    first, last = len(case.angles), len(case.angles) + case.n
    with precision(128):
        centred, plain = CentredEvaluator(case), Evaluator(case, BALLS)
        for _ in range(12):
            width = 10.0 ** random.uniform(-3, 0)
            low = random.uniform(-2, 2, last)
            box = (*((float(x), float(x + width)) for x in low), *case.start[last:])
            point = [float(random.uniform(*side)) for side in box]
            at = tuple((x, x) for x in point)
            rows = centred.schur(box[:first], box[first:last], box[last:])
            exact = plain.schur(at[:first], at[first:last], at[last:])
            for row, wanted in zip(rows, exact, strict=True):
                for entry, value in zip(row, wanted, strict=True):
                    total = entry.middle
                    for k, (x, side) in enumerate(zip(point, box, strict=True)):
                        total += entry.slopes[0, k] * (arb(x) - arb(0.5 * (side[0] + side[1])))
                    assert total.overlaps(value)
                    assert entry.hull.overlaps(value)


@pytest.mark.parametrize(("family", "m"), FUNCTIONS)
def test_slopes_hold_every_quotient_of_differences(family, m):
    function, random = member(family, m), np.random.default_rng(4)
    with precision(200):
        for _ in range(150):
            low = float(random.choice([-1, 1]) * random.choice([0.5, 2, 20]) * random.random())
            high = low + float(10.0 ** random.uniform(-3, 1))
            c, x = 0.5 * (low + high), float(random.uniform(low, high))
            for f, (_, hull, slope) in zip(
                (function.h, function.dh), of_error(function, (low, high)), strict=True
            ):
                assert hull.overlaps(f(arb(x)))
                assert slope.overlaps((f(arb(x)) - f(arb(c))) / (arb(x) - arb(c)))


@pytest.mark.parametrize(("family", "m"), FUNCTIONS)
def test_the_second_derivative_is_that_of_h(family, m):
    function = member(family, m)
    assert function.d2h is not None
    with precision(300):
        step = arb(2) ** -60
        for x in (0.01, 0.3, 0.7, 0.999, 1.001, 1.6, 3.0, 12.0):
            quotient = (function.dh(arb(x) + step) - function.dh(arb(x) - step)) / (2 * step)
            assert abs(function.d2h(arb(x)) - quotient) < arb(10) ** -25
            assert abs(function.d2h(arb(-x)) + quotient) < arb(10) ** -25
            assert function.d2h(arb(-x).union(arb(2 * x))).overlaps(quotient)


def around(width):
    return tuple((x - width, x + width) for x in WORST)


def test_boxes_near_a_worst_state_may_be_many_times_larger_than_by_ranges():
    case = replace(TWO, eps0=F("0.9256361"))
    with precision(64):
        centred, plain = CentredEvaluator(case), Evaluator(case, BALLS)
        assert centred.proves(around(0.003))
        assert not plain.proves(around(0.0003))


def test_no_box_with_a_state_that_refutes_is_shown():
    with precision(64):
        centred = CentredEvaluator(replace(TWO, eps0=F("0.92638")))
        assert not any(centred.proves(around(width)) for width in (1e-9, 1e-6, 1e-3, 1e-2, 0.1))


@pytest.mark.parametrize(
    "errors", [((-0.1, 0.1), (-0.1, 0.1)), ((0.0, 0.1), (-0.1, 0.0)), ((0.0, 0.0), (0.0, 0.0))]
)
def test_a_box_that_touches_the_origin_is_not_shown(errors):
    with precision(64):
        assert not CentredEvaluator(replace(TWO, eps0=F(1, 100))).proves(((0.1, 0.2), *errors))


def test_without_second_derivative_nothing_is_shown():
    case = replace(TWO, eps0=F(1, 100))
    case.__dict__["member"] = replace(case.member, d2h=None)
    with precision(64):
        assert not CentredEvaluator(case).proves(around(0.001))


def test_the_triangle_makes_a_diagonal():
    random = np.random.default_rng(5)
    root = random.normal(size=(4, 4))
    P = root @ root.T + np.eye(4)
    T = np.eye(4)
    for i, row in enumerate(triangle([list(P[i, : i + 1]) for i in range(4)])):
        T[i, : len(row)] = row
    Q = T @ P @ T.T
    assert np.allclose(Q, np.diag(np.diag(Q)), atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("index", [1, 2])
def test_trees_of_two_joints_near_the_falsified_are_small(index):
    case = loop_of("reyes-kelly2", "table2_shoulder_elbow", index, ("0.9256361", "0.6356907")[index - 1])
    result = certify(SchurProblem(case), 10_000)
    assert result.proved
    assert len(result.tree) < 4_000
    assert proves(case, result.tree)
    assert not proves(replace(case, eps0=case.eps0 * F(1002, 1000)), result.tree)


@pytest.mark.slow
def test_a_kernel_gets_boxes_that_ranges_alone_show():
    case = loop_of("reyes-kelly2", "table2_shoulder_elbow", 1, "0.9")
    tree = certify(SchurProblem(case), 10_000).tree
    finer = _finer(case, tree)
    assert len(finer) > len(tree)
    assert _finer(case, finer) == finer
    assert _finer(case, tree[:-1]) == tree[:-1]


def test_members_of_large_m_have_no_second_derivative():
    """Its extremes would take minutes; the search and the checker do without."""
    assert member("hyperbolic", 60).d2h is not None
    assert member("hyperbolic", 61).d2h is None
