"""Certified bounds of a motion, and what they rest on."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Provenance:
    """What a bound rests on: the accepted proof, ε₀, and the shares of B and K_p that it does without."""

    by: str
    boxes: int
    eps0: Fraction
    friction: Fraction
    stiffness: Fraction


@dataclass(frozen=True)
class SettlingBound:
    """A certified time after which every |e_i| ≤ δ for good, for all q and all motions from one start.

    Args:
        name: of the gain set.
        robot: name of the arm, at nominal numbers.
        delta: δ, rad.
        time: s, from above; none where nothing was proved.
        start_level: J, at least V at the start.
        end_level: J, V ≤ that is enough for δ.
        envelope: pairs (s, J): from that time on V is at most that.
        errors: rad, |e_i| at all times.
        exponential: whether V falls exponentially near the goal: h'(0) > 0.
        rests_on: the proof.
        reason: why there is no time.
    """

    name: str
    robot: str
    delta: Fraction
    time: Fraction | None
    start_level: Fraction | None
    end_level: Fraction | None
    envelope: tuple[tuple[Fraction, Fraction], ...]
    errors: tuple[float, ...]
    exponential: bool
    rests_on: Provenance | None
    reason: str = ""


@dataclass(frozen=True)
class DisturbanceBound:
    """What a bounded disturbance leaves of the error, certified for all motions from one start.

    Args:
        name: of the gain set.
        robot: name of the arm, at nominal numbers.
        torque: d̄_i, N·m, of any sign.
        dry: f_i, N·m, against the motion.
        level: J: V comes down to it and stays; none where no level is shown to be reached.
        errors: rad, |e_i| from ``time`` on.
        time: s, from above.
        start_level: J, at least V at the start.
        rest: rad, |e_i| at every state of rest; none for a joint whose k_pi does not exceed the torque.
        rests_on: the proof.
        reason: why there is no level.
    """

    name: str
    robot: str
    torque: tuple[Fraction, ...]
    dry: tuple[Fraction, ...]
    level: Fraction | None
    errors: tuple[float, ...]
    time: Fraction | None
    start_level: Fraction | None
    rest: tuple[float | None, ...]
    rests_on: Provenance | None
    reason: str = ""
