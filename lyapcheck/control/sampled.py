"""Gains on a computer: how it runs them, what shows (S), and for which periods (S) holds."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.kinds.chain import NoTorque, OwnLevers
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import MOST_DELAY, MOST_TAPS, SampledStable, ShortPeriod
from lyapcheck.check.loop.chain import lever_bound, pulls
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.statement import Proof
from lyapcheck.control.gravity import least_along
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.robots.dynamics import Chain


@dataclass(frozen=True)
class SampledLoop:
    """How a computer runs (6).

    Args:
        period: nominal, by which differences of readings are divided, s.
        longest: interval between readings, s; the period where none is given.
        delay: whole samples from a reading to its torque.
        filter: weights of the differences, the newest first.
        velocity: how it is had.
        angles: as readings give them.

    Raises:
        ValueError: (S) does not speak of such a loop; it says what to do.
    """

    period: Fraction
    longest: Fraction | None = None
    delay: int = 0
    filter: tuple[Fraction, ...] = (Fraction(1),)
    velocity: str = "difference"
    angles: str = "unwrapped"

    def __post_init__(self) -> None:
        taps = isinstance(self.filter, tuple) and 1 <= len(self.filter) <= MOST_TAPS
        rules = {
            "period": (self.period > 0, "must be positive; give seconds"),
            "longest": (self.stretch >= 1, "is below the period; give the longest interval"),
            "delay": (
                self.delay in range(MOST_DELAY + 1),
                f"must be whole samples to {MOST_DELAY}; round it up",
            ),
            "filter": (
                taps,
                f"must be 1 to {MOST_TAPS} weights of differences; cut one off that never ends",
            ),
            "velocity": (
                self.velocity == "difference",
                'needs the inertia and is not covered; take velocity = "difference"',
            ),
            "angles": (
                self.angles == "unwrapped",
                "jump by a turn and are not covered; add the turns, as |Δq| < π in a sample",
            ),
        }
        for name, (fits, rule) in rules.items():
            if not fits:
                raise ValueError(f"{name} = {getattr(self, name)} {rule}")

    @property
    def stretch(self) -> Fraction:
        return Fraction(1) if self.longest is None or self.period <= 0 else self.longest / self.period


def sampled_proof(statement: SampledStable) -> ShortPeriod:
    """What may show a statement by (S): a bound of each torque of gravity, with its proof."""
    chain, rows = Chain(statement.links, statement.fall), []
    for i, bound in enumerate(statement.bounds([Fraction(0)] * statement.n)):
        way: tuple[Fraction, Proof] = Fraction(0), NoTorque()
        if isinstance(bound, GravityBelow):
            sizes = (size_of(torque, statement.parameters) for torque in bound.entries)
            way = sum(sizes, Fraction(0)), HarmonicSizes()
        elif not pulls(statement.links, statement.fall, i, ()):
            along = least_along(chain, i)
            way = lever_bound(statement.links, statement.fall, i, along), OwnLevers(along)
        rows.append(way)
    return ShortPeriod(tuple(k for k, _ in rows), tuple(own for _, own in rows))


def judged_sampled(statement: SampledStable) -> JudgedStatement:
    """What the checker says of gains on a computer, by (S).

    Soundness: that of ``lyapcheck.check.verify``.
    """
    return judged_statement(statement, [sampled_proof(statement)])


def largest_period(statement: SampledStable) -> Fraction | None:
    """The supremum of the periods, s, that (S) shows; ``None``: none.

    Soundness: (S) is strict, and linear in T.
    """
    k_g = statement.k_g or sampled_proof(statement).k_g
    still, now = (statement.needed(k_g, T) for T in (Fraction(0), statement.period))
    rows = zip(statement.viscous_min, still, now, strict=True)
    most = min(statement.period * (b - low) / (high - low) for b, low, high in rows)
    return most if most > 0 else None
