"""Postures that refute a bound of M, C or g, sought in doubles and judged at 60 digits: no code of lyapcheck.

M and g come from the polynomials of a statement or from its links, body by body:
M = Σ m J_vᵀJ_v + J_ωᵀIJ_ω and g = −Σ m J_vᵀγ. The same few lines work on doubles and on mpmath's numbers.
"""

from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
from scipy.optimize import minimize

DIGITS = 60
SAMPLES, CLIMBS = 150, 3
KINDS = {
    "MassAbove", "MassBelow", "CoriolisBelow", "GravityBelow", "ChainAbove", "ChainBelow",
    "ChainGravityBelow", "ChainCoriolisBelow"
}  # fmt: skip


class Bound:
    """A bound as a function that is positive where it is broken, from the JSON of a statement."""

    def __init__(self, statement):
        self.statement, self.kind = statement, statement["kind"]
        self.links, self.parameters = statement.get("links"), statement.get("parameters", [])
        self.n = len(self.links or statement.get("mass") or range(statement.get("joints", 0)))

    def excess(self, x, number=float):
        """How far the bound is exceeded at q, a direction and shares of the ranges, (2n + parameters,)."""
        n = self.n
        q, a = x[:n], x[n : 2 * n]
        ends = [[_in(number, end) for end in pair] for pair in self.parameters]
        half = number(1) / 2
        free = [
            low + (high - low) * (half + half * _sin(t))
            for (low, high), t in zip(ends, x[2 * n :], strict=True)
        ]
        bound = _in(number, self.statement["low" if self.kind.endswith("Above") else "high"])
        if "Gravity" in self.kind:
            g = self._gravity(q, free, number)
            return g @ g - bound**2
        a = a / _root(a @ a)
        if "Coriolis" in self.kind:
            # symmetric in its two vectors, ‖C(q, x)y‖ is largest where they are the same
            turned = self._coriolis(q, free, a, number)
            return turned @ turned - bound**2
        moved = self._mass(q, free, number) @ a
        return bound - a @ moved if self.kind.endswith("Above") else moved @ moved - bound**2

    def hunt(self, seed=1):
        """The place of the largest excess found, and that."""
        random = np.random.default_rng(seed)
        size = 2 * self.n + len(self.parameters)
        starts = random.uniform(-np.pi, np.pi, (SAMPLES, size))
        best = sorted(starts, key=lambda x: -self.excess(x))[:CLIMBS]
        ends = [minimize(lambda x: -self.excess(x), x, method="BFGS").x for x in best]
        top = max([*best, *ends], key=self.excess)
        return top, self.excess(top)

    def confirmed(self, x):
        """Whether the bound is broken there, at 60 digits."""
        with mpmath.workdps(DIGITS):
            return self.excess(np.array([mpmath.mpf(float(t)) for t in x]), mpmath.mpf) > 0

    def _mass(self, q, free, number):
        if not self.links:
            return np.array(
                [[_sum(entry, q, free, number) for entry in row] for row in self.statement["mass"]]
            )
        total = np.zeros((self.n, self.n)) * number(0)
        for mass, inertia, linear, angular in self._bodies(q, number):
            total = total + mass * linear.T @ linear + angular.T @ inertia @ angular
        return total

    def _coriolis(self, q, free, x, number):
        """C(q, x)x by the slopes of M along x and along each angle."""

        def slope(direction):
            if number is float:
                return np.imag(self._mass(q + 1e-30j * direction, free, number)) / 1e-30
            step = number(10) ** -20
            there = [self._mass(q + sign * step * direction, free, number) for sign in (1, -1)]
            return (there[0] - there[1]) / (2 * step)

        along = np.array([x @ slope(unit) @ x for unit in np.eye(self.n)])
        return slope(x) @ x - along / 2

    def _gravity(self, q, free, number):
        if not self.links:
            return np.array([_sum(entry, q, free, number) for entry in self.statement["gravity"]])
        fall = np.array([_in(number, t) for t in self.statement["fall"]])
        torque = -sum(mass * linear.T @ fall for mass, _, linear, _ in self._bodies(q, number))
        return torque[[joint - 1 for joint in self.statement["joints"]]]

    def _bodies(self, q, number):
        """Mass, inertia and the two Jacobians of each body in the frame of the base."""
        zero = np.zeros((3, self.n)) * q[0]  # complex where slopes are taken along complex steps
        turn, place, joints = np.eye(3) * number(1), np.zeros(3) * number(0), []
        for i, link in enumerate(self.links):
            read = {
                name: np.vectorize(lambda text: _in(number, text), otypes=[object])(np.array(link[name]))
                for name in ("axis", "origin", "turn", "com", "inertia")
            }
            if number is float:
                read = {name: value.astype(float) for name, value in read.items()}
            place = place + turn @ read["origin"]
            turn = turn @ read["turn"]
            joints.append((turn @ read["axis"], place))
            turn = turn @ _about(read["axis"], q[i])
            centre = place + turn @ read["com"]
            linear, angular = zero.copy(), zero.copy()
            for k, (axis, origin) in enumerate(joints):
                linear[:, k], angular[:, k] = np.cross(axis, centre - origin), axis
            yield _in(number, link["mass"]), turn @ read["inertia"] @ turn.T, linear, angular


def _about(axis, angle):
    """The rotation about a unit vector."""
    x, y, z = axis
    cross = np.array([[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]])
    return np.eye(3) + _sin(angle) * cross + (1 - _cos(angle)) * cross @ cross


def _sum(entry, q, free, number):
    base = [*map(_sin, q), *map(_cos, q), *free]
    total = number(0)
    for powers, value in entry:
        term = _in(number, value)
        for x, k in zip(base, powers, strict=True):
            term *= x**k
        total += term
    return total


@cache
def _in(number, text):
    value = Fraction(text)
    return number(value.numerator) / number(value.denominator)


def _sin(x):
    return mpmath.sin(x) if isinstance(x, mpmath.mpf) else np.sin(x)


def _cos(x):
    return mpmath.cos(x) if isinstance(x, mpmath.mpf) else np.cos(x)


def _root(x):
    return mpmath.sqrt(x) if isinstance(x, mpmath.mpf) else np.sqrt(x)
