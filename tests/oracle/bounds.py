"""Bounds of M(q), C(q, x)y and g(q), of polynomials or of links, at the worst posture that is found.

Body by body, M = Σ m J_vᵀJ_v + J_ωᵀIJ_ω and g = −Σ m J_vᵀγ. The same lines work on doubles and on 60 digits.
"""

from fractions import Fraction

import numpy as np
from mpmath import mp
from scipy.optimize import minimize

from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import CERTAIN, DIGITS, Place, many, quarter_turns, turned, within

KINDS = "MassAbove", "MassBelow", "CoriolisBelow", "GravityBelow"
CHAINS = "ChainAbove", "ChainBelow", "ChainCoriolisBelow", "ChainGravityBelow"
SAMPLES, CLIMBS = 150, 3


class Bound:
    """A bound as a function that is positive where it is broken."""

    def __init__(self, statement):
        self.statement, self.kind = statement, type(statement).__name__
        self.links, self.ranges = getattr(statement, "links", None), getattr(statement, "parameters", ())
        self.n = len(self.links or getattr(statement, "mass", ()) or range(statement.joints))

    def broken(self, q, x, y, free, number):
        """How far the bound is exceeded, and the size of what is compared."""
        bound = number(self.statement.low if self.kind.endswith("Above") else self.statement.high)
        if self.kind.endswith("Above"):
            form, bound = x @ self._mass(q, free, number) @ x, bound * (x @ x)
            return bound - form, abs(bound) + abs(form)
        if "Gravity" in self.kind:
            reached, square = self._gravity(q, free, number), bound**2
        elif "Coriolis" in self.kind:
            reached, square = self._coriolis(q, x, y, free, number), bound**2 * (x @ x) * (y @ y)
        else:
            reached, square = self._mass(q, free, number) @ x, bound**2 * (x @ x)
        return reached @ reached - square, reached @ reached + square

    def _split(self, z):
        n = self.n
        shares = (Fraction(float(t)) for t in np.clip(0.5 + 0.6 * np.sin(z[2 * n :]), 0, 1))
        return z[:n], z[n : 2 * n], [a + (b - a) * t for (a, b), t in zip(self.ranges, shares, strict=True)]

    def excess(self, z):
        """In doubles at angles, a direction and shares of the ranges; C(q, x)y is largest where x = y."""
        q, x, free = self._split(z)
        x = x / np.linalg.norm(x)
        return self.broken(q, x, x, [float(p) for p in free], float)[0]

    def hunt(self, seed):
        """The place of the largest excess found."""
        random, size = np.random.default_rng(seed), 2 * self.n + len(self.ranges)
        starts = random.uniform(-np.pi, np.pi, (SAMPLES, size))
        starts[: SAMPLES // 4] = np.round(starts[: SAMPLES // 4] / (np.pi / 4)) * (np.pi / 4) + 1e-9
        values = np.array([self.excess(z) for z in starts])
        best = starts[np.argsort(-values)[:CLIMBS]]
        size = np.abs(values).max() or 1.0  # arms of any size: BFGS knows of none
        ends = [minimize(lambda z: -self.excess(z) / size, z, method="BFGS").x for z in best]
        return max([*best, *ends], key=self.excess)

    def certainly(self, q, x, y, free):
        """Whether it is broken beyond doubt."""
        if not self.kind.endswith("Above") and self.statement.high < 0:
            return True
        with mp.workdps(DIGITS):
            q, x, y = (np.array([many(t) for t in row]) for row in (q, x, y))
            gap, size = self.broken(q, x, y, [many(p) for p in free], many)
            return bool(gap > CERTAIN * size)

    def _place(self, q, free, number):
        return Place([_sin(a) for a in q], [_cos(a) for a in q], free, number)

    def _mass(self, q, free, number):
        if not self.links:
            return np.array(self._place(q, free, number).matrix(self.statement.mass))
        parts = (m * v.T @ v + w.T @ inertia @ w for m, inertia, v, w in self._bodies(q, number))
        rotors = np.diag([number(link.rotor) for link in self.links])
        return sum(parts, rotors)

    def _coriolis(self, q, x, y, free, number):
        if not self.links:
            return np.array(turned(self._place(q, free, number).symbols(self.statement.mass), x, y))

        def slope(direction):  # with x = y, by the slopes of M along x and along each angle
            step = number(1) / 10**6 if number is float else number(1) / 10**20
            there = [self._mass(q + sign * step * direction, free, number) for sign in (1, -1)]
            return (there[0] - there[1]) / (2 * step)

        units = np.eye(self.n, dtype=int)
        return slope(x) @ x - np.array([x @ slope(unit) @ x for unit in units]) / 2

    def _gravity(self, q, free, number):
        if not self.links:
            place = self._place(q, free, number)
            return np.array([place.value(g) for g in self.statement.gravity])
        fall = np.array([number(t) for t in self.statement.fall])
        torque = -sum(mass * linear.T @ fall for mass, _, linear, _ in self._bodies(q, number))
        return torque[[joint - 1 for joint in self.statement.joints]]

    def _bodies(self, q, number):
        """Mass, inertia and the two Jacobians of each body in the frame of the base."""
        turn, place, joints = np.eye(3) * number(1), np.zeros(3) * number(0), []
        for angle, link in zip(q, self.links, strict=True):
            parts = (link.axis, link.origin, link.turn, link.com, link.inertia)
            axis, origin, turned_by, com, inertia = (
                np.vectorize(number, otypes=[float if number is float else object])(np.array(part))
                for part in parts
            )
            place, turn = place + turn @ origin, turn @ turned_by
            joints.append((turn @ axis, place))
            turn = turn @ _about(axis, angle)
            linear, angular = np.zeros((2, 3, self.n)) * number(0)
            for k, (own, start) in enumerate(joints):
                linear[:, k], angular[:, k] = np.cross(own, place + turn @ com - start), own
            yield number(link.mass), turn @ inertia @ turn.T, linear, angular


def _about(axis, angle):
    """The rotation about a unit vector."""
    x, y, z = axis
    cross = np.array([[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]])
    return np.eye(3, dtype=int) + _sin(angle) * cross + (1 - _cos(angle)) * cross @ cross


def _sin(x):
    return np.sin(x) if isinstance(x, float) else mp.sin(x)


def _cos(x):
    return np.cos(x) if isinstance(x, float) else mp.cos(x)


def extreme(kind, *data):
    """The largest ‖M‖, ‖C(q, x)x‖ or ‖g‖ that is found, or the least eigenvalue of M."""
    bound = Bound(kind(*data, Fraction(0)))
    largest = bound.excess(bound.hunt(1))
    return -largest if bound.kind.endswith("Above") else float(np.sqrt(max(largest, 0)))


@oracle.objections_to(*KINDS, *CHAINS)
def _exceeded(statement, random):
    if type(statement).__name__ == "MassAbove" and (found := _at_right_angles(statement)) is not None:
        return found
    bound = Bound(statement)
    q, x, free = bound._split(bound.hunt(random.getrandbits(32)))
    q, x = ([Fraction(float(t)) for t in row] for row in (q, x))
    if not bound.certainly(q, x, x, free):
        return None
    return Objection(
        "false", f"q = {list(map(float, q))}, x = {list(map(float, x))}, p = {list(map(float, free))}"
    )


def _at_right_angles(statement):
    """Equality, or an M that is not symmetric, exactly."""
    n = len(statement.mass)
    for place in quarter_turns(n, statement.parameters):
        rows = np.array(place.matrix(statement.mass))
        if (rows != rows.T).any() or not _definite(rows - statement.low * np.eye(n, dtype=int)):
            return Objection("false", f"sines, cosines and parameters {[str(x) for x in place.generators]}")
    return None


def _definite(rows):
    """Whether an exact symmetric matrix is positive definite, by elimination."""
    for k in range(len(rows)):
        if rows[k, k] <= 0:
            return False
        for i in range(k + 1, len(rows)):
            rows[i] = rows[i] - rows[k] * (rows[i, k] / rows[k, k])
    return True


@oracle.judges(*KINDS, *CHAINS)
def _exceeds(statement, point):
    bound = Bound(statement)
    letters = {"Gravity": "", "CoriolisBelow": "xy"}.get(bound.kind.removesuffix("Below"), "x")
    letters = "" if "Gravity" in bound.kind else "xy" if bound.kind == "CoriolisBelow" else "x"
    place = within(statement, point, bound.n, letters)
    if place is None:
        return False
    q, free, *vectors = place
    x, y = (*vectors, *vectors)[:2] or ([1] * bound.n,) * 2
    return any(x) and any(y) and bound.certainly(q, x, y, free)
