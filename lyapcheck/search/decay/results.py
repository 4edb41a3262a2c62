"""Certified bounds of a motion: what the checker accepted, and the numbers that are read from it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.at_corners import RateAtCorners
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.kinds.phases import FallingPhases, Phase, StaysWithin
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.kinds.settling import Envelope, FallingLevels, Settling
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.check.loop.processes import shared_between
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.control.judgement import proves

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm


@dataclass(frozen=True)
class Provenance:
    """What a bound rests on: the accepted proof, ε₀, and the shares of B and K_p that it does without.

    In several phases ε₀ is the least one, and the shares are the largest.
    """

    by: str
    boxes: int
    eps0: Fraction
    friction: Fraction
    stiffness: Fraction
    phases: int = 1


@dataclass(frozen=True)
class MotionWithProof:
    """A statement and the proof by which the checker has accepted it."""

    statement: Settling | StaysWithin
    proof: FallingLevels | FallingPhases

    @property
    def rests_on(self) -> Provenance:
        """What it rests on."""
        parts = [(part.friction, part.stiffness, rate, eps0) for part, rate, eps0 in self._parts()]
        frictions, stiffnesses, rates, eps0s = zip(*parts, strict=True)
        every = [one for rate in rates for one in (rate.each if isinstance(rate, RateAtCorners) else [rate])]
        boxes = sum(getattr(rate, "tree", "").count(".") for rate in every)
        boxed = all(isinstance(rate, BoxTree) for rate in every)
        by = "branch and bound" if boxed else "bounds along the links"
        return Provenance(by, boxes, min(eps0s), max(frictions), max(stiffnesses), len(parts))

    def _parts(self) -> list[tuple[Phase | FallingLevels, Proof, Fraction]]:
        """The phases, with what shows dV/dt < 0 and ε₀."""
        if isinstance(self.proof, FallingPhases):
            return [(phase, phase.rate, phase.eps0) for phase in self.proof.phases]
        eps0 = self.statement.eps0 if isinstance(self.statement, Settling) else Fraction(0)
        return [(self.proof, self.proof.decreasing.rate, eps0)]

    @property
    def envelope(self) -> Envelope:
        """Pairs (s, J): from that time on V is at most that, in several phases at the ε₀ of each."""
        if isinstance(self.proof, FallingPhases):
            return tuple(pair for phase in self.proof.phases for pair in phase.envelope)
        return self.statement.envelope if isinstance(self.statement, Settling) else ()


@dataclass(frozen=True)
class AtRest:
    """A statement about states of rest and the proof by which the checker has accepted it."""

    statement: Resting | ComesToRest
    proof: AtBounds | EnergyFalls


@dataclass(frozen=True)
class MotionBound:
    """What is certified of all motions from some starts, for all q; all numbers are of ``shown``.

    Args:
        name: of the gain set.
        m: its member, if its family has members.
        robot: name of the arm, at nominal numbers or over ranges.
        shown: what the checker accepted; none where it accepted nothing.
        reason: why there is nothing.
    """

    name: str
    m: int | None
    robot: str
    shown: MotionWithProof | None
    reason: str

    @property
    def envelope(self) -> Envelope:
        """Pairs (s, J): from that time on V is at most that."""
        return () if self.shown is None else self.shown.envelope

    @property
    def time(self) -> Fraction | None:
        """s, from above: when the last level is reached."""
        return self.envelope[-1][0] if self.envelope else None

    @property
    def level(self) -> Fraction | None:
        """J: V comes down to it and stays."""
        return self.envelope[-1][1] if self.envelope else None

    @property
    def start_level(self) -> Fraction | None:
        """J, at least V at the start."""
        return self.envelope[0][1] if self.envelope else None

    @property
    def errors(self) -> tuple[Fraction, ...]:
        """rad, |e_i| from ``time`` on."""
        return () if self.shown is None else self.shown.statement.errors

    @property
    def largest_errors(self) -> tuple[Fraction, ...]:
        """rad, |e_i| at all times."""
        return () if self.shown is None else self.shown.statement.largest_errors

    @property
    def rests_on(self) -> Provenance | None:
        """The proof."""
        return None if self.shown is None else self.shown.rests_on


@dataclass(frozen=True)
class SettlingBound(MotionBound):
    """A certified time after which every |e_i| ≤ δ for good.

    Args:
        delta: δ, rad.
        exponential: whether V falls exponentially near the goal: h'(0) > 0.
    """

    delta: Fraction
    exponential: bool

    @classmethod
    def of(
        cls, controlled: ControlledArm, shown: MotionWithProof | None, reason: str, delta: Fraction
    ) -> SettlingBound:
        """What was shown of a controlled arm."""
        gains = controlled.gains
        exponential = gains.m in (None, 1)
        return cls(gains.name, gains.m, controlled.model.name, shown, reason, delta, exponential)


@dataclass(frozen=True)
class DisturbanceBound(MotionBound):
    """What a bounded disturbance leaves of the error.

    Args:
        torque: d̄_i, N·m, of any sign.
        dry: f_i, N·m, against the motion.
        resting: what the checker accepted of states of rest, or where nothing but dry friction acts of how
            every motion ends; none where it accepted nothing.
    """

    torque: tuple[Fraction, ...]
    dry: tuple[Fraction, ...]
    resting: AtRest | None

    @classmethod
    def of(
        cls,
        controlled: ControlledArm,
        shown: MotionWithProof | None,
        reason: str,
        torque: tuple[Fraction, ...],
        dry: tuple[Fraction, ...],
        resting: AtRest | None,
    ) -> DisturbanceBound:
        """What was shown of a controlled arm."""
        gains = controlled.gains
        return cls(gains.name, gains.m, controlled.model.name, shown, reason, torque, dry, resting)

    @property
    def rest(self) -> tuple[Fraction | None, ...]:
        """rad, |e_i| at every state of rest; none for a joint whose k_pi does not exceed the torque."""
        return (None,) * len(self.torque) if self.resting is None else self.resting.statement.errors

    @property
    def comes_to_rest(self) -> bool:
        """Whether it is shown that every motion ends at such a state."""
        return self.resting is not None and isinstance(self.resting.statement, ComesToRest)


def accepted(statement: Statement, proof: Proof, jobs: int = 1) -> bool:
    """Whether the checker takes a proof of a statement, in so many processes."""
    with shared_between(jobs):
        return proves(statement, proof)
