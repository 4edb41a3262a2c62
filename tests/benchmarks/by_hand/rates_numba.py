"""V and dV/dt in numba, a thread a share of the states, from the printed (13) and (15), scalars alone."""

import numpy as np
from numba import njit, prange

from .arms import BASE, CROSS, ELBOW, SHOULDER, VISCOUS

FAST = {"fastmath": True}
BLOCKS = 64
"""Shares of the states: more than threads, so that none waits long for another."""


@njit(**FAST)
def reyes_kelly2(q, M, dM):
    s2, c2 = np.sin(q[1]), np.cos(q[1])
    M[0, 0] = 2.351 + 0.168 * c2
    M[0, 1] = M[1, 0] = 0.102 + 0.084 * c2
    M[1, 1] = 0.102
    dM[0, 0, 1] = -0.168 * s2
    dM[0, 1, 1] = dM[1, 0, 1] = -0.084 * s2


@njit(**FAST)
def buap3(q, M, dM):
    s2, c2, s3, c3 = np.sin(q[1]), np.cos(q[1]), np.sin(q[2]), np.cos(q[2])
    s23, c23 = s2 * c3 + c2 * s3, c2 * c3 - s2 * s3
    M[0, 0] = BASE + SHOULDER * s2**2 + 2 * CROSS * s2 * s23 + ELBOW * s23**2
    M[1, 1] = SHOULDER + ELBOW + 2 * CROSS * c3
    M[1, 2] = M[2, 1] = ELBOW + CROSS * c3
    M[2, 2] = ELBOW
    dM[0, 0, 1] = 2 * SHOULDER * s2 * c2 + 2 * CROSS * (c2 * s23 + s2 * c23) + 2 * ELBOW * s23 * c23
    dM[0, 0, 2] = 2 * CROSS * s2 * c23 + 2 * ELBOW * s23 * c23
    dM[1, 1, 2] = -2 * CROSS * s3
    dM[1, 2, 2] = dM[2, 1, 2] = -CROSS * s3


@njit(**FAST)
def h_and_slope(m, x):
    s, c = np.sinh(x), np.cosh(x)
    u = s * s
    power = u ** (m - 1)
    below = 1 + power * u
    top = power * (2 * m - 1 + 2 * m * u - power * u)
    return power * s * c / below, top / (below * below), np.log(below) / (2 * m)


def loops(arm, m, kp, kv, eps0):
    """V and dV/dt of arrays of states, compiled at their first call."""
    fill, B, n = {"reyes-kelly2": reyes_kelly2, "buap3": buap3}[arm], VISCOUS[arm], len(kp)

    @njit(parallel=True, **FAST)
    def values(q, e, w):
        out = np.empty(len(q))
        for block in prange(BLOCKS):
            M, dM, y = np.zeros((n, n)), np.zeros((n, n, n)), np.empty(n)
            for k in range(block * len(q) // BLOCKS, (block + 1) * len(q) // BLOCKS):
                fill(q[k], M, dM)
                r, total = 0.0, 0.0
                for i in range(n):
                    r += e[k, i] * e[k, i]
                eps = eps0 / (1 + np.sqrt(r))
                for i in range(n):
                    he, _, U = h_and_slope(m, e[k, i])
                    y[i] = w[k, i] - eps * he
                    total += kp[i] * U
                for i in range(n):
                    for j in range(n):
                        total += 0.5 * y[i] * M[i, j] * y[j]
                out[k] = total
        return out

    @njit(parallel=True, **FAST)
    def rates(q, e, w):
        out = np.empty(len(q))
        for block in prange(BLOCKS):
            M, dM = np.zeros((n, n)), np.zeros((n, n, n))
            he, slope, damping = np.empty(n), np.empty(n), np.empty(n)
            for k in range(block * len(q) // BLOCKS, (block + 1) * len(q) // BLOCKS):
                fill(q[k], M, dM)
                r, ew = 0.0, 0.0
                for i in range(n):
                    r += e[k, i] * e[k, i]
                    ew += e[k, i] * w[k, i]
                    he[i], dh, _ = h_and_slope(m, e[k, i])
                    slope[i] = dh * w[k, i]
                    damping[i] = B[i] * w[k, i] + kv[i] * h_and_slope(m, w[k, i])[0]
                r = np.sqrt(r)
                eps, near = eps0 / (1 + r), ew / (r * (1 + r))
                total = 0.0
                for i in range(n):
                    total -= w[k, i] * damping[i]
                    total += eps * he[i] * (damping[i] - kp[i] * he[i])
                    left = w[k, i] - eps * he[i]
                    for j in range(n):
                        total += eps * (slope[i] * M[i, j] - near * he[i] * M[i, j]) * (w[k, j] - eps * he[j])
                        C = 0.0
                        for l in range(n):
                            C += 0.5 * (dM[i, j, l] + dM[i, l, j] - dM[j, l, i]) * w[k, l]
                        total -= eps * left * C * he[j]
                out[k] = total
        return out

    return values, rates
