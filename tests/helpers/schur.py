"""P of the certificates at one state, by NumPy from its definition and the numeric model."""

import numpy as np

from lyapcheck.family import named
from lyapcheck.robots.numeric import NumericModel


def schur_of(arm, gains, eps0, q, e, scale=1.0):
    """P for gains on an arm at angles and errors, with weights Λ where there are some."""
    model, family = NumericModel(arm), named(gains.family, gains.m)
    h, dh, r = scale * family.h(e), scale * family.dh(e), float(np.linalg.norm(e))
    M, B = model.mass(q), np.diag(model.viscous)
    unit = e / r if r else np.zeros_like(e)
    S = model.coriolis(q, h) + np.outer(M @ h, unit) / (1 + r) - M @ np.diag(dh)
    eps, L = eps0 / (1 + r), float(family.constants().L.upper)
    kp, kv = (np.array([float(k) for k in part]) for part in (gains.kp, gains.kv))
    X = B + eps * S
    return B + eps * (S + S.T) / 2 - eps / 4 * X.T @ np.diag(1 / (kp / scale - eps0 * L * kv / 4)) @ X
