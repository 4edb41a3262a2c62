"""dV/dt < 0 within limits: states within them at which it is not, and energies that allow states beyond."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from types import SimpleNamespace
from typing import Any

import numpy as np

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import in_doubles
from tests.statement_fuzz.oracle.arms import mass_above, stacked
from tests.statement_fuzz.oracle.decreasing import States, held, rises_at, rising
from tests.statement_fuzz.oracle.loop import DOUBLES
from tests.statement_fuzz.oracle.region import Objection

POSTURES = 500
CLEARLY = 1.001


@kinds.objections_to("DecreasingNearby")
def nearby(statement: Any, random: Random) -> Objection | None:
    """A posture at which M is not positive definite, a state within the limits, or one that E lets beyond."""
    whole = statement.everywhere
    low = SimpleNamespace(mass=whole.mass, parameters=whole.parameters, low=Fraction(0))
    if (result := mass_above(low, random)) is not None:
        return result
    if (joint := held(whole)) is not None:
        return Objection("false", f"w = 0, e along joint {joint + 1}")
    if (beyond := _beyond(statement, random)) is not None:
        return beyond
    best, at = rising(whole, random, lambda z, one: _near(States(z, one), statement))
    return rises_at(whole, at) if best > -1e-6 else None


def _near(at: States, statement: Any) -> States:
    """The states moved to where the limits are, if they are beyond."""
    for name, limits in (("e", statement.errors), ("w", statement.speeds)):
        if limits:
            most = np.array([float(x) for x in limits]).reshape(-1, *[1] * (np.ndim(at.e) - 1)) * (1 - 1e-12)
            setattr(at, name, np.clip(getattr(at, name), -most, most))
    return at


def _beyond(statement: Any, random: Random) -> Objection | None:
    """A state beyond a limit with no more energy than is said to keep motions within."""
    if statement.energy is None:
        return None
    whole, energy = statement.everywhere, float(statement.energy)
    for k, error in zip(whole.kp, statement.errors, strict=False):
        if float(k) * float(DOUBLES.potential(whole.family, whole.m, CLEARLY * float(error))) < energy:
            return Objection("false", f"e = {CLEARLY * float(error)} at rest")
    n = len(whole.mass)
    shares = np.random.default_rng(random.randrange(10**6)).uniform(
        0, 1, (n + len(whole.parameters), POSTURES)
    )
    q = 2 * np.pi * shares[:n]
    numbers = [
        float(a) + float(b - a) * share for (a, b), share in zip(whole.parameters, shares[n:], strict=True)
    ]
    inverse = np.linalg.inv(stacked(in_doubles(q, numbers).matrix(whole.mass), POSTURES))
    fastest = np.sqrt(2 * energy * np.diagonal(inverse, axis1=1, axis2=2).max(axis=0))
    for speed, most in zip(fastest, statement.speeds, strict=False):
        if speed > CLEARLY * float(most):
            return Objection("false", f"a speed of {speed} where e = 0")
    return None
