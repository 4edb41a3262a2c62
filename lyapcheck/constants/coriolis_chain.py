"""k_c = sup ‖C(q, x)x‖ over unit vectors x of a chain of links, from points of a lattice of postures.

The Christoffel symbols do not see the first angle and are of degree 2 in each other one. So by Bernstein's
inequality a second derivative is at most four times the largest value, 4 k_c at first. Later angles matter
less: the second derivatives by them are bounded on grids, because between N equally spaced points of
a circle a polynomial of degree 2 comes to at most 1/cos(2π/N) times what it is there.

References: bernstein1912ordre; ehlich1964schwankung, for the points.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.compiled.threads import over_shares
from lyapcheck.constants.circles import TERMS, Circles
from lyapcheck.constants.lattice import FIRST, Lattice, norms_above
from lyapcheck.constants.products import common_factor
from lyapcheck.constants.quartic import quartic
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.plant import Plant

MOST_JOINTS = 7
"""With more the polynomials take ten times as much memory and time a joint."""
_ANGLES, _GAP_OF_MANY = 5, 0.05
"""Where more angles than these matter, the least gap that is asked for: a smaller one takes minutes."""
_POINTS = 20_000_000
_SAMPLES, _USED = 4000, (400, 200)
_AROUND = 12
"""Points of a circle on which second derivatives are looked at; fewer where a bound of them is known that"""
_WEAK = 0.05
"""is small: what interpolation leaves is then this share of the derivative, about."""
_WITHIN = 0.99
"""Share of the gap that is asked for, so that rounding does not exceed it."""
_ROUNDING = 1e-8
"""Of the largest matrix, beyond what doubles lose: the matrices at the nodes are right within 1e-13 of it, to
pass through them multiplies that by at most 2 an angle, 64 in all, D by 3/2, 12 in all, and L by 10."""


def coriolis_bound(plant: Plant, inside: float, gap: float) -> Fraction | None:
    """An upper bound of k_c, larger than ``inside`` by the relative gap if the lattice suffices.

    Args:
        plant: a chain with exact parameters, of two joints at least.
        inside: a lower bound of k_c, kg·m², positive.
        gap: 1 − inside / bound; at least `_GAP_OF_MANY` where more than `_ANGLES` angles matter.

    Returns:
        The bound; ``None`` for more than `MOST_JOINTS` joints.

    Soundness: floating point, with `_ROUNDING` for its errors.
    """
    n = plant.n
    if n > MOST_JOINTS:
        return None
    model, stack = NumericModel(plant), quartic(n).stack

    def stacks(q: Array) -> Array:
        return stack(model.christoffel(q))

    q = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (_SAMPLES, n))
    factor = _factor_for(stacks(q), n)
    entries = Circles.through(stacks, n)
    if len(entries.angles) > _ANGLES:
        gap = max(gap, _GAP_OF_MANY)
    lost = _ROUNDING * entries.size
    moved = entries.times(factor)
    target = inside / (1 - _WITHIN * gap) - 2 * lost
    bend = _bends(moved, target) + lost
    return Fraction(Lattice(moved, bend, target, factor).bound(_POINTS) + 2 * lost)


def _factor_for(stacks: Array, n: int) -> Array:
    """One L for the postures at which the matrices are large."""
    norms, factor = np.sum(stacks**2, axis=(1, 2)), np.eye(stacks.shape[-1])
    used = np.zeros(len(stacks), dtype=np.bool_)
    for count in _USED:
        used[np.argsort(-norms, kind="stable")[:count]] = True
        factor = common_factor(stacks[used], n)
        norms = norms_above(stacks @ factor, 0.0)
    return factor


def _bends(entries: Circles, most: float) -> Array:
    """What second derivatives by each angle are at most, if the norm is at most ``most``."""
    count = len(entries.angles)
    parts = [entries.bent(axis) for axis in range(count)]
    coarse = [_largest(part, [TERMS - 2] * count) for part in parts]
    bends = np.full(count, 4 * most)
    for axis in np.argsort(coarse, kind="stable").tolist():
        around, growth, rest = [_AROUND] * count, 1.0, 0.0
        for other in range(count):
            few = np.ceil(np.pi * np.sqrt(2 * bends[other] / (_WEAK * coarse[axis]))) if coarse[axis] else 1
            if few < _AROUND:
                around[other] = int(few)
                rest += 2 * (np.pi / few) ** 2 * bends[other]
            else:
                growth /= np.cos(2 * np.pi / _AROUND)
        bends[axis] = min(bends[axis], _largest(parts[axis], around) * growth + rest)
    return bends


def _largest(entries: Circles, around: Sequence[int]) -> float:
    """The largest norm on a grid of so many points a circle."""
    circles = [2 * np.pi * np.arange(count) / count for count in around[:FIRST]]
    first = np.stack(np.meshgrid(*circles, indexing="ij"), axis=-1).reshape(-1, len(circles))
    tops = [0.0]

    def look(start: int, stop: int) -> int:
        largest = max(tops)
        for _, values in entries.on(first[start:stop], around[FIRST:]):
            norms = norms_above(values.reshape(-1, *values.shape[2:]), largest)
            largest = max(largest, float(norms.max()))
        tops.append(largest)
        return stop - start

    over_shares(look, len(first))
    return max(tops)
