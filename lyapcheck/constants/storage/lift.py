"""Products of rates as coordinates in which C(q, q̇)q̇ is linear.

For rates x and z of the joints let V and Z be the twists of a link, A the acceleration that x alone causes
(q̈ = 0), and N the sum of the x² so far. The state is w = (Z, A, W, N), where W has the 21 products of the
components of V in combinations that turns about the third axis rotate in pairs, or not at all. A joint adds

    Z' = Z + s z,   A' = A + (V x) × s,   W' = W + sym(2 V x sᵀ) + s sᵀ x²,   N' = N + x²

for the twist s of its axis, which is linear in w and u = (z, V x, x²); and zᵀC(q, x)x is the sum of the
Z'ᵀ(G A' + V' ×* G V') of the links, a quadratic form of the states.

References: recursive Newton–Euler algorithm, featherstone2008rigid chapter 5.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from flint import fmpq, fmpq_mat

from lyapcheck._types import Array
from lyapcheck.constants.storage.exact import Exact, cross, exact, unit, zeros

STATE, INPUT = 34, 8
ROWS = STATE + INPUT
Z, A, W, N = slice(0, 6), slice(6, 12), slice(12, 33), 33
RATE, MIXED, SQUARE = 34, slice(35, 41), 41
"""Places of z, V x and x² among (w, u)."""
AXIS = exact([[0, 0, 1, 0, 0, 0]])[0]

_VECTOR = ((1, (0, 1)), (0, (2,)))
"""How the components of a vector turn about the third axis: a pair at the rate 1, and one not at all."""


def _products() -> tuple[list[Array], list[tuple[int, tuple[int, ...]]]]:
    """Symmetric matrices F with the product ⟨F, V Vᵀ⟩, and at which rate which of them turn."""
    result: list[Array] = []
    rotation: list[tuple[int, tuple[int, ...]]] = []

    def entry(i: int, j: int) -> Array:
        matrix = np.zeros((6, 6))
        matrix[i, j] += 0.5
        matrix[j, i] += 0.5
        return matrix

    def add(rate: int, *forms: Array) -> None:
        rotation.append((rate, tuple(range(len(result), len(result) + len(forms)))))
        result.extend(forms)

    for x, y, z in ((0, 1, 2), (3, 4, 5)):
        add(0, entry(x, x) + entry(y, y))
        add(0, entry(z, z))
        add(1, entry(x, z), entry(y, z))
        add(2, entry(x, x) - entry(y, y), 2 * entry(x, y))
    add(0, entry(0, 3) + entry(1, 4))
    add(0, entry(2, 5))
    add(0, entry(0, 4) - entry(1, 3))
    add(1, entry(0, 5), entry(1, 5))
    add(1, entry(2, 3), entry(2, 4))
    add(2, entry(0, 3) - entry(1, 4), entry(0, 4) + entry(1, 3))
    return result, rotation


_FORMS, _ROTATION = _products()
_TO: Exact = exact([form.reshape(36) for form in _FORMS])


@lru_cache(maxsize=1)
def _from() -> Exact:
    """From the 21 products to the symmetric matrix V Vᵀ, 36 × 21."""
    square = fmpq_mat(21, 21, [x for row in _TO @ _TO.T for x in row]).inv()
    inverse = np.array([[square[i, j] for j in range(21)] for i in range(21)], dtype=object)
    return np.asarray(_TO.T @ inverse)


def products(matrix: Exact) -> Exact:
    """The 21 products of a symmetric matrix, (21,)."""
    return np.asarray(_TO @ matrix.reshape(36))


def _matrices() -> list[Exact]:
    return [_from()[:, i].reshape(6, 6) for i in range(21)]


def invariant_forms() -> list[Array]:
    """A basis of the forms of w that turns about the third axis leave as they are."""
    places = [
        (rate, tuple(6 * v + 3 * h + i for i in ix)) for v in (0, 1) for h in (0, 1) for rate, ix in _VECTOR
    ]
    places += [(rate, tuple(12 + i for i in ix)) for rate, ix in _ROTATION] + [(0, (N,))]
    result = []
    for index, (rate, rows) in enumerate(places):
        for other, columns in places[index:]:
            if rate == other:
                result += _patterns(rows, columns)
    return result


def _patterns(rows: tuple[int, ...], columns: tuple[int, ...]) -> list[Array]:
    """a·b and, for two different pairs, a × b as well."""
    straight, skew = np.zeros((STATE, STATE)), np.zeros((STATE, STATE))
    for i, j in zip(rows, columns, strict=True):
        straight[i, j] = straight[j, i] = 1
    if len(rows) == 1 or rows == columns:
        return [straight]
    skew[rows[0], columns[1]] = skew[columns[1], rows[0]] = 1
    skew[rows[1], columns[0]] = skew[columns[0], rows[1]] = -1
    return [straight, skew]


def carried(carry: Exact) -> Exact:
    """From the state of the link before to that of this one at q = 0, 34 × 34, given how twists go."""
    result = zeros(STATE, STATE)
    result[Z, Z] = result[A, A] = carry
    for i, matrix in enumerate(_matrices()):
        result[W, 12 + i] = products(carry @ matrix @ carry.T)
    result[N, N] = fmpq(1)
    return result


def step() -> Exact:
    """(w, u) ↦ w', 34 × 42."""
    result = np.hstack([unit(STATE), zeros(STATE, INPUT)])
    result[Z, RATE] = AXIS
    for i, e in enumerate(unit(6)):
        result[A, 35 + i] = onto_axis(e)
        result[W, 35 + i] = products(np.outer(e, AXIS) + np.outer(AXIS, e))
    result[W, SQUARE] = products(np.outer(AXIS, AXIS))
    result[N, SQUARE] = fmpq(1)
    return result


def onto_axis(twist: Exact) -> Exact:
    """V × s."""
    return np.concatenate([cross(twist[:3]) @ AXIS[:3], cross(twist[3:]) @ AXIS[:3]])


def power(body: Exact) -> Exact:
    """2 Zᵀ(G A + V ×* G V) as a form of w."""
    half = zeros(STATE, STATE)
    half[Z, A] = body
    for i, matrix in enumerate(_matrices()):
        moved = matrix @ body
        force = _axial(moved[:3, 3:])
        half[Z, 12 + i] = np.concatenate([_axial(moved[:3, :3]) + _axial(moved[3:, 3:]), force])
    return np.asarray(half + half.T)


def _axial(matrix: Exact) -> Exact:
    """a × b of a bᵀ."""
    return np.array([matrix[i, j] - matrix[j, i] for i, j in ((1, 2), (2, 0), (0, 1))], dtype=object)


def monomials() -> dict[tuple[int, int], Array]:
    """The products of the seven numbers (V, x) as functions of (w, u)."""
    back = _from().astype(np.float64).reshape(6, 6, 21)
    result = {}
    for i, j in combinations_with_replacement(range(7), 2):
        row = np.zeros(ROWS)
        if j < 6:
            row[W] = back[i, j]
        else:
            row[35 + i if i < 6 else SQUARE] = 1
        result[i, j] = row
    return result


def relations() -> list[Array]:
    """Forms of (w, u) that vanish because all products are of the same seven numbers: ab·cd = ac·bd."""
    rows, result = monomials(), []
    for a, b, c, d in combinations_with_replacement(range(7), 4):
        pairs = (((a, b), (c, d)), ((a, c), (b, d)), ((a, d), (b, c)))
        ways = list(dict.fromkeys((min(p, q), max(p, q)) for p, q in pairs))
        for way in ways[1:]:
            difference = np.outer(rows[ways[0][0]], rows[ways[0][1]]) - np.outer(rows[way[0]], rows[way[1]])
            result.append(difference + difference.T)
    return result


def positive_products() -> dict[tuple[int, int], Array]:
    """N times each product of (V, x): as N ≥ 0, weighted by a matrix ⪰ 0 they are not negative."""
    count = np.zeros(ROWS)
    count[N] = 1
    return {place: np.outer(count, row) + np.outer(row, count) for place, row in monomials().items()}
