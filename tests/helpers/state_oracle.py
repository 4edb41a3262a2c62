"""States that refute dV/dt < 0, sought in doubles and judged at 60 digits: no code of lyapcheck.

    V = ½ yᵀM(q)y + Σ k_pi U(e_i),   y = w − εh(e),   ε = ε₀/(1 + ‖e‖)
    q̇ = w,   ė = −w,   Mẇ = K_p h(e) − K_v h(w) − Bw − Ṁw + ½ (∂/∂q)(wᵀMw)

A statement is the JSON of a certificate. The hunter takes the best of random states and climbs from them with
SciPy; the judge differentiates V along the motion with mpmath.
"""

from fractions import Fraction

import mpmath
import numpy as np
from scipy.optimize import minimize

DIGITS = 60
SAMPLES, CLIMBS = 20_000, 6


class Loop:
    """An arm under its controller as arrays of doubles, from the JSON of a statement."""

    def __init__(self, statement):
        assert statement["kind"] == "Decreasing"
        assert not statement["coupling"]  # y = w − εh is what is differentiated here
        self.statement = statement
        self.n = len(statement["kp"])
        self.kp, self.kv = (np.array([float(Fraction(x)) for x in statement[k]]) for k in ("kp", "kv"))
        self.eps0 = float(Fraction(statement["eps0"]))
        self.ranges = np.array(
            [[float(Fraction(x)) for x in ends] for ends in statement["parameters"] + statement["viscous"]]
        )
        self.mass = [
            (i, j, np.array(powers), float(Fraction(value)))
            for i, row in enumerate(statement["mass"])
            for j, entry in enumerate(row)
            for powers, value in entry
        ]

    def states(self, x):
        """q, e, w and what is uncertain, of vectors of numbers without bounds; w = exp(size)·direction."""
        n = self.n
        direction = x[:, 2 * n : 3 * n]
        length = np.linalg.norm(direction, axis=1, keepdims=True)
        w = direction / np.where(length > 0, length, 1.0) * np.exp(np.clip(x[:, 3 * n : 3 * n + 1], -12, 16))
        low, high = self.ranges.T
        free = low + (high - low) * (0.5 + 0.5 * np.sin(x[:, 3 * n + 1 :]))
        return x[:, :n], x[:, n : 2 * n], w, free

    def random(self, count, random):
        """Starts: errors and rates of all sizes."""
        n, shape = self.n, (count, self.n)
        e = random.choice([-1.0, 1.0], shape) * 10 ** random.uniform(-3, 0.8, shape)
        rest = random.uniform(-12, 16, (count, 1)), random.uniform(-2, 2, (count, len(self.ranges)))
        return np.hstack([random.uniform(-np.pi, np.pi, shape), e, random.normal(size=(count, n)), *rest])

    def steepness(self, x):
        """dV/dt over ε‖h‖² + ‖w‖², by the chain rule."""
        q, e, w, free = self.states(x)
        M, slopes = self._mass(q, free[:, : len(free[0]) - self.n])
        B = free[:, len(free[0]) - self.n :]
        h, dh, hw = self._h(e), self._dh(e), self._h(w)
        r = np.linalg.norm(e, axis=1, keepdims=True)
        eps = self.eps0 / (1 + r)
        eps_rate = self.eps0 / (1 + r) ** 2 * np.sum(e * w, axis=1, keepdims=True) / np.where(r > 0, r, 1.0)
        mass_rate = np.einsum("ck,ckij->cij", w, slopes)
        force = self.kp * h - self.kv * hw - B * w - np.einsum("cij,cj->ci", mass_rate, w)
        force += 0.5 * np.einsum("ci,ckij,cj->ck", w, slopes, w)
        y = w - eps * h
        force += np.einsum("cij,cj->ci", M, eps * dh * w - eps_rate * h)
        rate = np.sum(y * force, axis=1) + 0.5 * np.einsum("ci,cij,cj->c", y, mass_rate, y)
        rate -= np.sum(self.kp * h * w, axis=1)
        return rate / (eps[:, 0] * np.sum(h * h, axis=1) + np.sum(w * w, axis=1) + 1e-300)

    def hunt(self, seed):
        """The state of the largest steepness found, and that."""
        random = np.random.default_rng(seed)
        starts = self.random(SAMPLES, random)
        found = self.steepness(starts)
        best = starts[np.argsort(-found, kind="stable")[:CLIMBS]]
        ends = np.array([minimize(self._downhill, x, method="BFGS", jac=True).x for x in best])
        both = np.vstack([best, ends])
        values = np.nan_to_num(self.steepness(both), nan=-np.inf)
        top = int(np.argmax(values))
        return tuple(part[0] for part in self.states(both[top : top + 1])), float(values[top])

    def _downhill(self, x):
        """−steepness and its slopes, by differences, all in one call."""
        steps = 1e-6 * np.eye(len(x))
        values = -np.nan_to_num(self.steepness(np.vstack([x, x + steps, x - steps])), nan=-1e9)
        up, down = np.split(values[1:], 2)
        return values[0], (up - down) / 2e-6

    def _mass(self, q, parameters):
        n, count = self.n, len(q)
        M, slopes = np.zeros((count, n, n)), np.zeros((count, n, n, n))
        base = np.hstack([np.sin(q), np.cos(q), parameters])
        for i, j, powers, value in self.mass:
            M[:, i, j] += value * np.prod(base**powers, axis=1)
            for k in range(n):
                for place, other, sign in ((k, n + k, 1), (n + k, k, -1)):
                    if powers[place]:
                        less = powers.copy()
                        less[place] -= 1
                        less[other] += 1
                        slopes[:, k, i, j] += sign * powers[place] * value * np.prod(base**less, axis=1)
        return M, slopes

    def _h(self, x):
        if self.statement["family"] == "arctan":
            return np.arctan(x)
        m = self.statement["m"] or 1
        x = np.clip(x, -100 / m, 100 / m)
        return np.sinh(x) ** (2 * m - 1) * np.cosh(x) / (1 + np.sinh(x) ** (2 * m))

    def _dh(self, x):
        if self.statement["family"] == "arctan":
            return 1 / (1 + x * x)
        m = self.statement["m"] or 1
        u = np.sinh(np.clip(x, -100 / m, 100 / m)) ** 2
        return u ** (m - 1) * (2 * m - 1 + 2 * m * u - u**m) / (1 + u**m) ** 2


def confirmed(statement, state):
    """Whether dV/dt > 0 at a state of doubles, at 60 digits: V differentiated along the motion."""
    with mpmath.workdps(DIGITS):
        q, e, w, free = ([mpmath.mpf(float(x)) for x in part] for part in state)
        return _rate(statement, q, e, w, free) > mpmath.mpf(10) ** (-DIGITS // 3)


def _rate(statement, q, e, w, free):
    n = len(q)
    kp, kv = ([_number(x) for x in statement[name]] for name in ("kp", "kv"))
    eps0, (parameters, B) = _number(statement["eps0"]), (free[: len(free) - n], free[len(free) - n :])

    def mass(q):
        base = [*map(mpmath.sin, q), *map(mpmath.cos, q), *parameters]
        return mpmath.matrix(
            [
                [
                    mpmath.fsum(
                        _number(value) * mpmath.fprod(x**k for x, k in zip(base, powers, strict=True))
                        for powers, value in entry
                    )
                    for entry in row
                ]
                for row in statement["mass"]
            ]
        )

    def moved(point, direction, t):
        return [x + t * v for x, v in zip(point, direction, strict=True)]

    def energy(q, v):
        v = mpmath.matrix(v)
        return (v.T * mass(q) * v)[0] / 2

    def V(q, e, w):
        eps = eps0 / (1 + mpmath.norm(e))
        y = [v - eps * _h(statement, x) for v, x in zip(w, e, strict=True)]
        return energy(q, y) + mpmath.fsum(k * _U(statement, x) for k, x in zip(kp, e, strict=True))

    units = [[mpmath.mpf(i == k) for i in range(n)] for k in range(n)]
    slopes = [mpmath.diff(lambda t, d=d: energy(moved(q, d, t), w), 0) for d in units]
    momentum = [mpmath.diff(lambda t, i=i: (mass(moved(q, w, t)) * mpmath.matrix(w))[i], 0) for i in range(n)]
    force = [
        kp[i] * _h(statement, e[i]) - kv[i] * _h(statement, w[i]) - B[i] * w[i] - momentum[i] + slopes[i]
        for i in range(n)
    ]
    change = list(mpmath.lu_solve(mass(q), mpmath.matrix(force)))
    back = [-x for x in w]
    # short steps beside the times in which fast states change anything
    scale = 1 / (1 + mpmath.norm(w) + mpmath.norm(change))
    return (
        mpmath.diff(lambda t: V(*(moved(*x, t * scale) for x in ((q, w), (e, back), (w, change)))), 0) / scale
    )


def _number(text):
    value = Fraction(text)
    return mpmath.mpf(value.numerator) / value.denominator


def _h(statement, x):
    if statement["family"] == "arctan":
        return mpmath.atan(x)
    m = statement["m"] or 1
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    return s ** (2 * m - 1) * c / (1 + s ** (2 * m))


def _U(statement, x):
    if statement["family"] == "arctan":
        return x * mpmath.atan(x) - mpmath.log(1 + x * x) / 2
    m = statement["m"] or 1
    return mpmath.log(1 + mpmath.sinh(x) ** (2 * m)) / (2 * m)
