"""Interval arithmetic against exact rationals and 200-bit balls: every result holds every possible value."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import arb
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.intervals import Interval, cosine, inverse_one_plus, norm, sine, unit_vector
from lyapcheck.intervals.interval import positive_definite

F = Fraction
Array = NDArray[np.float64]
Box = tuple[float, float]
BITS = 200

doubles = st.floats(allow_nan=False, allow_infinity=False)
"""Every finite double: denormal, huge, both zeros."""
fractions = st.floats(0.0, 1.0)


def box_of(ends: tuple[float, float]) -> Box:
    return min(ends), max(ends)


def thin_box(middle: float) -> Box:
    return math.nextafter(middle, -math.inf), math.nextafter(middle, math.inf)


boxes = st.one_of(
    st.tuples(doubles, doubles).map(box_of),
    st.tuples(st.floats(-4, 4), st.floats(-4, 4)).map(box_of),
    st.floats(-1e300, 1e300).map(thin_box),
    doubles.map(lambda x: (x, x)),
    st.floats(0.0, 1e300).map(lambda x: (-x, x)),
)


@st.composite
def box_and_point(draw: st.DrawFn) -> tuple[Box, Fraction]:
    """A box and a rational point of it: an end, or anything between."""
    low, high = draw(boxes)
    share = F(draw(fractions))
    return (low, high), F(low) + share * (F(high) - F(low))


def interval(box: Box) -> Interval:
    return Interval(np.asarray(box[0]), np.asarray(box[1]))


def holds(result: Interval, exact: Fraction) -> bool:
    """Comparisons of floats and fractions are exact, with infinite ends too; NaN holds nothing."""
    return float(result.lo) <= exact <= float(result.hi)


def holds_ball(result: Interval, ball: arb) -> bool:
    exact = Enclosure.from_arb(ball)
    return float(result.lo) <= exact.upper and exact.lower <= float(result.hi)


def within(inner: Interval, outer: Interval) -> bool:
    return bool(np.all(outer.lo <= inner.lo) and np.all(inner.hi <= outer.hi))


OPERATIONS: dict[str, Callable[..., object]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
}


@pytest.mark.parametrize("name", OPERATIONS)
@given(x=box_and_point(), y=box_and_point())
@example(x=((1.0, 2.0), F(1)), y=((1.0, 3.0), F(1)))
def test_sums_and_products_hold_exact_ones(
    name: str, x: tuple[Box, Fraction], y: tuple[Box, Fraction]
) -> None:
    result = OPERATIONS[name](interval(x[0]), interval(y[0]))
    assert isinstance(result, Interval)
    exact = OPERATIONS[name](x[1], y[1])
    assert isinstance(exact, Fraction)
    assert holds(result, exact)


@given(x=box_and_point())
def test_squares_roots_reciprocals_and_signs(x: tuple[Box, Fraction]) -> None:
    box, point = interval(x[0]), x[1]
    square, root, reciprocal = box.square(), box.sqrt(), box.reciprocal()
    assert holds(square, point**2)
    assert square.lo >= 0
    assert holds(-box, -point)
    assert holds(reciprocal, 1 / point if point else F(0))
    if point >= 0:
        assert root.lo <= 0 or F(float(root.lo)) ** 2 <= point
        assert root.hi == math.inf or F(float(root.hi)) ** 2 >= point
    if x[0][0] < 0:
        assert root.lo == -math.inf
        assert root.hi == math.inf
    if x[0][0] <= 0:
        assert reciprocal.lo == -math.inf
        assert reciprocal.hi == math.inf


sizes = st.floats(1e-150, 1e150)


def test_enclosures_are_tight() -> None:
    """Without this an arithmetic that always answers (−∞, ∞) would pass."""
    third = Interval.of(F(1, 3))
    for result in (third + third, third * third, third - 1.0, third.square(), third.sqrt(), sine(third)):
        assert result.hi - result.lo < 1e-14
    assert third.reciprocal().hi - third.reciprocal().lo < 1e-13
    assert unit_vector([third, third])[0].hi < 0.70711


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_undefined_ends_prove_nothing(bad: float) -> None:
    """No operation turns an undefined or infinite end into a bound that excludes anything."""
    one, odd = Interval.exact(1.0), Interval(np.asarray(-abs(bad)), np.asarray(abs(bad)))
    for result in (one + odd, odd - one, one * odd, odd * 2.0, odd * odd):
        assert result.lo == -math.inf
        assert result.hi == math.inf
    assert (odd * 0.0).lo == -math.inf
    assert odd.square().hi == math.inf
    for trigonometric in (sine(odd), cosine(odd)):
        assert trigonometric.lo == -1.0
        assert trigonometric.hi == 1.0
    assert unit_vector([odd, one])[0].hi == 1.0
    assert not positive_definite([[odd]])
    assert not positive_definite([[one, one], [odd, one]])


TURNS = [0.0, math.pi / 2, math.pi, 3 * math.pi / 2, 2 * math.pi]


def angle_boxes(generator: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Wide, thin and single points, near and far, many of them at the extremes."""
    kind = generator.integers(0, 4, count)
    middle = np.choose(
        kind,
        [
            generator.uniform(-7, 7, count),
            generator.choice(TURNS, count) + generator.choice([0.0, 1e-16, -1e-9, 1e-3], count),
            generator.uniform(-6000, 6000, count),
            10.0 ** generator.uniform(-320, 2, count),
        ],
    )
    width = generator.choice([0.0, 1e-15, 1e-6, 0.1, 2.0, 7.0], count)
    return middle - width, middle + width


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_sine_and_cosine_hold_balls(name: str) -> None:
    generator = np.random.default_rng(1)
    low, high = angle_boxes(generator, 3000)
    result = {"sin": sine, "cos": cosine}[name](Interval(low, high))
    share = generator.choice([0.0, 1.0, 0.5, 0.123], low.shape)
    points = np.clip(low + share * (high - low), low, high)
    with precision(BITS):
        for k, x in enumerate(points.tolist()):
            assert holds_ball(result[k], getattr(arb(x), name)())
            if high[k] - low[k] > 6.3:
                assert result.lo[k] == -1.0
                assert result.hi[k] == 1.0
    assert np.all(result.lo >= -1)
    assert np.all(result.hi <= 1)


def test_sine_finds_the_extremes_inside() -> None:
    """Boxes around a peak whose ends both lie well below it."""
    for k, a, b in product(range(-50, 50), (0.01, 1.0), (0.02, 0.5)):
        peak = math.pi / 2 + 2 * math.pi * k
        assert sine(interval((peak - a, peak + b))).hi == 1.0
        assert cosine(interval((peak + math.pi / 2 - a, peak + math.pi / 2 + b))).lo == -1.0
        assert sine(interval((peak + a, peak + a + b))).hi < 1.0


def error_boxes(generator: np.random.Generator, n: int, count: int) -> tuple[Array, Array]:
    """Boxes of n errors, of all sizes a double has, many touching the origin or an axis."""
    scale = 10.0 ** generator.choice(
        [-320.0, -200.0, -162.0, -154.0, -3.0, 0.0, 3.0, 150.0, 160.0, 300.0], count
    )
    middle = generator.normal(size=(count, n)) * scale[:, None]
    middle *= generator.choice([0.0, 1.0, 1.0, 1e-8], (count, n))
    width = np.abs(middle) * generator.choice([0.0, 1e-15, 0.1, 1.0, 3.0], (count, n))
    width += scale[:, None] * generator.choice([0.0, 0.0, 0.5], (count, n))
    return middle - width, middle + width


@pytest.mark.parametrize("n", [1, 2, 3])
def test_norm_and_direction_hold_balls(n: int) -> None:
    generator = np.random.default_rng(n)
    low, high = error_boxes(generator, n, 1500)
    e = [Interval(low[:, i], high[:, i]) for i in range(n)]
    length, units, shrink = norm(e), unit_vector(e), inverse_one_plus(norm(e))
    share = generator.choice([0.0, 1.0, 0.3, 0.5], low.shape)
    points = np.clip(low + share * (high - low), low, high)
    with precision(BITS):
        for k, point in enumerate(points.tolist()):
            r = sum((to_arb(F(x)) ** 2 for x in point), arb(0)).sqrt()
            assert holds_ball(length[k], r)
            assert holds_ball(shrink[k], 1 / (1 + r))
            for i, x in enumerate(point):
                assert holds_ball(units[i][k], arb(x) / r if any(point) else arb(0))
    for unit in units:
        assert np.all(unit.lo >= -1)
        assert np.all(unit.hi <= 1)


# Positive definiteness


def members(generator: np.random.Generator, low: Array, high: Array, count: int) -> Array:
    """Symmetric matrices within an interval matrix: vertices and inner ones."""
    share = generator.uniform(0, 1, (count, *low.shape))
    share[::2] = np.round(share[::2])
    lower = np.tril(low + share * (high - low))
    return np.asarray(lower + np.swapaxes(np.tril(lower, -1), -1, -2))


def matrix(low: Array, high: Array) -> list[list[Interval]]:
    return [[Interval(low[..., i, j], high[..., i, j]) for j in range(i + 1)] for i in range(low.shape[-1])]


@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_proved_matrices_have_only_positive_definite_members(n: int) -> None:
    generator = np.random.default_rng(n)
    roots = generator.normal(size=(400, n, n))
    middle = roots @ np.swapaxes(roots, 1, 2) + generator.uniform(-0.5, 0.5, (400, 1, 1)) * np.eye(n)
    width = np.abs(middle) * (10.0 ** generator.uniform(-6, -0.5, (400, 1, 1)))
    low, high = middle - width, middle + width
    proved = positive_definite(matrix(low, high))
    assert 40 < proved.sum() < 400
    for k in range(400):
        least = float(np.linalg.eigvalsh(members(generator, low[k], high[k], 40)).min())
        if least < -1e-9:
            assert not proved[k]
        if proved[k]:
            assert least > 0
