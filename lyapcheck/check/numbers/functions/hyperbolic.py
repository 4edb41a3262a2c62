"""The paper's family of hyperbolic functions.

References: ``reyes2019family`` (6), (7), (8).
"""

from __future__ import annotations

from functools import partial

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.numbers.members import Member, unknown

MOST = 60
"""The m beyond which h_m'' is not used: its extremes are roots of a polynomial of degree 3m."""


def create(m: int | None) -> Member:
    """h_m = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), for m >= 1."""
    if not isinstance(m, int) or m < 1:
        raise unknown("hyperbolic", m)
    result = hyperbolic_constants(m)
    bounds = result.gamma.upper, result.rho.upper, result.L.upper
    h, dh, potential = (partial(f, m) for f in (balls.h, balls.dh, balls.potential))
    if m > MOST:
        return Member(h, dh, potential, *bounds)
    return Member(h, dh, potential, *bounds, partial(balls.d2h, m), partial(balls.bends, m))
