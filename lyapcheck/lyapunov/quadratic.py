"""dV/dt of (15) as a quadratic form without velocities, in any arithmetic.

With h(w) = D w, D = diag(h(w_i)/w_i), and C(q, w) h = C(q, h) w, every term of (15) is quadratic in
z = [√ε h; w], and dV/dt = −zᵀ Q z exactly, where

    Q = [ K_p        −½√ε X ]      X = B + K_v D + ε (C(q,h) + (Mh) êᵀ/(1+r) − M H')
        [ −½√ε Xᵀ       Y   ]      Y = B + K_v D − ε sym(H'M − ê (Mh)ᵀ/(1+r) − C(q,h))

and sym(A) = ½(A + Aᵀ), H' = diag(h'(e_i)), ê = e/r (0 at e = 0), ε = ε₀/(1 + r). Term by term of (15):
6 is the corner K_p; 1 and 2 are B + K_v D in Y; 3, 4, 5 are the three parts of sym(·); 7 and 8 are B + K_v D
in X; 9, 10, 11 are the three parts of ε(·) in X. Terms 5 and 9 use wᵀC(q,w)h = wᵀC(q,h)w.

The entries may be floats, arrays, intervals, balls, exact rationals or CasADi expressions: only +, − and *
are used, and halves by multiplying with the argument ``half``.

Soundness: M symmetric; C(q, ·) from the Christoffel symbols of M; an enclosing arithmetic gives enclosures.

References: (15) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

Vector = Sequence[Any]
Rows = list[list[Any]]


@dataclass(frozen=True)
class Parts:
    """What X and Y are made of, at one state or one box of states.

    Args:
        M: inertia matrix, (n, n), kg·m².
        Ch: C(q, h), (n, n), kg·m².
        h: h(e_i).
        dh: h'(e_i).
        e_hat: e/‖e‖, 0 at e = 0.
        D: h(w_i)/w_i, each in [0, L].
        kv: diagonal of K_v, N·m.
        B: diagonal of B, N·m·s/rad.
        eps: ε = ε₀/(1 + ‖e‖).
        one_plus_r: 1/(1 + ‖e‖), its inverse; the factor that belongs to ê.
        half: ½ in the arithmetic used.
    """

    M: Sequence[Vector]
    Ch: Sequence[Vector]
    h: Vector
    dh: Vector
    e_hat: Vector
    D: Vector
    kv: Vector
    B: Vector
    eps: Any
    one_plus_r: Any
    half: Any = 0.5

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.h)

    def momentum(self) -> list[Any]:
        """M h / (1 + r)."""
        return [_dot(row, self.h) * self.one_plus_r for row in self.M]

    def damping(self) -> list[Any]:
        """The diagonal of B + K_v D."""
        return [b + k * d for b, k, d in zip(self.B, self.kv, self.D, strict=True)]


def cross(parts: Parts) -> Rows:
    """X = B + K_v D + ε (C(q,h) + (Mh) êᵀ/(1+r) − M H'), (n, n), N·m·s/rad; not symmetric."""
    p, Mh, damping = parts, parts.momentum(), parts.damping()

    def entry(i: int, j: int) -> Any:
        turned = p.eps * (p.Ch[i][j] + Mh[i] * p.e_hat[j] - p.M[i][j] * p.dh[j])
        return turned + damping[i] if i == j else turned

    return _rows(p.n, entry)


def fast(parts: Parts) -> Rows:
    """Y = B + K_v D − ε sym(H'M − ê (Mh)ᵀ/(1+r) − C(q,h)), (n, n), N·m·s/rad; symmetric.

    At D = 0 it is what dV/dt = −wᵀYw + O(‖w‖) becomes for fast states: Y ⪰ 0 is necessary there.
    """
    p, damping, spread = parts, parts.damping(), spread_matrix(parts)

    def entry(i: int, j: int) -> Any:
        turned = p.eps * spread[i][j]
        return damping[i] - turned if i == j else -turned

    return _rows(p.n, entry)


def spread_matrix(parts: Parts) -> Rows:
    """S = sym(H'M − ê (Mh)ᵀ/(1+r) − C(q,h)), (n, n), kg·m²; Y = B + K_v D − ε S."""
    p, Mh = parts, parts.momentum()

    def entry(i: int, j: int) -> Any:
        if i == j:
            return p.M[i][i] * p.dh[i] - p.e_hat[i] * Mh[i] - p.Ch[i][i]
        inertia = p.M[i][j] * (p.dh[i] + p.dh[j])
        return (inertia - p.e_hat[i] * Mh[j] - p.e_hat[j] * Mh[i] - p.Ch[i][j] - p.Ch[j][i]) * p.half

    return _mirrored(p.n, entry)


def quadratic_form(parts: Parts, kp: Vector, root_eps: Any, zero: Any = 0) -> Rows:
    """Q, (2n, 2n): K_p in its corner, −½√ε X beside it, Y below.

    Args:
        parts: what X and Y are made of.
        kp: diagonal of K_p, N·m.
        root_eps: √ε in the same arithmetic.
        zero: what stands beside the diagonal of K_p.
    """
    n, X, Y = parts.n, cross(parts), fast(parts)
    scale = -parts.half * root_eps
    upper = [[kp[i] if i == j else zero for j in range(n)] + [scale * x for x in X[i]] for i in range(n)]
    return upper + [[scale * X[i][j] for i in range(n)] + Y[j] for j in range(n)]


def value(form: Sequence[Vector], z: Vector) -> Any:
    """zᵀ Q z."""
    return _dot(z, [_dot(row, z) for row in form])


def _dot(x: Vector, y: Vector) -> Any:
    first, *rest = [a * b for a, b in zip(x, y, strict=True)]
    for term in rest:
        first = first + term
    return first


def _rows(n: int, entry: Any) -> Rows:
    return [[entry(i, j) for j in range(n)] for i in range(n)]


def _mirrored(n: int, entry: Any) -> Rows:
    upper = {(i, j): entry(i, j) for i in range(n) for j in range(i, n)}
    return [[upper[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]
