"""Gains on a computer: how it runs them, what shows (S), and for which periods (S) holds."""

from __future__ import annotations

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
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.robots.dynamics import Chain


def require_sampled(loop: LoopRecord, angles: str = "unwrapped") -> LoopRecord:
    """A loop of which (S) speaks, with the angles as readings give them.

    Raises:
        ValueError: (S) does not speak of such a loop; it says what to do.
    """
    period, taps = loop.period or Fraction(0), loop.filter
    few = isinstance(taps, tuple) and 1 <= len(taps) <= MOST_TAPS
    cut = f"must be 1 to {MOST_TAPS} weights of differences; cut one off that never ends"
    whole = loop.delay in range(MOST_DELAY + 1)
    rules: dict[str, tuple[object, bool, str]] = {
        "period": (loop.period, period > 0, "must be positive; give seconds"),
        "longest": (loop.longest, loop.stretch >= 1, "is below the period; give the longest interval"),
        "delay": (loop.delay, whole, f"must be whole samples to {MOST_DELAY}; round it up"),
        "filter": (taps, few, cut),
        "velocity": (
            loop.velocity,
            loop.velocity == "difference",
            'needs the inertia and is not covered; take velocity = "difference"',
        ),
        "angles": (
            angles,
            angles == "unwrapped",
            "jump by a turn and are not covered; add the turns, as |Δq| < π in a sample",
        ),
    }
    for name, (value, fits, rule) in rules.items():
        if not fits:
            raise ValueError(f"{name} = {value} {rule}")
    return loop


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
