"""Margins of dV/dt < 0: how much friction and stiffness its proof can do without, searched in doubles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial

import numpy as np

from lyapcheck._types import SEED
from lyapcheck.check.kinds.at_corners import RateAtCorners
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.kinds.link_bounds import InertiaAlongLinks, LinkBounds
from lyapcheck.check.loop.closed_loop import ClosedLoop, InertiaBound
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.radial import RadialBounds
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay_digits import short_above
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.link_bounds import link_bounds
from lyapcheck.search.radial import holds_radially, radial_data
from lyapcheck.search.schur import Problem

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
    """A margin, and untrusted data for dV/dt < 0 of its reduced closure."""

    margin: Margin
    by: BoxTree | RadialBounds | RateAtCorners | LinkBounds


def candidates(
    controlled: ControlledArm, disturbed: bool, shares: Sequence[Fraction] = FRICTION
) -> list[Margin]:
    """One margin for each η, with the largest ε₀ that samples, or bounds of the parts of dV/dt, allow.

    Args:
        controlled: gains and arm, with a bounded h.
        disturbed: whether damping has to be left for disturbances.
        shares: the η.
    """
    inertia = inertia_bound(controlled)
    if inertia is None:
        return []
    slack = SLACK if disturbed else Fraction(0)
    rows = zip(shares, _largest_allowed(controlled, tuple(shares)), strict=True)
    return [margin_at(controlled, eps0, friction, slack, inertia) for friction, eps0 in rows if eps0 > 0]


@lru_cache(maxsize=_KEPT)
def _largest_allowed(controlled: ControlledArm, shares: tuple[Fraction, ...]) -> list[Fraction]:
    """The largest ε₀ for each η; what is left for disturbances has no part in it."""
    inertia = inertia_bound(controlled)
    assert inertia is not None
    if isinstance(inertia, InertiaAlongLinks):
        allows = _by_errors(controlled)
    elif isinstance(inertia, RadialBounds) and controlled.n > FEW_JOINTS:
        allows = _by_bounds(inertia)
    else:
        allows = _by_samples(controlled)

    def holds(eps0: Fraction, eta: Fraction) -> bool:
        return allows(margin_at(controlled, eps0, eta, Fraction(0), inertia).reduced)

    return [_largest(partial(holds, eta=friction)) for friction in shares]


@lru_cache(maxsize=_KEPT)
def inertia_bound(controlled: ControlledArm) -> InertiaBound | None:
    """μ with M ≼ μ B: along the links of arms of many joints where they are known, else by boxes of q."""
    bounds = link_bounds(controlled) if controlled.n > FEW_JOINTS else None
    if bounds is None:
        return radial_data(controlled)
    friction = [low for low, _ in controlled.loop(Fraction(1)).friction]
    weights = tuple(map(_root_below, friction))
    mu = max(x / (d * d) for x, d in zip(bounds.inertia.prices, weights, strict=True))
    return InertiaAlongLinks(weights, short_above(mu), bounds.arms, bounds.inertia)


def as_stated(inertia: InertiaBound) -> InertiaBound:
    """What of it a certificate has to hold: cuts of r are for dV/dt alone."""
    return replace(inertia, cuts=()) if isinstance(inertia, RadialBounds) else inertia


def margin_at(
    controlled: ControlledArm, eps0: Fraction, friction: Fraction, slack: Fraction, inertia: InertiaBound
) -> Margin:
    """The margin of one ε₀ and η; t is chosen so that no joint loses more than `LOSS` of κ k_pi."""
    loop = controlled.loop(eps0)
    rows = zip((low for low, _ in loop.friction), loop.kp, strict=True)
    split = max(friction * b * eps0 / (4 * LOSS * STIFFNESS * k) for b, k in rows)
    return Margin(loop, friction, STIFFNESS, _short(min(split, Fraction(1, 4))), slack, inertia)


def attempts(controlled: ControlledArm, margin: Margin, max_boxes: int = MAX_BOXES) -> Iterator[Attempt]:
    """The margin at falling shares of its ε₀, wherever the search finds data; for the checker to judge."""
    for share in SHARES:
        eps0 = _short(margin.loop.eps0 * share)
        tried = margin_at(controlled, eps0, margin.friction, margin.slack, margin.inertia)
        by = _data(controlled, eps0, margin.friction, max_boxes)
        if by is not None:
            yield Attempt(tried, by)


@lru_cache(maxsize=_KEPT)
def _data(
    controlled: ControlledArm, eps0: Fraction, friction: Fraction, max_boxes: int
) -> BoxTree | RadialBounds | RateAtCorners | LinkBounds | None:
    """Untrusted data for the reduced closure; where parameters range at each corner, or for all at once."""
    inertia = inertia_bound(controlled)
    if inertia is None:
        return None
    margin = margin_at(controlled, eps0, friction, Fraction(0), inertia)
    loop = margin.reduced
    if not loop.admissible:
        return None
    if isinstance(margin.inertia, InertiaAlongLinks):
        bounds = link_bounds(controlled)
        covered = None if bounds is None else ErrorBoxes(loop, bounds).covered(max_boxes)
        if bounds is None or covered is None or not covered.proved:
            return None
        return replace(bounds, tree=covered.tree, scales=covered.scales)
    found: list[BoxTree | RadialBounds] = []
    for corner in at_corners(loop):
        if controlled.n > FEW_JOINTS:
            found.append(reduced_radial(margin))
            continue
        outcome = certify(Problem(corner), max_boxes)
        if not outcome.proved:
            return None
        found.append(BoxTree(outcome.tree))
    return RateAtCorners(tuple(found)) if loop.parameters else found[0]


def reduced_radial(margin: Margin) -> RadialBounds:
    """The data in r for (1 − η)B."""
    assert isinstance(margin.inertia, RadialBounds)
    return _shrunk(margin.inertia, _root_below(1 - margin.friction))


def _shrunk(data: RadialBounds, root: Fraction) -> RadialBounds:
    """The data with smaller weights, in which M̃, and with it μ and ν, grow by the inverse of the square."""
    weights, square = tuple(d * root for d in data.weights), root * root
    return replace(data, weights=weights, inertia=data.inertia / square, lowest=data.lowest / square)


def _root_below(value: Fraction) -> Fraction:
    """A rational not above the square root."""
    return Fraction(math.isqrt(math.floor(value * 10**12)), 10**6)


def _by_samples(controlled: ControlledArm) -> Callable[[ClosedLoop], bool]:
    """Whether P ≻ 0 at random q and e of all sizes."""
    random = np.random.default_rng(SEED)
    angles = controlled.loop(Fraction(1)).angles
    q = random.uniform(-np.pi, np.pi, (SAMPLES, len(angles)))
    e = random.normal(size=(SAMPLES, controlled.n))
    e *= 10.0 ** random.uniform(-3.0, 1.0, (SAMPLES, 1)) / np.linalg.norm(e, axis=1, keepdims=True)
    if controlled.within:
        q, e = q[::NEAR], e[::NEAR]
        e = np.clip(e, *(sign * np.array(controlled.within, dtype=float) for sign in (-1.0, 1.0)))

    def holds(loop: ClosedLoop) -> bool:
        points = np.hstack((q[:, [angles.index(joint) for joint in loop.angles]], e))
        return bool(Problem(loop).proved(np.stack((points, points), axis=1)).all())

    def allows(loop: ClosedLoop) -> bool:
        return loop.admissible and all(map(holds, at_corners(loop)))

    return allows


def _by_errors(controlled: ControlledArm) -> Callable[[ClosedLoop], bool]:
    """Whether the form of bounds along the links is positive definite at random e of all sizes."""
    bounds = link_bounds(controlled)
    random = np.random.default_rng(SEED)
    e = np.abs(random.normal(size=(SAMPLES // FEW, controlled.n)))
    e *= 10.0 ** random.uniform(-3.0, 1.0, (SAMPLES // FEW, 1)) / np.linalg.norm(e, axis=1, keepdims=True)
    points = np.stack((e, e), axis=1)

    def allows(loop: ClosedLoop) -> bool:
        if bounds is None or not loop.admissible:
            return False
        return bool(ErrorBoxes(loop, bounds).judged(points, False)[0].all())

    return allows


def _by_bounds(inertia: RadialBounds) -> Callable[[ClosedLoop], bool]:
    """Whether the inequality in ‖e‖ holds."""

    def allows(loop: ClosedLoop) -> bool:
        rows = zip(loop.arm.viscous, inertia.weights, strict=True)
        data = _shrunk(inertia, min(_root_below(b / (d * d)) for b, d in rows))
        return loop.admissible and all(holds_radially(corner, data) for corner in at_corners(loop))

    return allows


def _largest(allows: Callable[[Fraction], bool]) -> Fraction:
    """The largest ε₀ that is allowed, to a per cent; 0 where none is."""
    low, high = Fraction(0), Fraction(1, 64)
    while high < 64 and allows(high):
        low, high = high, 2 * high
    while high > Fraction(1, 10**6) and high - low > high / 100:
        middle = (low + high) / 2
        low, high = (middle, high) if allows(middle) else (low, middle)
    return low


def _short(value: Fraction) -> Fraction:
    """A positive number rounded down to five significant digits."""
    scale = Fraction(10) ** (4 - math.floor(math.log10(value)))
    return Fraction(math.floor(value * scale)) / scale
