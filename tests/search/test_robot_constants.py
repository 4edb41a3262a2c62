"""λmin(M), λmax(M) and k_c of the arms: enclosures against dense samples, closed forms and spent budgets."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.constants import arm_constants, robot_bounds, robot_constants
from lyapcheck.constants.storage import storage_proof
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.committed import ROOT
from tests.helpers.robot_cases import BUILT_IN
from tests.helpers.shares import but, one_in

F = Fraction
Array = NDArray[np.float64]


def angles(n: int, count: int = 20_000) -> Array:
    """Random angles, and every combination of quarter turns, where extremes often are."""
    quarters = np.stack(np.meshgrid(*[np.arange(4) * np.pi / 2] * n, indexing="ij"), axis=-1).reshape(-1, n)
    return np.concatenate([quarters, np.random.default_rng(n).uniform(-np.pi, np.pi, (count, n))])


QUICK = [name for name in BUILT_IN if not name.startswith("buap3")]


@pytest.mark.parametrize("name", but(QUICK, BUILT_IN))
def test_no_sampled_state_lies_outside(name: str) -> None:
    result, model = robot_constants(load(name)), NumericModel(load(name))
    q = angles(model.n)
    eigenvalues = np.linalg.eigvalsh(model.mass(q))
    assert eigenvalues.min() >= result.lambda_min.lower * (1 - F(1, 10**12))
    assert eigenvalues.max() <= result.lambda_max.upper * (1 + F(1, 10**12))
    x = np.random.default_rng(0).normal(size=q.shape)
    x /= np.linalg.norm(x, axis=1)[:, None]
    norms = np.linalg.norm(model.coriolis(q, x), ord=2, axis=(1, 2))
    assert norms.max() <= result.k_c.upper + F(1, 10**12)
    # and the bounds are not merely safe
    assert eigenvalues.min() < result.lambda_min.upper * F(11, 10)
    assert eigenvalues.max() > result.lambda_max.lower * F(9, 10)
    assert norms.max() >= result.k_c.lower * F(8, 10)


@pytest.mark.parametrize("name", but(QUICK, BUILT_IN))
def test_the_states_handed_back_show_the_inside_bounds(name: str) -> None:
    result, model = robot_constants(load(name)), NumericModel(load(name))
    least = np.linalg.eigvalsh(model.mass(np.array(result.lambda_min_at)))[0]
    largest = np.linalg.eigvalsh(model.mass(np.array(result.lambda_max_at)))[-1]
    assert least == pytest.approx(float(result.lambda_min.upper), rel=1e-9)
    assert largest == pytest.approx(float(result.lambda_max.lower), rel=1e-9)


@pytest.mark.parametrize("name", but(QUICK, BUILT_IN))
def test_gaps_are_small(name: str) -> None:
    result = robot_constants(load(name))
    for enclosure in (result.lambda_min, result.lambda_max, result.k_c):
        assert enclosure.lower <= enclosure.upper
        assert enclosure.width <= F(1, 1000) * enclosure.upper
    assert result.lambda_min.lower > 0


def test_a_pendulum_has_its_inertia_and_no_coriolis() -> None:
    model = load("pendulum1")
    result = robot_constants(model)
    inertia = F(int(model.mass[0][0].coefficient(0).p), int(model.mass[0][0].coefficient(0).q))
    for enclosure in (result.lambda_min, result.lambda_max):
        assert enclosure.lower <= inertia <= enclosure.upper
        assert enclosure.width < F(1, 10**11)
    assert result.k_c == Enclosure.exact(0)


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
    result = robot_constants(model)
    expected = {"lambda_min": (a + d - root) / 2, "lambda_max": (a + d + root) / 2}
    turn = np.linspace(0, np.pi, 20_001)
    x1, x2, zero = np.cos(turn), np.sin(turn), np.zeros_like(turn)
    shape = np.stack([np.stack([x2, x1 + x2], -1), np.stack([-x1, zero], -1)], -2)
    expected["k_c"] = k * float(np.linalg.norm(shape, ord=2, axis=(1, 2)).max())
    for constant, value in expected.items():
        enclosure = getattr(result, constant)
        assert enclosure.lower * (1 - F(1, 10**8)) <= value <= enclosure.upper * (1 + F(1, 10**8))


def test_bounds_handed_to_the_scalar_forms_are_the_outer_ones() -> None:
    model = load("reyes-kelly2")
    result, bounds = robot_constants(model), robot_bounds(model)
    assert (bounds.beta_M, bounds.k_c) == (result.lambda_max.upper, result.k_c.upper)
    assert bounds.lambda_min_M == result.lambda_min.lower
    assert (bounds.viscous_min, bounds.viscous_max) == (F("0.175"), F("2.288"))


@pytest.mark.slow
def test_k_c_of_many_joints_is_the_certified_one() -> None:
    model = load(str(ROOT / "examples" / "px100.toml"))
    chain = model.fixed().chain
    assert chain is not None
    shown = storage_proof(chain, "k_c")
    assert shown is not None
    assert robot_bounds(model).k_c == shown.bound
    q, x = np.random.default_rng(1).normal(size=(2, 2000, 4))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    torques = np.einsum("cij,cj->ci", NumericModel(model.fixed()).coriolis(q, x), x)
    assert 0.3 * float(shown.bound) < np.max(np.linalg.norm(torques, axis=1)) < float(shown.bound)


@pytest.mark.parametrize("budget", one_in(3, [0, 1, 40, 300]))
@pytest.mark.parametrize("name", one_in(2, ["reyes-kelly2", "buap3"]))
def test_a_small_budget_is_kept_and_its_bounds_contain_the_better_ones(name: str, budget: int) -> None:
    known = {constant.name: constant.enclosure for constant in arm_constants(load(name))}
    for constant in arm_constants(load(name), budget):
        assert constant.boxes <= max(budget, 1)
        assert constant.enclosure.lower <= known[constant.name].upper
        assert constant.enclosure.upper >= known[constant.name].lower


def test_only_the_constants_asked_for() -> None:
    result = arm_constants(load("pelican2"), names=("k_g2", "lambda_max"))
    assert [constant.name for constant in result] == ["lambda_max", "k_g2"]


def test_the_constants_of_a_model_are_found_once() -> None:
    model = load("pelican2")
    assert robot_constants(model) is robot_constants(model)


def test_an_indefinite_inertia_is_not_called_positive() -> None:
    """Data errors happen: the enclosure then lies below zero, it does not end there."""
    model = load("reyes-kelly2")
    (a, b), (_, d) = model.mass
    wrong = replace(model, dynamics=replace(model.dynamics.polynomials, mass=((a, 20 * b), (20 * b, d))))
    result = robot_constants(wrong)
    assert result.lambda_min.upper < 0
    assert np.linalg.eigvalsh(NumericModel(wrong).mass(angles(2))).min() >= result.lambda_min.lower


# Bounds on single boxes -----


@pytest.mark.slow
def test_k_c_of_four_joints() -> None:
    """Within six tenths of what is reached, and above a sample of ‖C(q, x)x‖ that comes near."""
    model = load("px100")
    (k_c,) = arm_constants(model, 200_000 // model.n**2, names=("k_c",))
    rng = np.random.default_rng(3)
    q, x = rng.uniform(-np.pi, np.pi, (200_000, 4)), rng.standard_normal((200_000, 4))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    sampled = np.linalg.norm(np.einsum("bij,bj->bi", NumericModel(model).coriolis(q, x), x), axis=1).max()
    assert k_c.enclosure.upper < F(8, 5) * k_c.enclosure.lower
    assert 0.8 * float(k_c.enclosure.lower) < sampled < float(k_c.enclosure.upper)
