"""What a sampled run shows against its gains: a limit cycle, or a load that falls."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.results import BAND
from lyapcheck.simulate.run import FALLS, LIMIT_CYCLE, Run, Unrest
from lyapcheck.simulate.task import Gains

LEAST_ANGLE, LEAST_SHARE = math.radians(0.05), 0.01
"""Peak to peak, rad, and as a share of a motor's limit: less is no limit cycle."""
LASTS = 0.9
"""A limit cycle keeps at least this share of what it was a fifth of the run before."""


def unrest_of(run: Run, gains: Gains, unknown: Array) -> Unrest | None:
    """What a run to its end shows against the gains; a load that falls goes before a limit cycle.

    A limit cycle: in the last fifth a joint turns back twice, its angle spans more than 0.05° or its torque
    more than 1 % of the motor's limit beside a steady drift, and not below 0.9 of the fifth before. A load
    falls where on the way or at the goal it asks no less than k_pi sup h, and the joint ends a degree away.

    Args:
        run: sampled.
        gains: of the run.
        unknown: (N, n) N·m, what gravity asks on the way and at the goal beyond what the controller knows.

    Soundness: floating point, of one run: what is slower than a fifth of it is not seen.
    """
    if not run.complete:
        return None
    found = [*_falls(run, gains, unknown)] or [*_cycles(run)]
    return replace(max(found)[1], others=len(found) - 1) if found else None


def _falls(run: Run, gains: Gains, unknown: Array) -> Iterator[tuple[float, Unrest]]:
    gamma, loads = gains.family.constants().gamma, np.max(np.abs(unknown), axis=0)
    for i, (joint, load, kp) in enumerate(zip(run.joints, loads, gains.kp, strict=True)):
        most = math.inf if gamma is None else kp * gamma.float_upper
        end = abs(float(run.e[-1, i]))
        if load > 0 and load >= most and end > BAND:
            yield end, Unrest(FALLS, joint, math.degrees(end), float(load), most)


def _cycles(run: Run) -> Iterator[tuple[float, Unrest]]:
    part = len(run.t) // 5
    if part < 4:
        return
    last, before = slice(-part, None), slice(-2 * part, -part)
    for i, (joint, limit) in enumerate(zip(run.joints, run.torque_limit, strict=True)):
        if min(_turns(run.w[last, i]), _turns(run.w[before, i])) < 2:
            continue
        spans = []
        for signal, least in ((run.q, LEAST_ANGLE), (run.tau, LEAST_SHARE * limit if limit else math.inf)):
            now, then = _span(signal[last, i]), _span(signal[before, i])
            spans.append((now, now / least if now >= LASTS * then else 0.0))
        (angle, wide), (torque, strong) = spans
        if max(wide, strong) > 1:
            yield max(wide, strong), Unrest(LIMIT_CYCLE, joint, math.degrees(angle), torque)


def _turns(rate: Array) -> int:
    """How often a rate changes its sign."""
    signs = np.sign(rate[rate != 0])
    return int(np.count_nonzero(np.diff(signs)))


def _span(signal: Array) -> float:
    """Peak to peak beside the straight line through a signal."""
    t = np.linspace(-1.0, 1.0, len(signal))
    rest = signal - np.mean(signal) - t * (np.mean(t * signal) / np.mean(t * t))
    return float(np.ptp(rest))
