"""Boxes of |e| on which the form of `lyapcheck.check.kinds.link_bounds` is positive definite, by NumPy.

Each box is judged at several multipliers l. The sizes of w and p that weigh what is uncertain about N are
those of the eigenvector of the smallest eigenvalue, again and again: there they cost least.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.link_bounds import BITS, FIRST, SCALES, BoxForm, LinkBounds
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.field import Box
from lyapcheck.check.numbers.balls import precision
from lyapcheck.family import named
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.cover import CHUNK, EXHAUSTED, RESISTS, SMALLEST, CoverOutcome, Nodes, halve
from lyapcheck.search.interval import Interval
from lyapcheck.search.interval_arm import dh_range, h_range

MULTIPLIERS = (-2, 0)
"""Of l, as powers of √2."""
ROUNDS = 6
LEAST = 1e-7
"""What the smallest eigenvalue has to exceed, w in units of b^−½: doubles are not balls."""


class ErrorBoxes:
    """The form for one closed loop.

    Args:
        loop: at the ε₀ that is tried.
        bounds: U and Q_j.
    """

    def __init__(self, loop: ClosedLoop, bounds: LinkBounds) -> None:
        self.loop, self.n = loop, loop.n
        with precision(BITS):
            self.form = BoxForm(loop, bounds.inertia.prices, [bound.prices for bound in bounds.rising])
        self.family = named(loop.family, loop.m)
        self.U = np.array([float(x) for x in bounds.inertia.prices])
        Q = [[0.0] * loop.n, *([float(x) for x in bound.prices] for bound in bounds.rising)]
        self.Q = np.array(Q)
        self.b = np.array([float(low) for low, _ in loop.friction])
        self.fast = np.array([float(x) for x in self.form.fast])
        self.kp = np.array([float(k) for k in loop.kp])

    def covered(self, max_boxes: int) -> CoverOutcome:
        """A tree of boxes from 0 to R within a budget, with their scales."""
        nodes = Nodes()
        start = np.stack([np.zeros(self.n), np.array(self.loop.farthest)])[None]
        stack, seen, scales = [(start, nodes.add(1))], 0, dict[int, str]()
        shown: list[tuple[Array, NDArray[np.intp], NDArray[np.intp]]] = []
        while stack or shown:
            if stack:
                boxes, names = stack.pop()
                if len(boxes) > CHUNK // 4:
                    stack.append((boxes[CHUNK // 4 :], names[CHUNK // 4 :]))
                    boxes, names = boxes[: CHUNK // 4], names[: CHUNK // 4]
                seen += len(boxes)
                if seen > max_boxes:
                    return CoverOutcome(False, seen, f"{EXHAUSTED}; allow more boxes")
                proved, signs = self.judged(boxes)
                shown.append((boxes[proved], names[proved], signs[proved]))
            else:  # balls take longer than doubles, and have the last word
                boxes, names, signs = (np.concatenate(parts) for parts in zip(*shown, strict=True))
                proved, shown = self._surely(boxes, signs), []
                scales |= {int(names[k]): "".join(map(chr, signs[k])) for k in np.flatnonzero(proved)}
            rest = boxes[~proved]
            if len(rest):
                if np.max(rest[:, 1] - rest[:, 0], axis=1).min() < 2 * SMALLEST or self._resists(rest):
                    return CoverOutcome(False, seen, RESISTS)
                sides = self.sides(rest)
                stack.append((halve(rest, sides), nodes.cut(names[~proved], sides)))
        tree, order = nodes.preorder()
        return CoverOutcome(True, seen, tree=tree, scales="".join(scales[name] for name in order))

    def _resists(self, boxes: Array) -> bool:
        """Whether the middle of one of some boxes cannot be shown alone."""
        middles = boxes[:: max(1, len(boxes) // 64)].mean(axis=1)
        points = np.stack([middles, middles], axis=1)
        return not bool(self.judged(points)[0].all())

    def judged(self, boxes: Array) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
        """Which boxes seem to be shown, and with which scales."""
        count, size = len(boxes), 1 + 2 * self.n
        signs = np.full((count, size), FIRST + SCALES // 2, dtype=np.intp)
        at = FormAt(self, boxes)
        proved = self._beyond(boxes)
        for power in MULTIPLIERS:
            left = np.flatnonzero(~proved)
            if not len(left):
                break
            shown, sizes = at.tried(left, power)
            rows = left[shown]
            signs[rows, 0] += power
            signs[rows, 1:] += sizes[shown]
            proved[rows] = True
        return proved, signs

    def _beyond(self, boxes: Array) -> NDArray[np.bool_]:
        """Which boxes lie where nothing is to be shown."""
        return np.asarray(np.sum(boxes[:, 0] ** 2, axis=1) >= (1 + 1e-12) * self.loop.radius**2)

    def _surely(self, boxes: Array, signs: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Which boxes are shown with their scales in balls."""
        proved = self._beyond(boxes)
        with precision(BITS):
            for k in np.flatnonzero(~proved):
                box: Box = tuple(zip(boxes[k, 0].tolist(), boxes[k, 1].tolist(), strict=True))
                proved[k] = self.form.proves(box, "".join(map(chr, signs[k])))
        return proved

    def sides(self, boxes: Array) -> NDArray[np.intp]:
        """The sides over which N changes most, in rough measure."""
        low, high = boxes[:, 0], boxes[:, 1]
        middle = (low + high) / 2
        r = np.linalg.norm(middle, axis=1)[:, None]
        slopes = dh_range(self.family, Interval(low, high))
        rise = self.family.h(high) - self.family.h(low)
        root = np.sqrt(self.U / self.b)
        weight = np.sqrt(self.b)
        size = np.linalg.norm(self.family.h(high) * weight, axis=1)[:, None]
        turned = size / weight * np.minimum((high - low) / r, 1.0)
        score = (slopes.hi - slopes.lo) * root + 0.5 * (rise * weight / weight.min() + turned) / (1 + r)
        return np.asarray(np.argmax(score, axis=1))


class FormAt:
    """What the form needs on some boxes, w and p in units of b^∓½."""

    def __init__(self, of: ErrorBoxes, boxes: Array) -> None:
        low, high = boxes[:, 0], boxes[:, 1]
        n, b, root = of.n, of.b, np.sqrt(of.b)
        near, far = np.linalg.norm(low, axis=1), np.linalg.norm(high, axis=1)
        self.eps = eps = (float(of.loop.eps0) / (1 + near))[:, None]
        x = Interval(low, high)
        h, dh = h_range(of.family, x), dh_range(of.family, x)
        unit = _units(low, high)
        scaled = unit[0] / (1 + far[:, None]), unit[1] / (1 + near[:, None])
        products = [h.lo[:, :, None] * scaled[0][:, None, :], h.hi[:, :, None] * scaled[1][:, None, :]]
        diagonal = np.eye(n)
        lower = -products[1] + dh.lo[:, :, None] * diagonal
        upper = -products[0] + dh.hi[:, :, None] * diagonal
        scale = root[:, None] / root
        self.N, self.spread = 0.5 * (lower + upper) * scale, 0.5 * (upper - lower) * scale
        self.H = H = np.maximum(np.abs(h.lo), np.abs(h.hi))
        k = np.maximum(of.kp - eps * of.fast, 1e-12)
        self.t = t = np.sqrt((eps * k)[:, :, None] / b)
        R = of.Q.T * H[:, :, None]
        self.kappa = np.maximum(k - eps / 2 * np.sum(R * t, axis=2), 1e-12)
        lost = eps * (H @ of.Q) + eps**2 / 2 * np.sum(R / t, axis=1) + eps * b**2 / (4 * self.kappa)
        self.W = 1 - lost / b
        self.compliance = b / self.kappa
        self.U, self.b, self.n = of.U / b, b, n

    def middle(self, some: NDArray[np.intp], l: float) -> Array:
        """The form in (w, √ε p) with N in the middle of some boxes: the lower triangles, (count, 2n, 2n)."""
        n, eps = self.n, self.eps[some]
        shift = 0.25 * eps * self.compliance[some]
        places = np.arange(n)
        big = np.zeros((len(some), 2 * n, 2 * n))
        big[:, n:, :n] = -np.sqrt(eps)[:, :, None] * (
            0.5 * (np.eye(n) + l * self.N[some]) - shift[:, :, None] * np.eye(n)
        )
        big[:, places, places] = self.W[some]
        big[:, n + places, n + places] = l / self.U - eps * shift
        return big

    def tried(self, some: NDArray[np.intp], power: int) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
        """Which of some boxes seem to be shown at one l, and the sizes of w and p as powers of √2."""
        n, count, l = self.n, len(some), np.sqrt(2.0) ** power
        eps, spread = self.eps[some], self.spread[some]
        big = self.middle(some, l)
        places = np.arange(2 * n)
        steady = big[:, places, places]
        # in units of w; p as a plain number
        sizes = np.zeros((count, 2 * n))
        sizes[:, n:] = np.log2(self.U)
        shown, best = np.zeros(count, dtype=bool), np.zeros((count, 2 * n), dtype=np.intp)
        offset = np.concatenate([-np.log2(self.b), np.log2(self.b)])
        for _ in range(ROUNDS):
            powers = np.clip(np.rint(sizes + offset), 1 - SCALES // 2, SCALES // 2 - 1)
            w, p = np.split(np.sqrt(2.0) ** (powers - offset), 2, axis=1)
            lost = eps * np.einsum("bij,bi->bj", spread, p) / w, np.einsum("bij,bj->bi", spread, w) / p
            big[:, places, places] = steady - l / 2 * np.hstack(lost)
            values, vectors = np.linalg.eigh(big)
            now = (values[:, 0] > LEAST) & ~shown
            best[now] = powers[now]
            shown |= now
            if shown.all():
                break
            result = np.abs(vectors[:, :, 0])
            result[:, n:] /= np.sqrt(eps)
            w, p = np.split(result, 2, axis=1)
            w, p = w + 0.03 * w.max(axis=1, keepdims=True), p + 0.03 * p.max(axis=1, keepdims=True)
            wanted = 2 * np.log2(np.concatenate([w, p], axis=1))
            wanted -= wanted.mean(axis=1, keepdims=True) - sizes.mean(axis=1, keepdims=True)
            sizes = 0.5 * (sizes + wanted)
        return shown, best


def _units(low: Array, high: Array) -> tuple[Array, Array]:
    """The range of e/‖e‖ over boxes of e ≥ 0."""
    near, far = low**2, high**2
    rest = np.sum(far, axis=1, keepdims=True) - far, np.sum(near, axis=1, keepdims=True) - near
    ends = [np.sqrt(x / np.maximum(x + y, 1e-300)) for x, y in zip((near, far), rest, strict=True)]
    return ends[0], ends[1]


# --- What the entries of U and Q_j cost at the errors at which the form in (w, p) is smallest.
#
# At such an e let (w, p) be the eigenvector of the smallest eigenvalue. There the form of
# `lyapcheck.check.kinds.link_bounds` falls with U_i by ε l p_i²/U_i², and with Q_ji by
#
#     ε |h_j| w_i² + ½ ε² |h_i| w_j²/t_ij + ⅛ ε² |h_i| t_ij (b_i w_i − ε p_i)²/κ_i².


Shares = tuple[tuple[float, ...], ...]
"""Of U, then of Q_2, …, Q_n: the cost of each entry in units of b, of mean 1."""
ERROR_COSTS_MULTIPLIERS = (-2, -1, 0, 1)
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
    result = [
        np.linalg.eigvalsh(at.middle(some, np.sqrt(2.0) ** power))[:, 0] for power in ERROR_COSTS_MULTIPLIERS
    ]
    return np.asarray(np.max(result, axis=0))


def costs_at(boxes: ErrorBoxes, errors: Array) -> Array:
    """The mean cost of U_i/b_i, and below it of Q_ji/b_i, (n, n)."""
    n, b = boxes.n, boxes.b
    at, some = FormAt(boxes, np.stack([errors, errors], axis=1)), np.arange(len(errors))
    result = [np.linalg.eigh(at.middle(some, np.sqrt(2.0) ** power)) for power in ERROR_COSTS_MULTIPLIERS]
    best = np.argmax([values[:, 0] for values, _ in result], axis=0)
    vectors = np.array([vectors[:, :, 0] for _, vectors in result])[best, some]
    l = np.sqrt(2.0) ** np.array(ERROR_COSTS_MULTIPLIERS)[best][:, None]
    w, p, eps = vectors[:, :n], vectors[:, n:], at.eps
    costs = eps[:, :, None] * at.H[:, :, None] * w[:, None, :] ** 2
    pressed = (b * (w - np.sqrt(eps) * p) / at.kappa) ** 2
    cubic = at.H[:, :, None] * (w[:, None, :] ** 2 * b[:, None] / b / at.t + at.t * pressed[:, :, None] / 4)
    costs += 0.5 * eps[:, :, None] ** 2 * np.swapaxes(cubic, 1, 2)
    costs[:, 0] = l * p**2 / at.U**2
    return np.asarray(np.mean(costs, axis=0))
