"""V and dV/dt one state at a time in plain NumPy, from the printed (13) and (15)."""

import numpy as np

from .arms import ARMS, VISCOUS, coriolis, dh, h, potential


def value(arm, m, kp, eps0, q, e, w):
    M, _ = ARMS[arm](q)
    y = w - eps0 / (1 + np.linalg.norm(e)) * h(m, e)
    return 0.5 * y @ M @ y + kp @ potential(m, e)


def rate(arm, m, kp, kv, eps0, q, e, w):
    M, dM = ARMS[arm](q)
    C, he, hw, r = coriolis(dM, w), h(m, e), h(m, w), np.linalg.norm(e)
    eps, slope, near = eps0 / (1 + r), dh(m, e) * w, (e @ w) / (r * (1 + r))
    damping = VISCOUS[arm] * w + kv * hw
    return (
        -w @ damping
        + eps * (slope @ M @ w - near * (he @ M @ w) - w @ C @ he)
        + eps * (he @ damping - he @ (kp * he))
        + eps**2 * (he @ C @ he + near * (he @ M @ he) - slope @ M @ he)
    )


def values(arm, m, kp, eps0, q, e, w):
    return np.array([value(arm, m, kp, eps0, *state) for state in zip(q, e, w, strict=True)])


def rates(arm, m, kp, kv, eps0, q, e, w):
    return np.array([rate(arm, m, kp, kv, eps0, *state) for state in zip(q, e, w, strict=True)])
