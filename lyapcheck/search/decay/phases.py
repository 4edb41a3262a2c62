"""Phases of a motion: as V falls the arm is slower and nearer, so that it is shown to fall faster.

Each phase has the largest ε₀ that is proved for the speeds and errors which the energy still allows. The
search is in doubles; the checker judges what comes of it (``lyapcheck.check.kinds.phases``).

References: ``reyes2019family`` (11), (13).
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED, Progress
from lyapcheck.check.kinds.at_corners import MassAtCorners
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.check.kinds.inertia import Bisection, Mass, MassAbove
from lyapcheck.check.kinds.phases import DiesOut, FallingPhases, Phase, StaysWithin
from lyapcheck.check.loop.corners import corners_of, is_affine
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate, reach_of
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.decay.speeds import fastest, regraded
from lyapcheck.check.loop.decay.tail import covers, degree, shortest
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Ends
from lyapcheck.control.judgement import proves
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.descent import Descent, level_within, lowered
from lyapcheck.search.decay.digits import short_above, short_below
from lyapcheck.search.decay.heaviest import Heaviest, heaviest, masses
from lyapcheck.search.decay.margins import Attempt, attempts, candidates, margin_at
from lyapcheck.search.decay.results import MotionWithProof
from lyapcheck.search.decay.start import Start

FRICTION = tuple(Fraction(k, 100) for k in (20, 40, 60))
"""The η that are weighed against each other."""
COARSE, FINE = 0.6, 0.93
"""Ratio of neighbouring levels, to compare margins and for the answer."""
STEP = Fraction(1, 6)
"""What is left of V after a phase."""
MOST_PHASES = 24
SHARES = tuple(Fraction(k, 100) for k in (98, 90, 70, 50, 25))
"""Of the least inertia that samples show, tried one after the other."""
SAMPLES = 4_000
POINTS = 400
SMALL = Fraction(1, 10**6)
"""ε₀ of an estimate that is asked for nothing which depends on it."""
ROOM = Fraction(101, 100)
"""Above the energy, for what the checker rounds."""


class Phases:
    """What is known when some phases are over.

    Args:
        controlled: gains and arm, at nominal numbers or over ranges.
        start: bounds of |e_i| and |w_i|.
        goal: rad.
        max_boxes: the budget of each attempt.
    """

    def __init__(self, controlled: ControlledArm, start: Start, goal: Fraction, max_boxes: int) -> None:
        self.controlled, self.start, self.goal, self.max_boxes = controlled, start, goal, max_boxes
        self.made: list[Phase] = []
        self.member = member(controlled.gains.family, controlled.gains.m)
        self.lightest = lightest(controlled)
        self.base = self._base()
        self.last: Estimate | None = self.base
        self.energy = Fraction(0) if self.base is None else self.base.start_energy(*start)
        self.largest = short_above(self.energy * ROOM)
        self.level = self.eps0 = self.time = Fraction(0)

    def found(self, on_progress: Progress) -> MotionWithProof | None:
        """A statement by when every |e_i| ≤ goal and its untrusted proof; none where there is none."""
        if self.base is None or self.controlled.n > FEW_JOINTS:
            return None
        first, last = self.energy, short_below(level_within(self.base, self.goal))
        if not 0 < last < first:
            return None
        while not self.made or self.level > last:
            if len(self.made) == MOST_PHASES or not self._another(last):
                return None
            gone = math.log(first / self.level) / math.log(first / last)
            on_progress(min(max(gone, 0.0), 1.0), f"phase {len(self.made)}")
        return self._claim()

    def _base(self) -> Estimate | None:
        """For what does not depend on ε₀, on speeds and errors."""
        heavy = heaviest(self.controlled)
        if heavy is None:
            return None
        margin = margin_at(self.controlled, SMALL, Fraction(1, 2), Fraction(0), heavy.diagonal)
        with suppress(ValueError):  # gains so small that this ε₀ is too large for them
            return self._estimate(margin)
        return None

    def _another(self, last: Fraction) -> bool:
        """One more phase; ``False`` where none is found."""
        near = self._near()
        heavy, ranked = heaviest(near), []
        for margin in candidates(near, False, FRICTION):
            result = self._descent(margin, last, COARSE)
            if result is not None:
                ranked.append((result.time, margin.friction, margin))
        for _, _, margin in sorted(ranked, key=lambda row: row[:2]):
            for attempt in attempts(near, margin, self.max_boxes):
                result = self._descent(attempt.margin, last, FINE)
                if result is not None and heavy is not None:
                    self._keep(near, heavy, attempt, result)
                    return True
        return False

    def _near(self) -> ControlledArm:
        """The setting with the floors and errors that the energy allows."""
        energy = self.energy * ROOM
        floors = tuple(
            floor_below(self.controlled, float(fastest(energy, inertia))) if inertia else Fraction(0)
            for inertia in self.lightest
        )
        return replace(self.controlled, floors=floors, within=self._kept(energy))

    def _estimate(self, margin: Margin) -> Estimate:
        return Estimate(margin, Disturbance.none(self.controlled.n))

    def _descent(self, margin: Margin, last: Fraction, ratio: float) -> Descent | None:
        """From where the last phase ended, or the start, to a share of V."""
        try:
            estimate = self._estimate(margin)
            if self.made:
                first = regraded(self.level, margin.loop.eps0 - self.eps0, margin.loop, margin.heaviest)
            else:
                first = estimate.start_level(*self.start)
            first = short_above(first)
            low = max(last, short_below(first * STEP))
            if low >= first or (not self.made and estimate.start_energy(*self.start) > self.largest):
                return None
            result = lowered(estimate, self.controlled.family, first, low, ratio, self.time)
        except ValueError:  # a level of V that allows errors beyond all bounds
            return None
        return result if result.level == low else None

    def _keep(self, near: ControlledArm, heavy: Heaviest, attempt: Attempt, result: Descent) -> None:
        margin = attempt.margin
        self.made.append(
            Phase(
                margin.loop.eps0,
                near.within,
                near.floors,
                margin.friction,
                margin.stiffness,
                margin.split,
                heavy.diagonal,
                heavy.proof,
                attempt.by,
                result.envelope,
                result.slopes,
            )
        )
        self.last = self._estimate(margin)
        self.time, self.level, self.eps0 = result.time, result.level, margin.loop.eps0
        self.energy = min(self.energy, regraded(self.level, self.eps0, margin.loop, margin.heaviest))

    def _claim(self) -> MotionWithProof:
        """What there is to be judged."""
        loop = self.controlled.loop(Fraction(1))
        n = self.controlled.n
        ends = [(Fraction(0), self.largest), *(phase.envelope[-1] for phase in self.made[:-1])]
        within = [(time, self._kept(level)) for time, level in ends]
        statement = StaysWithin.about(
            loop,
            errors_at_start=self.start[0],
            rates_at_start=self.start[1],
            within=(*within, (self.time, (self.goal,) * n)),
            after=self._after(),
        )
        lightness = tuple(light_proof(loop.arm.mass, loop.parameters) for x in self.lightest if x)
        proof = FallingPhases(self.controlled.inertia_proof, self.lightest, lightness, tuple(self.made))
        return MotionWithProof(statement, proof)

    def _after(self) -> DiesOut | None:
        """How errors die out after the last phase."""
        errors = (self.goal,) * self.controlled.n
        m = degree(self.controlled.gains.family, self.controlled.gains.m)
        scale = None if self.last is None else shortest(self.last, self.level, errors)
        if m is None or scale is None or self.last is None:
            return None
        z = 1 + math.sinh(self.goal) ** (2 * m)
        sizes = tuple(
            short_above(Fraction((2 * m * z * float(self.level / k)) ** (1 / (2 * m)) * (1 + 1e-12)))
            for k in self.controlled.gains.kp
        )
        return DiesOut(sizes, short_above(scale)) if covers(self.last, self.level, errors, sizes) else None

    def _kept(self, level: Fraction) -> tuple[Fraction, ...]:
        """Bounds of |e_i| where V is at most that."""
        return tuple(
            short_above(Fraction(reach_of(self.member, level / k))) for k in self.controlled.gains.kp
        )


def floor_below(controlled: ControlledArm, speed: float) -> Fraction:
    """The least h(x)/x up to a speed, rad/s, nearly; 0 where it is next to nothing."""
    x = np.linspace(speed / POINTS, speed, POINTS)
    least = min(float(np.min(controlled.family.h(x) / x)), float(controlled.family.dh(np.zeros(1))[0]))
    return short_below(Fraction(least * (1 - 1e-5))) if least > 1e-6 else Fraction(0)


def lightest(controlled: ControlledArm) -> tuple[Fraction, ...]:
    """For each joint a ν_i with M ⪰ ν_i at place (i, i), near the largest one, or 0 where none is shown."""
    if controlled.n > FEW_JOINTS:
        return (Fraction(0),) * controlled.n
    loop = controlled.loop(Fraction(1))
    statement = statement_of(loop)
    q = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (SAMPLES, controlled.n))
    least = np.min(
        [1.0 / np.diagonal(np.linalg.inv(M), axis1=1, axis2=2).max(axis=0) for M in masses(controlled, q)],
        axis=0,
    )
    result = []
    for joint, inertia in enumerate(least.tolist()):
        tried = (short_below(Fraction(inertia) * share) for share in SHARES)
        shown = (x for x in tried if _shown(statement.mass_lightened(joint, x)))
        result.append(next(shown, Fraction(0)))
    return tuple(result)


def light_proof(mass: Mass, parameters: tuple[Ends, ...]) -> Bisection | MassAtCorners:
    """What shows such bounds: boxes of angles, at each corner of the ranges if M is affine in parameters."""
    count = len(list(corners_of(parameters)))
    return MassAtCorners((Bisection(),) * count) if parameters and is_affine(mass) else Bisection()


def _shown(above: MassAbove) -> bool:
    """Whether the checker sees at once that a matrix is positive definite throughout."""
    return proves(above, light_proof(above.mass, above.parameters))
