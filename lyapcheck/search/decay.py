"""Certified bounds of a motion: how long it takes to come near the goal, and what disturbances can do to it.

The search chooses ε₀, the shares η and κ, the levels of V and λ; ``lyapcheck.check.decay`` computes every
bound from them in balls.

References: ``reyes2019family`` (11), (12).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.loop.decay import Disturbance, Estimate, rest_errors
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.search.decay_input import Start, start_of, torques_of
from lyapcheck.search.decay_results import DisturbanceBound, Provenance, SettlingBound
from lyapcheck.search.levels import Slopes, falling
from lyapcheck.search.margins import MAX_BOXES, Shown, candidates, proved
from lyapcheck.search.setting import Setting

Progress = Callable[[float, str], None]

COARSE = 0.6
FINE = 0.93
"""Ratio of neighbouring levels, to compare margins and for the answer."""
DEEPEST = 1e-9
"""Levels below this share of the first one are not looked at for what a disturbance leaves."""
NOT_FALLING = "V was not shown to fall at all levels between"
NO_MARGIN = "no margin of dV/dt < 0 was proved"


def settling_bound(
    setting: Setting,
    e0: Sequence[float],
    w0: Sequence[float] | None = None,
    delta: float = math.radians(1.0),
    *,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> SettlingBound:
    """A certified time after which every |e_i| ≤ δ, whatever the posture.

    T = Σ (v_k − v_{k+1})/φ_k over levels of V from V at the start down to min k_pi U(δ).

    Args:
        setting: gains and arm, at nominal numbers.
        e0: (n,) q_d − q at the start, rad.
        w0: (n,) rates at the start, rad/s; rest if missing.
        delta: δ > 0, rad.
        max_boxes: the budget of each attempt at a proof.
        jobs: processes for the checker.
        on_progress: told the share done.

    Raises:
        InputError: an unbounded h, ranges, or values that are not finite or of the wrong number.

    Soundness: for (11) at exactly the nominal numbers; the checker has accepted the margin, and every number
        is computed by it in balls.

    References: ``reyes2019family`` (11), (12), (15).
    """
    start = start_of(setting, e0, w0, delta)
    tell = on_progress or _silent
    calm, goal = Disturbance.none(setting.n), Fraction(delta)

    def time_of(margin: Margin) -> float:
        found = _descent(setting, Estimate(margin, calm), start, goal, COARSE)
        return math.inf if found is None else float(found[0][-1])

    accepted, reason = _margin(setting, False, time_of, max_boxes, jobs, tell)
    exponential = setting.gains.m in (None, 1)
    if accepted is None:
        none = (None,) * 3
        return SettlingBound(
            setting.gains.name,
            setting.model.name,
            goal,
            *none,
            (),
            (),
            exponential,
            None,
            reason or NOT_FALLING,
        )
    estimate = Estimate(accepted.margin, calm)
    tell(0.7, "levels of V")
    descent = _descent(setting, estimate, start, goal, FINE)
    first = estimate.start_level(*start)
    return SettlingBound(
        name=setting.gains.name,
        robot=setting.model.name,
        delta=goal,
        time=None if descent is None else descent[0][-1],
        start_level=first,
        end_level=estimate.level_within(goal),
        envelope=() if descent is None else tuple(zip(*descent, strict=True)),
        errors=estimate.reach(first),
        exponential=exponential,
        rests_on=_provenance(accepted),
        reason=NOT_FALLING if descent is None else "",
    )


def disturbance_bound(
    setting: Setting,
    e0: Sequence[float],
    w0: Sequence[float] | None = None,
    torque: Sequence[Fraction | float] = (),
    dry: Sequence[Fraction | float] = (),
    *,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> DisturbanceBound:
    """A level of V, and with it errors, that every motion from a start comes down to under a disturbance.

    Args:
        setting: gains and arm, at nominal numbers.
        e0: (n,) q_d − q at the start, rad.
        w0: (n,) rates at the start, rad/s; rest if missing.
        torque: (n,) bounds of a torque of any sign, N·m; none if empty.
        dry: (n,) bounds of a torque that never helps the motion, as dry friction, N·m; none if empty.
        max_boxes: the budget of each attempt at a proof.
        jobs: processes for the checker.
        on_progress: told the share done.

    Raises:
        InputError: as `settling_bound`, or bounds that are negative.

    Soundness: as `settling_bound`, for every absolutely continuous motion along which such a torque acts.

    References: ``reyes2019family`` (11), (12), (15).
    """
    start = start_of(setting, e0, w0, 1.0)
    acting = Disturbance(torques_of(setting, "torque", torque), torques_of(setting, "dry", dry))
    tell = on_progress or _silent
    both = [a + b for a, b in zip(acting.torque, acting.dry, strict=True)]

    def level_of(margin: Margin) -> float:
        found = _lowest(setting, Estimate(margin, acting), start, COARSE)
        return math.inf if len(found) < 2 else float(found[-1])

    accepted, reason = _margin(setting, any(acting.torque), level_of, max_boxes, jobs, tell)
    rest = rest_errors(setting.closure(Fraction(1)), both)
    found: list[Fraction] = []
    first = times = None
    if accepted is not None:
        tell(0.7, "levels of V")
        estimate = Estimate(accepted.margin, acting)
        first = estimate.start_level(*start)
        found = _lowest(setting, estimate, start, FINE)
        slopes = Slopes(estimate, setting.family)
        times = estimate.descent(found, [slopes.best(low, high) for high, low in pairwise(found)])
    reached = times is not None and len(found) > 1
    return DisturbanceBound(
        name=setting.gains.name,
        robot=setting.model.name,
        torque=acting.torque,
        dry=acting.dry,
        level=found[-1] if reached else None,
        errors=estimate.reach(found[-1]) if reached else (),
        time=times[-1] if times is not None and reached else None,
        start_level=first,
        rest=rest,
        rests_on=None if accepted is None else _provenance(accepted),
        reason="" if reached else reason or _TOO_LARGE,
    )


_TOO_LARGE = "the disturbance is too large beside k_pi and the friction: V is not shown to fall at the start"


def _margin(
    setting: Setting,
    disturbed: bool,
    worth: Callable[[Margin], float],
    max_boxes: int,
    jobs: int,
    tell: Progress,
) -> tuple[Shown | None, str]:
    """The accepted margin that promises the least ``worth``, and why there is none."""
    tell(0.05, "margins by samples")
    found = candidates(setting, disturbed)
    rows = ((_worth(worth, margin), margin.friction, margin) for margin in found)
    ranked = [row for row in rows if row[0] < math.inf]
    if not ranked:
        return None, "" if found else NO_MARGIN
    for index, (_, _, margin) in enumerate(sorted(ranked, key=lambda row: row[:2])):
        tell(0.3 + 0.08 * index, f"proving a margin, η = {float(margin.friction):g}")
        accepted = proved(setting, margin, max_boxes, jobs)
        if accepted is not None:
            return accepted, ""
    return None, f"{NO_MARGIN}; allow more boxes"


def _worth(worth: Callable[[Margin], float], margin: Margin) -> float:
    """The worth of a margin, infinite where its level of V allows errors beyond all bounds."""
    try:
        return worth(margin)
    except ValueError:
        return math.inf


def _descent(
    setting: Setting, estimate: Estimate, start: Start, delta: Fraction, ratio: float
) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]] | None:
    """Times and levels from the start down to δ."""
    first, last = estimate.start_level(*start), estimate.level_within(delta)
    if last >= first:
        return (Fraction(0),), (first,)
    if last <= 0:
        return None
    levels = tuple(falling(first, last, ratio))
    slopes = Slopes(estimate, setting.family)
    times = estimate.descent(levels, [slopes.best(low, high) for high, low in pairwise(levels)])
    return None if times is None else (times, levels)


def _lowest(setting: Setting, estimate: Estimate, start: Start, ratio: float) -> list[Fraction]:
    """Levels from the start down, as long as V is shown to fall between them."""
    first = estimate.start_level(*start)
    slopes = Slopes(estimate, setting.family)
    found = [first]
    for low in falling(first, first * Fraction(DEEPEST), ratio):
        if low >= first:
            continue
        if estimate.fall(low, found[-1], slopes.best(low, found[-1])) <= 0:
            break
        found.append(low)
    return found


def _provenance(accepted: Shown) -> Provenance:
    margin = accepted.margin
    by = "branch and bound" if isinstance(accepted.by, BoxTree) else "bounds in ‖e‖ alone"
    boxes = accepted.by.tree.count(".")
    return Provenance(by, boxes, margin.closure.eps0, margin.friction, margin.stiffness)


def _silent(fraction: float, note: str) -> None:
    pass
