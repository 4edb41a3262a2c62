"""dV/dt of (15) as a quadratic form without velocities, in any arithmetic.

With h(w) = D w, D = diag(h(w_i)/w_i), and C(q, w) h = C(q, h) w, every term of (15) is quadratic in
z = [√ε h; w], and dV/dt = −zᵀ Q z exactly, where

    Q = [ K_p        −½√ε X ]      X = B + K_v D + ε S
        [ −½√ε Xᵀ       Y   ]      Y = B + K_v D + ε sym(S) = sym(X)
                                   S = C(q,h) + (Mh) êᵀ/(1+r) − M H'

and sym(A) = ½(A + Aᵀ), H' = diag(h'(e_i)), ê = e/r (0 at e = 0), ε = ε₀/(1 + r). Term by term of (15):
6 is the corner K_p; 1 and 2 are B + K_v D in Y; 3, 4, 5 are the three parts of sym(S) in Y, transposed; 7 and
8 are B + K_v D in X; 9, 10, 11 are the three parts of S in X. Terms 5 and 9 use wᵀC(q,w)h = wᵀC(q,h)w.
Because Y = sym(X), the whole is also

    dV/dt = −ε hᵀ K_p h − (w − ε h)ᵀ X w.

The entries may be floats, arrays, intervals, balls, exact rationals or CasADi expressions: only +, − and *
are used, and ½ is given in the arithmetic at hand where a half is needed.

Soundness: M symmetric; C(q, ·) from the Christoffel symbols of M; an enclosing arithmetic gives enclosures.

References: (15) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

Vector = Sequence[Any]
Matrix = Sequence[Sequence[Any]]
Rows = list[list[Any]]


def damping(B: Vector, kv: Vector, D: Vector) -> list[Any]:
    """The diagonal of B + K_v D, n, N·m·s/rad; D_i = h(w_i)/w_i lies in [0, L]."""
    return [b + k * d for b, k, d in zip(B, kv, D, strict=True)]


def coupling(M: Matrix, Ch: Matrix, h: Vector, dh: Vector, e_hat: Vector, one_plus_r: Any) -> Rows:
    """S = C(q,h) + (Mh) êᵀ/(1+r) − M H', (n, n), kg·m²; not symmetric.

    Args:
        M: inertia matrix, (n, n), kg·m².
        Ch: C(q, h), (n, n), kg·m².
        h: h(e_i), n.
        dh: h'(e_i), n.
        e_hat: e/‖e‖, 0 at e = 0, n.
        one_plus_r: the factor 1/(1 + ‖e‖) itself.
    """
    n = len(h)
    Mh = [dot(row, h) * one_plus_r for row in M]
    return _rows(n, lambda i, j: Ch[i][j] + Mh[i] * e_hat[j] - M[i][j] * dh[j])


def x_matrix(damped: Vector, S: Matrix, eps: Any) -> Rows:
    """X = B + K_v D + ε S, (n, n), N·m·s/rad, from the diagonal of B + K_v D and S."""
    return _rows(len(damped), lambda i, j: damped[i] + eps * S[i][j] if i == j else eps * S[i][j])


def y_matrix(damped: Vector, S: Matrix, eps: Any, half: Any = 0.5) -> Rows:
    """Y = B + K_v D + ε sym(S), (n, n), N·m·s/rad; symmetric.

    dV/dt = −wᵀYw + O(‖w‖), so Y ⪰ 0 at D → 0 (‖w‖ → ∞, bounded h) is necessary for dV/dt ≤ 0.
    """

    def entry(i: int, j: int) -> Any:
        return damped[i] + eps * S[i][i] if i == j else eps * (half * (S[i][j] + S[j][i]))

    n = len(damped)
    upper = {(i, j): entry(i, j) for i in range(n) for j in range(i, n)}
    return _rows(n, lambda i, j: upper[min(i, j), max(i, j)])


def quadratic_form(kp: Vector, X: Matrix, Y: Matrix, root_eps: Any, half: Any = 0.5, zero: Any = 0.0) -> Rows:
    """Q, (2n, 2n): K_p in its corner, −½√ε X beside it, Y below.

    Args:
        kp: diagonal of K_p, n, N·m.
        X: (n, n).
        Y: (n, n).
        root_eps: √ε.
        half: ½ in the arithmetic used.
        zero: 0 in the arithmetic used.
    """
    n = len(kp)
    beside = _rows(n, lambda i, j: -(half * (root_eps * X[i][j])))
    upper = [[kp[i] if i == j else zero for j in range(n)] + beside[i] for i in range(n)]
    return upper + [[beside[i][j] for i in range(n)] + list(Y[j]) for j in range(n)]


def rate(kp: Vector, X: Matrix, h: Vector, w: Vector, eps: Any) -> Any:
    """dV/dt = −ε hᵀ K_p h − (w − ε h)ᵀ X w, W."""
    y = [a - eps * b for a, b in zip(w, h, strict=True)]
    corner = dot(h, [k * b for k, b in zip(kp, h, strict=True)])
    return -(eps * corner + dot(y, [dot(row, w) for row in X]))


def dot(x: Vector, y: Vector) -> Any:
    """xᵀ y."""
    first, *rest = [a * b for a, b in zip(x, y, strict=True)]
    for term in rest:
        first = first + term
    return first


def _rows(n: int, entry: Callable[[int, int], Any]) -> Rows:
    return [[entry(i, j) for j in range(n)] for i in range(n)]
