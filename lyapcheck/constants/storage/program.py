"""Proposing storage forms: a semidefinite program in doubles, solved by Clarabel."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from flint import fmpq, fmpq_mat

from lyapcheck._types import Array
from lyapcheck.check.loop.storage import invariant_form, slack, stored_at_base
from lyapcheck.constants.storage.problem import Problem, doubles, unit_rows


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
class Proposal:
    """κ and for each joint the coefficients of its form, (n, forms)."""

    kappa: float
    coefficients: Array


def propose(problem: Problem, margin: float) -> Proposal | None:
    """The least κ for which every slack is at least ``margin`` times the size of the costs; ``None`` without.

    The first unknown is κ, then come the coefficients of each s_k.
    """
    count = problem.count
    unknowns = 1 + count * len(problem.stages)
    least = margin * max(float(np.abs(doubles(stage.cost)).max()) for stage in problem.stages)
    x = solve(_blocks(problem, least), unknowns)
    return None if x is None else Proposal(float(x[0]), x[1:].reshape(-1, count))


def _blocks(problem: Problem, least: float) -> Blocks:
    """The conditions of `lyapcheck.check.loop.storage`, which are affine in the unknowns."""
    blocks, count, stages = Blocks(), problem.count, problem.stages
    units = [invariant_form(row, problem.vectors) for row in unit_rows(count)]
    nothing = units[0] * fmpq(0)
    if any(problem.fall):
        at_base = [float(stored_at_base(stages, [form], problem.fall)) for form in units]
        slopes = {0: np.eye(1)} | {1 + i: np.array([[-x]]) for i, x in enumerate(at_base)}
        blocks.add(np.array([[-least]]), slopes)
    for k in range(len(stages)):

        def part(own: fmpq_mat, after: fmpq_mat, kappa: int, k: int = k) -> Array:
            following = after if k + 1 < len(stages) else None
            return doubles(slack(stages, k, own, following, fmpq(kappa)))

        constant = part(nothing, nothing, 0)
        slopes = {0: part(nothing, nothing, 1) - constant}
        for i, form in enumerate(units):
            slopes[1 + k * count + i] = part(form, nothing, 0) - constant
            if k + 1 < len(stages):
                slopes[1 + (k + 1) * count + i] = part(nothing, form, 0) - constant
        blocks.add(constant - least * np.eye(len(constant)), slopes)
    return blocks


def _stacked(matrix: Array) -> Array:
    """The upper triangle by columns, off the diagonal times √2, as Clarabel wants it."""
    columns, rows = np.tril_indices(len(matrix))
    return np.asarray(matrix[rows, columns] * np.where(rows == columns, 1.0, np.sqrt(2.0)))


def solve(blocks: Blocks, unknowns: int, tolerance: float = 1e-8) -> Array | None:
    """The x with the least x_0, as far as the solver comes; ``None`` where it comes to nothing."""
    import clarabel
    from scipy import sparse

    parts = []
    for constant, slopes in zip(blocks.constants, blocks.slopes, strict=True):
        part = np.zeros((len(constant), unknowns))
        for i, slope in slopes.items():
            part[:, i] = -slope
        parts.append(sparse.csc_matrix(part))
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.chordal_decomposition_enable = False
    # the same answer on any number of cores
    settings.direct_solve_method, settings.max_threads = "faer", 1
    settings.tol_gap_rel = settings.tol_gap_abs = settings.tol_feas = tolerance
    aim = np.zeros(unknowns)
    aim[0] = 1.0
    cones = [clarabel.PSDTriangleConeT(size) for size in blocks.sizes]
    nothing = sparse.csc_matrix((unknowns, unknowns))
    rows = sparse.vstack(parts, format="csc")
    result = clarabel.DefaultSolver(
        nothing, aim, rows, np.concatenate(blocks.constants), cones, settings
    ).solve()
    x = np.array(result.x)
    return x if np.isfinite(x).all() else None
