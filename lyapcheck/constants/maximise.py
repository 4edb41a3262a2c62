"""The largest value of a function over a box, from both sides: best first, and stopped at any time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lyapcheck._types import Array, Progress

Bounds = Callable[[Array, Array], tuple[Array, Array]]
"""Middles and half widths of boxes to what the function is at least in the middle and at most on the box."""
Influence = Callable[[Array, Array], Array]
"""Middles and half widths of boxes to how much each side matters."""

BATCH = 128


@dataclass(frozen=True)
class Largest:
    """The supremum lies in [inside, outside]; the function is at least ``inside`` at ``state``."""

    inside: float
    outside: float
    state: tuple[float, ...]
    boxes: int


def maximise(
    half: Array,
    bounds: Bounds,
    influence: Influence,
    witness: tuple[Array, float],
    max_boxes: int,
    gap: float,
    most: float = np.inf,
    on_progress: Progress | None = None,
) -> Largest:
    """Enclose the supremum over the box [−half, half], splitting where the bound is largest.

    Args:
        half: half widths of the box, (n,); sides of width 0 stay.
        bounds: see ``Bounds``.
        influence: decides which side of a box is halved.
        witness: a state to begin with, (n,), and what the function is at least there.
        max_boxes: how many boxes may be looked at.
        gap: relative distance of the two bounds that is good enough.
        most: an upper bound of the supremum that is known beforehand.
        on_progress: receives the share of the budget used.

    Soundness: halves cover their box, and a box is dropped only when its bound is not above ``inside``;
        ``bounds`` is taken at its word.
    """
    state, inside = witness
    middle, width = np.zeros((1, len(half))), half[None]
    top = np.fmin(bounds(middle, width)[1], most)
    seen = 1
    while len(top) and top.max() > inside + gap * abs(inside) and seen + 2 <= max_boxes:
        chosen = np.argsort(-top, kind="stable")[: min(BATCH, (max_boxes - seen) // 2)]
        rest = np.ones(len(top), dtype=np.bool_)
        rest[chosen] = False
        halves = _halves(middle[chosen], width[chosen], influence)
        low, high = bounds(*halves)
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
    outside = max(inside, float(top.max())) if len(top) else inside
    return Largest(inside, outside, tuple(float(x) for x in state), seen)


def _halves(middle: Array, width: Array, influence: Influence) -> tuple[Array, Array]:
    """Both halves of every box; they overlap by the rounding of their middles."""
    rows = np.arange(len(middle))
    side = np.argmax(influence(middle, width), axis=1)
    half = width.copy()
    half[rows, side] *= 0.5
    step = np.zeros_like(middle)
    step[rows, side] = half[rows, side]
    wider = half.copy()
    wider[rows, side] = np.nextafter(half[rows, side] * (1 + 1e-15), np.inf) + 1e-15
    return np.concatenate([middle - step, middle + step]), np.concatenate([wider, wider])
