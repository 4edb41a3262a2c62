"""Bounds of a motion: motions from the corners of what they may start from, under the worst of torques."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import solved
from tests.statement_fuzz.oracle.decreasing import loop_of
from tests.statement_fuzz.oracle.loop import DOUBLES, Loop
from tests.statement_fuzz.oracle.region import Objection

MOTIONS = 24
STEP = 0.03
MOST_STEPS = 600
MARGIN = 1e-4
"""Relative; above the error of the motion by orders of magnitude."""
SHARES = (Fraction(0), Fraction(1), Fraction(0), Fraction(1), Fraction(1, 2))
"""Of the way through a range."""
STEEPEST = 5.0
"""Dry friction is at most f and has the sign of w: f tanh(kw), with kf as large as the step can follow."""


def ranges(statement: Any) -> tuple[Any, Any]:
    """Those of friction and of parameters."""
    return statement.viscous, statement.parameters


def within(ends: Any, random: Random) -> list[Fraction]:
    """One number of each range, mostly an end of it."""
    return [low + (high - low) * random.choice(SHARES) for low, high in ends]


class Motion:
    """Many motions at once: angles, errors and rates in columns.

    One arm in the ranges is taken at random. They start at the corners of what the statement lets them start
    from, or of ``errors`` and ``rates``.
    """

    def __init__(self, statement: Any, random: Random, errors: Any = None, rates: Any = None) -> None:
        generator = np.random.default_rng(random.getrandbits(32))
        n = len(statement.mass)
        corners = generator.choice((-1.0, 1.0), (3, n, MOTIONS))
        corners[:, :, :2] = 1.0
        corners[1, :, 1] = -1.0
        starts = errors or statement.errors_at_start, rates or statement.rates_at_start
        sizes = ([float(x) for x in part] for part in starts)
        self.e, self.w = (sign * np.array(size)[:, None] for sign, size in zip(corners, sizes, strict=False))
        self.q = generator.uniform(-np.pi, np.pi, (n, MOTIONS))
        torque, dry = (getattr(statement, name, (0,) * n) for name in ("torque", "dry"))
        self.torque = corners[2] * np.array([[float(x)] for x in torque])
        self.dry = np.array([[float(x)] for x in dry])
        self.steep = STEEPEST / max(0.1, float(np.max(self.dry)))
        self.dry = np.where(generator.random(MOTIONS) < 0.5, 1.0, 0.0) * self.dry
        self.loop: Loop = loop_of(statement, *(within(part, random) for part in ranges(statement)))

    def slope(self, z: Any) -> Any:
        """The derivatives of q, e and w."""
        q, e, w = z
        force = np.array(self.loop.force(list(q), list(e), list(w), DOUBLES))
        force = force + self.torque - self.dry * np.tanh(self.steep * w)
        a = solved(self.loop.at(list(q), DOUBLES).matrix(self.loop.mass), list(force))
        return np.array([w, -w, np.array(a)])

    def advance(self, step: float) -> None:
        """One step of Runge and Kutta's fourth order."""
        z = np.array([self.q, self.e, self.w])
        a = self.slope(z)
        b = self.slope(z + step / 2 * a)
        c = self.slope(z + step / 2 * b)
        d = self.slope(z + step * c)
        self.q, self.e, self.w = z + step / 6 * (a + 2 * b + 2 * c + d)

    def energy(self) -> Any:
        """V."""
        return self.loop.energy(list(self.q), list(self.e), list(self.w), DOUBLES)


@kinds.objections_to("Settling")
def settling(statement: Any, random: Random) -> Objection | None:
    """A time at which a motion is above its level, or beyond an error."""
    motion = Motion(statement, random)
    envelope = [(float(t), float(v)) for t, v in statement.envelope]
    largest, last = (
        np.array([[float(x)] for x in part]) for part in (statement.largest_errors, statement.errors)
    )
    end = min(envelope[-1][0] + 1.0, MOST_STEPS * STEP)
    time, passed = 0.0, 0
    with np.errstate(all="ignore"):
        while time <= end:
            while passed < len(envelope) and envelope[passed][0] <= time:
                passed += 1
            over = _over(motion, envelope[:passed], largest, last if passed == len(envelope) else None)
            if over:
                return Objection("false", f"{over}, t = {time:.4g}")
            # times of levels are met exactly
            step = STEP if passed == len(envelope) else min(STEP, max(envelope[passed][0] - time, 1e-9))
            motion.advance(step)
            time += step
    return None


def _over(motion: Motion, levels: Sequence[tuple[float, float]], largest: Any, last: Any) -> str:
    """What a motion exceeds beyond the error of the arithmetic."""
    if not levels:
        return ""
    energy = np.max(motion.energy())
    if energy > levels[-1][1] * (1 + MARGIN) + 1e-12:
        return f"V = {energy:.6g} > {levels[-1][1]:.6g}"
    for bound in (largest, *(() if last is None else (last,))):
        if np.any(np.abs(motion.e) > bound * (1 + MARGIN) + 1e-12):
            return "|e| beyond its bound"
    return ""
