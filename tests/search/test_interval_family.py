"""h, h' and the polynomials of an arm over boxes, against 200-bit balls and exact rationals."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from flint import arb
from numpy.typing import NDArray

from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import Family, hyperbolic, named, names
from lyapcheck.intervals import Interval
from lyapcheck.intervals.arm import ArmIntervals, dh_range, h_range
from lyapcheck.robots import load
from lyapcheck.robots.trig import to_terms
from tests.helpers.robot_cases import BUILT_IN
from tests.helpers.shares import one_in

F = Fraction
Array = NDArray[np.float64]
BITS = 200

FAMILIES = [hyperbolic(m) for m in (1, 2, 3, 7, 20)] + [named(n) for n in names() if n != "hyperbolic"]
FORMS = ["h", "dh"]
SIZES = [-320.0, -200.0, -20.0, -8.0, -3.0, -1.0, 0.0, 1.0, 2.0, 2.8]


def label(family: Family) -> str:
    return f"{family.name}{family.m or ''}"


def over(family: Family, form: str, x: Interval) -> Interval:
    return {"h": h_range, "dh": dh_range}[form](family, x)


def ball(family: Family, form: str, x: float) -> arb:
    return {"h": family.ball_h, "dh": family.ball_dh}[form](arb(x))


def peaks(family: Family) -> list[float]:
    """Where |h| and |h'| are largest and h' is least, seen on a grid, without the code that is tested."""
    x = np.linspace(0, 6, 60_001)
    h, dh = np.abs(family.h(x)), family.dh(x)
    return [float(x[k]) for k in (h.argmax(), dh.argmax(), dh.argmin(), np.abs(dh[100:]).argmin() + 100)]


def boxes(family: Family, generator: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Boxes of every size around 0, around each peak on either side, and far out."""
    middle = generator.choice([*peaks(family), 0.0], count) * generator.choice([-1.0, 1.0], count)
    middle += generator.normal(size=count) * 10.0 ** generator.uniform(-17, 0, count)
    loose = generator.random(count) < 0.4
    middle[loose] = (generator.normal(size=count) * 10.0 ** generator.choice(SIZES, count))[loose]
    width = generator.choice([0.0, 1e-300, 1e-16, 1e-9, 1e-3, 0.3, 2.0], count)
    left = width * generator.choice([0.0, 0.1, 1.0], count)
    return middle - left, middle + width


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("family", one_in(3, FAMILIES), ids=label)
def test_ranges_hold_balls(family: Family, form: str) -> None:
    generator = np.random.default_rng(family.m or 0)
    low, high = boxes(family, generator, 1500)
    result = over(family, form, Interval(low, high))
    share = generator.choice([0.0, 1.0, 0.5, 0.1, 0.77], low.shape)
    points = np.clip(low + share * (high - low), low, high)
    with precision(BITS):
        for k, x in enumerate(points.tolist()):
            exact = Enclosure.from_arb(ball(family, form, x))
            assert float(result.lo[k]) <= exact.upper, (low[k], high[k], x)
            assert exact.lower <= float(result.hi[k]), (low[k], high[k], x)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("family", one_in(3, FAMILIES), ids=label)
def test_ranges_are_those_of_a_dense_grid(family: Family, form: str) -> None:
    """No wider than the function: an answer that is merely safe would pass the test above."""
    function = {"h": family.h, "dh": family.dh}[form]
    generator = np.random.default_rng(5)
    for _ in range(60):
        low, high = np.sort(generator.uniform(-4, 4, 2))
        result = over(family, form, Interval(np.asarray(low), np.asarray(high)))
        values = function(np.linspace(low, high, 4001))
        assert result.lo <= values.min()
        assert result.hi >= values.max()
        slack = 1e-3 * max(1.0, float(np.abs(values).max()))
        assert values.min() - result.lo < slack
        assert result.hi - values.max() < slack


# Arms


def arm_box(generator: np.random.Generator, n: int) -> list[tuple[float, float]]:
    width = generator.choice([0.0, 1e-12, 1e-3, 0.3, 4.0], n)
    middle = generator.uniform(-4, 4, n) * generator.choice([0.0, 1.0, 1.0], n)
    return [(float(a - b), float(a + b)) for a, b in zip(middle, width, strict=True)]


def intervals_of(name: str) -> ArmIntervals:
    model = load(name).fixed()
    return ArmIntervals([[by_parameters(to_terms(entry), model.n) for entry in row] for row in model.mass])


def exact_entries(name: str, q: list[float], x: list[F]) -> tuple[list[list[arb]], list[list[arb]]]:
    """M(q) and C(q, x) by the model's own evaluation of its polynomials, in balls."""
    model = load(name).fixed()
    sines, cosines = [arb(a).sin() for a in q], [arb(a).cos() for a in q]

    def lift(value: Fraction) -> arb:
        return arb(value.numerator) / value.denominator

    return model.mass_at(sines, cosines, lift), model.coriolis_at(sines, cosines, list(map(lift, x)), lift)


def coriolis(symbols: dict[tuple[int, int, int], Interval], x: list[F]) -> list[list[Interval | float]]:
    """C(q, x)_ij = Σ_k c_ijk x_k."""
    rows: list[list[Interval | float]] = [[0.0] * len(x) for _ in x]
    for (i, j, k), symbol in symbols.items():
        for a, b in {(j, k), (k, j)}:
            rows[i][a] = symbol * Interval.of(x[b]) + rows[i][a]
    return rows


@pytest.mark.parametrize("name", one_in(3, BUILT_IN))
def test_mass_and_coriolis_matrices_hold_balls(name: str) -> None:
    arm, generator = intervals_of(name), np.random.default_rng(11)
    for _ in range(60):
        box = arm_box(generator, arm.n)
        x = [F(float(value)) for value in generator.normal(size=arm.n)]
        over_box = arm.at([Interval(np.asarray(a), np.asarray(b)) for a, b in box])
        result = over_box.mass(), coriolis(over_box.symbols(), x)
        for _ in range(3):
            point = [float(generator.choice([a, b, generator.uniform(a, b)])) for a, b in box]
            # what the arm says does not matter may be anything
            point = [a if i in arm.angles else 9.0 for i, a in enumerate(point)]
            with precision(BITS):
                for matrix, exact in zip(result, exact_entries(name, point, x), strict=True):
                    for row, exact_row in zip(matrix, exact, strict=True):
                        for entry, value in zip(row, exact_row, strict=True):
                            low, high = (
                                (float(entry.lo), float(entry.hi)) if isinstance(entry, Interval) else (0, 0)
                            )
                            known = Enclosure.from_arb(value)
                            assert low <= known.upper
                            assert known.lower <= high
