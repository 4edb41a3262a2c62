"""The checker of global certificates: trees of boxes, P in balls, tail, symmetry, and what it must refuse."""

import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.loop import ClosedLoop
from lyapcheck.check.loop.field import BALLS, SPANS, BrokenTree, Span, halves, leaves
from lyapcheck.check.loop.schur import Evaluator, proves, proves_part
from lyapcheck.check.loop.states import State, rate
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.harmonics import derivative, is_mirrored
from lyapcheck.check.numbers.polynomials import dyadic
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.family import named
from lyapcheck.robots import load
from lyapcheck.search.certified import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import SchurProblem
from tests.helpers.schur import schur_of
from tests.helpers.shares import one_in

F = Fraction
TENTH = F(1, 10)
GAINS = {
    "buap3": read_gain_file(paper_gain_file("table2")).gains,
    "reyes-kelly2": read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains,
    "pendulum1": tuple(GainSet(f"m{m}", m, (F(20),), (F(1, 5),)) for m in (1, 2, 3)),
}
CASES = [(robot, index) for robot in GAINS for index in range(3)]


def loop(robot, index, eps0=TENTH):
    gains = GAINS[robot][index]
    return ClosedLoop(ControlledArm(gains, load(robot)).arm, gains.family, gains.m, gains.kp, gains.kv, eps0)


def exact_schur(robot, index, eps0, q, e):
    """P at one state of a built-in arm."""
    return schur_of(load(robot), GAINS[robot][index], eps0, q, e)


@pytest.mark.parametrize(("robot", "index"), one_in(4, CASES))
def test_P_over_a_box_holds_P_of_every_state_in_it(robot, index):
    case = loop(robot, index)
    generator = np.random.default_rng(index)
    joints, angles = range(case.n), case.angles
    with precision(64):
        evaluator = Evaluator(case, BALLS)
        for _ in range(25):
            width = 10.0 ** generator.uniform(-3, 0.3)
            middle = generator.uniform(-2, 2, len(angles) + case.n)
            box = tuple((float(x - width), float(x + width)) for x in middle)
            sides, errors = box[: len(angles)], box[len(angles) :]
            P = evaluator.schur(sides, errors, ())
            for _ in range(8):
                point = np.array([generator.uniform(*side) for side in box])
                q = generator.uniform(-3, 3, case.n)
                q[list(angles)] = point[: len(angles)]
                exact = exact_schur(robot, index, 0.1, q, point[len(angles) :])
                for i, j in product(joints, repeat=2):
                    if j <= i:
                        low, high = float(P[i][j].lower()), float(P[i][j].upper())
                        assert low - 1e-12 <= exact[i, j] <= high + 1e-12


@pytest.mark.parametrize(("robot", "index"), CASES)
def test_P_positive_definite_means_that_V_falls_for_every_rate(robot, index):
    """The reduction itself, against the checker's independent dV/dt in balls."""
    case, gains = loop(robot, index, F(1, 2)), GAINS[robot][index]
    controlled = ControlledArm(gains, load(robot))
    generator = np.random.default_rng(7 + index)
    shown = 0
    for _ in range(30):
        q, e = generator.uniform(-3, 3, case.n), generator.uniform(-2, 2, case.n)
        if np.linalg.eigvalsh(exact_schur(robot, index, 0.5, q, e))[0] < 1e-9:
            continue
        for scale in (1e-3, 0.1, 1.0, 30.0, 1e4):
            parts = (q, e, scale * generator.normal(size=case.n))
            state = State(*(tuple(F(float(x)) for x in part) for part in parts))
            assert rate(case.arm, controlled.controller, F(1, 2), state) < 0
            shown += 1
    assert shown or robot == "buap3"


def grown(case, deepest):
    """A tree by plain halving, side after side, as far as the checker's own evaluator needs."""
    with precision(64):
        evaluator = Evaluator(case, BALLS)

        def grow(box, depth):
            if depth == deepest or evaluator.proves(box):
                return "."
            side = max(range(len(box)), key=lambda i: box[i][1] - box[i][0])
            return str(side) + "".join(grow(half, depth + 1) for half in halves(box, side))

        return grow(case.start, 0)


@pytest.mark.parametrize("index", [0, 1, 2])
def test_a_pendulum_is_proved_below_its_limit_and_refused_above(index):
    """At e → 0 (m = 1), and at the peak of h' (m > 1), P is B − ε₀ρJ/(1+r) less a little."""
    arm = loop("pendulum1", index).arm
    inertia, friction = float(sum(c for _, c in arm.mass[0][0])), float(arm.viscous[0])
    rho = float(named("hyperbolic", index + 1).constants().rho.upper)
    low, high = F(friction / inertia / rho * 0.3), F(friction / inertia / rho * 4)
    fine = loop("pendulum1", index, low)
    assert proves(fine, grown(fine, 12))
    wrong = loop("pendulum1", index, high)
    assert not proves(wrong, grown(wrong, 8))


@pytest.mark.slow
def test_two_joints_are_proved_at_99_percent_and_refused_just_above_the_falsified():
    case = loop("reyes-kelly2", 0, F("0.802"))
    tree = grown(case, 40)
    assert proves(case, tree)
    assert all(proves_part(case, tree, part, 3) for part in range(3))
    assert not proves(replace(case, eps0=F("0.8106")), tree)


@pytest.mark.parametrize("tree", ["", "0", "0.", "..", "9..", "x..", "0...", "-.."])
def test_broken_trees_are_refused(tree):
    with pytest.raises(BrokenTree):
        list(leaves(((0.0, 1.0), (0.0, 1.0)), tree))


@st.composite
def trees(draw, sides=3, depth=6):
    if depth == 0 or draw(st.booleans()):
        return "."
    side = draw(st.integers(0, sides - 1))
    return str(side) + draw(trees(sides, depth - 1)) + draw(trees(sides, depth - 1))


@given(trees(), st.lists(st.floats(-1, 1), min_size=3, max_size=3))
def test_leaves_cover_the_start(tree, point):
    boxes = list(leaves(((-1.0, 1.0),) * 3, tree))
    assert any(all(low <= x <= high for x, (low, high) in zip(point, box, strict=True)) for box in boxes)
    volume = sum(np.prod([high - low for low, high in box]) for box in boxes)
    assert volume == pytest.approx(8.0)


def test_mirrors_of_sines_and_cosines_and_their_slopes():
    terms = {(1, -2): (F(1), F(2)), (0, 1): (F(0), F(3))}
    assert not any(is_mirrored(terms, turned, sign) for turned in ((-1, 1), (1, -1)) for sign in (1, -1))
    assert not any(is_mirrored(terms, (-1, -1), sign) for sign in (1, -1))
    even, odd = (dict.fromkeys([(1, 2), (1, -2)], own) for own in ((F(1), F(0)), (F(0), F(1))))
    for part, turned, sign in ((even, (-1, 1), 1), (odd, (1, -1), 1), (odd, (-1, 1), -1)):
        assert is_mirrored(part, turned, sign)
        assert not is_mirrored(part, turned, -sign)
    assert derivative(terms, 1) == {(1, -2): (F(-4), F(2)), (0, 1): (F(3), F(0))}


@pytest.mark.parametrize("arithmetic", [BALLS, SPANS], ids=["balls", "spans"])
def test_P_over_ranges_holds_P_of_every_arm_in_them(arithmetic):
    model, gains = load("buap3"), GAINS["buap3"][1]
    case = ControlledArm(gains, model, ranges=True).loop(TENTH)
    generator = np.random.default_rng(5)
    first, last = len(case.angles), len(case.angles) + case.n
    with precision(64):
        evaluator = Evaluator(case, arithmetic)
        for _ in range(20):
            width = 10.0 ** generator.uniform(-2, 0)
            middle = generator.uniform(-2, 2, last)
            box = (*((float(x - width), float(x + width)) for x in middle), *case.start[last:])
            P = evaluator.schur(box[:first], box[first:last], box[last:])
            for _ in range(5):
                point = [generator.uniform(*side) for side in box]
                arm = at_random(model, point[last:])
                q = np.array([0.7, *point[:first]])
                exact = schur_of(arm, gains, 0.1, q, np.array(point[first:last]))
                for i in range(3):
                    for j in range(i + 1):
                        entry = Span.of(P[i][j]) if isinstance(P[i][j], arb) else P[i][j]
                        assert float(entry.low) - 1e-12 <= exact[i, j] <= float(entry.high) + 1e-12


def at_random(model, values):
    """The arm with its uncertain numbers, parameters first and then friction, at given values."""
    exact = iter(F(value) for value in values)
    parameters = {name: replace(x, value=next(exact)) for name, x in model.parameters.items()}
    viscous = tuple(replace(x, value=next(exact)) if x.ranged else x for x in model.viscous)
    return replace(model, parameters=parameters, viscous=viscous)


def test_a_proof_over_ranges_is_a_proof_for_each_arm_in_them():
    gains, model = GAINS["buap3"][1], load("buap3")
    case = ControlledArm(gains, model, ranges=True).loop(F("0.055"))
    outcome = certify(SchurProblem(case), 20_000)
    assert outcome.proved
    assert proves(case, outcome.tree)
    assert not proves(replace(case, viscous=((F(1, 100), F(3)),) * 3), outcome.tree)
    assert not proves(replace(case, parameters=((F(1), F(90)), *case.parameters[1:])), outcome.tree)


numbers = st.floats(-1e3, 1e3)


@given(numbers, numbers, numbers, numbers, st.floats(0, 1), st.floats(0, 1))
def test_spans_hold_what_they_should(a, b, c, d, s, t):
    first, second = (Span(arb(min(ends)), arb(max(ends))) for ends in ((a, b), (c, d)))
    x, y = F(a) + F(s) * (F(b) - F(a)), F(c) + F(t) * (F(d) - F(c))
    results = [(first + second, x + y), (first - second, x - y), (first * second, x * y)]
    results += [(first.square(), x * x), (first.meet(first), x)]
    if second.positive:
        results.append((first / second, x / y))
    for span, exact in results:
        assert dyadic(span.low) <= exact <= dyadic(span.high)


def test_undefined_spans_are_not_positive():
    wide = Span(arb(1), arb(1)) / Span(arb(-1), arb(1))
    assert not wide.positive
    assert not (wide - wide).positive
    assert not Span.of(arb("nan")).positive


@pytest.mark.slow
def test_a_script_without_a_guard_may_share_boxes_between_processes(tmp_path):
    """The processes import what they need and do not run the script again."""
    script = tmp_path / "script.py"
    script.write_text(
        "from fractions import Fraction\n"
        "from lyapcheck import load_robot, paper_gain_file, read_gain_file\n"
        "from lyapcheck.check.loop import schur\n"
        "from lyapcheck.computing import shared_between\n"
        "from lyapcheck.search.certified import certify\n"
        "from lyapcheck.search.controlled_arm import ControlledArm\n"
        "from lyapcheck.search.schur import SchurProblem\n"
        "gains = read_gain_file(paper_gain_file('table2_shoulder_elbow')).gains[0]\n"
        "loop = ControlledArm(gains, load_robot('reyes-kelly2')).loop(Fraction(7, 10))\n"
        "schur.WORTH_SHARING = 0\n"
        "with shared_between(2):\n"
        "    print(schur.proves(loop, certify(SchurProblem(loop), 10_000).tree))\n"
    )
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == ("True\n", "")
