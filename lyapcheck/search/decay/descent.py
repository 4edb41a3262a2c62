"""Levels of V from a start down, the λ of each band between two, and the times by which they are passed."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.kinds.settling import Envelope
from lyapcheck.check.loop.decay.estimate import BITS, Estimate
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family import Family
from lyapcheck.search.decay.digits import short_above, short_below, tick_after
from lyapcheck.search.decay.levels import Slopes, falling
from lyapcheck.search.decay.start import Start

DEEPEST = Fraction(1, 10**9)
"""Levels below this share of the first one are not looked at for what a disturbance leaves."""
RISE, RISES = 4, 24
"""How often, and how much, the first level is raised until V is shown to fall there."""
SMALLEST = Fraction(1, 10**9)
"""J: a first level for starts at the goal."""


@dataclass(frozen=True)
class Descent:
    """Times in s with levels in J that V is below from then on, and λ of each band; not yet judged."""

    envelope: Envelope
    slopes: tuple[Fraction, ...]

    @property
    def time(self) -> Fraction:
        """When the last level is reached, s."""
        return self.envelope[-1][0]

    @property
    def level(self) -> Fraction:
        """The last level, J."""
        return self.envelope[-1][1]


def descent(
    estimate: Estimate, family: Family, start: Start, goal: Fraction | None, ratio: float
) -> Descent | None:
    """The descent to where every |e_i| ≤ goal, rad, or without a goal as low as V is shown to fall.

    Args:
        estimate: of a margin, proved or not.
        family: the h of the controller, in NumPy.
        start: bounds of |e_i| and |w_i|.
        goal: rad, or none.
        ratio: of neighbouring levels.

    Returns:
        ``None`` where the goal is not reached, or no level is left for a lower one.
    """
    first = max(short_above(estimate.start_level(*start)), SMALLEST)
    if goal is None:
        return _lowest(estimate, family, first, ratio)
    last = short_below(level_within(estimate, goal))
    if last >= first:
        return Descent(((Fraction(0), first),), ())
    if last == 0:
        return None
    result = lowered(estimate, family, first, last, ratio)
    return result if result.level == last else None


def level_within(estimate: Estimate, e: Fraction) -> Fraction:
    """A level, J: V ≤ that is enough for every |e_i| ≤ e. It is min k_pi U(e), from below."""
    with precision(BITS):
        least = estimate.member.potential(to_arb(e)) * to_arb(min(estimate.margin.loop.kp))
        return max(Enclosure.from_arb(least).lower, Fraction(0))


def _lowest(estimate: Estimate, family: Family, first: Fraction, ratio: float) -> Descent | None:
    """From the first level, or a higher one: near the goal a disturbance may make V rise."""
    for power in range(RISES):
        result = lowered(estimate, family, first * RISE**power, first * DEEPEST, ratio)
        if result.slopes:
            return result
    return None


def lowered(
    estimate: Estimate,
    family: Family,
    first: Fraction,
    last: Fraction,
    ratio: float,
    begins: Fraction = Fraction(0),
) -> Descent:
    """Down from the first level, at time ``begins``, s, to the last one, as long as V is shown to fall."""
    best = Slopes(estimate, family).best
    envelope, slopes = [(begins, first)], []
    for low in map(short_below, falling(first, last, ratio)):
        time, high = envelope[-1]
        if low >= high:
            continue
        slope = short_below(best(low, high))
        fall = estimate.fall(low, high, slope)
        if fall <= 0:
            break
        envelope.append((tick_after(time + (high - low) / fall), low))
        slopes.append(slope)
    return Descent(tuple(envelope), tuple(slopes))
