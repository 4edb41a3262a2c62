"""h, h' and the polynomials of an arm over boxes, against 200-bit balls and exact rationals."""

import numpy as np
import pytest
from flint import arb

from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import hyperbolic, named, names
from lyapcheck.search.interval import Interval
from lyapcheck.search.interval_arm import dh_range, h_range
from tests.helpers.shares import one_in

BITS = 200

FAMILIES = [hyperbolic(m) for m in (1, 2, 3, 7, 20)] + [named(n) for n in names() if n != "hyperbolic"]
FORMS = ["h", "dh"]
SIZES = [-320.0, -200.0, -20.0, -8.0, -3.0, -1.0, 0.0, 1.0, 2.0, 2.8]


def label(family):
    return f"{family.name}{family.m or ''}"


def over(family, form, x):
    return {"h": h_range, "dh": dh_range}[form](family, x)


def ball(family, form, x):
    return {"h": family.ball_h, "dh": family.ball_dh}[form](arb(x))


def peaks(family):
    """Where |h| and |h'| are largest and h' is least, seen on a grid, without the code that is tested."""
    x = np.linspace(0, 6, 60_001)
    h, dh = np.abs(family.h(x)), family.dh(x)
    return [float(x[k]) for k in (h.argmax(), dh.argmax(), dh.argmin(), np.abs(dh[100:]).argmin() + 100)]


def boxes(family, generator, count):
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
def test_ranges_hold_balls(family, form):
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
