"""Margins of dV/dt < 0: how much friction and stiffness its proof can do without, searched in doubles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED
from lyapcheck.check.kinds.at_corners import RateAtCorners
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.corners import at_corners
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.radial import RadialBounds
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.controlled_arm import ControlledArm
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
MAX_BOXES = 60_000


@dataclass(frozen=True)
class Attempt:
    """A margin, and untrusted data for dV/dt < 0 of its reduced closure."""

    margin: Margin
    by: BoxTree | RadialBounds | RateAtCorners


def candidates(
    controlled: ControlledArm, disturbed: bool, shares: Sequence[Fraction] = FRICTION
) -> list[Margin]:
    """One margin for each η, with the largest ε₀ that samples, or the bounds in ‖e‖, allow.

    Args:
        controlled: gains and arm, with a bounded h.
        disturbed: whether damping has to be left for disturbances.
        shares: the η.
    """
    inertia = radial_data(controlled)
    if inertia is None:
        return []
    slack = SLACK if disturbed else Fraction(0)
    allows = _by_samples(controlled) if controlled.n <= FEW_JOINTS else _by_bounds(inertia)
    result = []
    for friction in shares:

        def holds(eps0: Fraction, eta: Fraction = friction) -> bool:
            return allows(margin_at(controlled, eps0, eta, slack, inertia).reduced)

        eps0 = _largest(holds)
        if eps0 > 0:
            result.append(margin_at(controlled, eps0, friction, slack, inertia))
    return result


def margin_at(
    controlled: ControlledArm, eps0: Fraction, friction: Fraction, slack: Fraction, inertia: RadialBounds
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
        by = _data(controlled, tried, max_boxes)
        if by is not None:
            yield Attempt(tried, by)


def _data(
    controlled: ControlledArm, margin: Margin, max_boxes: int
) -> BoxTree | RadialBounds | RateAtCorners | None:
    """Untrusted data for the reduced closure, at each corner where parameters range."""
    loop = margin.reduced
    if not loop.admissible:
        return None
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
