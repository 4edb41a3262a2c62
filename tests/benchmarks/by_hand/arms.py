"""The two arms as a user would type them: M(q) and its derivatives, batched over leading axes."""

import numpy as np

BASE, SHOULDER, CROSS, ELBOW = 0.5, 2.249632462, 0.083808, 0.10193952


def buap3(q):
    """Base, shoulder and elbow: M and dM[..., k] = ∂M/∂q_k."""
    s2, c2, s3, c3 = np.sin(q[..., 1]), np.cos(q[..., 1]), np.sin(q[..., 2]), np.cos(q[..., 2])
    s23, c23 = s2 * c3 + c2 * s3, c2 * c3 - s2 * s3
    M, dM = np.zeros((*q.shape, 3)), np.zeros((*q.shape, 3, 3))
    M[..., 0, 0] = BASE + SHOULDER * s2**2 + 2 * CROSS * s2 * s23 + ELBOW * s23**2
    M[..., 1, 1] = SHOULDER + ELBOW + 2 * CROSS * c3
    M[..., 1, 2] = M[..., 2, 1] = ELBOW + CROSS * c3
    M[..., 2, 2] = ELBOW
    dM[..., 0, 0, 1] = 2 * SHOULDER * s2 * c2 + 2 * CROSS * (c2 * s23 + s2 * c23) + 2 * ELBOW * s23 * c23
    dM[..., 0, 0, 2] = 2 * CROSS * s2 * c23 + 2 * ELBOW * s23 * c23
    dM[..., 1, 1, 2] = -2 * CROSS * s3
    dM[..., 1, 2, 2] = dM[..., 2, 1, 2] = -CROSS * s3
    return M, dM


def reyes_kelly2(q):
    """Shoulder and elbow of the two-joint arm."""
    s2, c2 = np.sin(q[..., 1]), np.cos(q[..., 1])
    M, dM = np.zeros((*q.shape, 2)), np.zeros((*q.shape, 2, 2))
    M[..., 0, 0] = 2.351 + 0.168 * c2
    M[..., 0, 1] = M[..., 1, 0] = 0.102 + 0.084 * c2
    M[..., 1, 1] = 0.102
    dM[..., 0, 0, 1] = -0.168 * s2
    dM[..., 0, 1, 1] = dM[..., 1, 0, 1] = -0.084 * s2
    return M, dM


ARMS = {"buap3": buap3, "reyes-kelly2": reyes_kelly2}
VISCOUS = {"buap3": np.array([0.406, 2.288, 0.406]), "reyes-kelly2": np.array([2.288, 0.175])}


def coriolis(dM, x):
    """C(q, x) by Christoffel symbols of the first kind."""
    symbols = (dM + np.swapaxes(dM, -1, -2) - np.moveaxis(dM, -1, -3)) / 2
    return np.einsum("...ijk,...k->...ij", symbols, x)


def h(m, x):
    s = np.sinh(x)
    return s ** (2 * m - 1) * np.cosh(x) / (1 + s ** (2 * m))


def dh(m, x):
    u = np.sinh(x) ** 2
    return ((2 * m - 1) * u ** (m - 1) + 2 * m * u**m - u ** (2 * m - 1)) / (1 + u**m) ** 2


def potential(m, x):
    return np.log1p(np.sinh(x) ** (2 * m)) / (2 * m)
