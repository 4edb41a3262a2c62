"""Arms under dry friction, from stick to slip and back when it happens: no code of lyapcheck.

    M q̈ + C(q,q̇)q̇ = K_p h(e) − K_v h(w) − Bw − φ,   φ_i = f_i sign(w_i) in a slip, |φ_i| ≤ f_i in a stick

Between events each joint sticks or slips one way. Where a slip ends, or a stick can no longer hold, the modes
of the joints at rest are those that agree with the accelerations that follow from them.
"""

from fractions import Fraction
from itertools import product

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

from tests.helpers.state_oracle import Loop

DIGITS = 60
EVENTS = 200
SLACK = 1e-9


class Sticking:
    """An arm of a statement that it comes to rest.

    Args:
        statement: JSON.
        viscous, parameters: of one arm in its ranges.
        dry: f, N·m.
    """

    def __init__(self, statement, viscous, parameters, dry):
        as_rate = {"kind": "Decreasing", "coupling": [], "parameters": [], "viscous": [], "eps0": "0"}
        self.loop = Loop({**statement, **as_rate})
        self.viscous, self.parameters, self.dry = viscous, parameters, dry
        self.n = len(dry)

    def ends(self, start, seconds):
        """(e, w, whether every joint sticks) when the time is up or nothing moves any more."""
        t, y = 0.0, np.array(start)
        w = np.split(y, 3)[2]
        modes = self._modes(y, [(int(np.sign(x)),) if abs(x) > SLACK else (0, 1, -1) for x in w])
        for _ in range(EVENTS):
            if not any(modes) or t >= seconds:
                break
            events = [self._event(i, modes) for i in range(self.n)]
            path = solve_ivp(
                lambda _, x, m=modes: self._slope(x, m), (t, seconds), y, events=events, rtol=1e-9, atol=1e-11
            )
            t, y = path.t[-1], path.y[:, -1]
            choices = []
            for i, times in enumerate(path.t_events):
                if modes[i] and not len(times):
                    choices.append((modes[i],))
                    continue
                y[2 * self.n + i] = 0.0
                # what could not hold any longer does not hold
                choices.append((1, -1) if len(times) and not modes[i] else (0, 1, -1))
            modes = self._modes(y, choices)
        return y[self.n : 2 * self.n], y[2 * self.n :], not any(modes)

    def _event(self, i, modes):
        """A slip ends, or a stick cannot hold."""

        def when(t, y):
            return y[2 * self.n + i] if modes[i] else self.dry[i] + SLACK - abs(self._held(y, modes)[1][i])

        when.terminal, when.direction = True, -modes[i]
        if not modes[i]:
            when.direction = -1
        return when

    def _slope(self, y, modes):
        w = np.split(y, 3)[2]
        return np.concatenate([w, -w, self._held(y, modes)[0]])

    def _held(self, y, modes):
        """ẇ and φ: those that slip have φ, those that stick have ẇ = 0."""
        q, e, w = np.split(y, 3)
        stuck = np.array([mode == 0 for mode in modes])
        friction = self.dry * np.array(modes, dtype=float)
        free = self.loop.acceleration(q, e, w, self.viscous, -friction, self.parameters)
        if stuck.any():
            unit = np.eye(self.n)[stuck]
            moved = self.loop.acceleration(q, e, w, self.viscous, -friction, self.parameters)
            inverse = np.array(
                [
                    moved - self.loop.acceleration(q, e, w, self.viscous, -friction - x, self.parameters)
                    for x in unit
                ]
            ).T
            friction[stuck] = np.linalg.solve(inverse[stuck], free[stuck])
            free = free - inverse @ friction[stuck]
            free[stuck] = 0.0
        return free, friction

    def _modes(self, y, choices):
        """The first modes of some choices that agree with what follows from them."""
        for modes in product(*choices):
            change, friction = self._held(y, modes)
            if all(
                abs(friction[i]) <= self.dry[i] + SLACK if modes[i] == 0 else change[i] * modes[i] >= -SLACK
                for i in range(self.n)
                if len(choices[i]) > 1
            ):
                return modes
        raise AssertionError("no modes agree")  # there are some wherever M ≻ 0


def holds_beyond(statement, kind, e):
    """Whether at 60 digits some |e_i| is beyond its bound, and torques within theirs hold the arm there."""
    with mpmath.workdps(DIGITS):
        limit = [_number(x) for x in statement[{"Resting": "torque", "ComesToRest": "dry"}[kind]]]
        kp = [_number(x) for x in statement["kp"]]
        beyond = any(
            bound is not None and abs(mpmath.mpf(float(x))) > _number(bound)
            for x, bound in zip(e, statement["errors"], strict=True)
        )
        held = all(abs(k * _h(statement, x)) <= f for k, x, f in zip(kp, e, limit, strict=True))
        return beyond and held


def farthest(statement, kind):
    """For each joint the largest error found at which it can be held, with the others at their goal."""
    sizes = np.concatenate([np.linspace(0, 6, 20_001), np.geomspace(6, 100, 500)])
    limits = statement[{"Resting": "torque", "ComesToRest": "dry"}[kind]]
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
