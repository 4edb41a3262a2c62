"""Margins of dV/dt < 0: how much friction and stiffness its proof can do without, searched in doubles."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.at_corners import RateAtCorners
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.scalar import certifies
from lyapcheck.files.decimals import significant_down
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.heaviest import Heaviest, heaviest
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.link_bounds import link_bounds
from lyapcheck.search.schur import SchurProblem

FRICTION = tuple(Fraction(k, 100) for k in (8, 15, 25, 40, 60))
"""The η that are weighed against each other: less for the proof allows less ε₀."""
STIFFNESS = Fraction(19, 20)
"""κ: the proof needs little of K_p."""
LOSS = Fraction(1, 50)
"""The share of κ k_pi that the mixed terms may cost; t follows from it."""
SLACK = Fraction(1, 2)
SHARES = tuple(Fraction(k, 100) for k in (85, 75, 60, 40, 20))
"""Shares of the largest ε₀ that samples allow, tried one after the other."""
SAMPLES = 1_500
NEAR = 3
"""Of so many samples one is taken where errors are bounded: there is less to miss."""
FEW = 8
"""Likewise where errors are all there is to sample."""
MAX_BOXES = 60_000
_KEPT = 16
"""Arms and margins of which results are kept: several bounds ask for the same."""


@dataclass(frozen=True)
class Attempt:
    """A margin, and untrusted data for dV/dt < 0 of its reduced loop."""

    margin: Margin
    by: BoxTree | LinkBounds | RateAtCorners


def candidates(
    controlled: ControlledArm, disturbed: bool, shares: Sequence[Fraction] = FRICTION
) -> list[Margin]:
    """One margin for each η, with the largest ε₀ that samples, or norms, allow.

    Args:
        controlled: gains and arm, with a bounded h.
        disturbed: whether damping has to be left for disturbances.
        shares: the η.
    """
    heavy = heaviest(controlled)
    if heavy is None:
        return []
    slack = SLACK if disturbed else Fraction(0)
    rows = zip(shares, _largest_allowed(controlled, heavy, tuple(shares)), strict=True)
    return [margin_at(controlled, eps0, eta, slack, heavy.diagonal) for eta, eps0 in rows if eps0 > 0]


@lru_cache(maxsize=_KEPT)
def _largest_allowed(
    controlled: ControlledArm, heavy: Heaviest, shares: tuple[Fraction, ...]
) -> list[Fraction]:
    """The largest ε₀ for each η; what is left for disturbances has no part in it."""
    allows = _by_samples(controlled) if controlled.n <= FEW_JOINTS else _of_many_joints(controlled)

    def holds(eps0: Fraction, eta: Fraction) -> bool:
        return allows(margin_at(controlled, eps0, eta, Fraction(0), heavy.diagonal).reduced)

    return [_largest(partial(holds, eta=friction)) for friction in shares]


def margin_at(
    controlled: ControlledArm,
    eps0: Fraction,
    friction: Fraction,
    slack: Fraction,
    heaviest: tuple[Fraction, ...],
) -> Margin:
    """The margin of one ε₀ and η; t is chosen so that no joint loses more than `LOSS` of κ k_pi."""
    loop = controlled.loop(eps0)
    rows = zip((low for low, _ in loop.friction), loop.kp, strict=True)
    split = max(friction * b * eps0 / (4 * LOSS * STIFFNESS * k) for b, k in rows)
    return Margin(loop, friction, STIFFNESS, significant_down(min(split, Fraction(1, 4)), 5), slack, heaviest)


def attempts(controlled: ControlledArm, margin: Margin, max_boxes: int = MAX_BOXES) -> Iterator[Attempt]:
    """The margin at falling shares of its ε₀, wherever the search finds data; for the checker to judge."""
    for share in SHARES:
        eps0 = significant_down(margin.loop.eps0 * share, 5)
        tried = margin_at(controlled, eps0, margin.friction, margin.slack, margin.heaviest)
        by = _data(controlled, eps0, margin.friction, margin.heaviest, max_boxes)
        if by is not None:
            yield Attempt(tried, by)


@lru_cache(maxsize=_KEPT)
def _data(
    controlled: ControlledArm,
    eps0: Fraction,
    friction: Fraction,
    heaviest: tuple[Fraction, ...],
    max_boxes: int,
) -> BoxTree | LinkBounds | RateAtCorners | None:
    """Untrusted data for the reduced loop, by boxes at each corner where parameters range."""
    loop = margin_at(controlled, eps0, friction, Fraction(0), heaviest).reduced
    if not loop.admissible:
        return None
    if controlled.n > FEW_JOINTS:
        bounds = link_bounds(controlled)
        if bounds is None:
            return BoxTree(".") if certifies(loop.tail, loop.eps0) else None
        covered = ErrorBoxes(loop, bounds).covered(max_boxes)
        return replace(bounds, tree=covered.tree, scales=covered.scales) if covered.proved else None
    result: list[BoxTree] = []
    for corner in at_corners(loop):
        outcome = certify(SchurProblem(corner), max_boxes)
        if not outcome.proved:
            return None
        result.append(BoxTree(outcome.tree))
    return RateAtCorners(tuple(result)) if loop.parameters else result[0]


def _by_samples(controlled: ControlledArm) -> Callable[[ClosedLoop], bool]:
    """Whether P ≻ 0 at random q and e of all sizes."""
    random = np.random.default_rng(SEED)
    angles = controlled.loop(Fraction(1)).angles
    q = random.uniform(-np.pi, np.pi, (SAMPLES, len(angles)))
    e = _errors(random, controlled.n)
    if controlled.within:
        q, e = q[::NEAR], e[::NEAR]
        e = np.clip(e, *(sign * np.array(controlled.within, dtype=float) for sign in (-1.0, 1.0)))

    def holds(loop: ClosedLoop) -> bool:
        points = np.hstack((q[:, [angles.index(joint) for joint in loop.angles]], e))
        return bool(SchurProblem(loop).proved(np.stack((points, points), axis=1)).all())

    def allows(loop: ClosedLoop) -> bool:
        return loop.admissible and all(map(holds, at_corners(loop)))

    return allows


def _of_many_joints(controlled: ControlledArm) -> Callable[[ClosedLoop], bool]:
    """Whether the form along the links is positive at random e; norms, where links are not known."""
    bounds = link_bounds(controlled)
    if bounds is None:
        return lambda loop: loop.admissible and certifies(loop.tail, loop.eps0)
    e = np.abs(_errors(np.random.default_rng(SEED), controlled.n))[::FEW]
    points = np.stack((e, e), axis=1)
    return lambda loop: loop.admissible and bool(ErrorBoxes(loop, bounds).judged(points, False)[0].all())


def _errors(random: np.random.Generator, n: int) -> Array:
    """e of all sizes, (SAMPLES, n)."""
    e = random.normal(size=(SAMPLES, n))
    e *= 10.0 ** random.uniform(-3.0, 1.0, (SAMPLES, 1)) / np.linalg.norm(e, axis=1, keepdims=True)
    return e


def _largest(allows: Callable[[Fraction], bool]) -> Fraction:
    """The largest ε₀ that is allowed, to a per cent; 0 where none is."""
    low, high = Fraction(0), Fraction(1, 64)
    while high < 64 and allows(high):
        low, high = high, 2 * high
    while high > Fraction(1, 10**6) and high - low > high / 100:
        middle = (low + high) / 2
        low, high = (middle, high) if allows(middle) else (low, middle)
    return low
