"""Proposing storage forms: a semidefinite program in doubles, solved by Clarabel."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lyapcheck._types import Array
from lyapcheck.constants.storage.exact import rounded
from lyapcheck.constants.storage.problem import Problem


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
    """κ and the coefficients of s_1, …, s_n by the forms of the problem, (n, forms)."""

    kappa: float
    coefficients: Array


def propose(problem: Problem, margin: float) -> Proposal | None:
    """The least κ for which every slack is at least ``margin`` times the size of the costs; ``None`` without.

    The first unknown is κ, then come the coefficients of each s_k.
    """
    count = len(problem.forms)
    unknowns = 1 + count * len(problem.steps)
    blocks = _blocks(problem, margin * max(float(np.abs(rounded(s.cost)).max()) for s in problem.steps))
    x = solve(blocks, unknowns)
    return None if x is None else Proposal(float(x[0]), x[1:].reshape(-1, count))


def _blocks(problem: Problem, least: float) -> Blocks:
    blocks, count = Blocks(), len(problem.forms)
    first = rounded(problem.steps[0].carry @ problem.start)
    if first.any():
        slopes = {0: np.eye(1)} | {1 + i: -_at(form, first) for i, form in enumerate(problem.forms)}
        blocks.add(np.array([[-least]]), slopes)
    for k, step in enumerate(problem.steps):
        push, met = rounded(step.push), np.array(step.met)
        place = np.ix_(met, met)
        slopes = {0: rounded(step.price)[place]}
        for i, form in enumerate(problem.forms):
            own = np.zeros((push.shape[1],) * 2)
            own[: len(form), : len(form)] = form
            slopes[1 + k * count + i] = own[place]
            if k + 1 < len(problem.steps):
                moved = rounded(problem.steps[k + 1].carry) @ push
                slopes[1 + (k + 1) * count + i] = -(moved.T @ form @ moved)[place]
        cost = push.T @ rounded(step.cost) @ push
        blocks.add(-cost[place] - least * np.eye(len(met)), slopes)
    return blocks


def _at(form: Array, w: Array) -> Array:
    return np.array([[w @ form @ w]])


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
    found = clarabel.DefaultSolver(
        nothing, aim, rows, np.concatenate(blocks.constants), cones, settings
    ).solve()
    x = np.array(found.x)
    return x if np.isfinite(x).all() else None
