"""The first two joints of the problem of k_c, whose angle q_2 is kept: a 5 × 5 matrix over the circle.

With rates a, b and z_0, z_1 of two joints the state after the second is linear in (z_0, z_1, a², ab, b²), and
trigonometric in q_2. The condition there is

    κ (z_0² + z_1²) ≥ cost_1 + cost_2 + s_3(X_3 w'),

a quadratic form of these five for each q_2, up to a multiple ν of a²·b² = (ab)²; forms in two variables need
no other relation.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from flint import fmpq, fmpq_mat

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import Harmonics
from lyapcheck.constants.maximise import maximise
from lyapcheck.constants.spectrum import smallest_eigenvalue
from lyapcheck.constants.storage import lift
from lyapcheck.constants.storage.exact import Exact
from lyapcheck.constants.storage.hinges import Hinge
from lyapcheck.constants.torus import Torus

SIZE = 5
RELATION = np.zeros((SIZE, SIZE))
RELATION[2, 4] = RELATION[4, 2] = 0.5
RELATION[3, 3] = -1.0
PRICE = np.diag([1.0, 1.0, 0.0, 0.0, 0.0])
_PLACES = [(i, j) for i in range(SIZE) for j in range(i + 1)]
_BOXES = 40_000
_DEGREE = 4
_STEPS = 40


def states(hinges: Sequence[Hinge], sine: fmpq, cosine: fmpq) -> Exact:
    """w' after the second joint as a function of (z_0, z_1, a², ab, b²), 34 × 5, at one q_2."""
    zero, one = fmpq(0), fmpq(1)
    turn = np.array([[cosine, sine, zero], [-sine, cosine, zero], [zero, zero, one]], dtype=object)
    twist = hinges[1].carry @ lift.AXIS
    first, second = np.concatenate([turn @ twist[:3], turn @ twist[3:]]), lift.AXIS
    result = np.full((lift.STATE, SIZE), zero, dtype=object)
    result[lift.Z, 0], result[lift.Z, 1] = first, second
    result[lift.A, 3] = lift.onto_axis(first)
    result[lift.W, 2] = lift.products(np.outer(first, first))
    result[lift.W, 3] = lift.products(np.outer(first, second) + np.outer(second, first))
    result[lift.W, 4] = lift.products(np.outer(second, second))
    result[lift.N, 2] = result[lift.N, 4] = one
    return result


def first_cost(hinges: Sequence[Hinge]) -> Exact:
    """The cost of the first joint as a form of the five."""
    place = np.full((lift.STATE, SIZE), fmpq(0), dtype=object)
    place[lift.Z, 0] = lift.AXIS
    place[lift.W, 2] = lift.products(np.outer(lift.AXIS, lift.AXIS))
    place[lift.N, 2] = fmpq(1)
    return np.asarray(place.T @ lift.power(hinges[0].body) @ place)


def certain(hinges: Sequence[Hinge], kappa: fmpq, after: Exact, centre: float, half: float) -> bool:
    """Whether the condition holds for every q_2 within ``half`` of ``centre``.

    Args:
        hinges: base first.
        kappa: the constant.
        after: the cost of the second joint and what follows it, a form of w'.
        centre: rad.
        half: rad.

    Soundness: bounds of eigenvalues over intervals of q_2, see `lyapcheck.constants.torus`.
    """
    torus = Torus(_harmonics([_slack(hinges, kappa, after, *node[1:3]) for node in _nodes()]), 1)

    def bounds(middle: Array, half: Array) -> tuple[Array, Array]:
        affine = torus.on(middle + centre, half)
        low = _best(_matrix(affine.value), np.zeros((len(middle), SIZE, SIZE)))
        # ν may go along with the linear part: between its ends the sum is a mean of the two at the ends
        ends = [_matrix(affine.corners()[:, k]) for k in range(1 + half.any())]
        return -low, -np.min([_best(end, _matrix(affine.radius)) for end in ends], axis=0)

    begin = np.zeros(1)
    inside = float(bounds(begin[None], np.zeros((1, 1)))[0][0])
    width = np.array([half * (1 + 1e-9)])
    result = maximise(width, bounds, lambda middle, half: half, (begin, inside), _BOXES, 0.5)
    return result.outside < 0


def _slack(hinges: Sequence[Hinge], kappa: fmpq, after: Exact, sine: fmpq, cosine: fmpq) -> Exact:
    reached = states(hinges, sine, cosine)
    slack = -first_cost(hinges) - reached.T @ after @ reached
    for i in range(2):
        slack[i, i] += kappa
    return np.asarray(slack)


def _nodes() -> list[list[fmpq]]:
    """1, sin q, cos q, sin 2q, … at as many rational points of the circle: at tan(q/2) = t/2."""
    rows = []
    for t in range(-_DEGREE, _DEGREE + 1):
        half = fmpq(t, 2)
        sine, cosine = 2 * half / (1 + half**2), (1 - half**2) / (1 + half**2)
        row, here = [fmpq(1)], (fmpq(0), fmpq(1))
        for _ in range(_DEGREE):
            here = here[0] * cosine + here[1] * sine, here[1] * cosine - here[0] * sine
            row += here
        rows.append(row)
    return rows


def _harmonics(slacks: Sequence[Exact]) -> list[Harmonics]:
    """The entries as trigonometric polynomials of degree 4, from their values at the nodes."""
    values = fmpq_mat([[slack[i, j] for i, j in _PLACES] for slack in slacks])
    result = fmpq_mat(_nodes()).solve(values)

    def number(row: int, column: int) -> Fraction:
        return Fraction(int(result[row, column].p), int(result[row, column].q))

    return [
        {(k,): (number(2 * k, c), number(2 * k - 1, c) if k else Fraction(0)) for k in range(_DEGREE + 1)}
        for c in range(len(_PLACES))
    ]


def _best(matrices: Array, radius: Array) -> Array:
    """For each matrix a lower bound of λmin(M + ν R) within the radius, for a ν that makes it large."""
    moved = _multiplier(matrices)[:, None, None] * RELATION
    rounding = 1e-12 * (np.abs(matrices) + np.abs(moved))
    return smallest_eigenvalue(matrices + moved, radius + rounding)


def _multiplier(matrices: Array) -> Array:
    """For each matrix a ν with a large λmin(M + ν R), which is concave in ν."""
    size = np.max(np.abs(matrices), axis=(1, 2))
    low, high = -4 * size, 4 * size
    for _ in range(_STEPS):
        third = (high - low) / 3
        one, two = low + third, high - third
        better = _least(matrices, one) > _least(matrices, two)
        low, high = np.where(better, low, one), np.where(better, two, high)
    return np.asarray((low + high) / 2)


def _least(matrices: Array, nu: Array) -> Array:
    return np.asarray(np.linalg.eigvalsh(matrices + nu[:, None, None] * RELATION)[:, 0])


def _matrix(entries: Array) -> Array:
    result = np.empty((*entries.shape[:-1], SIZE, SIZE))
    for column, (i, j) in enumerate(_PLACES):
        result[..., i, j] = result[..., j, i] = entries[..., column]
    return result
