"""Data for a proof in r = ‖e‖ alone, and the largest ε₀ that it gives."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.balls import precision
from lyapcheck.check.certificates.proofs import RadialBounds
from lyapcheck.check.stability import Closure
from lyapcheck.check.stability.closure import PI_ABOVE
from lyapcheck.check.stability.radial import BITS, Inequality, Parts, Radial, proves_radially
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.certified import Proof
from lyapcheck.search.cover import cover
from lyapcheck.search.setting import Setting

Array = NDArray[np.float64]

SAMPLES = 20_000
SEED = 20190301
MAX_BOXES = 3_000
MOST_ANGLES = 4
"""Angles whose boxes are looked at; the harmonics of the others are bounded by their sizes."""
MARGINS = tuple(Fraction(k, 100) for k in (102, 105, 110, 120, 140, 180))
"""μ beside the largest eigenvalue that was sampled."""
CUTS = (Fraction(0), *(Fraction(k, 50) for k in range(1, 151)), *(Fraction(k) for k in (4, 5, 7, 10, 20, 50)))
SMALLEST = Fraction(1, 10**9)
DIGITS = 7


def radial_epsilon(setting: Setting) -> Proof | None:
    """The proof of the largest ε₀ that can be had in r alone; ``None`` where there is none.

    Args:
        setting: gains and arm; over ranges there is no such proof yet.

    Soundness: ``lyapcheck.check.stability.radial`` has accepted what is handed back.
    """
    if not setting.family.bounded or setting.ranges:
        return None
    data = radial_data(setting)
    if data is None:
        return None
    with precision(BITS):
        parts = Parts(setting.closure(Fraction(1)), data)
        low, high = Fraction(0), Fraction(1)
        while _holds(setting, parts, high):
            low, high = high, 2 * high
        while high - low > low / 10_000 and high > SMALLEST:
            middle = (low + high) / 2
            low, high = (middle, high) if _holds(setting, parts, middle) else (low, middle)
    if low == 0:
        return None
    closure = setting.closure(_short(low))
    if not proves_radially(closure, data):
        return None
    return Proof(closure, RadialBounds(data.weights, data.inertia, data.angles, data.tree, data.cuts))


def _holds(setting: Setting, parts: Parts, eps0: Fraction) -> bool:
    """Whether the inequality in r holds; the tree is looked at only once, at the end."""
    closure = setting.closure(eps0)
    return closure.admissible and Inequality(closure, parts).shown()


def holds_radially(closure: Closure, data: Radial) -> bool:
    """Whether the inequality in r holds for a closure; its tree is not looked at."""
    with precision(BITS):
        return closure.admissible and Inequality(closure, Parts(closure, data)).shown()


def radial_data(setting: Setting) -> Radial | None:
    """Weights, μ and the tree behind it: the tightest μ that the checker accepts within the budget."""
    closure = setting.closure(Fraction(1))
    weights = tuple(_root_below(low) for low, _ in closure.friction)
    angles = _leading_angles(closure)
    largest = _sampled(setting, weights)
    for margin in MARGINS:
        mu = _short(largest * margin)
        tree = _tree(closure, Radial(weights, mu, angles, ".", CUTS))
        if tree is not None:
            return Radial(weights, mu, angles, tree, CUTS)
    return None


def _tree(closure: Closure, data: Radial) -> str | None:
    """A tree of boxes of the chosen angles that shows μ, or ``None`` within the budget."""
    with precision(BITS):
        parts = Parts(closure, data)
        near, limit = parts.near, parts.limit
        if not limit > 0:
            return None

        def prove(boxes: Array) -> NDArray[np.bool_]:
            sides = [tuple(zip(box[0].tolist(), box[1].tolist(), strict=True)) for box in boxes]
            return np.array([parts.below(near, limit, side) for side in sides])

        count = len(data.angles)
        start = np.stack([np.full(count, -PI_ABOVE), np.full(count, PI_ABOVE)])[None]
        return cover(start, prove, _widest, MAX_BOXES).tree or None


def _widest(boxes: Array) -> NDArray[np.intp]:
    return np.asarray(np.argmax(boxes[:, 1] - boxes[:, 0], axis=1))


def _leading_angles(closure: Closure) -> tuple[int, ...]:
    """The angles in which most of M varies: added one by one, that which leaves the least to the others."""
    chosen: tuple[int, ...] = ()
    while len(chosen) < min(MOST_ANGLES, len(closure.angles)):
        left = [i for i in closure.angles if i not in chosen]
        chosen = min(((*chosen, i) for i in left), key=lambda angles: _rest(closure, angles))
    return tuple(sorted(chosen))


def _rest(closure: Closure, chosen: tuple[int, ...]) -> float:
    """How much of M turns with other angles than the chosen ones, roughly."""
    parts = (part for row in closure.mass for entry in row for part in entry.values())
    return sum(
        float(a * a + b * b)
        for part in parts
        for k, (a, b) in part.items()
        if any(x for i, x in enumerate(k) if i not in chosen)
    )


def _sampled(setting: Setting, weights: tuple[Fraction, ...]) -> Fraction:
    """The largest eigenvalue of D⁻¹MD⁻¹ among random angles."""
    random = np.random.default_rng(SEED)
    q = random.uniform(-np.pi, np.pi, (SAMPLES, setting.n))
    q[: 4**2] = 0.0
    d = np.array([float(x) for x in weights])
    M = NumericModel(setting.model).mass(q) / d[:, None] / d
    return Fraction(float(np.linalg.eigvalsh(M)[:, -1].max()))


def _root_below(value: Fraction) -> Fraction:
    """A short rational not above the square root."""
    scale = 10**6
    return Fraction(math.isqrt(value.numerator * scale * scale // value.denominator), scale)


def _short(value: Fraction) -> Fraction:
    """A number cut to a few significant digits."""
    scale = Fraction(10) ** (DIGITS - 1 - math.floor(math.log10(value)))
    return Fraction(math.floor(value * scale)) / scale
