"""Proposing storage forms: a semidefinite program in doubles, solved by Clarabel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from flint import fmpq, fmpq_mat

from lyapcheck._types import Array
from lyapcheck.check.loop.storage import invariant_form, slack, stored_at_base
from lyapcheck.constants.storage.problem import StorageProblem, doubles, unit_rows


@dataclass
class Blocks:
    """constant + Σ_i x_i slope_i ⪰ 0 for several blocks, each as the vector of its upper triangle."""

    sizes: list[int] = field(default_factory=list)
    constants: list[Array] = field(default_factory=list)
    slopes: list[dict[int, Array]] = field(default_factory=list)

    def add(self, constant: Array, slopes: dict[int, Array]) -> None:
        """One more block."""
        self.sizes.append(len(constant))
        self.constants.append(_stacked(constant))
        self.slopes.append({i: _stacked(slope) for i, slope in slopes.items()})


@dataclass(frozen=True, eq=False)
class ProgramSolution:
    """The κ_k of the joints, (n,), and of each problem the coefficients of its forms, (n, forms)."""

    prices: Array
    coefficients: list[Array]


def propose(
    problems: Sequence[StorageProblem], margin: float, prices: Array | None = None, most: float | None = None
) -> ProgramSolution | None:
    """The least κ for which every slack is at least ``margin`` times the size of the costs; ``None`` without.

    Args:
        problems: costs along chains of n links, all with the same κ_k.
        margin: share of the largest cost.
        prices: κ_k = Σ_i prices_ki x_i of unknowns x with the least Σ x_i, (n, x); one κ for all without.
        most: what no x_i is to exceed.
    """
    n = len(problems[0].stages)
    prices = np.ones((n, 1)) if prices is None else prices
    free = end = prices.shape[1]
    blocks, ends = Blocks(), []
    for problem in problems:
        size = max(float(np.abs(doubles(stage.cost)).max()) for stage in problem.stages)
        least = margin * (size or 1.0)  # a body without mass costs nothing, and yet a price must be positive
        _add_blocks(blocks, problem, least, prices, end)
        ends.append(end := end + n * problem.count)
    if most is not None:
        for i in range(free):
            blocks.add(np.array([[most]]), {i: np.array([[-1.0]])})
    x = solve(blocks, end, free)
    if x is None:
        return None
    parts = np.split(x, [free, *ends])[1:-1]
    return ProgramSolution(prices @ x[:free], [part.reshape(n, -1) for part in parts])


def _add_blocks(blocks: Blocks, problem: StorageProblem, least: float, prices: Array, first: int) -> None:
    """The conditions of `lyapcheck.check.loop.storage`: affine in x, and from ``first`` on in the forms."""
    count, stages = problem.count, problem.stages
    units = [invariant_form(row, problem.vectors) for row in unit_rows(count)]
    nothing = units[0] * fmpq(0)
    if any(problem.fall):
        at_base = [float(stored_at_base(stages, [form], problem.fall)) for form in units]
        slopes = {0: np.eye(1)} | {first + i: np.array([[-x]]) for i, x in enumerate(at_base)}
        blocks.add(np.array([[-least]]), slopes)
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
        blocks.add(constant - least * np.eye(len(constant)), slopes)


def _stacked(matrix: Array) -> Array:
    """The upper triangle by columns, off the diagonal times √2, as Clarabel wants it."""
    columns, rows = np.tril_indices(len(matrix))
    return np.asarray(matrix[rows, columns] * np.where(rows == columns, 1.0, np.sqrt(2.0)))


def solve(blocks: Blocks, unknowns: int, first: int) -> Array | None:
    """The x with the least sum of its first entries, as far as the solver comes; ``None`` without."""
    from scipy import sparse

    from lyapcheck.convex import solved_cones

    constants, entries, places, begin = np.concatenate(blocks.constants), [], [], 0
    for constant, slopes in zip(blocks.constants, blocks.slopes, strict=True):
        stacked = -np.array(list(slopes.values()))
        which, row = np.nonzero(stacked)
        entries.append(stacked[which, row])
        places.append((begin + row, np.array(list(slopes))[which]))
        begin += len(constant)
    table = (np.concatenate(entries), np.hstack(places))
    rows = sparse.coo_matrix(table, shape=(begin, unknowns)).tocsc()
    aim = np.zeros(unknowns)
    aim[:first] = 1.0
    # also what is not solved may show a bound: exact arithmetic has the last word
    found = solved_cones(aim, rows, constants, blocks.sizes, 1e-8).values
    return found[0] if found else None
