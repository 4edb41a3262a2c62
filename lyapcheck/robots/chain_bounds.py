"""Bounds that hold for a chain of links in every state, from masses and distances alone, exactly.

They are coarse but need no search, so that they hold up for any number of joints. With y_k = |ω_k| the
rate at which link k turns, j_k and J_k the ends of the spectrum of its inertia, and ρ_ik the largest
distance of its centre of mass from the axis of joint i:

    xᵀMx ≥ Σ j_k y_k²,          x_i² ≤ (y_i + y_{i−1})²,
    xᵀMx ≤ |x|ᵀ B |x|,          B_ij = Σ_{k≥i,j} (m_k ρ_ik ρ_jk + J_k),
    |c_ijk| ≤ N_ijk = Σ_{l≥i,j,k} (m_l ρ_il ρ_{max(j,k),l} + J_l).

The last one is c_ijk = ∫ ∂p/∂q_i · ∂²p/∂q_j∂q_k dm over the points p of the links, where the second
derivative is a_j × (a_k × (p − o_k)) for j ≤ k; it takes bodies whose mass is nowhere negative.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from lyapcheck.check.loop.chain import RigidLink, lever_bound
from lyapcheck.check.numbers.vectors import Algebra, is_positive_semidefinite
from lyapcheck.robots.dynamics import Chain

_DIGITS = 10**12
_HALVINGS = 30
_STEPS = 30
Vector = Sequence[Fraction]
Tensor = Sequence[Vector]


def chain_bounds(chain: Chain) -> dict[str, Fraction | None]:
    """Bounds for all angles of a chain of exact links: λmin(M) from below, else from above, by name.

    ``k_g1`` … of |g_i|, N·m; ``k_c`` is ``None`` where a link has an inertia that no body has; kg·m².

    Soundness: rational arithmetic, roots and eigenvalues rounded to the safe side.
    """
    links = chain.links
    masses, tensors = [link.mass for link in links], [link.inertia for link in links]
    spectra = [_spectrum(tensor) for tensor in tensors]
    distances = _distances(links)
    rotors = [link.rotor for link in links]
    largest = [high for _, high in spectra]
    return {
        "lambda_min": _smallest([low for low, _ in spectra]) + min(rotors),
        "lambda_max": _largest(masses, largest, distances) + max(rotors),
        "k_c": _coriolis(masses, largest, distances) if all(map(bodily, tensors)) else None,
    } | {f"k_g{i + 1}": lever_bound(links, chain.fall, i, ()) for i in range(chain.n)}


def _distances(links: Sequence[RigidLink]) -> list[list[Fraction]]:
    """ρ_ik, 0 for links before the joint; what link i itself holds keeps its distance from axis i."""
    arms = [_norm(link.com) for link in links]
    steps = [_norm(link.origin) for link in links]
    n = len(links)
    rows = [[Fraction(0)] * n for _ in range(n)]
    for i, link in enumerate(links):
        rows[i][i] = _from_axis(link, link.com)
        for k in range(i + 1, n):
            first = _from_axis(link, links[i + 1].origin)
            rows[i][k] = first + sum(steps[i + 2 : k + 1], Fraction(0)) + arms[k]
    return rows


def _from_axis(link: RigidLink, point: Vector) -> Fraction:
    return _norm(Algebra(Fraction).cross(link.axis, point))


def _smallest(inertia: Sequence[Fraction]) -> Fraction:
    """1/ρ(J⁻¹T) with T = Σ (e_i + e_{i−1})(e_i + e_{i−1})ᵀ."""
    if min(inertia) <= 0:
        return Fraction(0)
    n = len(inertia)
    rows = [[Fraction(0)] * n for _ in range(n)]
    for i in range(n):
        rows[i][i] = Fraction(2 if i < n - 1 else 1) / inertia[i]
        for k in (i - 1, i + 1):
            if 0 <= k < n:
                rows[i][k] = 1 / inertia[i]
    return 1 / _radius(rows)


def _largest(
    masses: Sequence[Fraction], inertia: Sequence[Fraction], distances: Sequence[Sequence[Fraction]]
) -> Fraction:
    joints = range(len(masses))

    def entry(i: int, j: int) -> Fraction:
        moved = [k for k in joints if k >= max(i, j)]
        return sum((masses[k] * distances[i][k] * distances[j][k] + inertia[k] for k in moved), Fraction(0))

    return _radius([[entry(i, j) for j in joints] for i in joints])


def _coriolis(
    masses: Sequence[Fraction], inertia: Sequence[Fraction], distances: Sequence[Sequence[Fraction]]
) -> Fraction:
    """ρ(Σ_i N_i²)^½ with N_i = (N_ijk)_jk, which bounds Σ N_ijk z_i x_j y_k for unit vectors."""
    joints = range(len(masses))

    def entry(i: int, j: int, k: int) -> Fraction:
        moved = [m for m in joints if m >= max(i, j, k)]
        return sum(
            (masses[m] * distances[i][m] * distances[max(j, k)][m] + inertia[m] for m in moved), Fraction(0)
        )

    layers = [[[entry(i, j, k) for k in joints] for j in joints] for i in joints]
    squares = [
        [sum((n[j][m] * n[m][k] for n in layers for m in joints), Fraction(0)) for k in joints]
        for j in joints
    ]
    return _root(_radius(squares))


def bodily(tensor: Tensor) -> bool:
    """Whether some body has this inertia: the second moments ½tr(I) − I are positive semidefinite.

    They are so exactly when no principal moment is above the sum of the others.
    """
    half = (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 2
    return is_positive_semidefinite([[half * (i == k) - tensor[i][k] for k in range(3)] for i in range(3)])


def _radius(rows: Sequence[Sequence[Fraction]]) -> Fraction:
    """An upper bound of the spectral radius of a matrix without negative entries (Collatz and Wielandt)."""
    w = [Fraction(1)] * len(rows)
    for _ in range(_STEPS):
        image = [sum((a * x for a, x in zip(row, w, strict=True)), Fraction(0)) for row in rows]
        largest = max(image) or Fraction(1)
        w = [Fraction(max(round(x / largest * _DIGITS), 1), _DIGITS) for x in image]
    image = [sum((a * x for a, x in zip(row, w, strict=True)), Fraction(0)) for row in rows]
    return _above(max(y / x for x, y in zip(w, image, strict=True)))


def _spectrum(tensor: Tensor) -> tuple[Fraction, Fraction]:
    """A lower bound of the smallest and an upper bound of the largest eigenvalue, by halving."""
    trace = sum((tensor[i][i] for i in range(3)), Fraction(0))
    low, high, step = Fraction(0), _above(trace), _above(trace)
    for _ in range(_HALVINGS):
        step /= 2
        if _definite(tensor, low + step, 1):
            low += step
        if _definite(tensor, high - step, -1):
            high -= step
    return low, high


def _definite(tensor: Tensor, shift: Fraction, sign: int) -> bool:
    """Whether ±(A − shift I) is positive semidefinite."""
    return is_positive_semidefinite(
        [[sign * (x - (shift if i == k else 0)) for k, x in enumerate(row)] for i, row in enumerate(tensor)]
    )


def _norm(vector: Vector) -> Fraction:
    return _root(sum((x * x for x in vector), Fraction(0)))


def _root(square: Fraction) -> Fraction:
    root = math.isqrt(math.ceil(square * _DIGITS**2))
    return Fraction(root if Fraction(root, _DIGITS) ** 2 >= square else root + 1, _DIGITS)


def _above(value: Fraction) -> Fraction:
    return Fraction(math.ceil(value * _DIGITS**2), _DIGITS**2)
