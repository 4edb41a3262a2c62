"""The least diagonal matrix in proportion to the friction that is shown to be above M(q)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.at_corners import MassAtCorners
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.check.kinds.inertia import Bisection, Dominance
from lyapcheck.check.kinds.link_bounds import EnergyBelow
from lyapcheck.check.loop.corners import at_corners, corners_of, is_affine
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.loop.storage import Shown
from lyapcheck.check.statement import Proof
from lyapcheck.control.judgement import proves
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.digits import short_above
from lyapcheck.search.link_bounds import link_bounds

SAMPLES = 5_000
NEARER = (1.0, 0.3, 0.1, 0.03, 0.01, 0.0)
MARGINS = (1.01, 1.03, 1.1, 1.2, 1.5)
"""Beside the largest eigenvalue that was found."""
SURELY = 1.0 + 1e-6


@dataclass(frozen=True)
class Heaviest:
    """u, kg·m², with M(q) ≺ diag(u), and what shows it."""

    diagonal: tuple[Fraction, ...]
    proof: Proof


@lru_cache(maxsize=16)
def heaviest(controlled: ControlledArm) -> Heaviest | None:
    """The least that is found, for all angles and ranges; ``None`` for an M that parameters bend.

    Few angles: by boxes, near the largest eigenvalue. Else along the links, or by the sizes of entries.
    """
    loop = controlled.loop(Fraction(1))
    if not is_affine(loop.arm.mass):
        return None
    statement, friction = statement_of(loop), [float(low) for low, _ in loop.friction]
    bounds = link_bounds(controlled) if controlled.n > FEW_JOINTS else None
    if bounds is not None:
        diagonal, rows = bounds.inertia.prices, zip(bounds.arms, bounds.inertia.forms, strict=True)
        each = [EnergyBelow(links, Shown(diagonal, (forms,))) for links, forms in rows]
        return Heaviest(diagonal, MassAtCorners(tuple(each)) if loop.parameters else each[0])
    share, weights = _dominated(controlled, np.array(friction))
    tried: list[tuple[float, Proof]] = []
    if controlled.n <= FEW_JOINTS:
        largest = _largest(controlled, np.array(friction))
        tried = [(largest * margin, Bisection()) for margin in MARGINS if largest * margin < share]
    for factor, proof in [*tried, (share * SURELY, Dominance(weights))]:
        diagonal = tuple(short_above(Fraction(factor * b)) for b in friction)
        count = len(list(corners_of(loop.parameters)))
        by = MassAtCorners((proof,) * count) if loop.parameters else proof
        if proves(statement.mass_below(diagonal), by):
            return Heaviest(diagonal, by)
    return None


def masses(controlled: ControlledArm, q: Array) -> list[Array]:
    """M at many angles, at each corner of its ranges."""
    plant = controlled.ranged
    corners = corners_of(controlled.loop(Fraction(1)).parameters)
    arms = (plant.fixed(**dict(zip(plant.parameters, corner, strict=True))) for corner in corners)
    return [NumericModel(arm).mass(q) for arm in arms]


def _dominated(controlled: ControlledArm, friction: Array) -> tuple[float, tuple[Fraction, ...]]:
    """The least u/b that sizes of the entries of M give, and the weights with which they do."""
    loops = at_corners(controlled.loop(Fraction(1)))
    size = np.max([[[float(size_of(x, ())) for x in row] for row in loop.mass] for loop in loops], axis=0)
    root = np.sqrt(friction)
    _, vectors = np.linalg.eigh(size / np.outer(root, root))
    weights = np.maximum(np.abs(vectors[:, -1]), 1e-6) / root
    weights = np.round(weights / weights.max(), 9)
    return float(np.max(size @ weights / (weights * friction))), tuple(Fraction(str(w)) for w in weights)


def _largest(controlled: ControlledArm, friction: Array) -> float:
    """The largest eigenvalue of B^−½MB^−½: at random, then ever nearer to the best."""
    random, scale = np.random.default_rng(SEED), np.sqrt(np.outer(friction, friction))
    best, result = random.uniform(-np.pi, np.pi, (SAMPLES, controlled.n)), 0.0
    best[0] = 0.0
    for spread in NEARER:
        largest = np.max([np.linalg.eigvalsh(M / scale)[:, -1] for M in masses(controlled, best)], axis=0)
        result = max(result, float(largest.max()))
        best = best[np.argmax(largest)] + spread * random.normal(size=(SAMPLES // 10, controlled.n))
    return result
