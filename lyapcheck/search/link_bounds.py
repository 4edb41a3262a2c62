"""The largest ε₀ that bounds along the links and boxes of e prove, for arms of many joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from time import monotonic

import numpy as np

from lyapcheck._types import Array, Progress
from lyapcheck.check.kinds.link_bounds import LinkBounds, Shown
from lyapcheck.constants.storage.problem import Problem, energy_problem, rate_problem
from lyapcheck.constants.storage.program import propose
from lyapcheck.robots.dynamics import Chain
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.proof import Proof

SHARES = tuple(Fraction(n, 100) for n in (30, 50, 60, 70, 75, 80, 83, 85, 87, 90, 93, 95, 97))
"""Shares of the falsified ε₀ that are tried one after the other; then the middle below the one that fails."""
MAX_BOXES = 100_000
"""Of one share: as many as the checker judges in half a minute."""
MORE = 1.01
"""How far an entry of U may exceed the largest eigenvalue of B^−½MB^−½, which lets the others be smaller."""
_MARGINS = (1e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3)
_DIGITS = 8


def linked_epsilon(
    controlled: ControlledArm,
    ceiling: Fraction,
    max_boxes: int,
    deadline: float,
    progress: Progress,
) -> tuple[Proof | None, int, str]:
    """The proof of the largest share of a ceiling, by bounds along the links; boxes looked at; why no more.

    Args:
        controlled: gains and arm.
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
        max_boxes: budget of all attempts together.
        deadline: by the monotonic clock, s; no attempt begins after it.
        progress: told the share of the attempts done.

    Soundness: every proof has been accepted by ``lyapcheck.check.verify``.
    """
    progress(0.0, "bounds along the links")
    bounds = link_bounds(controlled)
    if bounds is None:
        return None, 0, "no bounds along the links were shown"
    result, looked_at, reason = None, 0, ""
    shares, proved = list(SHARES), Fraction(0)
    while shares:
        share = shares.pop(0)
        progress(0.9 * float(share), f"{float(share):.1%} of falsified")
        loop = controlled.loop(Fraction(f"{float(ceiling * share):.6g}"))
        if monotonic() > deadline:
            reason = "the time is up: allow more seconds"
            break
        if not loop.admissible:
            reason = f"K_p is too small beside K_v for ε₀ = {float(loop.eps0):.6g}"
            break
        found = ErrorBoxes(loop, bounds).covered(min(MAX_BOXES, max_boxes - looked_at))
        looked_at += found.boxes
        if found.proved:
            result = controlled.proof(loop, replace(bounds, tree=found.tree, scales=found.scales))
            proved = share
        else:
            reason = f"ε₀ = {float(loop.eps0):.6g} was not proved: {found.reason}"
            shares = [(proved + share) / 2] if share in SHARES and proved else []
    if result is not None and not result.accepted():
        return None, looked_at, "the checker refused the boxes"
    return result, looked_at, reason


def link_bounds(controlled: ControlledArm) -> LinkBounds | None:
    """Bounds of M and its rates, without boxes yet; ``None`` where some were not found."""
    friction = tuple(low for low, _ in controlled.loop(Fraction(1)).friction)
    return bounds_along(controlled.chains, friction) if controlled.chains else None


@lru_cache(maxsize=4)
def bounds_along(chains: tuple[Chain, ...], friction: tuple[Fraction, ...]) -> LinkBounds | None:
    """The same for the links at each corner, and the lower ends of the friction, N·m·s/rad."""
    weight = np.array([float(b) for b in friction])
    energies = [energy_problem(chain, 1) for chain in chains]
    uniform = propose(energies, _MARGINS[0], weight[:, None])
    if uniform is None:
        return None
    inertia = _shown(energies, weight, MORE * float(uniform.prices[0]) / weight[0])
    rising, falling = [], []
    for joint in range(1, len(friction)):
        # the same prices for both signs
        problems = [rate_problem(chain, joint, sign) for sign in (1, -1) for chain in chains]
        both = _shown(problems, weight, None)
        if both is None:
            return None
        rising.append(replace(both, forms=both.forms[: len(chains)]))
        falling.append(replace(both, forms=both.forms[len(chains) :]))
    if inertia is None:
        return None
    arms = tuple(chain.links for chain in chains)
    return LinkBounds(arms, inertia, tuple(rising), tuple(falling), "", "")


def _shown(problems: Sequence[Problem], weight: Array, most: float | None) -> Shown | None:
    """Prices κ_k with a small Σ κ_k/b_k, and forms for each problem that show them."""
    for margin in _MARGINS:
        found = propose(problems, margin, np.diag(weight), most)
        if found is None:
            continue
        least = 1e-7 * np.max(np.abs(found.prices / weight)) * weight
        prices = tuple(_rounded_up(x) for x in found.prices * (1 + 1e-7) + least)
        forms = tuple(
            tuple(tuple(Fraction(float(x)) for x in row) for row in rows) for rows in found.coefficients
        )
        shown = Shown(prices, forms)
        if shown.holds([problem.stages for problem in problems], problems[0].vectors):
            return shown
    return None


def _rounded_up(value: float) -> Fraction:
    """A decimal of a few digits that is not below."""
    return Fraction(math.ceil(Fraction(float(value)) * 10**_DIGITS), 10**_DIGITS)
