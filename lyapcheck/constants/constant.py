"""One constant of an arm: what is maximised, and the enclosure that comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array, Progress
from lyapcheck.check.numbers.harmonics import Harmonics
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.constants.storage import BoundWithProof

# --- Trigonometric polynomials over boxes of angles: a linear part around the middle, and what it leaves.
#
# Over a box with half widths r a harmonic cos(k·q) or sin(k·q) turns by at most d = Σ |k_i| r_i from its
# value in the middle, and by at most d²/2 from its linear part. Harmonics that turn far are bounded by their
# exact range, those that hardly turn by their slope and what is sharper than the square.
#
# Soundness: floating point with the error bounded beforehand: every value is trusted within ``SLACK`` times
# the sum of the sizes of all coefficients, far more than the rounding of sines, products and sums amounts to.


def _sheared(multiples: Array, sizes: Array) -> tuple[Array, Array]:
    """Multiples of the coordinates q_i ± q_{i+1} in place of q_{i+1}, wherever the sums get shorter by that.

    On a torus such a change of coordinates is one to one.
    """
    n = multiples.shape[1]
    back = np.eye(n)
    for i, sign in product(range(n - 1), (-1.0, 1.0)):
        other = multiples.copy()
        other[:, i] += sign * multiples[:, i + 1]
        if sizes @ np.abs(other[:, i]) < 0.9 * (sizes @ np.abs(multiples[:, i])):
            shear = np.eye(n)
            shear[i + 1, i] = sign
            multiples, back = other, back @ shear
    return multiples, back


PI_ABOVE = 3.1415926535897936
SLACK = 1e-12
NEAR = 0.25


@dataclass(frozen=True)
class AffineForms:
    """Polynomials on boxes: middle + Σ_i t_i linear_i with |t_i| ≤ 1, up to the radius.

    Args:
        value: in the middles of the boxes, (boxes, entries).
        middle: of what the polynomials reach, (boxes, entries).
        linear: slopes times half widths, one an angle that matters, (boxes, angles, entries).
        radius: what that leaves, (boxes, entries).
    """

    value: Array
    middle: Array
    linear: Array
    radius: Array

    @property
    def reach(self) -> tuple[Array, Array]:
        """Both ends of what each polynomial reaches."""
        radius = np.abs(self.linear).sum(axis=1) + self.radius
        return self.middle - radius, self.middle + radius

    def corners(self) -> Array:
        """middle + Σ_i ± linear_i for all signs, (boxes, 2 to the number of angles, entries).

        A convex function of the entries is largest at one of them.
        """
        result = self.middle[:, None]
        for i in range(self.linear.shape[1]):
            step = self.linear[:, None, i]
            result = np.concatenate([result + step, result - step], axis=1)
        return result


class Torus:
    """Several polynomials on boxes of the coordinates that they depend on: angles, or sums of angles.

    Args:
        entries: the polynomials.
        n: number of joints.
        sheared: whether sums of angles may be coordinates.
        near: how far harmonics may turn over half a box, rad, that are bounded by their slope.
    """

    def __init__(
        self, entries: Sequence[Harmonics], n: int, sheared: bool = True, near: float = NEAR
    ) -> None:
        self.n, self.near = n, near
        sums = [
            {(k, odd): x for k, ab in entry.items() for odd, x in enumerate(ab) if x} for entry in entries
        ]
        keys = sorted({key for entry in sums for key in entry}) or [((0,) * n, 0)]
        coefficients = np.array([[float(entry.get(key, 0)) for entry in sums] for key in keys])
        self._coefficients: Array = coefficients.reshape(len(keys), len(entries))
        self._sizes: Array = np.abs(self._coefficients)
        self.slack: Array = SLACK * self._sizes.sum(axis=0)
        # q = back p, where back is whole and of determinant ±1
        multiples = np.array([k for k, _ in keys], dtype=np.float64)
        sizes = self._sizes.sum(axis=1)
        self._multiples, self._back = _sheared(multiples, sizes) if sheared else (multiples, np.eye(n))
        self._sine = np.array([sine for _, sine in keys]) > 0
        self._frequency: Array = np.abs(self._multiples)
        used = self._sizes.any(axis=1)
        self.angles = tuple(np.flatnonzero(self._frequency[used].any(axis=0)).tolist())

    def _harmonics(self, p: Array) -> tuple[Array, Array]:
        """cos(k·p) and sin(k·p) at coordinates (count, n), and their slopes by the angle k·p."""
        angle = p @ self._multiples.T
        sine, cosine = np.sin(angle), np.cos(angle)
        return np.where(self._sine, sine, cosine), np.where(self._sine, cosine, -sine)

    @property
    def lost(self) -> float:
        """What rounding can take from the size of all polynomials together."""
        return float(2 * np.sum(self.slack))

    def at(self, states: Array) -> Array:
        """Values at states, given by their coordinates (count, n); up to ``slack``."""
        return np.asarray(self._harmonics(states)[0] @ self._coefficients)

    def on(self, middle: Array, half: Array) -> AffineForms:
        """Values and reach over boxes of coordinates, given by their middles and half widths, (boxes, n)."""
        values, turned = self._harmonics(middle)
        turn = half @ self._frequency.T
        near = turn < self.near
        far = np.minimum(turn, np.pi)
        along, across = np.cos(far), turned * np.sin(far)
        ends = values * along + across, values * along - across
        low = np.where(-values >= along, -1.0, np.minimum(*ends))
        high = np.where(values >= along, 1.0, np.maximum(*ends))
        # v cos d + u sin d at the distance d, v the value and u the slope: what is left of it without u d
        most = np.minimum(turn, self.near)
        least = np.cos(most)
        bent = np.abs(values) * 0.5 * (1 - least) + np.abs(turned) * (most - np.sin(most))
        middles = np.where(near, values * 0.5 * (1 + least), 0.5 * (low + high))
        radius = np.where(near, bent, 0.5 * (high - low)) @ self._sizes + self.slack
        linear = np.zeros((len(middle), 0, len(self.slack)))
        if half.any():
            slopes = (turned * self._multiples[:, i] for i in self.angles)
            parts = [
                (np.where(near, slope, 0.0) @ self._coefficients) * half[:, [i]]
                for i, slope in zip(self.angles, slopes, strict=True)
            ]
            linear = np.stack(parts, axis=1) if parts else linear
        value, middle = values @ self._coefficients, middles @ self._coefficients
        return AffineForms(value, middle, linear, radius * (1.0 + 1e-9))

    def angles_at(self, p: Array) -> Array:
        """The joint angles of coordinates (n,), rad, each within one turn around 0."""
        q = self._back @ p
        return np.asarray(q - 2 * np.pi * np.round(q / (2 * np.pi)))

    def influence(self, half: Array, weight: Array) -> Array:
        """How much of the reach each angle causes, roughly, (boxes, n); ``weight`` is one number an entry."""
        turn = half @ self._frequency.T
        share = (np.minimum(turn, 2.0) / np.maximum(turn, 1e-300)) * (self._sizes @ weight)
        return np.asarray(half * (share @ self._frequency))


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

    def solve(self, max_boxes: int, gap: float, on_progress: Progress | None = None) -> ConstantResult:
        """The constant between the value at a state and a bound over all of them.

        Args:
            max_boxes: budget in boxes of cost 1.
            gap: relative width that is good enough.
        """
        half = np.zeros(self.torus.n)
        half[list(self.torus.angles)] = PI_ABOVE
        start = climb(lambda states: self.value(self.torus.at(states)), half)
        budget = max_boxes // self.cost
        inside, outside, coordinates, boxes = self._enclosed(half, start, budget, gap, on_progress)
        ends = sorted((Fraction(self.sign * inside), Fraction(self.sign * outside)))
        # a norm is never negative, however much its bound from below is rounded
        low, high = (max(x, Fraction(0)) for x in ends) if self.sign > 0 else ends
        shown = self.shown or (lambda p: tuple(self.torus.angles_at(p).tolist()))
        return ConstantResult(self.name, self.unit, Enclosure(low, high), shown(coordinates), boxes)

    def _enclosed(
        self, half: Array, state: Array, max_boxes: int, gap: float, on_progress: Progress | None
    ) -> tuple[float, float, Array, int]:
        """The supremum over [−half, half] from both sides, the state of the inner end, and the boxes it took.

        Boxes are halved where the bound is largest: best first, and stopped at any time.

        Soundness: halves cover their box, and one is dropped only when its bound is not above the inner end.
        """
        inside = float(self.value(self.torus.at(state[None]))[0])
        middle, width = np.zeros((1, len(half))), half[None]
        top = np.fmin(self.most(self.torus.on(middle, width)), np.inf)
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
