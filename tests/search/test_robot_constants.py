"""λmin(M), λmax(M) and k_c of the arms against closed forms, spent budgets and arms with errors."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.verify import verify
from lyapcheck.constants import arm_constants, robot_bounds, robot_constants
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.robot_cases import BUILT_IN
from tests.helpers.shares import but

F = Fraction
ROOT = Path(__file__).parents[2]


@cache
def constants(name):
    """All of an arm that comes along."""
    return arm_constants(load(name))


def angles(n, count=20_000):
    """Random angles, and every combination of quarter turns, where extremes often are."""
    quarters = np.stack(np.meshgrid(*[np.arange(4) * np.pi / 2] * n, indexing="ij"), axis=-1).reshape(-1, n)
    return np.concatenate([quarters, np.random.default_rng(n).uniform(-np.pi, np.pi, (count, n))])


@pytest.mark.parametrize("name", but(["reyes-kelly2"], BUILT_IN))
def test_gaps_are_small_and_all_is_shown(name):
    """k_c is that of C(q, x)x; boxes show norms of the Christoffel symbols."""
    for constant in constants(name):
        low, high = constant.enclosure.lower, constant.enclosure.upper
        assert 0 <= low <= high
        assert high - low <= (F(1, 5) if constant.name == "k_c" else F(1, 1000)) * high
        assert constant.shown is not None
        assert verify(constant.shown.statement, constant.shown.proof).verdict == "proved"
        assert constant.shown.bound == (low if constant.name == "lambda_min" else high)


@pytest.mark.parametrize(("name", "bend"), [("reyes-kelly2", 0.084), ("pelican2", None)])
def test_two_joints_in_closed_form(name, bend):
    """M = [[a + 2k cos q₂, b + k cos q₂], [·, b]], C(q,x) = −k sin q₂ [[x₂, x₁ + x₂], [−x₁, 0]].

    Both eigenvalues are extreme at q₂ = 0, where a + 2k + b is largest and the determinant least.
    """
    model = load(name)
    M = NumericModel(model).mass(np.array([[0.0, 0.0], [0.0, np.pi / 2]]))
    k = M[0, 0, 1] - M[1, 0, 1]
    assert bend is None or k == pytest.approx(bend)
    (a, b), (_, d) = M[0]
    root = sqrt((a - d) ** 2 + 4 * b * b)
    result = robot_constants(model)
    expected = {"lambda_min": (a + d - root) / 2, "lambda_max": (a + d + root) / 2}
    turn = np.linspace(0, np.pi, 20_001)
    x1, x2, zero = np.cos(turn), np.sin(turn), np.zeros_like(turn)
    shape = np.stack([np.stack([x2, x1 + x2], -1), np.stack([-x1, zero], -1)], -2)
    expected["k_c"] = k * float(np.linalg.norm(shape, ord=2, axis=(1, 2)).max())
    for constant, value in expected.items():
        enclosure = getattr(result, constant)
        assert enclosure.lower * (1 - F(1, 10**8)) <= value <= enclosure.upper * (1 + F(1, 10**8))
        inner = enclosure.upper if constant == "lambda_min" else enclosure.lower
        assert float(inner) == pytest.approx(value, rel=1e-8)


def test_bounds_handed_to_the_scalar_forms_are_the_outer_ones():
    model = load("reyes-kelly2")
    result, bounds = robot_constants(model), robot_bounds(model)
    assert (bounds.beta_M, bounds.k_c) == (result.lambda_max.upper, result.k_c.upper)
    assert (bounds.viscous_min, bounds.viscous_max) == (F("0.175"), F("2.288"))


@pytest.mark.parametrize("budget", but([1, 300], [1, 40, 300]))
def test_a_smaller_budget_shows_no_more(budget):
    better = {constant.name: constant.enclosure for constant in constants("reyes-kelly2")}
    for constant in arm_constants(load("reyes-kelly2"), budget):
        assert constant.enclosure.lower <= better[constant.name].lower
        assert constant.enclosure.upper >= better[constant.name].upper
        assert constant.shown is not None
        assert verify(constant.shown.statement, constant.shown.proof).verdict == "proved"


def test_only_the_constants_asked_for():
    result = arm_constants(load("pelican2"), names=("k_g2", "lambda_max"))
    assert [constant.name for constant in result] == ["lambda_max", "k_g2"]


def test_an_indefinite_inertia_is_not_called_positive():
    """Data errors happen: the enclosure then lies below zero, it does not end there."""
    model = load("reyes-kelly2")
    (a, b), (_, d) = model.mass
    wrong = replace(model, dynamics=replace(model.dynamics.polynomials, mass=((a, 20 * b), (20 * b, d))))
    result = robot_constants(wrong)
    assert result.lambda_min.upper < 0
    assert np.linalg.eigvalsh(NumericModel(wrong).mass(angles(2))).min() >= result.lambda_min.lower


def test_an_arm_of_many_joints_without_links_has_the_sizes_of_harmonics():
    """Boxes would take minutes; of λmin(M) no more is known than that M is not larger."""
    arm = load(ROOT / "examples" / "px100.toml").fixed()
    printed = replace(arm, dynamics=arm.dynamics.polynomials)
    smallest, largest = arm_constants(printed, names=("lambda_min", "lambda_max"))
    known = arm_constants(arm, names=("lambda_max",))[0].enclosure
    assert largest.shown is not None
    assert largest.shown.proof == HarmonicSizes()
    assert known.lower * F(999, 1000) <= largest.enclosure.lower <= known.upper < largest.enclosure.upper
    assert smallest.shown is None
    assert -largest.enclosure.upper <= smallest.enclosure.lower < 0 < smallest.enclosure.upper
