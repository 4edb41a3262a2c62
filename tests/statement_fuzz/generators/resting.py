"""Where an arm may rest: errors near those at which h meets the torque, and torques that nothing meets."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from mpmath import mp

from tests.statement_fuzz.generators import FALSE, UNPROVABLE, Made, generates
from tests.statement_fuzz.generators.controlled import FAMILIES, gains
from tests.statement_fuzz.oracle.arm import many
from tests.statement_fuzz.oracle.loop import many_digits
from tests.statement_fuzz.subject import Resting

SHARES = (Fraction(0), Fraction(1, 1000), Fraction(1, 3), Fraction(9, 10), Fraction(999, 1000))
LARGE = (Fraction(1), Fraction(1001, 1000), Fraction(3, 2), Fraction(40))
STEPS = (Fraction(1, 5), Fraction(1, 1000), Fraction(1, 10**7), Fraction(1, 10**12))


def _reached(family: str, m: int | None, share: Fraction) -> Fraction:
    """About the error at which h is this share of the stiffness, where h still rises."""
    low, high = Fraction(0), Fraction(4000)
    with mp.workdps(30):
        of = many_digits()
        for _ in range(70):
            middle = (low + high) / 2
            below = of.h(family, m, many(min(middle, Fraction(30)))) < many(share)
            low, high = (middle, high) if below else (low, middle)
    return low.limit_denominator(10**15)


@generates("Resting", 0.8)
def resting(random: Random) -> Made:
    """Bounds of the errors: none, far, near what h allows, or too small."""
    n = random.choice((1, 1, 2, 3))
    family, m = random.choice(FAMILIES)
    kp = gains(random, n)
    torque, errors, truth = [], [], None
    for k in kp:
        share = random.choice(SHARES if random.random() < 0.8 else LARGE)
        torque.append(share * k)
        if random.random() < 0.15:
            errors.append(None)
            continue
        error = _reached(family, m, min(share, Fraction(999, 1000)))
        step, kind = random.choice(STEPS), random.random()
        if share >= 1:
            errors.append(random.choice((Fraction(1), Fraction(10**6))))
        elif kind < 0.6:
            errors.append(error + step)
        elif error > step:
            errors.append(error - step)
            truth = FALSE
        else:
            errors.append(Fraction(0))
    if random.random() < 0.05:
        family, m, truth = *random.choice((("hyperbolic", None), ("linear", None), ("tanh", 2))), UNPROVABLE
    return Made(Resting(family, m, kp, tuple(torque), tuple(errors)), "states of rest", truth)
