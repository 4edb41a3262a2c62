"""The largest ε₀ that bounds along the links and boxes of e prove, for arms of many joints.

There is no least U, nor a least Q_j: what one entry gives up, others may gain. They are found again and again
with each entry as dear as it has been at the errors that resisted so far.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from lyapcheck._types import Progress
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.computing import computing_time
from lyapcheck.constants.storage import energy_problem, prices_shown, propose, rate_problem
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof
from lyapcheck.search.cover import RESISTS
from lyapcheck.search.error_boxes import ErrorBoxes, ErrorCosts, Shares

SHARES = tuple(Fraction(n, 100) for n in (30, 60, 75, 85, 90, 93, 95, 97))
"""Shares of the falsified ε₀ that are tried one after the other; then the middle below the one that fails."""
MAX_BOXES = 40_000
"""Of one share: as many as the checker judges in a quarter of a minute."""
MORE = 1.01
"""How far an entry of U may exceed the largest eigenvalue of B^−½MB^−½, which lets the others be smaller."""
ROUNDS = 4
"""In which U and Q_j may become better."""
_MARGIN = 1e-6


def linked_epsilon(
    controlled: ControlledArm, ceiling: Fraction, max_boxes: int, deadline: float, progress: Progress
) -> tuple[DecreaseProof | None, int, str]:
    """The proof of the largest share of a ceiling, by bounds along the links; boxes looked at; why no more.

    Args:
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
        deadline: by the computing time of `lyapcheck.computing`, s; no attempt begins after it.

    Soundness: every proof has been accepted by ``lyapcheck.check.verify``.
    """
    progress(0.0, "bounds along the links")
    bounds = link_bounds(controlled)
    if bounds is None:
        return None, 0, "no bounds along the links were shown"
    bounds, failing = fitted(controlled, bounds, ceiling)
    result, looked_at, reason = None, 0, _not_proved(failing, RESISTS)
    proved, top = Fraction(0), failing / ceiling
    shares, between = [share for share in SHARES if share < top], False
    while shares or (proved and not between):
        if not shares:
            shares, between = [(proved + top) / 2], True
        share = shares.pop(0)
        progress(0.9 * float(share), f"{float(share):.1%} of falsified")
        loop = controlled.loop(Fraction(f"{float(ceiling * share):.6g}"))
        if computing_time() > deadline:
            reason = "the time is up: allow more seconds"
            break
        if not loop.admissible:
            reason = f"K_p is too small beside K_v for ε₀ = {float(loop.eps0):.6g}"
            break
        outcome = ErrorBoxes(loop, bounds).covered(min(MAX_BOXES, max_boxes - looked_at))
        looked_at += outcome.boxes
        if outcome.proved:
            result = controlled.proof(loop, replace(bounds, tree=outcome.tree, scales=outcome.scales))
            proved = share
        else:
            reason = _not_proved(loop.eps0, outcome.reason)
            top, shares = share, []
    accepted = None if result is None else result.accepted()
    if result is not None and accepted is None:
        return None, looked_at, "the checker refused the boxes"
    return accepted, looked_at, reason


def linked_proof(controlled: ControlledArm, eps0: Fraction) -> DecreaseProof | None:
    """A proof for one ε₀ of an arm of many joints, that the checker has yet to judge."""
    loop = controlled.loop(eps0)
    bounds = link_bounds(controlled) if controlled.n > FEW_JOINTS and loop.admissible else None
    if bounds is None:
        return None
    outcome = ErrorBoxes(loop, bounds).covered(MAX_BOXES)
    if not outcome.proved:
        return None
    return controlled.proof(loop, replace(bounds, tree=outcome.tree, scales=outcome.scales))


def link_bounds(controlled: ControlledArm) -> LinkBounds | None:
    """Bounds of M and its rates, without boxes yet; ``None`` where some were not found."""
    return bounds_along(controlled.chains, _friction(controlled)) if controlled.chains else None


def fitted(controlled: ControlledArm, bounds: LinkBounds, ceiling: Fraction) -> tuple[LinkBounds, Fraction]:
    """Bounds that allow more at single errors, as far as such are found, and the ε₀ at which one resists.

    Args:
        bounds: where the search begins.
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
    """
    costs = ErrorCosts(controlled, ceiling)
    costs.climb(bounds)
    for _ in range(ROUNDS):
        if costs.failing > SHARES[-1] * ceiling:
            break
        other = bounds_along(controlled.chains, _friction(controlled), costs.shares)
        if other is None:
            break
        if costs.climb(other):
            bounds = other
    return bounds, costs.failing


def _not_proved(eps0: Fraction, why: str) -> str:
    return f"ε₀ = {float(eps0):.6g} was not proved: {why}"


def _friction(controlled: ControlledArm) -> tuple[Fraction, ...]:
    return tuple(low for low, _ in controlled.loop(Fraction(1)).friction)


@lru_cache(maxsize=4)
def bounds_along(
    chains: tuple[Chain, ...], friction: tuple[Fraction, ...], shares: Shares | None = None
) -> LinkBounds | None:
    """The same for the links at each corner, and the lower ends of the friction, N·m·s/rad.

    Args:
        chains: at each corner.
        friction: b.
        shares: what U_i/b_i and each further Q_ji/b_i cost; without, all the same.
    """
    n, weight = len(friction), np.array([float(b) for b in friction])
    energies = [energy_problem(chain, 1) for chain in chains]
    most = None
    if shares is None:
        shares = ((1.0,) * n,) * n
        uniform = propose(energies, _MARGIN, weight[:, None])
        if uniform is None:
            return None
        most = MORE * float(uniform[0][0]) / weight[0]
    inertia = prices_shown(energies, weight, shares[0], most)
    rising, falling = [], []
    for joint in range(1, n):
        # the same prices for both signs
        problems = [rate_problem(chain, joint, sign) for sign in (1, -1) for chain in chains]
        both = prices_shown(problems, weight, shares[joint])
        if both is None:
            return None
        rising.append(replace(both, forms=both.forms[: len(chains)]))
        falling.append(replace(both, forms=both.forms[len(chains) :]))
    if inertia is None:
        return None
    arms = tuple(chain.links for chain in chains)
    return LinkBounds(arms, inertia, tuple(rising), tuple(falling), "", "")
