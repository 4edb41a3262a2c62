"""Bounds of M(q), of its Coriolis matrix and of gravity: near the extreme that a search of its own finds."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.robots import Robot, gravity, ranges, robot, scaled, size
from tests.statement_fuzz.oracle.arms import (
    least_eigenvalue,
    size_of_gravity,
    size_of_mass,
    size_of_turning,
    start,
)
from tests.statement_fuzz.oracle.climb import climbed
from tests.statement_fuzz.subject import CoriolisBelow, GravityBelow, MassAbove, MassBelow

FAR = (Fraction(1, 100), Fraction(1, 20), Fraction(1, 5), Fraction(1, 2))
NEAR = (Fraction(1, 1000), Fraction(1, 10**6))


def planted(random: Random, extreme: float, easy: bool) -> tuple[Fraction, str | None]:
    """A bound beyond the largest value that was found, or one that this value breaks.

    Close bounds cost a whole budget of boxes: there are few of them where postures are met only roughly.
    """
    kind = random.random()
    share = random.choice(NEAR) if kind < (0.2 if easy else 0.01) else random.choice(FAR[0 if easy else 2 :])
    if random.random() < 0.5:
        return Fraction(extreme) + share * abs(Fraction(extreme)), None
    return Fraction(extreme) - share * abs(Fraction(extreme)), FALSE


def _largest(random: Random, function: Any, n: int, parameters: int) -> float:
    return climbed(function, start(n, parameters), random)[0]


def _found(random: Random, arm: Robot, function: Any) -> float:
    return _largest(random, lambda z: function(arm.mass, arm.parameters, z), arm.n, len(arm.parameters))


def _easy(arm: Robot) -> bool:
    return arm.n == 1 and not arm.parameters


@generates("MassAbove", 1.2)
def above(random: Random) -> Made:
    """M ≻ low·I, mostly with low near the least eigenvalue."""
    arm = robot(random)
    kind = random.random()
    if kind < 0.35:
        truth = {True: TRUE, False: FALSE, None: None}[arm.definite]
        return Made(MassAbove(arm.mass, arm.parameters, Fraction(0)), "M above 0", truth)
    if kind < 0.42 and arm.n == 2:
        mass = (arm.mass[0], (scaled(arm.mass[1][0], Fraction(3, 2)), arm.mass[1][1]))
        return Made(MassAbove(mass, arm.parameters, Fraction(0)), "M, not symmetric perhaps")
    least = -_found(random, arm, lambda *at: -least_eigenvalue(*at))
    bound, truth = planted(random, -least, _easy(arm))
    if bound > 0:
        return Made(MassAbove(arm.mass, arm.parameters, Fraction(0)), "M above 0", truth)
    return Made(MassAbove(arm.mass, arm.parameters, -bound), "M above a bound", truth)


@generates("MassBelow", 1)
def below(random: Random) -> Made:
    """‖M‖ ≤ high, with high the sum of all coefficients, near the largest value, or below 0."""
    arm = robot(random)
    rows = [sum((size(entry, arm.parameters) for entry in row), Fraction(0)) for row in arm.mass]
    kind = random.random()
    if kind < 0.2:
        return Made(MassBelow(arm.mass, arm.parameters, max(rows)), "M below the sum of its terms", TRUE)
    largest = _found(random, arm, size_of_mass)
    if kind < 0.3:
        high = random.choice((Fraction(0), Fraction(-1), -max(rows)))
        return Made(
            MassBelow(arm.mass, arm.parameters, high), "M below nothing", FALSE if largest > 0 else None
        )
    bound, truth = planted(random, largest, _easy(arm))
    return Made(MassBelow(arm.mass, arm.parameters, bound), "M below a bound", truth)


@generates("CoriolisBelow", 1)
def turning(random: Random) -> Made:
    """‖C(q, x)y‖ ≤ high ‖x‖ ‖y‖ near the largest value, or high ≤ 0."""
    arm = robot(random)
    largest = _found(random, arm, size_of_turning)
    if random.random() < 0.15:
        high = random.choice((Fraction(0), Fraction(-1), -Fraction(largest)))
        truth = FALSE if largest > 0 or high < 0 else TRUE
        return Made(CoriolisBelow(arm.mass, arm.parameters, high), "C below nothing", truth)
    bound, truth = planted(random, largest, _easy(arm))
    return Made(
        CoriolisBelow(arm.mass, arm.parameters, bound), "C below a bound", truth if largest > 0 else None
    )


@generates("GravityBelow", 1)
def weight(random: Random) -> Made:
    """√Σ g_i² ≤ high near the largest value; no gravity at all; a bound of 0."""
    n, parameters = random.choice((1, 1, 2)), ranges(random)
    torques = gravity(random, n, len(parameters))
    factor = random.choice((*[Fraction(1)] * 8, Fraction(10**9), Fraction(1, 10**30)))
    torques = tuple(scaled(g, factor) for g in torques)
    sizes = sum((size(g, parameters) for g in torques), Fraction(0))
    if random.random() < 0.2:
        return Made(GravityBelow(n, torques, parameters, sizes), "gravity below the sum of its terms", TRUE)
    largest = _largest(random, lambda z: size_of_gravity(torques, n, parameters, z), n, len(parameters))
    if random.random() < 0.1:
        truth = FALSE if largest > 0 else TRUE if not sizes else None
        return Made(GravityBelow(n, torques, parameters, Fraction(0)), "no gravity", truth)
    bound, truth = planted(random, largest, n == 1 and not parameters)
    return Made(
        GravityBelow(n, torques, parameters, max(bound, Fraction(0))),
        "gravity below a bound",
        truth if largest > 0 else None,
    )
