"""One constant of an arm: what is maximised, and the enclosure that comes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED, Array, Progress
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.constants.maximise import maximise
from lyapcheck.constants.outside import ceiling
from lyapcheck.constants.storage.bounds import BoundWithProof
from lyapcheck.constants.torus import PI_ABOVE, AffineForms, Torus

_SAMPLES = 1024
_BLOCK = 64
_ROUNDS = 40


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

    def bounds(self, middle: Array, half: Array) -> tuple[Array, Array]:
        """What the function is at least in the middles of boxes, and at most on them."""
        affine = self.torus.on(middle, half)
        return self.value(affine.value), self.most(affine)

    def at(self, states: Array) -> Array:
        """What the function is at least at states, given by their coordinates."""
        return self.value(self.torus.at(states))

    def influence(self, middle: Array, half: Array) -> Array:
        """How much each side of a box matters."""
        return self.torus.influence(half, self.weight)

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
            on_progress: receives the share of the budget used.
            known: a bound of the constant from outside.
        """
        half = np.zeros(self.torus.n)
        half[list(self.torus.angles)] = PI_ABOVE
        start = climb(self.at, half)
        witness = start, float(self.at(start[None])[0])
        most = ceiling(known, self.sign)
        budget = max_boxes // self.cost
        result = maximise(half, self.bounds, self.influence, witness, budget, gap, most, on_progress)
        outside = Fraction(self.sign * result.outside)
        if known is not None:
            outside = self.sign * min(self.sign * known, self.sign * outside)
        ends = sorted((Fraction(self.sign * result.inside), outside))
        # a norm is never negative, however much its bound from below is rounded
        low, high = (max(x, Fraction(0)) for x in ends) if self.sign > 0 else ends
        coordinates = np.array(result.state)
        state = tuple(self.torus.angles_at(coordinates).tolist())
        if self.shown is not None:
            state = self.shown(coordinates)
        return ConstantResult(self.name, self.unit, Enclosure(low, high), state, result.boxes)


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
