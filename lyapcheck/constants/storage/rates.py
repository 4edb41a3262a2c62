"""Proposing what bounds k_c = sup ‖C(q, x)x‖ along a chain: bounds of the rates of M, and shares.

Each Q_j is a small semidefinite program with the least Σ_i Q_ji. The shares are the least of a geometric
program, which is convex in their logarithms.

References: `lyapcheck.check.kinds.chain_coriolis`; geometric programs, ``boyd2004convex`` section 4.5.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

import numpy as np

from lyapcheck._types import Array
from lyapcheck.check.kinds.chain_coriolis import RateBounds
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.storage import Shown
from lyapcheck.constants.storage.problem import StorageProblem, rate_problem
from lyapcheck.constants.storage.program import propose
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.dynamics import Chain

_MARGINS = (1e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3)
_SPARE = 1e-7
"""By which prices are raised, relative to the largest."""
_DIGITS = 9
_TINY = 1e-12
"""Relative to the largest price: what no share is taken for."""


@lru_cache(maxsize=4)
def rate_bounds(links: tuple[RigidLink, ...]) -> RateBounds | None:
    """What bounds k_c of a chain; ``None`` where the forms of some joint are not found."""
    chain = Chain(links, (Fraction(0),) * 3)
    rates = []
    for joint in range(1, chain.n):
        shown = prices_shown(
            [rate_problem(chain, joint, sign) for sign in (1, -1)], np.ones(chain.n), (1.0,) * chain.n
        )
        if shown is None:
            return None
        rates.append(shown)
    return RateBounds(tuple(rates), *_shares(rates))


def prices_shown(
    problems: Sequence[StorageProblem], weight: Array, share: Sequence[float], most: float | None = None
) -> Shown | None:
    """Prices κ_k with a small Σ κ_k share_k/weight_k, and forms for each problem that show them.

    Args:
        problems: costs along chains of n links.
        weight: of the prices, (n,).
        share: what a κ_k/weight_k costs.
        most: what no κ_k/weight_k is to exceed, times share_k.
    """
    for margin in _MARGINS:
        result = propose(problems, margin, np.diag(weight / share), most)
        if result is None:
            continue
        least = _SPARE * np.max(np.abs(result.prices / weight)) * weight
        prices = np.maximum(result.prices * (1 + _SPARE) + least, 0.0)
        forms = tuple(
            tuple(tuple(Fraction(float(x)) for x in row) for row in rows) for rows in result.coefficients
        )
        shown = Shown(tuple(significant_up(Fraction(float(x)), _DIGITS) for x in prices), forms)
        if shown.holds([problem.stages for problem in problems], problems[0].vectors):
            return shown
    return None


def _shares(rates: Sequence[Shown]) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
    """The s_j and t_j of `RateBounds` with which the bound is least, in doubles."""
    from scipy.optimize import minimize

    if not rates:
        return (), ()
    rows = np.array([[float(x) for x in shown.prices] for shown in rates])
    count, size = len(rows), rows.max()
    rows = np.maximum(rows / size, _TINY)
    upper = np.triu_indices(count + 1)

    def reached(shares: Array) -> Array:
        s, t = np.split(np.exp(shares), 2)
        charged = s @ rows + np.concatenate([[0.0], t / 2])
        crossed = np.vstack([np.zeros(count + 1), rows / s[:, None]])
        spent = (rows.T / t) @ rows + crossed + crossed.T
        return np.asarray(np.log(np.concatenate([charged, spent[upper] / 2])))

    start = np.zeros(2 * count)
    found = minimize(
        lambda v: v[-1],
        np.append(start, reached(start).max()),
        jac=lambda v: np.eye(len(v))[-1],
        constraints={"type": "ineq", "fun": lambda v: v[-1] - reached(v[:-1])},
        method="SLSQP",
        options={"maxiter": 200},
    ).x[:-1]
    best = min(start, found, key=lambda shares: float(reached(shares).max()))
    s, t = np.split(np.exp(best), 2)
    return tuple(Fraction(f"{x:.6g}") for x in s), tuple(Fraction(f"{x * size:.6g}") for x in t)
