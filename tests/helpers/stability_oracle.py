"""Arms under the torque of a theorem of stability, moved and linearised: no code of lyapcheck.

    M q̈ + C(q,q̇)q̇ + Bq̇ + g = τ,   e = q_d − q,   w = q̇ − q̇_d,   ė = −w

with τ as the tree of the statement says. The same lines work on doubles and on mpmath's numbers.
"""

from copy import copy
from fractions import Fraction
from operator import itemgetter

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

DIGITS = 60
NEAR, FAR = 0.6, 1e3
"""rad and rad/s: every motion comes nearer than the one in the time that tests give it, none goes so far."""


class System:
    """The system of an argument on one arm.

    Args:
        argument: JSON.
        arm: mass, potential and viscous, JSON.
        gains: the diagonal of each gain, by name.
        swing: amplitudes, rad, and angular frequencies, rad/s, of q_d; it stands still without.
    """

    def __init__(self, argument, arm, gains, swing=None):
        self.torque = argument["system"]["torque"]
        self.functions = argument["system"]["functions"]
        self.swing = swing
        self.n = n = len(arm["mass"])
        rows = [entry for row in arm["mass"] for entry in row] + [arm["potential"]]
        rows += [_slope(rows[-1], k, n) for k in range(n)]
        rows += [_slope(entry, k, n) for k in range(n) for entry in rows[: n * n]]
        self.powers = sorted({tuple(powers) for row in rows for powers, _ in row})
        self.rows = [{tuple(powers): value for powers, value in row} for row in rows]
        self.coefficients = {}
        self.diagonals = {**gains, "B": arm["viscous"]}

    def rate(self, t, state, number=float):
        """d/dt of (e, w)."""
        e, w = np.split(np.asarray(state), 2)
        desired, speed, change = self._desired(t, number)
        q, rates = desired - e, w + speed
        M, g, slopes = self._at(q, number)
        own = {
            "e": e, "w": w, "g": g, "gd": self._at(desired, number)[1], "dqd": speed, "ddqd": change, "M": M,
            "C": _christoffel(slopes, w), "D": _christoffel(slopes, speed),
        }  # fmt: skip
        own["dg"] = g - own["gd"]
        own |= {name: np.array([_in(number, x) for x in row]) for name, row in self.diagonals.items()}
        for f in self.functions:
            own[f["name"]] = np.array([_value(f["member"], x) for x in own[f["of"]]])
        push = _vector(self.torque, own, number)
        push = push - _christoffel(slopes, rates) @ rates - own["B"] * rates - g
        return np.concatenate([-w, _solved(M, push) - change])

    def grows(self):
        """Whether, where q_d stands still, the linearisation at the origin grows, at 60 digits."""
        still = copy(self)
        still.swing = None
        with mpmath.workdps(DIGITS):
            n, step = 2 * self.n, mpmath.mpf(10) ** -20
            columns = []
            for k in range(n):
                moved = [np.array([sign * step * (i == k) for i in range(n)]) for sign in (1, -1)]
                ends = [still.rate(mpmath.mpf(0), x, mpmath.mpf) for x in moved]
                columns.append((ends[0] - ends[1]) / (2 * step))
            values, _ = mpmath.eig(mpmath.matrix([list(row) for row in np.array(columns).T]))
            return any(mpmath.re(x) > mpmath.mpf(10) ** -12 for x in values)

    def stays_away(self, seconds, runs=1, seed=5):
        """Whether some motion from a random start is not near the origin at the end."""
        random = np.random.default_rng(seed)
        for _ in range(runs):
            start = np.concatenate([random.uniform(-3, 3, self.n), random.uniform(-4, 4, self.n)])
            path = solve_ivp(self.rate, (0, seconds), start, "LSODA", rtol=1e-6, atol=1e-8, events=_lost)
            if not path.success or np.abs(path.y[:, -1]).max() > NEAR:
                return True
        return False

    def _desired(self, t, number):
        still = np.array([number(1) * (k + 1) / 2 for k in range(self.n)])
        if self.swing is None:
            return still, 0 * still, 0 * still
        size, fast = (np.array([number(x) for x in row]) for row in self.swing)
        s, c = (np.array([f(x * t) for x in fast]) for f in (_sin, _cos))
        return still + size * s, size * fast * c, -size * fast**2 * s

    def _at(self, q, number):
        """M, g and ∂M/∂q_k (k, i, j) at a posture."""
        if number not in self.coefficients:
            table = [[_in(number, row.get(powers, "0")) for row in self.rows] for powers in self.powers]
            self.coefficients[number] = np.array(table)
        n = self.n
        base = np.array([*map(_sin, q), *map(_cos, q)])
        values = np.prod(base ** np.array(self.powers), axis=1) @ self.coefficients[number]
        g = values[n * n + 1 : n * n + 1 + n]
        return values[: n * n].reshape(n, n), g, values[n * n + 1 + n :].reshape(n, n, n)


def _lost(t, state):
    return FAR - np.abs(state).max()


_lost.terminal = True


def holds(relation, numbers):
    """Whether a condition holds for numbers, exactly."""
    left, right = (_number(relation[side], numbers) for side in ("left", "right"))
    return left < right if relation["operator"] == "<" else left <= right


def _number(tree, numbers):
    kind, *rest = tree
    if kind in ("num", "var"):
        return Fraction(rest[0]) if kind == "num" else numbers[rest[0]]
    if kind == "pow":
        return _number(rest[0], numbers) ** rest[1]
    first, *others = (_number(part, numbers) for part in rest)
    for x in others:
        first = {"add": first + x, "mul": first * x, "div": first / x if x else None}[kind]
    return -first if kind == "neg" else first


def _vector(tree, own, number):
    kind, *rest = tree
    if kind == "vec":
        return own[rest[0]]
    if kind == "sum":
        return sum(_vector(part, own, number) for part in rest)
    if kind == "scale":
        assert rest[0][0] == "num"
        return _in(number, rest[0][1]) * _vector(rest[1], own, number)
    assert kind == "apply"
    return _applied(rest[0], own, _vector(rest[1], own, number))


def _applied(matrix, own, vector):
    kind, *rest = matrix
    if kind == "sum":
        return sum(_applied(part, own, vector) for part in rest)
    return own[rest[0]] * vector if kind == "diag" else own[rest[0]] @ vector


def _value(member, x):
    """The function of a member, or one of the class where there is none: x/√(1 + x²)."""
    if member is None:
        return x / (1 + x * x) ** (0.5 if isinstance(x, float) else mpmath.mpf(1) / 2)
    kind, *rest = member["value"]
    if kind == "atan":
        return mpmath.atan(x) if isinstance(x, mpmath.mpf) else np.arctan(x)
    m = rest[0]
    assert kind == "h"
    if isinstance(x, mpmath.mpf):
        s, c = mpmath.sinh(x), mpmath.cosh(x)
    else:
        s, c = np.sinh(np.clip(x, -100 / m, 100 / m)), np.cosh(np.clip(x, -100 / m, 100 / m))
    return s ** (2 * m - 1) * c / (1 + s ** (2 * m))


def _christoffel(slopes, x):
    """C(q, x)_ij = ½ Σ_k (∂_k M_ij + ∂_j M_ik − ∂_i M_jk) x_k."""
    turned = np.transpose(slopes, (1, 2, 0)) + np.transpose(slopes, (1, 0, 2)) - slopes
    return turned @ x / 2


def _slope(terms, k, n):
    """∂/∂q_k of a polynomial in the sines and then the cosines."""
    found = {}
    for powers, value in terms:
        for place, other, sign in ((k, n + k, 1), (n + k, k, -1)):
            if powers[place]:
                less = list(powers)
                less[place] -= 1
                less[other] += 1
                key = tuple(less)
                found[key] = found.get(key, 0) + sign * powers[place] * Fraction(value)
    return sorted(((key, str(value)) for key, value in found.items()), key=itemgetter(0))


def _solved(M, x):
    if M.dtype != object:
        return np.linalg.solve(M, x)
    return np.array(list(mpmath.lu_solve(mpmath.matrix(M.tolist()), mpmath.matrix(x.tolist()))))


def _in(number, text):
    value = Fraction(text)
    return number(value.numerator) / number(value.denominator)


def _sin(x):
    return mpmath.sin(x) if isinstance(x, mpmath.mpf) else np.sin(x)


def _cos(x):
    return mpmath.cos(x) if isinstance(x, mpmath.mpf) else np.cos(x)
