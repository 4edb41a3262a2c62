"""Errors within bounds from times on, as the search finds them and changed; motions that friction ends."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.resting import resting
from tests.statement_fuzz.generators.robots import robot, scaled
from tests.statement_fuzz.generators.settling import factored
from tests.statement_fuzz.motions import UNDISTURBED, found
from tests.statement_fuzz.oracle.phases import worst
from tests.statement_fuzz.subject import ComesToRest, DiesOut, StaysWithin

BETTER = (Fraction(999, 1000), Fraction(9, 10), Fraction(1, 2), Fraction(1, 20))
WORSE = (Fraction(1001, 1000), Fraction(11, 10), Fraction(2), Fraction(20))
BELOW = Fraction(9, 10)
"""Of the largest error that is simulated."""
LEAST = Fraction(1, 10**6)
LATEST = 20.0
"""s: the oracle's motions are followed so far."""


@generates("StaysWithin", 0.1)
def stays_within(random: Random) -> Made:
    """Errors and times, true, larger, or with one number better than what was found."""
    statement, _ = found(random.choice(UNDISTURBED), True)
    if not isinstance(statement, StaysWithin):
        raise TypeError("the search finds no phases")
    kind, better, worse = random.random(), random.choice(BETTER), random.choice(WORSE)
    if kind < 0.15:
        return Made(statement, "a settling time in phases", TRUE)
    if kind < 0.45:
        return _below_what_is_seen(random, statement)
    if kind < 0.6:
        times = ((t * better, errors) for t, errors in statement.within)
        return Made(replace(statement, within=tuple(times), after=None), "earlier times")
    if kind < 0.75 and statement.after is not None:
        after = statement.after
        sizes = tuple(x * better for x in after.sizes)
        changed = random.choice((DiesOut(sizes, after.scale), DiesOut(after.sizes, after.scale * better)))
        return Made(replace(statement, after=changed), "errors that die out faster")
    if kind < 0.9:
        name, factor, least = random.choice(
            (
                ("errors_at_start", worse, Fraction(0)),
                ("rates_at_start", worse, LEAST),
                ("kp", better, Fraction(0)),
                ("viscous", better, Fraction(0)),
                ("parameters", better, Fraction(0)),
                ("kv", better, Fraction(0)),
            )
        )
        values = tuple(factored(x, factor, least) for x in getattr(statement, name))
        return Made(replace(statement, **{name: values}), f"other {name}")
    mass = tuple(tuple(scaled(entry, worse) for entry in row) for row in statement.mass)
    return Made(replace(statement, mass=mass), "a heavier arm")


def _below_what_is_seen(random: Random, statement: StaysWithin) -> Made:
    """One bound below what a motion of the oracle has from its time on."""
    rows = list(statement.within)
    k = random.choice([k for k, (time, _) in enumerate(rows) if float(time) < LATEST])
    time, _ = rows[k]
    seen = worst(statement, float(time), random)
    rows[k] = (time, tuple(Fraction(x).limit_denominator(10**9) * BELOW for x in seen))
    return Made(replace(statement, within=tuple(rows)), "errors below those of a motion", FALSE)


@generates("ComesToRest", 0.2)
def comes_to_rest(random: Random) -> Made:
    """States of rest as bounded elsewhere, for an arm that mostly is one."""
    rest = resting(random)
    still = rest.statement
    n, kind = len(still.kp), random.random()
    arm = robot(random, n, kind < 0.9, plain=True)
    each = tuple(Fraction(random.choice((1, 2, 5)), random.choice((1, 2, 4))) for _ in range(n))
    friction = tuple((x, x * random.choice((1, 1, 2))) for x in each)
    statement = ComesToRest(
        arm.mass, friction, (), still.family, still.m, still.kp, each[::-1], still.torque, still.errors
    )
    if kind >= 0.95:
        driving = (-each[0], -each[0]), *friction[1:]
        return Made(replace(statement, viscous=driving), "friction that drives", FALSE)
    return Made(statement, "motions that dry friction ends", FALSE if kind >= 0.9 else rest.truth)
