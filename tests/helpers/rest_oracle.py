"""Where torques within their bounds hold an arm beside its goal: no code of lyapcheck."""

from fractions import Fraction

import mpmath
import numpy as np

DIGITS = 60


def holds_beyond(statement, e):
    """Whether at 60 digits some |e_i| is beyond its bound, and torques within theirs hold the arm there."""
    with mpmath.workdps(DIGITS):
        limit = [_number(x) for x in statement["torque"]]
        kp = [_number(x) for x in statement["kp"]]
        beyond = any(
            bound is not None and abs(mpmath.mpf(float(x))) > _number(bound)
            for x, bound in zip(e, statement["errors"], strict=True)
        )
        held = all(abs(k * _h(statement, x)) <= f for k, x, f in zip(kp, e, limit, strict=True))
        return beyond and held


def farthest(statement):
    """For each joint the largest error found at which it can be held, with the others at their goal."""
    sizes = np.concatenate([np.linspace(0, 6, 20_001), np.geomspace(6, 100, 500)])
    limits = statement["torque"]
    for joint, (k, f) in enumerate(zip(statement["kp"], limits, strict=True)):
        held = [x for x in sizes if float(Fraction(k)) * abs(float(_h(statement, x))) <= float(Fraction(f))]
        yield np.eye(len(limits))[joint] * max(held) * (1 - 1e-12)


def _number(text):
    value = Fraction(text)
    return mpmath.mpf(value.numerator) / value.denominator


def _h(statement, x):
    x = mpmath.mpf(float(x))
    if statement["family"] == "arctan":
        return mpmath.atan(x)
    m = statement["m"] or 1
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    return s ** (2 * m - 1) * c / (1 + s ** (2 * m))
