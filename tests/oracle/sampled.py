"""Gains on a computer that do not come to rest: the loop at a goal, and arms without inertia.

Near a goal the loop reads δq¨ = M⁻¹(τ_k − Gδq − Bδq̇), τ_k = (G − h'(0)K_p) δp − h'(0)K_v v, all angles at
readings; a radius above 1 is a motion that leaves. Of one joint almost without inertia b q̇ = τ_k, and a
motion that keeps on changing sides does not come to rest.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import cos, pi, sin

import numpy as np
from scipy.linalg import expm

from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import Place, derivative
from tests.oracle.bounds import Bound
from tests.oracle.loop import DOUBLES

STEPS, STARTS, SAMPLES = 600, 60, 12
ABOVE = 1e-7
"""Of a radius, beyond what doubles lose."""
INERTIAS = (1e-6, 3e-2, 1.0, 30.0)
"""Of an arm that is not given, as shares of b T."""


@dataclass(frozen=True)
class Loop:
    """The numbers of a statement, in doubles; ``span`` is the interval."""

    kp: np.ndarray
    kv: np.ndarray
    b: np.ndarray
    taps: np.ndarray
    delay: int
    period: float
    span: float
    family: str
    m: int | None

    def radius(self, M, G):
        """Of the map from reading to reading, h taken with its slope at 0."""
        n, slope = len(self.kp), 0.0 if (self.m or 1) > 1 else 1.0
        inverse = np.linalg.inv(M)
        flow = np.zeros((3 * n, 3 * n))
        flow[:n, n : 2 * n] = np.eye(n)
        flow[n : 2 * n] = np.hstack([-inverse @ G, -inverse * self.b, inverse])
        over = expm(flow * self.span)
        # the state: q, w, and the readings before, newest first
        past = self.delay + len(self.taps)
        size = (2 + past) * n
        read = [*range(n)], *([*range((2 + k) * n, (3 + k) * n)] for k in range(past))
        torque = np.zeros((n, size))
        torque[:, read[self.delay]] += G - slope * np.diag(self.kp)
        for j, tap in enumerate(self.taps):
            share = slope * np.diag(self.kv) * tap / self.period
            torque[:, read[self.delay + j]] -= share
            torque[:, read[self.delay + j + 1]] += share
        step = np.zeros((size, size))
        step[: 2 * n] = over[: 2 * n, 2 * n :] @ torque
        step[: 2 * n, : 2 * n] += over[: 2 * n, : 2 * n]
        step[2 * n : 3 * n, :n] = np.eye(n)
        step[3 * n :, 2 * n : -n] += np.eye(size - 3 * n)
        return max(abs(np.linalg.eigvals(step)))

    def swings(self, i):
        """Whether joint i, without inertia and gravity, keeps on changing sides from some start."""
        q = np.tile(np.geomspace(1e-2, 20, STARTS), (self.delay + len(self.taps) + 1, 1))
        sides, far = [], min(15.0, 300 / (self.m or 1))
        for k in range(STEPS):
            late = q[self.delay :]
            v = sum(f * (late[j] - late[j + 1]) for j, f in enumerate(self.taps)) / self.period
            h = [DOUBLES.h(self.family, self.m, np.clip(x, -far, far)) for x in (late[0], v)]
            now = q[0] - self.span / self.b[i] * (self.kp[i] * h[0] + self.kv[i] * h[1])
            q = np.vstack([now, q[:-1]])
            sides += [now] if k >= STEPS // 2 else []
        late, early = np.array(sides[STEPS // 4 :]), np.array(sides[: STEPS // 4])
        kept = np.abs(late).max(0) > 0.9999 * np.abs(early).max(0)
        turns = (late[1:] * late[:-1] < 0).mean(0) > 0.3
        return bool(np.any(kept & turns & (np.abs(late).max(0) > 1e-2)))


def arms(statement, random):
    """M and the Hessian of the potential at goals, where they are given; else arms of all inertias."""
    n = len(statement.kp)
    if statement.mass:
        for _ in range(SAMPLES):
            q = [random.uniform(-pi, pi) for _ in range(n)]
            p = [float(a) + float(c - a) * random.random() for a, c in statement.parameters]
            at = Place(list(map(sin, q)), list(map(cos, q)), p, float)
            slopes = [derivative(statement.potential, i, n) for i in range(n)]
            hessian = [[at.value(derivative(slope, j, n)) for j in range(n)] for slope in slopes]
            yield np.array(at.matrix(statement.mass)), np.array(hessian)
    elif statement.links:
        bodies, fall = Bound(statement)._bodies, np.array(statement.fall, float)

        def pull(q):
            return -sum(mass * linear.T @ fall for mass, _, linear, _ in bodies(q, float))

        for _ in range(SAMPLES):
            q, near = [random.uniform(-pi, pi) for _ in range(n)], 1e-5 * np.eye(n)
            slopes = [(pull(list(q + x)) - pull(list(q - x))) / 2e-5 for x in near]
            yield Bound(statement)._mass(q, (), float), np.array(slopes)
    elif statement.k_g:
        b = np.array(statement.viscous_min, float)
        for share in INERTIAS:
            M = np.diag(share * b * float(statement.period) + 1e-12)
            for sign in (0, 1, -1):
                yield M, np.diag(sign * np.array(statement.k_g, float))


@oracle.objections_to("SampledStable")
def _sampled(statement, random):
    """A goal that motions leave, or a joint that swings for ever, at the longest period or half of it."""
    if min(statement.viscous_min) <= 0:
        return Objection("false", "a joint without friction, of little inertia")
    for share in (Fraction(1), Fraction(1, 2)):
        for span in {Fraction(1), statement.stretch}:
            T = share * statement.period
            arrays = (np.array(x, float) for x in (statement.kp, statement.kv, statement.viscous_min))
            taps = np.array(statement.taps, float)
            loop = Loop(
                *arrays, taps, statement.delay, float(T), float(span * T), statement.family, statement.m
            )
            for M, G in arms(statement, random):
                if statement.conclusion == "rest" and G.any():
                    continue
                if min(np.linalg.eigvalsh(M)) > 0 and loop.radius(M, G) > 1 + ABOVE:
                    return Objection("false", f"T = {float(T)} s, M = {M.tolist()}")
            if statement.k_g:
                for i in range(len(statement.kp)):
                    if loop.swings(i):
                        return Objection("false", f"T = {float(T)} s, joint {i + 1} without inertia")
    return None


@oracle.objections_to("SampledFromRest")
def _from_rest(statement, random):
    """A goal that motions leave, with the least or the most friction."""
    for end in (0, 1):
        b = np.array([pair[end] for pair in statement.viscous], float)
        gains = (np.array(x, float) for x in (statement.kp, statement.kv))
        T = float(statement.period)
        loop = Loop(*gains, b, np.ones(1), statement.delay, T, T, statement.family, statement.m)
        for M, G in arms(statement, random):
            if loop.radius(M, G) > 1 + ABOVE:
                return Objection("false", f"M = {M.tolist()}, G = {G.tolist()}")
    return None
