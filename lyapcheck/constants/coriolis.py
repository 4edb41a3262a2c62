"""k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖) over boxes of angles, from the Christoffel symbols S_i = (c_ijk)_jk.

C(q,x)y = (xᵀS_i y)_i is symmetric in x and y, so that for a unit vector z the largest zᵀC(q,x)y is the
spectral radius of Σ_i z_i S_i, reached with x = y its eigenvector: k_c is reached with x = y.

At one q the bound is that of `lyapcheck.constants.quartic`, for each box with one relation N. As
λmax(WᵀW + N) is convex in the symbols, it is largest at a corner of their linear part; what the linear part
leaves adds at most its own ‖C(q,x)y‖, which the two unfoldings of its entries bound:

    ‖C(q,x)y‖² ≤ λmax(Σ_i S_i²)     and     ‖C(q,x)y‖ ≤ ‖(c_i,jk)‖     for ‖x‖ = ‖y‖ = 1.

References: property 2.6 of reyes2019family.
"""

from __future__ import annotations

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.constants.arm_harmonics import ArmHarmonics
from lyapcheck.constants.constant import SupremumTask
from lyapcheck.constants.quartic import quartic
from lyapcheck.constants.spectrum import ROUNDING, eigenvalues, largest_norm
from lyapcheck.constants.torus import AffineForms

_TURNS = 6
_STARTS = 3


def coriolis_task(arm: ArmHarmonics) -> SupremumTask:
    """k_c as a supremum over the angles."""
    torus = arm.symbols

    def value(entries: Array) -> Array:
        return _pushed(arm.tensor(entries))[0] * (1 - 1e-12) - 2 * arm.n * torus.lost

    def shown(q: Array) -> tuple[float, ...]:
        tensor = arm.tensor(torus.at(q[None]))
        return (*torus.angles_at(q).tolist(), *_pushed(tensor)[1][0].tolist())

    weight = np.ones(len(arm.triples))
    return SupremumTask(
        "k_c", "kg·m²", torus, value, lambda affine: _most(arm, affine), weight, shown=shown, cost=arm.n
    )


def _most(arm: ArmHarmonics, affine: AffineForms) -> Array:
    """What ‖C(q,x)y‖ is at most over boxes of angles, for unit vectors."""
    forms, tensor = quartic(arm.n), arm.tensor(affine.middle)
    relation = forms.relation(_square(forms.stack(tensor)), _pushed(tensor)[0] ** 2)
    corners = forms.stack(arm.tensor(affine.corners()))
    values, distance, _ = eigenvalues(_square(corners) + relation[:, None])
    size = np.sum(corners**2, axis=(-2, -1)) + np.sqrt(np.sum(relation**2, axis=(-2, -1)))[:, None]
    square = values[..., -1] + distance + ROUNDING * arm.n**2 * size
    rest = _unfolded(arm.tensor(affine.radius))
    return np.asarray((np.sqrt(np.max(np.maximum(square, 0.0), axis=1)) + rest) * (1 + 1e-12))


def _square(stack: Array) -> Array:
    return np.asarray(np.swapaxes(stack, -1, -2) @ stack)


def _unfolded(tensor: Array) -> Array:
    """An upper bound of ‖C(q,x)y‖ for unit x and y: the smaller norm of the two unfoldings."""
    n = tensor.shape[-1]
    tall = [t.reshape(-1, n * n, n) for t in (tensor, np.moveaxis(tensor, -3, -1))]
    return np.minimum(*[largest_norm(t, np.zeros_like(t)) for t in tall])


def _pushed(tensor: Array) -> tuple[Array, Array]:
    """For each tensor a large ‖C(q,x)x‖ and its unit vector x: the best of alternating between z and x.

    The starts are the singular vectors of the unfolding, which symmetry can make stationary, and others.
    """
    vectors = np.linalg.eigh(np.einsum("bijk,bijl->bkl", tensor, tensor))[1]
    x = np.swapaxes(vectors, -1, -2)[:, -_STARTS:]
    others = np.random.default_rng(SEED).standard_normal(x.shape[1:])
    x = np.concatenate([x, np.broadcast_to(others, x.shape)], axis=1)
    for _ in range(_TURNS):
        z = np.einsum("bijk,bsj,bsk->bsi", tensor, x, x)
        z /= np.maximum(np.linalg.norm(z, axis=2, keepdims=True), 1e-300)
        values, vectors = np.linalg.eigh(np.einsum("bsi,bijk->bsjk", z, tensor))
        last = np.argmax(np.abs(values), axis=2)
        x = np.take_along_axis(vectors, last[..., None, None], axis=3)[..., 0]
    x = x / np.linalg.norm(x, axis=2, keepdims=True)
    size = np.linalg.norm(np.einsum("bijk,bsj,bsk->bsi", tensor, x, x), axis=2)
    best = np.argmax(size, axis=1)
    rows = np.arange(len(best))
    return np.asarray(size[rows, best]), np.asarray(x[rows, best])
