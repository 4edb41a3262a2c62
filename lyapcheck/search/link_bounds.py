"""Bounds along the links, and boxes of e that prove dV/dt < 0 by them, for arms of many joints.

There is no least U, nor a least Q_j: what one entry gives up, others may gain. All entries are equally dear.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.kinds.link_bounds import BITS, FIRST, SCALES, BoxForm, LinkBounds
from lyapcheck.check.loop import ClosedLoop
from lyapcheck.check.loop.field import Box, ball
from lyapcheck.check.numbers.balls import precision
from lyapcheck.constants.storage import energy_problem, prices_shown, propose, rate_problem
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain
from lyapcheck.search.boxes import (
    CHUNK,
    EXHAUSTED,
    RESISTS,
    SMALLEST,
    CoverOutcome,
    Interval,
    Nodes,
    halve,
    norm,
    of_sides,
    unit_vector,
)
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof

MAX_BOXES = 40_000
"""Of one share: as many as the checker judges in a quarter of a minute."""
MORE = 1.01
"""How far an entry of U may exceed the largest eigenvalue of B^−½MB^−½, which lets the others be smaller."""
_MARGIN = 1e-6


def linked_proof(controlled: ControlledArm, eps0: Fraction) -> DecreaseProof | None:
    """A proof for one ε₀ of an arm of many joints, that the checker has yet to judge."""
    loop = controlled.loop(eps0)
    bounds = link_bounds(controlled) if controlled.n > FEW_JOINTS and loop.admissible else None
    if bounds is None:
        return None
    outcome = ErrorBoxes(loop, bounds).covered(MAX_BOXES)
    if not outcome.proved:
        return None
    return controlled.proof(loop, replace(bounds, tree=outcome.tree, scales=outcome.scales))


def link_bounds(controlled: ControlledArm) -> LinkBounds | None:
    """Bounds of M and its rates, without boxes yet; ``None`` where some were not found."""
    friction = tuple(low for low, _ in controlled.loop(Fraction(1)).friction)
    return bounds_along(controlled.chains, friction) if controlled.chains else None


@lru_cache(maxsize=4)
def bounds_along(chains: tuple[Chain, ...], friction: tuple[Fraction, ...]) -> LinkBounds | None:
    """The same for the links at each corner, and the lower ends of the friction, N·m·s/rad.

    Args:
        chains: at each corner.
        friction: b.
    """
    n, weight = len(friction), np.array([float(b) for b in friction])
    energies = [energy_problem(chain, 1) for chain in chains]
    uniform = propose(energies, _MARGIN, weight[:, None])
    if uniform is None:
        return None
    inertia = prices_shown(energies, weight, MORE * float(uniform[0][0]) / weight[0])
    rising, falling = [], []
    for joint in range(1, n):
        # the same prices for both signs
        problems = [rate_problem(chain, joint, sign) for sign in (1, -1) for chain in chains]
        both = prices_shown(problems, weight)
        if both is None:
            return None
        rising.append(replace(both, forms=both.forms[: len(chains)]))
        falling.append(replace(both, forms=both.forms[len(chains) :]))
    if inertia is None:
        return None
    arms = tuple(chain.links for chain in chains)
    return LinkBounds(arms, inertia, tuple(rising), tuple(falling), "", "")


# --- Boxes of |e| on which the form of `lyapcheck.check.kinds.link_bounds` is positive definite, by NumPy.
#
# Each box is judged at several multipliers l. The sizes of w and p that weigh what is uncertain about N are
# those of the eigenvector of the smallest eigenvalue, again and again: there they cost least.

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
        self.of_error = of_sides(lambda side: (loop.member.h(ball(side)), loop.member.dh(ball(side))))
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
                    return CoverOutcome(False, seen, EXHAUSTED)
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
        values, slopes = self.of_error(Interval(low, high))
        root = np.sqrt(self.U / self.b)
        weight = np.sqrt(self.b)
        size = np.linalg.norm(values.hi * weight, axis=1)[:, None]
        turned = size / weight * np.minimum((high - low) / r, 1.0)
        score = slopes.radius * root + 0.5 * (values.radius * weight / weight.min() + turned / 2) / (1 + r)
        return np.asarray(np.argmax(score, axis=1))


class FormAt:
    """What the form needs on some boxes, w and p in units of b^∓½."""

    def __init__(self, of: ErrorBoxes, boxes: Array) -> None:
        low, high = boxes[:, 0], boxes[:, 1]
        n, b, root = of.n, of.b, np.sqrt(of.b)
        sides = [Interval(low[:, k], high[:, k]) for k in range(n)]
        near, far = norm(sides).lo, norm(sides).hi
        self.eps = eps = (float(of.loop.eps0) / (1 + near))[:, None]
        h, dh = of.of_error(Interval(low, high))
        unit = unit_vector(sides)
        least = np.stack([x.lo / (1 + far) for x in unit], axis=1)
        most = np.stack([x.hi / (1 + near) for x in unit], axis=1)
        products = [h.lo[:, :, None] * least[:, None, :], h.hi[:, :, None] * most[:, None, :]]
        diagonal = np.eye(n)
        lower = -products[1] + dh.lo[:, :, None] * diagonal
        upper = -products[0] + dh.hi[:, :, None] * diagonal
        scale = root[:, None] / root
        self.N, self.spread = 0.5 * (lower + upper) * scale, 0.5 * (upper - lower) * scale
        self.H = H = h.size
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
