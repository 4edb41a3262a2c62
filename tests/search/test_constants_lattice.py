"""k_c from points of a lattice: beside samples and boxes, and each step of the argument on its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lyapcheck.constants import arm_constants
from lyapcheck.constants.circles import Circles, basis
from lyapcheck.constants.coriolis_chain import MOST_JOINTS, _bends, coriolis_bound
from lyapcheck.constants.extreme import extreme
from lyapcheck.constants.lattice import Lattice, norms_above, remainder
from lyapcheck.constants.products import common_factor
from lyapcheck.constants.quartic import quartic
from lyapcheck.robots import RobotModel
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import one_in
from tests.search.test_constants_storage import arm_of

RNG_SEED = 5


def stacks_of(arm: RobotModel, q: np.ndarray) -> np.ndarray:
    return quartic(arm.n).stack(NumericModel(arm).christoffel(q))


def products(x: np.ndarray) -> np.ndarray:
    forms = quartic(x.shape[-1])
    return x[..., forms.rows] * x[..., forms.columns] * forms.scale


def polynomials(arm: RobotModel) -> Circles:
    return Circles.through(lambda q: stacks_of(arm, q), arm.n)


def at(circles: Circles, q: np.ndarray) -> np.ndarray:
    """Term by term, one posture."""
    result = circles.coefficients
    for angle in circles.angles:
        result = np.tensordot(basis(q[angle]), result, 1)
    return result


def test_polynomials_pass_through_the_arm_everywhere() -> None:
    arm, rng = arm_of("px100", Path()), np.random.default_rng(RNG_SEED)
    circles = polynomials(arm)
    for q in rng.uniform(-3, 3, (5, arm.n)):
        assert at(circles, q) == pytest.approx(stacks_of(arm, q[None])[0], abs=1e-12)
        step = np.zeros(arm.n)
        for axis, angle in enumerate(circles.angles):
            step[:], step[angle] = 0, 1e-3
            around = [at(circles, q + k * step) for k in (-1, 0, 1)]
            bent = (around[0] - 2 * around[1] + around[2]) / 1e-6
            assert at(circles.bent(axis), q) == pytest.approx(bent, abs=1e-6)


def test_what_second_derivatives_give_back_is_what_they_are(tmp_path: Path) -> None:
    circles = polynomials(arm_of("leaning", tmp_path))
    half, q = np.array([0.3, 0.2]), np.array([0, 1.0, -2.0])
    bent = [circles.bent(axis) for axis in range(2)]
    both = 0.25 * np.prod(half**2) * at(bent[0].bent(1), q)
    parts = [0.5 * r**2 * at(part, q) for r, part in zip(half, bent, strict=True)]
    assert at(circles.spread(half), q) == pytest.approx(at(circles, q) - sum(parts) + both)


@pytest.mark.parametrize("counts", one_in(4, [[9, 4, 3], [8, 9, 14], [20, 7, 5], [12, 12, 12]]))
def test_no_largest_value_is_further_above_the_points_than_the_remainder(counts: list[int]) -> None:
    """Random polynomials, the lattice moved so that the largest value is anywhere in its cell."""
    rng = np.random.default_rng(RNG_SEED)
    fine = np.stack(np.meshgrid(*[np.linspace(0, 2 * np.pi, 31)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)

    def values(circles: Circles, q: np.ndarray) -> np.ndarray:
        return np.einsum("abcij,qa,qb,qc->q", circles.coefficients, *map(basis, q.T), optimize=True)

    for _ in range(3):
        coefficients = rng.normal(size=(5, 5, 5, 1, 1)) * rng.choice([1.0, 0.1], (5, 5, 5, 1, 1))
        circles = Circles(coefficients, (1, 2, 3), 1.0)
        bend = np.array([np.abs(values(circles.bent(axis), fine)).max() for axis in range(3)])
        half = np.pi / np.array(counts)
        spread = circles.spread(np.where(half < 0.5, half, 0.0))
        largest = values(circles, fine).max()
        for shift in rng.uniform(0, 1, (4, 3)):
            circle = [2 * np.pi * (np.arange(n) + s) / n for n, s in zip(counts, shift, strict=True)]
            points = np.stack(np.meshgrid(*circle, indexing="ij"), axis=-1).reshape(-1, 3)
            assert largest <= values(spread, points).max() + remainder(half, bend)


@pytest.mark.slow
def test_other_factors_reach_what_one_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lyapcheck.constants.lattice._WORTH", 500)
    arm = arm_of("px100", Path())
    inside = float(extreme(arm, "k_c").value)
    circles, target = polynomials(arm), inside / 0.95
    lattice = Lattice(circles, _bends(circles, target), target, np.eye(10))
    assert inside <= lattice.bound(10**6) <= target
    assert lattice.factors


def test_a_grid_has_the_values_of_its_points() -> None:
    rng = np.random.default_rng(RNG_SEED)
    circles = Circles(rng.normal(size=(5, 5, 5, 5, 2, 3)), (1, 2, 3, 4), 1.0)
    first = rng.choice([0.1, 0.7, 2.0], size=(9, 2))
    seen = 0
    for places, values in circles.on(first, (2, 3)):
        for place, grid in zip(places, values.reshape(-1, 2, 3, 2, 3), strict=True):
            for i, j in np.ndindex(2, 3):
                q = np.array([0, *first[place], np.pi * i, 2 * np.pi * j / 3])
                assert grid[i, j] == pytest.approx(at(circles, q))
                seen += 1
    assert seen == 9 * 6


def test_an_angle_that_does_not_matter_is_left_out(tmp_path: Path) -> None:
    arm = arm_of("ur5", tmp_path)
    rest = Circles.through(lambda q: stacks_of(arm, np.where(np.arange(6) == 2, 0.0, q)), arm.n)
    assert rest.angles == (1, 3, 4, 5)


def test_a_common_factor_leaves_the_size_of_products_as_it_is() -> None:
    arm, rng = arm_of("px100", Path()), np.random.default_rng(RNG_SEED)
    stacks = stacks_of(arm, rng.uniform(-3, 3, (50, arm.n)))
    factor = common_factor(stacks, arm.n)
    x = rng.normal(size=(200, arm.n))
    measured = np.sum(np.linalg.solve(factor, products(x).T) ** 2, axis=0)
    assert measured == pytest.approx(np.sum(x**2, axis=1) ** 2)
    plain, better = (norms_above(stacks @ f, 0.0) for f in (np.eye(len(factor)), factor))
    reached = np.linalg.norm(stacks @ products(x).T, axis=1) / np.sum(x**2, axis=1)
    assert np.all(better >= reached.max(axis=1) * (1 - 1e-9))
    assert better.max() < plain.max()


def test_norms_are_never_too_small_and_close_above_the_cut() -> None:
    matrices = np.random.default_rng(RNG_SEED).normal(size=(500, 4, 10))
    norms = np.linalg.norm(matrices, ord=2, axis=(1, 2))
    bounds = norms_above(matrices, 4.0)
    assert np.all(bounds >= norms * (1 - 1e-12))
    assert bounds[bounds > 4.0] == pytest.approx(norms[bounds > 4.0], rel=3e-3)
    assert 0 < np.count_nonzero(bounds > 4.0) < len(bounds)


@pytest.mark.parametrize("name", ["leaning", pytest.param("px100", marks=pytest.mark.slow)])
def test_the_bound_is_above_every_posture_and_as_close_as_asked(name: str, tmp_path: Path) -> None:
    arm = arm_of(name, tmp_path)
    inside = float(extreme(arm, "k_c").value)
    bound = float(coriolis_bound(arm, inside, 0.02))
    assert inside <= bound <= inside / 0.98 * (1 + 1e-9)
    rng = np.random.default_rng(RNG_SEED)
    q, x = rng.uniform(-np.pi, np.pi, (5000, arm.n)), rng.normal(size=(5000, arm.n))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    stacks = stacks_of(arm, q)
    for _ in range(3):
        torque = np.einsum("kip,kp->ki", stacks, products(x))
        assert np.linalg.norm(torque, axis=1).max() <= bound
        tensor = np.einsum("ki,kijl->kjl", torque, NumericModel(arm).christoffel(q))
        x = np.linalg.eigh(tensor)[1][..., -1]


@pytest.mark.parametrize("name", ["pelican2", pytest.param("leaning", marks=pytest.mark.slow)])
def test_few_joints_have_what_boxes_enclose(name: str, tmp_path: Path) -> None:
    arm = arm_of(name, tmp_path)
    (boxes,) = arm_constants(arm, 20_000, names=("k_c",))
    bound = coriolis_bound(arm, float(boxes.enclosure.lower), 0.01)
    assert boxes.enclosure.lower <= bound <= float(boxes.enclosure.lower) / 0.99 * (1 + 1e-9)


@pytest.mark.parametrize("share", one_in(3, [0.99, 0.9, 0.5]))
@pytest.mark.parametrize("most", [0, 10_000])
def test_what_is_too_small_is_never_shown(share: float, most: int, tmp_path: Path) -> None:
    """A target below what is reached is not met, whatever the budget and the second derivatives assumed."""
    arm = arm_of("leaning", tmp_path)
    inside = float(extreme(arm, "k_c").value)
    target = share * inside
    circles = polynomials(arm)
    bend = np.full(len(circles.angles), 4 * target)
    assert Lattice(circles, bend, target).bound(most) >= inside


def test_second_derivatives_stay_below_their_bounds() -> None:
    arm = arm_of("px100", Path())
    inside = float(extreme(arm, "k_c").value)
    circles = polynomials(arm).times(np.eye(10))
    bends = _bends(circles, inside / 0.98)
    assert bends.min() < 2 * inside
    rng = np.random.default_rng(RNG_SEED)
    x = rng.normal(size=(4000, arm.n))
    for axis, bend in enumerate(bends):
        part = circles.bent(axis)
        for q in rng.uniform(-np.pi, np.pi, (20, arm.n)):
            torque = at(part, q) @ products(x).T
            assert np.max(np.linalg.norm(torque, axis=0) / np.sum(x**2, axis=1)) <= bend


@pytest.mark.parametrize("phase", np.linspace(0, np.pi / 3, 5))
def test_a_largest_value_between_the_points_of_a_circle_is_not_missed(phase: float) -> None:
    """cos(2q − phase) and a second angle that hardly matters."""
    wave = np.array([0, 0, 0, np.cos(phase), np.sin(phase)])
    faint = np.array([1, 0.01 * np.cos(phase), 0.01 * np.sin(phase), 0, 0])
    circles = Circles(np.multiply.outer(wave, faint)[..., None, None], (1, 2), 1.0)
    bends = _bends(circles, 10.0)
    assert 4 * 1.01 <= bends[0] <= 4 * 1.4
    assert 0.01 <= bends[1] <= 0.02


def test_many_joints_are_left_to_others(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("lyapcheck.constants.coriolis_chain.MOST_JOINTS", 2)
    assert MOST_JOINTS >= 6
    assert coriolis_bound(arm_of("leaning", tmp_path), 1.0, 0.1) is None
