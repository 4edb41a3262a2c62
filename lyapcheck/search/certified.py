"""The largest ε₀ that branch and bound proves, approached from below a falsified one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.family import named
from lyapcheck.lyapunov.scalar import RobotBounds, scalar_form
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.cover import EXHAUSTED, RESISTS, Progress
from lyapcheck.search.schur import problem

if TYPE_CHECKING:
    from lyapcheck.control import GainSet
    from lyapcheck.robots import RobotModel

SHARES = tuple(Fraction(n, 1000) for n in (500, 800, 900, 950, 980, 990, 995, 998, 999))
"""Shares of the falsified ε₀ that are tried one after the other."""

DIGITS = 7
MAX_BOXES = 400_000


@dataclass(frozen=True)
class Certified:
    """The largest ε₀ proved, how many boxes that proof and all attempts took, and why it is not larger."""

    eps0: Fraction | None
    boxes: int
    looked_at: int
    reason: str


def certified_epsilon(
    model: RobotModel,
    gain_set: GainSet,
    bounds: RobotBounds,
    ceiling: Fraction,
    max_boxes: int = MAX_BOXES,
    on_progress: Progress | None = None,
) -> Certified:
    """The largest share of a ceiling for which dV/dt < 0 is proved on the whole state space.

    Args:
        model: the arm; uncertain parameters are taken at their nominal values.
        gain_set: the controller.
        bounds: proved bounds of the arm, for the states far away.
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
        max_boxes: the budget of all attempts together.
        on_progress: told the share of the attempts done.

    Returns:
        ``eps0`` is ``None`` where nothing was proved; ``reason`` says why the next share was not.

    Soundness: ``lyapcheck.search.branch_and_bound``.
    """
    fixed, family = model.fixed(), named(gain_set.family, gain_set.m)
    form = scalar_form(gain_set, family.constants(), bounds)
    if form is None:
        return Certified(None, 0, 0, "h is unbounded: branch and bound needs its γ for the states far away")
    best, boxes, total, reason = None, 0, 0, ""
    for index, share in enumerate(SHARES):
        eps0 = _rounded_down(ceiling * share)
        task = problem(fixed, family, gain_set.kp, gain_set.kv, eps0)
        if task is None:
            return Certified(best, boxes, total, f"K_p is too small beside K_v for ε₀ = {float(eps0):.6g}")
        if on_progress is not None:
            on_progress(index / len(SHARES), f"{float(share):.1%} of falsified")
        outcome = certify(fixed, task, form, max_boxes - total)
        total += outcome.boxes
        if not outcome.proved:
            reason = _advice(outcome.reason, eps0, max_boxes)
            break
        best, boxes = eps0, outcome.boxes
    return Certified(best, boxes, total, reason)


def _advice(reason: str, eps0: Fraction, max_boxes: int) -> str:
    tried = f"ε₀ = {float(eps0):.6g} was not proved"
    if reason == EXHAUSTED:
        return f"{tried} within {max_boxes} boxes: allow more boxes"
    if reason == RESISTS:
        return f"{tried}: the bound fails at one state, so more boxes would not help"
    return f"{tried}: {reason}"


def _rounded_down(value: Fraction) -> Fraction:
    places = DIGITS - 1 - math.floor(math.log10(value))
    scale = Fraction(10) ** places
    return Fraction(math.floor(value * scale)) / scale
