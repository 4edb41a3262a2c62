"""Control points of matrices of trigonometric polynomials: hulls, halving, and what must not pass."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np
import pytest
from flint import arb, fmpq
from hypothesis import given, settings
from hypothesis import strategies as st

from lyapcheck.check.loop import control_points
from lyapcheck.check.loop.control_points import (
    children,
    control_weights,
    definite_at_all_angles,
    nodes,
)

DEGREES = st.integers(1, 4)


def weights(count: int, degree: int) -> np.ndarray:
    return np.array(control_weights(count, degree), dtype=np.float64)


def random_values(seed: int, degree: int) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    """A trigonometric polynomial: its values at the nodes, and itself."""
    a = np.random.default_rng(seed).normal(size=(2, degree + 1))

    def f(t: np.ndarray) -> np.ndarray:
        k = np.arange(degree + 1)
        return np.cos(np.multiply.outer(t, k)) @ a[0] + np.sin(np.multiply.outer(t, k)) @ a[1]

    size = 2 * degree + 1
    return f(2 * np.pi * np.arange(size) / size), f


@given(DEGREES, st.integers(0, 30), st.integers(0, 10**6))
@settings(max_examples=25, deadline=None)
def test_a_polynomial_lies_between_its_control_points(degree: int, more: int, seed: int) -> None:
    count = 2 * degree + 1 + more
    nodes, f = random_values(seed, degree)
    control, h = weights(count, degree) @ nodes, 2 * np.pi / count
    t = np.linspace(0, 2 * np.pi, 400)
    for value, angle in zip(f(t), t, strict=True):
        i = (
            np.arange(np.floor(angle / h - 0.5) - degree, np.floor(angle / h - 0.5) + degree + 2).astype(int)
            % count
        )
        assert control[i].min() - 1e-9 <= value <= control[i].max() + 1e-9


@given(DEGREES, st.integers(0, 20), st.integers(0, 10**6))
@settings(max_examples=25, deadline=None)
def test_control_points_at_half_the_step_lie_between_those_they_come_from(
    degree: int, more: int, seed: int
) -> None:
    count = 2 * degree + 1 + more
    nodes, _ = random_values(seed, degree)
    coarse, fine = weights(count, degree) @ nodes, weights(2 * count, degree) @ nodes
    parents: dict[int, list[int]] = {i: [] for i in range(2 * count)}
    for j in range(count):
        for (i,) in children([(j,)], 0, degree, 2 * count):
            parents[i].append(j)
    for i, value in enumerate(fine):
        above = coarse[parents[i]]
        assert above.min() - 1e-9 <= value <= above.max() + 1e-9


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_halving_is_a_mean_with_weights_that_are_not_negative(degree: int) -> None:
    """The weights solved for, without the formula of the module: they are those of its proof."""
    count = 4 * degree + 5
    h = 2 * np.pi / count
    mask = np.array([1.0 + 0j])
    for k in range(-degree, degree + 1):
        mask = np.convolve(mask, [np.exp(-1j * k * h / 4), np.exp(1j * k * h / 4)])
    assert np.allclose(mask.imag, 0)
    assert mask.real.min() >= 0
    fine, coarse = weights(2 * count, degree), weights(count, degree)
    scale = None
    for i in range(2 * count):
        shares = {
            j: mask.real[i - 2 * j + degree]
            for j in range(-degree, count + degree)
            if 0 <= i - 2 * j + degree < len(mask)
        }
        total = sum(share * coarse[j % count] for j, share in shares.items())
        scale = scale or sum(total) / sum(fine[i])
        assert np.allclose(total, scale * fine[i])


def scalar(f: Callable[[Sequence[float]], float], degree: int = 2, angles: int = 2) -> list[list[arb]]:
    return [[arb(f(radians(at)))] for at in nodes(degree, angles)]


def radians(angles: Sequence[fmpq]) -> list[float]:
    return [float(a.p) / float(a.q) * np.pi for a in angles]


HALVINGS = tuple([0, 1] * 6)


@pytest.mark.parametrize("lift", [0.1, 0.01, 1e-3])
def test_a_function_just_above_zero_is_seen_with_steps_that_are_small_enough(lift: float) -> None:
    f = scalar(lambda q: 2 + lift - np.cos(2 * q[0] + 1) - np.cos(q[0] - 2 * q[1]))
    assert definite_at_all_angles(f, 2, (9, 9), HALVINGS)
    assert not definite_at_all_angles(f, 2, (9, 9), ())


@pytest.mark.parametrize("drop", [0.0, 1e-9, 0.1])
def test_a_function_that_comes_to_zero_is_never_positive(drop: float) -> None:
    f = scalar(lambda q: 1 - drop - np.cos(q[0] - 2 * q[1] + 0.123))
    assert not definite_at_all_angles(f, 2, (9, 9), HALVINGS)


@given(st.integers(0, 10**6), st.integers(9, 20), st.integers(9, 20))
@settings(max_examples=12, deadline=None)
def test_no_random_matrix_passes_that_is_not_definite_somewhere(seed: int, first: int, second: int) -> None:
    rng = np.random.default_rng(seed)
    parts = rng.normal(size=(5, 5, 3, 3)) * 0.3
    parts = parts + np.swapaxes(parts, 2, 3)
    lift = rng.uniform(1, 12)

    def at(q: Sequence[float]) -> np.ndarray:
        basis = [[1, np.cos(a), np.sin(a), np.cos(2 * a), np.sin(2 * a)] for a in q]
        return np.einsum("i,j,ijab->ab", *map(np.array, basis), parts) + lift * np.eye(3)

    matrices = [at(radians(angles)) for angles in nodes(2, 2)]
    values = [[arb(matrix[i, j]) for i in range(3) for j in range(i + 1)] for matrix in matrices]
    shown = definite_at_all_angles(values, 2, (first, second), (0, 1, 0, 1))
    least = min(np.linalg.eigvalsh(at(q))[0] for q in product(np.linspace(0, 2 * np.pi, 25), repeat=2))
    assert not shown or least > 0
    if least > lift / 4:
        assert shown


def test_too_many_points_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    near = scalar(lambda q: 1.001 - np.cos(q[0] - 0.2), 1, 1)
    assert definite_at_all_angles(near, 1, (9,), (0,) * 6)
    monkeypatch.setattr(control_points, "MOST_AROUND", 50)
    assert not definite_at_all_angles(near, 1, (9,), (0,) * 6)
    far = scalar(lambda q: 2 - np.cos(q[0]), 1, 1)
    monkeypatch.setattr(control_points, "MOST", 9)
    assert definite_at_all_angles(far, 1, (9,), ())
    assert not definite_at_all_angles(far, 1, (10,), ())
    monkeypatch.setattr(control_points, "MOST", 20)
    assert not definite_at_all_angles(near, 1, (9,), (0,) * 6)


def test_too_few_points_and_angles_that_are_not_there_show_nothing() -> None:
    """The weights are those of splines for more points than 2D only."""
    one = scalar(lambda q: 1.0)
    assert definite_at_all_angles(one, 2, (5, 5), (0,))
    assert not definite_at_all_angles(one, 2, (4, 5), ())
    assert not definite_at_all_angles(one, 2, (5, 0), ())
    assert not definite_at_all_angles(one, 2, (5, 5), (2,))
    assert not definite_at_all_angles(one, 2, (5, 5), (-1,))
