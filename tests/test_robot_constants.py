"""λmin(M), λmax(M) and k_c of the arms: enclosures against dense samples, closed forms and spent budgets."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray
from robot_cases import BUILT_IN

from lyapcheck.check.enclosure import Enclosure
from lyapcheck.intervals.arm import ArmIntervals
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search import robot_constants as room
from lyapcheck.search.robot_constants import robot_bounds, robot_constants

F = Fraction
Array = NDArray[np.float64]


def angles(n: int, count: int = 20_000) -> Array:
    """Random angles, and every combination of quarter turns, where extremes often are."""
    quarters = np.stack(np.meshgrid(*[np.arange(4) * np.pi / 2] * n, indexing="ij"), axis=-1).reshape(-1, n)
    return np.concatenate([quarters, np.random.default_rng(n).uniform(-np.pi, np.pi, (count, n))])


@pytest.mark.parametrize("name", BUILT_IN)
def test_no_sampled_state_lies_outside(name: str) -> None:
    found, model = robot_constants(load(name)), NumericModel(load(name))
    q = angles(model.n)
    eigenvalues = np.linalg.eigvalsh(model.mass(q))
    assert eigenvalues.min() >= found.lambda_min.lower * (1 - F(1, 10**12))
    assert eigenvalues.max() <= found.lambda_max.upper * (1 + F(1, 10**12))
    x = np.random.default_rng(0).normal(size=q.shape)
    x /= np.linalg.norm(x, axis=1)[:, None]
    norms = np.linalg.norm(model.coriolis(q, x), ord=2, axis=(1, 2))
    assert norms.max() <= found.k_c.upper + F(1, 10**12)
    # and the bounds are not merely safe
    assert eigenvalues.min() < found.lambda_min.upper * F(11, 10)
    assert eigenvalues.max() > found.lambda_max.lower * F(9, 10)
    assert norms.max() >= found.k_c.lower * F(8, 10)


@pytest.mark.parametrize("name", BUILT_IN)
def test_the_states_handed_back_show_the_inside_bounds(name: str) -> None:
    found, model = robot_constants(load(name)), NumericModel(load(name))
    least = np.linalg.eigvalsh(model.mass(np.array(found.lambda_min_at)))[0]
    largest = np.linalg.eigvalsh(model.mass(np.array(found.lambda_max_at)))[-1]
    assert least == pytest.approx(float(found.lambda_min.upper), rel=1e-9)
    assert largest == pytest.approx(float(found.lambda_max.lower), rel=1e-9)


@pytest.mark.parametrize("name", BUILT_IN)
def test_gaps_are_small(name: str) -> None:
    found = robot_constants(load(name))
    for enclosure, gap in (
        (found.lambda_min, F(1, 500)),
        (found.lambda_max, F(1, 500)),
        (found.k_c, F(1, 20)),
    ):
        assert enclosure.lower <= enclosure.upper
        assert enclosure.width <= gap * enclosure.upper
    assert found.lambda_min.lower > 0


def test_a_pendulum_has_its_inertia_and_no_coriolis() -> None:
    model = load("pendulum1")
    found = robot_constants(model)
    inertia = F(int(model.mass[0][0].coefficient(0).p), int(model.mass[0][0].coefficient(0).q))
    for enclosure in (found.lambda_min, found.lambda_max):
        assert enclosure.lower <= inertia <= enclosure.upper
        assert enclosure.width < F(1, 10**12)
    assert found.k_c == Enclosure.exact(0)


@pytest.mark.parametrize(("name", "bend"), [("reyes-kelly2", 0.084), ("pelican2", None)])
def test_two_joints_in_closed_form(name: str, bend: float | None) -> None:
    """M = [[a + 2k cos q₂, b + k cos q₂], [·, b]], C(q,x) = −k sin q₂ [[x₂, x₁ + x₂], [−x₁, 0]].

    Both eigenvalues are extreme at q₂ = 0, where a + 2k + b is largest and the determinant least.
    """
    model = load(name)
    M = NumericModel(model).mass(np.array([[0.0, 0.0], [0.0, np.pi / 2]]))
    k = M[0, 0, 1] - M[1, 0, 1]
    assert bend is None or k == pytest.approx(bend)
    (a, b), (_, d) = M[0]
    root = sqrt((a - d) ** 2 + 4 * b * b)
    found = robot_constants(model)
    expected = {"lambda_min": (a + d - root) / 2, "lambda_max": (a + d + root) / 2}
    turn = np.linspace(0, np.pi, 20_001)
    x1, x2, zero = np.cos(turn), np.sin(turn), np.zeros_like(turn)
    shape = np.stack([np.stack([x2, x1 + x2], -1), np.stack([-x1, zero], -1)], -2)
    expected["k_c"] = k * float(np.linalg.norm(shape, ord=2, axis=(1, 2)).max())
    for constant, value in expected.items():
        enclosure = getattr(found, constant)
        assert enclosure.lower * (1 - F(1, 10**8)) <= value <= enclosure.upper * (1 + F(1, 10**8))


def test_bounds_handed_to_the_scalar_forms_are_the_outer_ones() -> None:
    model = load("reyes-kelly2")
    found, bounds = robot_constants(model), robot_bounds(model)
    assert (bounds.beta_M, bounds.k_c) == (found.lambda_max.upper, found.k_c.upper)
    assert bounds.lambda_min_M == found.lambda_min.lower
    assert (bounds.viscous_min, bounds.viscous_max) == (F("0.175"), F("2.288"))


@pytest.mark.parametrize("budget", [0, 1, 40])
@pytest.mark.parametrize("name", ["buap3", "reyes-kelly2"])
def test_a_spent_budget_gives_wider_bounds_that_still_contain(
    name: str, budget: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = robot_constants(load(name))
    monkeypatch.setattr(room, "MAX_BOXES", budget)
    coarse = robot_constants.__wrapped__(load(name))
    for constant in ("lambda_min", "lambda_max", "k_c"):
        wide, narrow = getattr(coarse, constant), getattr(known, constant)
        assert wide.lower <= narrow.lower
        assert wide.upper >= narrow.upper


def test_coarse_bounds_contain_the_proved_ones() -> None:
    for name in BUILT_IN:
        arm, known = ArmIntervals(load(name).fixed()), robot_constants(load(name))
        coarse = room.coarse_eigenvalues(arm)
        assert coarse.lower <= known.lambda_min.lower
        assert coarse.upper >= known.lambda_max.upper * (1 - F(1, 10**12))
        assert room.coarse_k_c(arm) >= known.k_c.lower


def test_an_indefinite_inertia_is_not_called_positive() -> None:
    """Data errors happen: the enclosure then lies below zero, it does not end there."""
    model = load("reyes-kelly2")
    (a, b), (_, d) = model.mass
    wrong = replace(model, mass=((a, 20 * b), (20 * b, d)))
    found = robot_constants.__wrapped__(wrong)
    assert found.lambda_min.upper < 0
    assert np.linalg.eigvalsh(NumericModel(wrong).mass(angles(2))).min() >= found.lambda_min.lower


def test_coarse_bound_of_coriolis_counts_every_symbol() -> None:
    """Two joints have c₁₁₂ = c₁₂₁ = c₁₂₂ = −c₂₁₁ = −k sin q₂: the root of the sum of squares is 2k."""
    assert room.coarse_k_c(ArmIntervals(load("reyes-kelly2").fixed())) == pytest.approx(0.168, rel=1e-9)
