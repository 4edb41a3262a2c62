"""Data for a proof in r = ‖e‖ alone, and the largest ε₀ that it gives."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.check.loop.boxes import Box
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.loop.field import PI_ABOVE
from lyapcheck.check.loop.radial import BITS, Inequality, Parts, RadialBounds, Table
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.harmonics import Harmonic, Harmonics
from lyapcheck.intervals import Interval
from lyapcheck.intervals.definite import positive_definite
from lyapcheck.intervals.functions import cosine, sine
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.cover import cover
from lyapcheck.search.proof import Proof

SAMPLES = 5_000
MAX_BOXES = 12_000
MOST_ANGLES = 4
"""Angles whose boxes are looked at; the harmonics of the others are bounded by their sizes."""
NEARER = (1.0, 0.3, 0.1, 0.03, 0.01, 0.0)
MARGINS = tuple(Fraction(k, 100) for k in (101, 103, 106, 110, 120, 140, 180))
"""μ beside the largest eigenvalue that was found, for the part of M in the chosen angles."""
LOWEST = (Fraction(1, 8), Fraction(1, 3), Fraction(1))
"""ν likewise: small where M can be shown to be nearly positive, else as large as it may be."""
CUTS = (Fraction(0), *(Fraction(k, 50) for k in range(1, 151)), *(Fraction(k) for k in (4, 5, 7, 10, 20, 50)))
SMALLEST = Fraction(1, 10**9)
DIGITS = 7


def radial_epsilon(controlled: ControlledArm) -> Proof | None:
    """The proof of the largest ε₀ that can be had in r alone; ``None`` where there is none.

    Args:
        controlled: gains and arm; over ranges there is no such proof yet.

    Soundness: ``lyapcheck.check.verify`` has accepted what is handed back.
    """
    if not controlled.family.bounded or controlled.ranges:
        return None
    data = radial_data(controlled)
    if data is None:
        return None
    with precision(BITS):
        parts = Parts(controlled.loop(Fraction(1)), data)
        low, high = Fraction(0), Fraction(1)
        while _holds(controlled, parts, high):
            low, high = high, 2 * high
        while high - low > low / 10_000 and high > SMALLEST:
            middle = (low + high) / 2
            low, high = (middle, high) if _holds(controlled, parts, middle) else (low, middle)
    if low == 0:
        return None
    loop = controlled.loop(_short(low))
    by = data
    proof = Proof(loop, by, controlled.inertia_proof)
    return proof if proof.accepted() else None


def _holds(controlled: ControlledArm, parts: Parts, eps0: Fraction) -> bool:
    """Whether the inequality in r holds; the tree is looked at only once, at the end."""
    loop = controlled.loop(eps0)
    return loop.admissible and Inequality(loop, parts).shown()


def holds_radially(loop: ClosedLoop, data: RadialBounds) -> bool:
    """Whether the inequality in r holds for a closure; its tree is not looked at."""
    with precision(BITS):
        return loop.admissible and Inequality(loop, Parts(loop, data)).shown()


def radial_data(controlled: ControlledArm) -> RadialBounds | None:
    """Weights, μ, ν and the tree behind them: the tightest that the checker accepts within the budget."""
    loops = at_corners(controlled.loop(Fraction(1)))
    # where boxes of the leading angles are too many, all angles are bounded by the sizes of their harmonics
    for angles in (_leading_angles(loops[0]), ()):
        result = _Attempts(loops, angles).tightest()
        if result is not None:
            return result
    return None


class _Attempts:
    """Trees of boxes of some angles for ever tighter μ, of one arm or of it at all corners of its ranges."""

    def __init__(self, loops: Sequence[ClosedLoop], angles: tuple[int, ...]) -> None:
        weights = tuple(_root_below(low) for low, _ in loops[0].friction)
        self.loops = loops
        # μ and ν do not matter yet
        self.blank = RadialBounds(weights, Fraction(1), Fraction(1), angles, ".", CUTS)
        parts = [Parts(loop, self.blank) for loop in loops]
        self.largest = Fraction(max(map(_largest, parts)))
        self.far = max(part.far for part in parts)

    def tightest(self) -> RadialBounds | None:
        """What resists a small ν resists it beside any μ, so the loosest μ shows first which ν can be had."""
        loosest = LOWEST[-1]
        if self.tried(loosest, MARGINS[-1]) is None:
            return None
        share = next((share for share in LOWEST[:-1] if self.tried(share, MARGINS[-1])), loosest)
        return next(filter(None, (self.tried(share, margin) for margin in MARGINS)), None)

    def tried(self, share: Fraction, margin: Fraction) -> RadialBounds | None:
        """The data with a tree, if one was found within the budget."""
        mu = _short(self.largest * margin + self.far)
        lowest = min(_short(self.largest * share + self.far), mu)
        data = replace(self.blank, inertia=mu, lowest=lowest)
        tree = _tree(self.loops, data)
        return None if tree is None else replace(data, tree=tree)


def _tree(loops: Sequence[ClosedLoop], data: RadialBounds) -> str | None:
    """A tree of boxes of the chosen angles that shows μ of every loop, or ``None`` within the budget."""
    with precision(BITS):
        of_each = [Parts(loop, data) for loop in loops]

        def prove(boxes: Array) -> NDArray[np.bool_]:
            proved = np.ones(len(boxes), dtype=np.bool_)
            for parts in of_each:
                proved[proved] = _between(parts, boxes[proved])
                # balls are wider than intervals: what the checker would refuse is halved once more
                proved[proved] = [parts.shown_over(_sides(box)) for box in boxes[proved]]
            return proved

        if not data.angles:
            return "." if all(parts.shown_over(()) for parts in of_each) else None
        count = len(data.angles)
        start = np.stack([np.full(count, -PI_ABOVE), np.full(count, PI_ABOVE)])[None]
        return cover(start, prove, _widest, MAX_BOXES).tree or None


def _sides(box: Array) -> Box:
    return tuple(zip(box[0].tolist(), box[1].tolist(), strict=True))


def _between(parts: Parts, boxes: Array) -> NDArray[np.bool_]:
    """Where −ν < M̃ < μ over boxes of the chosen angles, as ``Parts.shown_over`` finds it box by box."""
    q = [Interval.exact(0.0)] * parts.loop.n
    for column, joint in enumerate(parts.radial.angles):
        q[joint] = Interval(boxes[:, 0, column], boxes[:, 1, column])
    harmonics = {k: _wave(k, q) for k in {k for row in parts.near for entry in row for k in entry}}
    M = [[_sum_of(entry, harmonics) for entry in row[: i + 1]] for i, row in enumerate(parts.near)]
    limits = (Interval.of(x - parts.far) for x in (parts.radial.inertia, parts.radial.lowest))
    above, below = (
        [[sign * x + limit if i == j else sign * x for j, x in enumerate(row)] for i, row in enumerate(M)]
        for sign, limit in zip((-1.0, 1.0), limits, strict=True)
    )
    return np.asarray(positive_definite(above) & positive_definite(below))


def _wave(k: Harmonic, q: list[Interval]) -> tuple[Interval, Interval]:
    angle = sum((x * float(factor) for factor, x in zip(k, q, strict=True) if factor), Interval.exact(0.0))
    return cosine(angle), sine(angle)


def _sum_of(terms: Harmonics, harmonics: dict[Harmonic, tuple[Interval, Interval]]) -> Interval:
    total = Interval.exact(0.0)
    for k, (a, b) in terms.items():
        total = total + harmonics[k][0] * Interval.of(a) + harmonics[k][1] * Interval.of(b)
    return total


def _widest(boxes: Array) -> NDArray[np.intp]:
    return np.asarray(np.argmax(boxes[:, 1] - boxes[:, 0], axis=1))


def _leading_angles(loop: ClosedLoop) -> tuple[int, ...]:
    """The angles in which most of M varies: added one by one, that which leaves the least to the others."""
    chosen: tuple[int, ...] = ()
    while len(chosen) < min(MOST_ANGLES, len(loop.angles)):
        left = [i for i in loop.angles if i not in chosen]
        chosen = min(((*chosen, i) for i in left), key=lambda angles: _rest(loop, angles))
    return tuple(sorted(chosen))


def _rest(loop: ClosedLoop, chosen: tuple[int, ...]) -> float:
    """How much of M turns with other angles than the chosen ones, roughly."""
    parts = (part for row in loop.mass for entry in row for part in entry.values())
    return sum(
        float(a * a + b * b)
        for part in parts
        for k, (a, b) in part.items()
        if any(x for i, x in enumerate(k) if i not in chosen)
    )


def _largest(parts: Parts) -> float:
    """The largest eigenvalue of M̃ in the chosen angles alone: at random, then ever nearer to the best."""
    random = np.random.default_rng(SEED)
    best = random.uniform(-np.pi, np.pi, (SAMPLES, parts.loop.n))
    best[0] = 0.0
    result = 0.0
    for spread in NEARER:
        largest = np.linalg.eigvalsh(_values(parts.near, best))[:, -1]
        result = max(result, float(largest.max()))
        best = best[np.argmax(largest)] + spread * random.normal(size=(SAMPLES // 10, parts.loop.n))
    return result


def _values(table: Table, q: Array) -> Array:
    """A matrix of trigonometric polynomials at many angles."""
    values = np.zeros((len(q), len(table), len(table)))
    for k in {k for row in table for entry in row for k in entry}:
        terms = np.array([[entry.get(k, (0, 0)) for entry in row] for row in table], dtype=float)
        turn = q @ np.array(k, dtype=float)
        values += np.cos(turn)[:, None, None] * terms[..., 0] + np.sin(turn)[:, None, None] * terms[..., 1]
    return values


def _root_below(value: Fraction) -> Fraction:
    """A short rational not above the square root."""
    scale = 10**6
    return Fraction(math.isqrt(value.numerator * scale * scale // value.denominator), scale)


def _short(value: Fraction) -> Fraction:
    """A number cut to a few significant digits."""
    scale = Fraction(10) ** (DIGITS - 1 - math.floor(math.log10(value)))
    return Fraction(math.floor(value * scale)) / scale
