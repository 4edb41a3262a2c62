"""Bounds for all angles at once from storage forms along a chain of links, certified in balls.

Let w be what link k hands on to the next one (its twist, say), u what its joint adds, and s_k a quadratic
form that turns about joint k leave as it is. If for k = 1, …, n and all w and u

    s_k(w) + κ·price(w, u) ≥ cost_k(w') + s_{k+1}(X_{k+1} w'),      w' = w + b(u),      s_{n+1} = 0,

where X_{k+1} moves w' into the frame of the next joint at q = 0, then for all angles Σ cost_k ≤ κ Σ price:
the turn by q_k changes nothing in s_k, and the sum telescopes. The least κ for which there are such forms is
the value of a small semidefinite program, whatever the number of joints, and it comes close to the truth:
the angles are gone without any box.

References: dissipation inequalities and storage functions, willems1972dissipative.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

import numpy as np
from flint import fmpq, fmpq_mat

from lyapcheck._types import Array
from lyapcheck.asked import along_links, joints_of
from lyapcheck.check.kinds.chain import (
    ChainAbove,
    ChainBelow,
    ChainCoriolisBelow,
    ChainGravityBelow,
    NoTorque,
    RateBounds,
    StorageForms,
)
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.storage import (
    FALL,
    Shown,
    Stage,
    energy,
    invariant_form,
    rate_of_mass,
    slack,
    stored_at_base,
    weight,
)
from lyapcheck.check.statement import Proof
from lyapcheck.control.judgement import proves
from lyapcheck.convex import Block, solved_cones
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.dynamics import Chain

# --- What a bound by storage forms along a chain asks for.


@dataclass(frozen=True, eq=False)
class StorageProblem:
    """A bound κ of the sum of some costs.

    Args:
        stages: one a joint, base first.
        vectors: of three components each in w.
        fall: of w_0, (3,), m/s²; zeros where w_0 = 0.
        sign: −1 where the constant is an infimum: −κ then is its bound.
    """

    stages: Sequence[Stage]
    vectors: int
    fall: Sequence[Fraction] = (Fraction(0),) * FALL
    sign: int = 1

    @property
    def count(self) -> int:
        return self.vectors * (3 * self.vectors + 1) // 2


def energy_problem(chain: Chain, sign: int) -> StorageProblem:
    """λmax(M) with sign 1, λmin(M) with sign −1."""
    return StorageProblem(energy(chain.links, sign), 2, sign=sign)


def rate_problem(chain: Chain, joint: int, sign: int) -> StorageProblem:
    """The form ± ½ ∂M/∂q_j from above, joints counted from 0."""
    return StorageProblem(rate_of_mass(chain.links, joint, sign), 4)


def unit_rows(count: int) -> list[list[Fraction]]:
    """The rows of the unit matrix."""
    return [[Fraction(int(i == k)) for k in range(count)] for i in range(count)]


def doubles(matrix: fmpq_mat) -> Array:
    """The nearest doubles."""
    rows, columns = matrix.nrows(), matrix.ncols()
    return np.array(
        [[int(matrix[i, j].p) / int(matrix[i, j].q) for j in range(columns)] for i in range(rows)],
        dtype=np.float64,
    )


# --- Proposing storage forms: a semidefinite program in doubles, solved by Clarabel.


def propose(
    problems: Sequence[StorageProblem], margin: float, prices: Array | None = None, most: float | None = None
) -> tuple[Array, list[Array]] | None:
    """The least κ for which every slack is at least ``margin`` times the size of the costs; ``None`` without.

    Args:
        problems: costs along chains of n links, all with the same κ_k.
        margin: share of the largest cost.
        prices: κ_k = Σ_i prices_ki x_i of unknowns x with the least Σ x_i, (n, x); one κ for all without.
        most: what no x_i is to exceed.

    Returns:
        The κ_k of the joints, (n,), and of each problem the coefficients of its forms, (n, forms).
    """
    n = len(problems[0].stages)
    prices = np.ones((n, 1)) if prices is None else prices
    free = end = prices.shape[1]
    blocks: list[Block] = []
    ends = []
    for problem in problems:
        size = max(float(np.abs(doubles(stage.cost)).max()) for stage in problem.stages)
        least = margin * (size or 1.0)  # a body without mass costs nothing, and yet a price must be positive
        blocks += _blocks(problem, least, prices, end)
        ends.append(end := end + n * problem.count)
    if most is not None:
        blocks += [(np.array([[most]]), {i: np.array([[-1.0]])}) for i in range(free)]
    aim = np.zeros(end)
    aim[:free] = 1.0
    # also what is not solved may show a bound: exact arithmetic has the last word
    found = solved_cones(aim, blocks, 1e-8).values
    if not found:
        return None
    parts = np.split(found[0], [free, *ends])[1:-1]
    return prices @ found[0][:free], [part.reshape(n, -1) for part in parts]


def _blocks(problem: StorageProblem, least: float, prices: Array, first: int) -> Iterator[Block]:
    """The conditions of `lyapcheck.check.loop.storage`: affine in x, and from ``first`` on in the forms."""
    count, stages = problem.count, problem.stages
    units = [invariant_form(row, problem.vectors) for row in unit_rows(count)]
    nothing = units[0] * fmpq(0)
    if any(problem.fall):
        at_base = [float(stored_at_base(stages, [form], problem.fall)) for form in units]
        slopes = {0: np.eye(1)} | {first + i: np.array([[-x]]) for i, x in enumerate(at_base)}
        yield np.array([[-least]]), slopes
    for k in range(len(stages)):

        def part(own: fmpq_mat, after: fmpq_mat, kappa: int, k: int = k) -> Array:
            following = after if k + 1 < len(stages) else None
            return doubles(slack(stages, k, own, following, fmpq(kappa)))

        constant = part(nothing, nothing, 0)
        price = part(nothing, nothing, 1) - constant
        slopes = {i: share * price for i, share in enumerate(prices[k]) if share}
        for i, form in enumerate(units):
            slopes[first + k * count + i] = part(form, nothing, 0) - constant
            if k + 1 < len(stages):
                slopes[first + (k + 1) * count + i] = part(nothing, form, 0) - constant
        yield constant - least * np.eye(len(constant)), slopes


# --- Proposing what bounds k_c = sup ‖C(q, x)x‖ along a chain: bounds of the rates of M, and shares.
#
# Each Q_j is a small semidefinite program with the least Σ_i Q_ji. The shares are the least of a geometric
# program, which is convex in their logarithms.
#
# References: `lyapcheck.check.kinds.chain`; geometric programs, ``boyd2004convex`` section 4.5.


_RATES_MARGINS = (1e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3)
_SPARE = 1e-7
"""By which prices are raised, relative to the largest."""
_RATES_DIGITS = 9
_TINY = 1e-12
"""Relative to the largest price: what no share is taken for."""


@lru_cache(maxsize=4)
def rate_bounds(links: tuple[RigidLink, ...]) -> RateBounds | None:
    """What bounds k_c of a chain; ``None`` where the forms of some joint are not found."""
    chain = Chain(links, (Fraction(0),) * 3)
    rates = []
    for joint in range(1, chain.n):
        shown = prices_shown([rate_problem(chain, joint, sign) for sign in (1, -1)], np.ones(chain.n))
        if shown is None:
            return None
        rates.append(shown)
    return RateBounds(tuple(rates), *_shares(rates))


def prices_shown(
    problems: Sequence[StorageProblem], weight: Array, most: float | None = None
) -> Shown | None:
    """Prices κ_k with a small Σ κ_k/weight_k, and forms for each problem that show them.

    Args:
        problems: costs along chains of n links.
        weight: of the prices, (n,).
        most: what no κ_k/weight_k is to exceed.
    """
    for margin in _RATES_MARGINS:
        result = propose(problems, margin, np.diag(weight), most)
        if result is None:
            continue
        kappa, coefficients = result
        least = _SPARE * np.max(np.abs(kappa / weight)) * weight
        prices = np.maximum(kappa * (1 + _SPARE) + least, 0.0)
        forms = tuple(tuple(tuple(Fraction(float(x)) for x in row) for row in rows) for rows in coefficients)
        shown = Shown(tuple(significant_up(Fraction(float(x)), _RATES_DIGITS) for x in prices), forms)
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


# --- From a chain to certified bounds: doubles propose the storage forms, the checker decides.


Bound = (
    ChainAbove
    | ChainBelow
    | ChainGravityBelow
    | ChainCoriolisBelow
    | MassAbove
    | MassBelow
    | CoriolisBelow
    | GravityBelow
)
_MARGINS = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5)
_DIGITS = 7
"""Significant digits of a bound; coefficients are kept as the doubles that they are."""


@dataclass(frozen=True)
class BoundWithProof:
    """A bound as a statement, and its proof."""

    statement: Bound
    proof: Proof

    @property
    def bound(self) -> Fraction:
        """Its number."""
        return end_of(self.statement)

    def at_end(self, value: Fraction) -> Bound:
        return with_end(self.statement, value)


def storage_proof(chain: Chain, name: str, still: bool = False) -> BoundWithProof | None:
    """The best bound of λmin(M), λmax(M), k_c, ‖g‖ or a |g_i| that the checker accepts; ``None`` without.

    Args:
        name: of the constant, ``k_g`` for ‖g‖ and ``k_g1`` and so on.
        still: no torque was seen: then it is shown to be 0.
    """
    statement: Bound = along_links(name, chain, Fraction(0))
    if name == "k_c":
        bounds = rate_bounds(chain.links)
        if bounds is None:
            return None
        return _accepted(BoundWithProof(with_end(statement, _above(bounds.reached)), bounds))
    if still:
        return _accepted(BoundWithProof(statement, NoTorque()))
    if isinstance(statement, ChainGravityBelow):
        problem = StorageProblem(weight(chain.links, joints_of(name, chain.n)), 3, chain.fall)
    else:
        problem = energy_problem(chain, -1 if name == "lambda_min" else 1)
    for margin in _MARGINS:
        result = propose([problem], margin)
        if result is None:
            continue
        # a little to the safe side, so that rounding takes nothing from what was proposed
        found = Fraction(float(result[0][0]))
        kappa = _above(found * (1 + Fraction(problem.sign if found > 0 else -1, 10**8)))
        forms = tuple(tuple(Fraction(float(x)) for x in row) for row in result[1][0])
        shown = _accepted(BoundWithProof(with_end(statement, problem.sign * kappa), StorageForms(forms)))
        if shown is not None:
            return shown
    return None


def _accepted(shown: BoundWithProof) -> BoundWithProof | None:
    return shown if proves(shown.statement, shown.proof) else None


def end_of(statement: Bound) -> Fraction:
    """The number of a bound: of λmin(M) from below, of the others from above."""
    return statement.low if isinstance(statement, ChainAbove | MassAbove) else statement.high


def with_end(statement: Bound, value: Fraction) -> Bound:
    """The statement with another bound."""
    if isinstance(statement, ChainAbove | MassAbove):
        return replace(statement, low=value)
    return replace(statement, high=value)


def _above(kappa: Fraction) -> Fraction:
    """The nearest decimal of a few digits that is not below."""
    scale = Fraction(10) ** (_DIGITS - len(str(int(abs(kappa) * 10**6))) + 6)
    return Fraction(-((-kappa * scale) // 1)) / scale
