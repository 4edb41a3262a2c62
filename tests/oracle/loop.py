"""States at which V does not fall: the closed loop (11), V of (13) and dV/dt by a step along the motion.

    V = ½ yᵀM(q)y + Σ k_pi U(e_i),   y = w − εΛh(e),   ε = ε₀/(1 + ‖e‖)
    q̇ = w,   ė = −w,   Mẇ = K_p h(e) − K_v h(w) − Bw − C(q, w)w

V is analytic along the motion, so that an imaginary step s gives dV/dt = Im V(x + isẋ)/s without a
difference: no rule of differentiation is used but that of sines and cosines in Christoffel symbols.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import isinf
from random import Random
from types import SimpleNamespace
from typing import Any

import numpy as np
from mpmath import mp
from scipy.optimize import minimize

from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.inertia import MassAbove
from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import CERTAIN, DIGITS, Place, dot, many, solved, times, turned, within
from tests.oracle.numbers import Undefined, Unsure, ends
from tests.oracle.trees import Evaluation

FARTHEST = 15.0
"""Where sinh is taken no farther in doubles: h_m is 1 beyond, but for its last digits."""


@dataclass(frozen=True)
class Arithmetic:
    """Functions of real and complex numbers, how a fraction is taken, and a step that leaves no trace."""

    functions: Any
    number: Any
    imaginary: Any

    def h(self, family, m, x):
        """h(x)."""
        f = self.functions
        if family == "arctan":
            return f.atan(x)
        if family == "algebraic":
            return x / f.sqrt(1 + x * x)
        if family == "tanh" or m == 1:
            return f.tanh(x)
        s, c = f.sinh(x), f.cosh(x)
        return s ** (2 * m - 1) * c / (1 + s ** (2 * m))

    def potential(self, family, m, x):
        """U(x), U' = h, U(0) = 0."""
        f = self.functions
        if family == "arctan":
            return x * f.atan(x) - f.log(1 + x * x) / 2
        if family == "algebraic":
            return f.sqrt(1 + x * x) - 1
        if family == "tanh" or m == 1:
            return f.log(f.cosh(x))
        return f.log(1 + f.sinh(x) ** (2 * m)) / (2 * m)


def _double(x):
    return float(x) if isinstance(x, Fraction) else x


DOUBLES = Arithmetic(np, _double, 1e-100j)


def many_digits():
    """In the digits that are in force."""
    return Arithmetic(mp, many, mp.mpc(0, mp.mpf(10) ** -DIGITS))


@dataclass(frozen=True)
class Loop:
    """One arm under one controller; numbers are fractions, or arrays of doubles."""

    mass: tuple
    viscous: Any
    parameters: Any
    family: str
    m: int | None
    kp: Any
    kv: Any
    eps0: Any
    coupling: Any = ()

    def at(self, q, of):
        """The place of angles, which may be complex."""
        f = of.functions
        own = [of.number(p) for p in self.parameters]
        return Place([f.sin(a) for a in q], [f.cos(a) for a in q], own, of.number)

    def energy(self, q, e, w, of):
        """V."""
        h = [of.h(self.family, self.m, x) for x in e]
        eps = of.number(self.eps0) / (1 + of.functions.sqrt(dot(e, e)))
        weights = [of.number(c) for c in self.coupling] or [1] * len(e)
        y = [a - eps * c * b for a, b, c in zip(w, h, weights, strict=True)]
        stored = sum(
            of.number(k) * of.potential(self.family, self.m, x) for k, x in zip(self.kp, e, strict=True)
        )
        return dot(y, times(self.at(q, of).matrix(self.mass), y)) / 2 + stored

    def acceleration(self, q, e, w, of):
        """ẇ without disturbance."""
        return solved(self.at(q, of).matrix(self.mass), self.force(q, e, w, of))

    def force(self, q, e, w, of):
        """Mẇ without disturbance."""
        turning = turned(self.at(q, of).symbols(self.mass), w, w)
        far = [np.clip(x, -FARTHEST, FARTHEST) if of is DOUBLES and self.m else x for x in w]
        return [
            of.number(kp) * of.h(self.family, self.m, a)
            - of.number(kv) * of.h(self.family, self.m, near)
            - of.number(b) * x
            - c
            for kp, kv, b, a, near, x, c in zip(
                self.kp, self.kv, self.viscous, e, far, w, turning, strict=True
            )
        ]

    def rate(self, q, e, w, of):
        """dV/dt; e must not be 0."""
        step, a = of.imaginary, self.acceleration(q, e, w, of)
        moved = self.energy(
            [x + step * v for x, v in zip(q, w, strict=True)],
            [x - step * v for x, v in zip(e, w, strict=True)],
            [x + step * v for x, v in zip(w, a, strict=True)],
            of,
        )
        return moved.imag / step.imag

    def exact_rate(self, q, e, w):
        """dV/dt at one state in many digits."""
        of = many_digits()
        return self.rate(*([many(x) for x in part] for part in (q, e, w)), of)


SAMPLES, ROUNDS, STEPS, BEST = 4_000, 10, 40, 4
LARGEST = 9.0
"""The logarithm of the largest rates: beyond them, doubles lose what is left when C(q, w)w cancels."""
ALLOWED = Fraction(1, 1000)
"""ε₀ at which V should fall under any damping, as a share of what is thought of as small."""


def _loop_of(s, viscous, parameters):
    """One arm within the ranges of a statement."""
    return Loop(s.mass, viscous, parameters, s.family, s.m, s.kp, s.kv, s.eps0, s.coupling)


class States:
    """Columns of a search as states, and as arms within their ranges."""

    def __init__(self, z, statement):
        n = len(statement.mass)
        self.q = z[:n]
        moved = np.sign(z[n : 3 * n]) * np.expm1(np.minimum(np.abs(z[n : 3 * n]), LARGEST))
        self.e, self.w = moved[:n], moved[n:]
        self.e = np.where(self.e == 0, 1e-9, np.clip(self.e, -FARTHEST, FARTHEST))
        self.shares = np.clip(z[3 * n :], 0, 1)
        self.ranges = [*statement.viscous, *statement.parameters]

    def numbers(self, number):
        """Friction and parameters."""
        pairs = zip(self.ranges, self.shares, strict=True)
        if number is float:
            return [float(a) + float(b - a) * t for (a, b), t in pairs]
        return [a + (b - a) * Fraction(float(t)) for (a, b), t in pairs]


def _start(random, n, numbers):
    """Columns to begin with: near the origin and far from it, w often beside a multiple of e."""
    q = random.uniform(-np.pi, np.pi, (n, SAMPLES))
    e = random.standard_normal((n, SAMPLES)) * np.exp(random.uniform(-5, 1, SAMPLES))
    w = random.standard_normal((n, SAMPLES)) * np.exp(random.uniform(-5, 1.5, SAMPLES))
    beside = random.random(SAMPLES) < 0.5
    w = np.where(beside, e * np.exp(random.uniform(-4, 2, SAMPLES)) * np.sign(w[:1]), w)
    return np.concatenate([q, e, w, np.clip(random.uniform(-0.5, 1.5, (numbers, SAMPLES)), 0, 1)])


def rising(statement, random):
    """How fast V rises at most beside friction and stiffness, and the states at which it does.

    Samples, then ever smaller steps from the best of them, then downhill.
    """
    n = len(statement.mass)
    generator = np.random.default_rng(random.getrandbits(32))

    def share(z):
        at = States(z, statement)
        numbers = at.numbers(float)
        loop = _loop_of(statement, numbers[:n], numbers[n:])
        with np.errstate(all="ignore"):
            rate = loop.rate(list(at.q), list(at.e), list(at.w), DOUBLES)
            h = DOUBLES.h(statement.family, statement.m, at.e)
            eps = abs(float(loop.eps0)) / (1 + np.linalg.norm(at.e, axis=0))
            size = sum(at.w**2) + eps * sum(h**2)
            value = rate / np.where(size > 0, size, np.inf)
        return np.where(np.isfinite(value), value, -np.inf)

    points = _start(generator, n, n + len(statement.parameters))
    values = share(points)
    chosen = np.argsort(values)[-BEST:]
    best, tops = points[:, chosen], values[chosen]
    for width in 0.5 ** np.arange(1, ROUNDS + 1):
        steps = (
            width * generator.standard_normal((*best.shape, STEPS)) * np.maximum(np.abs(best), 0.1)[..., None]
        )
        near = best[..., None] + steps * (generator.random(steps.shape) < 0.7)
        result = share(near.reshape(len(best), -1)).reshape(BEST, STEPS)
        for k, row in enumerate(result):
            step = int(np.argmax(row))
            if row[step] > tops[k]:
                best[:, k], tops[k] = near[:, k, step], row[step]

    def downhill(z):
        steps = 1e-6 * np.eye(len(z))
        columns = np.concatenate([z[:, None], z[:, None] + steps, z[:, None] - steps], axis=1)
        values = np.nan_to_num(-share(columns), posinf=1e9)
        up, down = np.split(values[1:], 2)
        return values[0], (up - down) / 2e-6

    ends = np.array([minimize(downhill, z, method="BFGS", jac=True).x for z in best.T]).T
    best = np.concatenate([best, ends], axis=1)
    tops = share(best)
    top = int(np.argmax(tops))
    return float(tops[top]), States(best[:, top], statement)


@oracle.objections_to("Decreasing")
def decreasing(statement, random):
    """A posture at which M is not positive definite, or a state at which V does not fall."""
    found = oracle.objection(_definite(statement), random.getrandbits(32))
    if found is not None:
        return found
    # at rest, dV/dt = −ε Σ λ_i k_pi h_i²
    weights = statement.coupling or (1,) * len(statement.kp)
    if any(statement.eps0 * k * c <= 0 for k, c in zip(statement.kp, weights, strict=True)):
        return Objection("false", "w = 0, e along one joint")
    best, at = rising(statement, random)
    state, numbers = [[Fraction(float(x)) for x in part] for part in (at.q, at.e, at.w)], at.numbers(Fraction)
    n = len(statement.mass)
    if best < -1e-6 or not _rises(_loop_of(statement, numbers[:n], numbers[n:]), state):
        return None
    return Objection("false", f"q, e, w = {[list(map(float, part)) for part in state]}")


def _definite(statement):
    return MassAbove(statement.mass, statement.parameters, Fraction(0))


def _rises(loop, state):
    """Whether dV/dt ≥ 0 at a state, which at 0 itself is left open."""
    q, e, w = state
    if not any(e):
        e = [Fraction(1, 10**30)] * len(e)
    with mp.workdps(3 * DIGITS):
        rate = loop.exact_rate(q, e, w)
        return None if abs(rate) < CERTAIN**2 else bool(rate > 0)


@oracle.judges("Decreasing")
def _rises_there(statement, point):
    """Whether dV/dt > 0 at the state for the arm in the middle of the ranges, or M is not definite there."""
    if "x1" in point:
        return oracle.confirms(_definite(statement), point)
    numbers = [[(a + b) / 2 for a, b in ranges] for ranges in (statement.viscous, statement.parameters)]
    state = within(SimpleNamespace(), point, len(statement.mass), "ew")
    return state is not None and _rises(_loop_of(statement, *numbers), [state[0], *state[2:]])


@oracle.objections_to("DampingBelow")
def _damping_below(statement, random):
    """A multiple of K_v beyond the bound, and an ε₀ at which no state is found where V does not fall."""
    try:
        with mp.workdps(DIGITS):
            highest = float(ends(Evaluation({}).of(statement.bound))[1])
    except Undefined as why:
        return Objection("undefined", f"the bound ({why})")
    except Unsure:
        return None
    if isinf(highest):
        return None
    factor = (max(Fraction(highest), Fraction(0)) + 1) / max(statement.kv)
    falls = _falls(statement, factor, ALLOWED / (1 + factor), random)
    return Objection("false", f"κ = {float(factor)}") if falls else None


def _falls(s, factor, eps0, random):
    """Whether nothing is found against dV/dt < 0 at κK_v and ε₀."""
    kv = tuple(factor * k for k in s.kv)
    tried = Decreasing(s.mass, s.viscous, s.parameters, s.family, s.m, s.kp, kv, eps0, ())
    positive = min((*s.kp, *(low for low, _ in s.viscous))) > 0
    return positive and decreasing(tried, random) is None


@oracle.judges("DampingBelow")
def _damping_above(statement, point):
    """Whether the gains break the bound, and nothing is found against dV/dt < 0 with them."""
    factor, eps0 = Fraction(point["factor of K_v"]), Fraction(point["eps0"])
    with mp.workdps(DIGITS):
        try:
            low = ends(Evaluation({}).of(statement.bound))[0]
        except (Undefined, Unsure):
            return False
        if many(factor * max(statement.kv)) < low * (1 - mp.mpf(10) ** -12):
            return False
    return _falls(statement, factor, eps0, Random(0))


BEYOND = (Fraction(1, 10**20), Fraction(1, 10**6), Fraction(1, 100), Fraction(1), Fraction(100))


@oracle.objections_to("Resting")
def _resting(statement, random):
    """A joint and an error somewhat or far beyond its bound, at which the arm may rest."""
    known = statement.family in ("tanh", "arctan", "algebraic") and statement.m is None
    if not known and (statement.family != "hyperbolic" or statement.m is None):
        return Objection("undefined", f"h, as there is no {statement.family} with m = {statement.m}")
    for joint, bound in enumerate(statement.errors):
        for step in (*BEYOND, Fraction(random.randint(1, 999), 10 ** random.randint(1, 9))):
            if bound is not None and _held(statement, joint, bound + step):
                return Objection("false", f"e{joint + 1} = {float(bound + step)}")
    return None


def _held(statement, joint, error):
    """Whether |k h(error)| is certainly at most the torque."""
    with mp.workdps(DIGITS):
        h = many_digits().h(statement.family, statement.m, many(error))
        ratio = many(statement.torque[joint]) / many(statement.kp[joint])
        return bool(abs(h) <= ratio * (1 - CERTAIN))


@oracle.judges("Resting")
def _rests_there(statement, point):
    """Whether the error of the witness is beyond its bound, and held."""
    ((name, text),) = point.items()
    joint, error = int(name[1:]) - 1, Fraction(text)
    bound = statement.errors[joint]
    return bound is not None and error > bound and _held(statement, joint, error)
