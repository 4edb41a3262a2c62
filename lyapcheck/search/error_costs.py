"""What the entries of U and Q_j cost at the errors at which the form in (w, p) is smallest.

At such an e let (w, p) be the eigenvector of the smallest eigenvalue. There the form of
`lyapcheck.check.loop.error_form` falls with U_i by ε l p_i²/U_i², and with Q_ji by

    ε |h_j| w_i² + ½ ε² |h_i| w_j²/t_ij + ⅛ ε² |h_i| t_ij (b_i w_i − ε p_i)²/κ_i².
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.error_boxes import ErrorBoxes, FormAt

Shares = tuple[tuple[float, ...], ...]
"""Of U, then of Q_2, …, Q_n: the cost of each entry in units of b, of mean 1."""

MULTIPLIERS = (-2, -1, 0, 1)
"""Of l, as powers of √2."""
SAMPLES, KEPT, NEIGHBOURS, STEPS = 2_000, 20, 15, 6
WORST = 10
"""Errors that count, of those met in one round."""
HALVINGS = 8
LEAST_SHARE = 0.3
"""The mean of all costs goes to each entry with this weight: errors that resist next are others."""


class ErrorCosts:
    """Errors that resisted, for ever better bounds.

    Args:
        controlled: gains and arm.
        ceiling: no larger ε₀ is of interest.
    """

    def __init__(self, controlled: ControlledArm, ceiling: Fraction) -> None:
        self.controlled, self.ceiling = controlled, ceiling
        self.random = np.random.default_rng(SEED)
        n = controlled.n
        self.near = np.zeros((0, n))
        self.failing = ceiling
        self.seen: list[Array] = []

    @property
    def shares(self) -> Shares:
        """The mean cost of each entry so far."""
        mean = np.mean(self.seen, axis=0)
        total = mean.sum(axis=1, keepdims=True)
        mean = mean * len(mean) / np.where(total > 0, total, 1.0) + LEAST_SHARE
        return tuple(tuple(row) for row in (mean / mean.mean(axis=1, keepdims=True)).tolist())

    def climb(self, bounds: LinkBounds) -> bool:
        """Whether bounds allow more than all before them; their costs where they resist are kept."""
        better = self._least(bounds, self.failing) > 0 or not self.seen
        if better:
            low, high = self.failing if self.seen else Fraction(0), self.ceiling
            for _ in range(HALVINGS):
                middle = (low + high) / 2
                low, high = (middle, high) if self._least(bounds, middle) > 0 else (low, middle)
            self.failing = high
            self._least(bounds, high)
        self.seen.append(costs_at(self._boxes(bounds, self.failing), self.near[:WORST]))
        return better

    def _boxes(self, bounds: LinkBounds, eps0: Fraction) -> ErrorBoxes:
        return ErrorBoxes(self.controlled.loop(Fraction(f"{float(eps0):.6g}")), bounds)

    def _least(self, bounds: LinkBounds, eps0: Fraction) -> float:
        """The smallest eigenvalue found, from random errors and near those kept; its errors are kept."""
        boxes = self._boxes(bounds, eps0)
        if not boxes.loop.admissible:
            return -1.0
        far, n = np.array(boxes.loop.farthest), boxes.n
        sizes = 10 ** self.random.uniform(-2, np.log10(far.max()), (SAMPLES, n))
        errors = np.vstack([self.near, sizes * self.random.choice([0, 1, 1, 1, 1], sizes.shape)])
        for step in range(STEPS):
            values = smallest_at(boxes, np.minimum(errors, far))
            order = np.argsort(values, kind="stable")[:KEPT]
            errors = np.minimum(errors, far)[order]
            if step < STEPS - 1:
                spread = 0.5 ** (1 + step) * self.random.normal(size=(2, NEIGHBOURS, *errors.shape))
                moved = np.abs(errors * np.exp(spread[0]) + 0.03 * spread[1])
                errors = np.vstack([errors, moved.reshape(-1, n)])
        self.near = errors
        return float(values[order[0]])


def smallest_at(boxes: ErrorBoxes, errors: Array) -> Array:
    """The smallest eigenvalues at single errors, each at its best l."""
    at, some = FormAt(boxes, np.stack([errors, errors], axis=1)), np.arange(len(errors))
    result = [np.linalg.eigvalsh(at.middle(some, np.sqrt(2.0) ** power))[:, 0] for power in MULTIPLIERS]
    return np.asarray(np.max(result, axis=0))


def costs_at(boxes: ErrorBoxes, errors: Array) -> Array:
    """The mean cost of U_i/b_i, and below it of Q_ji/b_i, (n, n)."""
    n, b = boxes.n, boxes.b
    at, some = FormAt(boxes, np.stack([errors, errors], axis=1)), np.arange(len(errors))
    result = [np.linalg.eigh(at.middle(some, np.sqrt(2.0) ** power)) for power in MULTIPLIERS]
    best = np.argmax([values[:, 0] for values, _ in result], axis=0)
    vectors = np.array([vectors[:, :, 0] for _, vectors in result])[best, some]
    l = np.sqrt(2.0) ** np.array(MULTIPLIERS)[best][:, None]
    w, p, eps = vectors[:, :n], vectors[:, n:], at.eps
    costs = eps[:, :, None] * at.H[:, :, None] * w[:, None, :] ** 2
    pressed = (b * (w - np.sqrt(eps) * p) / at.kappa) ** 2
    cubic = at.H[:, :, None] * (w[:, None, :] ** 2 * b[:, None] / b / at.t + at.t * pressed[:, :, None] / 4)
    costs += 0.5 * eps[:, :, None] ** 2 * np.swapaxes(cubic, 1, 2)
    costs[:, 0] = l * p**2 / at.U**2
    return np.asarray(np.mean(costs, axis=0))
