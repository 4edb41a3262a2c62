"""One constant of an arm: what is maximised, and the enclosure that comes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter, sqrt

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array, Progress
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.constants.storage import BoundWithProof
from lyapcheck.constants.torus import PI_ABOVE, AffineForms, Torus
from lyapcheck.robots.plant import Plant

# --- What is known of the constants of an arm for all angles before any box: from its links.


def ceiling(bound: Fraction | None, sign: int) -> float:
    """A double that is not below sign·bound; infinite where there is no bound."""
    return inf if bound is None else nextafter(float(sign * bound), inf)


def from_distances(plant: Plant, name: str) -> Fraction | None:
    """A lower bound of λmin(M), an upper one of another constant, from masses and distances where known."""
    known = plant.chain_bounds
    if known is None or name != "k_g":
        return None if known is None else known[name]
    square = sum((x * x for key, x in known.items() if key.startswith("k_g") and x is not None), Fraction(0))
    return Fraction(sqrt(square)) * (1 + Fraction(1, 10**12))


_SAMPLES = 1024
_BLOCK = 64
_ROUNDS = 40
_BATCH = 128


@dataclass(frozen=True)
class ConstantResult:
    """One constant of an arm: its enclosure, a state that shows the inside end, and the boxes it took.

    Args:
        name: ``lambda_min``, ``lambda_max``, ``k_c``, ``k_g`` or ``k_g1`` and so on.
        unit: SI unit.
        enclosure: both sides.
        state: angles in rad; for k_c followed by the components of x.
        boxes: looked at.
        shown: a bound from outside that the checker has accepted, where there is one.
    """

    name: str
    unit: str
    enclosure: Enclosure
    state: tuple[float, ...]
    boxes: int
    shown: BoundWithProof | None = None

    @property
    def gap(self) -> float:
        """Width of the enclosure relative to its larger end."""
        size = max(abs(self.enclosure.lower), abs(self.enclosure.upper))
        return float(self.enclosure.width / size) if size else 0.0


@dataclass(frozen=True)
class SupremumTask:
    """A constant as the supremum over all angles of a function of some polynomials.

    Args:
        name: of the constant.
        unit: SI unit.
        torus: the polynomials, whose coordinates the boxes are boxes of.
        value: from values of the polynomials to what the function is at least there.
        most: from reaches of the polynomials to what the function is at most on each box.
        weight: how much each polynomial matters for the order of the splits.
        shown: the state that is handed back, from coordinates; by default the angles.
        sign: −1 where the constant is the infimum, and the function its negative.
        cost: of a box, relative to those of λmax(M).
    """

    name: str
    unit: str
    torus: Torus
    value: Callable[[Array], Array]
    most: Callable[[AffineForms], Array]
    weight: Array
    shown: Callable[[Array], tuple[float, ...]] | None = None
    sign: int = 1
    cost: int = 1

    def solve(
        self,
        max_boxes: int,
        gap: float,
        on_progress: Progress | None = None,
        known: Fraction | None = None,
    ) -> ConstantResult:
        """The constant between the value at a state and a bound over all of them.

        Args:
            max_boxes: budget in boxes of cost 1.
            gap: relative width that is good enough.
            known: a bound of the constant from outside.
        """
        half = np.zeros(self.torus.n)
        half[list(self.torus.angles)] = PI_ABOVE
        start = climb(lambda states: self.value(self.torus.at(states)), half)
        most, budget = ceiling(known, self.sign), max_boxes // self.cost
        inside, outside, coordinates, boxes = self._enclosed(half, start, budget, gap, most, on_progress)
        bound = Fraction(self.sign * outside)
        if known is not None:
            bound = self.sign * min(self.sign * known, self.sign * bound)
        ends = sorted((Fraction(self.sign * inside), bound))
        # a norm is never negative, however much its bound from below is rounded
        low, high = (max(x, Fraction(0)) for x in ends) if self.sign > 0 else ends
        shown = self.shown or (lambda p: tuple(self.torus.angles_at(p).tolist()))
        return ConstantResult(self.name, self.unit, Enclosure(low, high), shown(coordinates), boxes)

    def _enclosed(
        self, half: Array, state: Array, max_boxes: int, gap: float, most: float, on_progress: Progress | None
    ) -> tuple[float, float, Array, int]:
        """The supremum over [−half, half] from both sides, the state of the inner end, and the boxes it took.

        Boxes are halved where the bound is largest: best first, and stopped at any time.

        Soundness: halves cover their box, and one is dropped only when its bound is not above the inner end.
        """
        inside = float(self.value(self.torus.at(state[None]))[0])
        middle, width = np.zeros((1, len(half))), half[None]
        top = np.fmin(self.most(self.torus.on(middle, width)), most)
        seen = 1
        while len(top) and top.max() > inside + gap * abs(inside) and seen + 2 <= max_boxes:
            chosen = np.argsort(-top, kind="stable")[: min(_BATCH, (max_boxes - seen) // 2)]
            rest = np.ones(len(top), dtype=np.bool_)
            rest[chosen] = False
            side = np.argmax(self.torus.influence(width[chosen], self.weight), axis=1)
            halves = _halves(middle[chosen], width[chosen], side)
            affine = self.torus.on(*halves)
            low, high = self.value(affine.value), self.most(affine)
            # a bound that is undefined is no bound: fmin then keeps that of the whole
            high = np.fmin(high, np.concatenate([top[chosen], top[chosen]]))
            seen += len(high)
            if low.max() > inside:
                inside, state = float(low.max()), halves[0][np.argmax(low)]
            keep = high > inside
            kept = rest & (top > inside)
            middle = np.concatenate([middle[kept], halves[0][keep]])
            width = np.concatenate([width[kept], halves[1][keep]])
            top = np.concatenate([top[kept], high[keep]])
            if on_progress is not None:
                on_progress(seen / max_boxes, f"{seen} boxes")
        return inside, max(inside, float(top.max())) if len(top) else inside, state, seen


def _halves(middle: Array, width: Array, side: NDArray[np.intp]) -> tuple[Array, Array]:
    """Both halves of every box; they overlap by the rounding of their middles."""
    rows = np.arange(len(middle))
    half = width.copy()
    half[rows, side] *= 0.5
    step = np.zeros_like(middle)
    step[rows, side] = half[rows, side]
    wider = half.copy()
    wider[rows, side] = np.nextafter(half[rows, side] * (1 + 1e-15), np.inf) + 1e-15
    return np.concatenate([middle - step, middle + step]), np.concatenate([wider, wider])


def climb(merit: Callable[[Array], Array], half: Array) -> Array:
    """A state of large merit: the best of a sample, improved by random steps that shrink."""
    rng = np.random.default_rng(SEED)
    best, top = np.zeros(len(half)), -np.inf
    for block in range(_SAMPLES // _BLOCK):
        points = rng.uniform(-1, 1, (_BLOCK, len(half))) * half
        if block == 0:
            points[0] = 0.0
        values = merit(points)
        if values.max() > top:
            best, top = points[np.argmax(values)], float(values.max())
    step = 0.5
    for _ in range(_ROUNDS):
        points = best + step * rng.standard_normal((_BLOCK, len(half))) * (half > 0)
        values = merit(points)
        if values.max() > top:
            best, top = points[np.argmax(values)], float(values.max())
        step *= 0.75
    return best
