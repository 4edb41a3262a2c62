"""Errors within bounds from times on, and motions that dry friction ends: motions of the oracle's own.

For dry friction a motion is held against the energy, which must not rise, and a joint that friction can hold
for ever beyond its bound is looked for, as for states of rest.
"""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

import numpy as np

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.loop import DOUBLES
from tests.statement_fuzz.oracle.region import Objection
from tests.statement_fuzz.oracle.resting import resting, rests_there
from tests.statement_fuzz.oracle.settling import MARGIN, STEEPEST, STEP, Motion

MOST_STEPS = 1_400
RESTING_STEPS = 40
STEEPEST_H = 3
"""Above h(w)/w of every function that statements are made of."""


@kinds.objections_to("StaysWithin")
def stays_within(statement: Any, random: Random) -> Objection | None:
    """A time at which a motion is beyond a bound that holds from then on."""
    motion = Motion(statement, random)
    within = [(float(t), np.array([[float(x)] for x in errors])) for t, errors in statement.within]
    time, end = 0.0, min(within[-1][0] + 3.0, MOST_STEPS * STEP)
    with np.errstate(all="ignore"):
        while time <= end:
            for since, bound in (*within, *_dying(statement, time)):
                if since <= time and np.any(np.abs(motion.e) > bound * (1 + MARGIN) + 1e-12):
                    return Objection("false", f"|e| beyond its bound, t = {time:.4g}")
            coming = [since - time for since, _ in within if since > time]
            step = max(min([STEP, *coming]), 1e-9)  # times of bounds are met exactly
            motion.advance(step)
            time += step
    return None


def _dying(statement: Any, time: float) -> list[tuple[float, Any]]:
    """What errors have come down to."""
    after, last = statement.after, float(statement.within[-1][0])
    if after is None or time < last:
        return []
    m = statement.m or 1
    passed = (time - last) / float(after.scale)
    share = np.exp(-passed) if m == 1 else (1 + passed) ** (-1 / (2 * m - 2))
    return [(last, np.array([[float(x)] for x in after.sizes]) * share)]


def worst(statement: Any, time: float, random: Random) -> list[float]:
    """The largest |e_i| that motions of the oracle have at a time or after it, for a while."""
    motion, passed, most = Motion(statement, random), 0.0, np.zeros(len(statement.mass))
    while passed < time + 2.0:
        if passed >= time:
            most = np.maximum(most, np.max(np.abs(motion.e), axis=1))
        motion.advance(step := max(min(STEP, time - passed), 1e-9) if passed < time else STEP)
        passed += step
    return [float(x) for x in most]


@kinds.objections_to("ComesToRest")
def comes_to_rest(statement: Any, random: Random) -> Objection | None:
    """A joint that friction holds beyond its bound; a posture without M ≻ 0; a motion that gains energy."""
    n = len(statement.mass)
    held = resting(_Resting(statement), random)
    if held is not None:
        return held
    motion = Motion(statement, random, (Fraction(1),) * n, (Fraction(1),) * n)
    rows = motion.loop.at(list(motion.q), DOUBLES).matrix(statement.mass)
    matrices = np.array([[np.broadcast_to(x, motion.q.shape[1]) for x in row] for row in rows])
    least = float(np.min(np.linalg.eigvalsh(np.moveaxis(matrices, -1, 0))))
    if least < -1e-9 * float(np.max(np.abs(matrices))):
        return Objection("false", "a posture where M is not positive")
    if not 1e-3 < least < 1e3:
        return None  # too stiff, or too slow, for these steps
    pairs = zip(statement.viscous, statement.kv, strict=True)
    damping = STEEPEST + float(max(max(map(abs, ends)) + STEEPEST_H * k for ends, k in pairs))
    step = min(STEP / 10, least / damping)
    with np.errstate(all="ignore"):
        before = motion.energy()
        for _ in range(RESTING_STEPS):
            motion.advance(step)
            now = motion.energy()
            if np.any(now > before * (1 + MARGIN) + 1e-9):
                return Objection("false", "a motion that gains energy")
            before = now
    return None


class _Resting:
    """What the statement says of states of rest."""

    def __init__(self, statement: Any) -> None:
        self.family, self.m, self.kp = statement.family, statement.m, statement.kp
        self.torque, self.errors = statement.dry, statement.errors


@kinds.judges("ComesToRest")
def rests_beyond(statement: Any, witness: Any) -> bool | None:
    """As for states of rest."""
    return rests_there(_Resting(statement), witness)
