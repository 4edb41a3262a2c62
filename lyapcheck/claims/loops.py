"""The letters of a closed loop with V of the form (13), for any robot and any function h, and its dV/dt.

    V = ½ yᵀMy + Σ k_pi U(e_i),  y = w − εh,  ε = ε₀/(1 + r),  r = ‖e‖,  U' = h
    ė = −w,  Mẇ = K_p h − K_v h(w) − Bw − Cw,  Ṁ = C + Cᵀ

C is a matrix of its own: C(q, w) with w = q̇ is (11); C(q, q̇_d + w) is the loop that (21) closes, where
w = −(q̇_d − q̇).

References: ``reyes2019family`` (11), (13), (15), (21).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.claims.bounds import FamilyBounds
from lyapcheck.claims.expressions import Expr, expr, var
from lyapcheck.claims.letters import (
    AnyMatrix,
    AnyVector,
    Least,
    Matrix,
    Norm,
    Rates,
    Vector,
    any_matrix,
    any_vector,
    apply,
    at_most_every_n,
    combined,
    diagonal,
    dot,
    every_n,
    form,
    matrix,
    plus,
    rate,
    scaled,
    transpose,
    vector,
    zero_vector,
)

V = TypeVar("V", Vector, AnyVector)
A = TypeVar("A", Matrix, AnyMatrix)


@dataclass(frozen=True)
class Loop(Generic[V, A]):
    """The letters: ``h`` stands for h(e), ``dh`` for h'(e), ``hw`` for h(w), ``a`` for ẇ.

    ``u`` is e/r, ``s`` is 1/(1 + r) and ``eps`` is ε: as these formulas say, or letters of their own.
    """

    w: V
    a: V
    e: V
    h: V
    dh: V
    U: V
    hw: V
    kp: V
    kv: V
    b: V
    u: V
    M: A
    C: A
    r: Expr
    eps0: Expr
    s: Expr
    eps: Expr

    @property
    def y(self) -> V:
        """w − εh."""
        return combined(self.w, -self.eps, self.h)

    @property
    def along(self) -> Expr:
        """êᵀw."""
        return dot(self.u, self.w)


Entries = Loop[Vector, Matrix]
Letters = Loop[AnyVector, AnyMatrix]
NAMES = {"a": "dw", "kp": "Kp", "kv": "Kv", "b": "B"} | {
    name: name for name in ("w", "e", "h", "dh", "U", "hw")
}
R, EPS0 = var("r"), var("eps0")


def loop(n: int) -> Entries:
    """The letters for n joints; M is symmetric, C any matrix."""
    own: dict[str, Any] = {field: vector(name, n) for field, name in NAMES.items()}
    own |= {"M": matrix("M", n, symmetric=True), "C": matrix("C", n), "u": [x / R for x in own["e"]]}
    return Loop(**own, r=R, eps0=EPS0, s=1 / (1 + R), eps=EPS0 / (1 + R))


def letters() -> Letters:
    """The letters for every number of joints."""
    short = short_letters()
    return replace(short, u=short.e.times(1 / R), s=1 / (1 + R), eps=EPS0 / (1 + R))


def short_letters() -> Letters:
    """The same with letters for e/r, 1/(1 + r) and ε, whose sizes are known."""
    own: dict[str, Any] = {field: any_vector(name) for field, name in NAMES.items()}
    own |= {"M": any_matrix("M"), "C": any_matrix("C"), "u": any_vector("u")}
    return Loop(**own, r=R, eps0=EPS0, s=var("s"), eps=var("eps"))


def energy(s: Loop[V, A]) -> Expr:
    """V of (13)."""
    return form(s.y, s.M, s.y) / 2 + dot(s.kp, s.U)


def along(s: Letters, function: Expr, equals: Expr) -> EveryN:
    """For every n and r > 0: a function has this derivative along the loop.

    ṙ = −êᵀw has no value at e = 0; where h = 0 as well, it enters V's derivative only in products with h.
    """
    rates, motion = (*moving(s), (s.e, -s.w), (s.r, -s.along), (s.eps0, expr(0))), (s.M, s.a, force(s))
    return every_n(rate(function), equals, (s.M,), rates, (motion,), (s.r,))


def moving(s: Letters) -> Rates:
    """The derivatives of all letters but e, r and ε; ẇ is a letter, Ṁ = C + Cᵀ and the gains stand still."""
    still = ((x, zero_vector()) for x in (s.kp, s.kv, s.b))
    return (
        (s.w, s.a),
        (s.h, -scaled(s.dh, s.w)),
        (s.U, -scaled(s.h, s.w)),
        (s.M, s.C + s.C.T),
        *still,
    )


def inertia(s: Loop[V, A]) -> V:
    """M ẇ."""
    return apply(s.M, s.a)


def force(s: Loop[V, A]) -> V:
    """What Mẇ equals in the loop: K_p h − K_v h(w) − Bw − Cw."""
    feedback, minus = scaled(s.kp, s.h), expr(-1)
    for resisting in (scaled(s.kv, s.hw), scaled(s.b, s.w), apply(s.C, s.w)):
        feedback = combined(feedback, minus, resisting)
    return feedback


def terms(s: Loop[V, A]) -> list[Expr]:
    """The eleven terms of (15), in printed order."""
    w, h, dw, eps = s.w, s.h, scaled(s.dh, s.w), s.eps
    return [
        -dot(w, scaled(s.kv, s.hw)),
        -dot(w, scaled(s.b, w)),
        eps * form(dw, s.M, w),
        -eps * s.s * s.along * form(h, s.M, w),
        -eps * form(h, transpose(s.C), w),
        -eps * dot(h, scaled(s.kp, h)),
        eps * dot(h, scaled(s.b, w)),
        eps * dot(h, scaled(s.kv, s.hw)),
        eps**2 * form(h, plus(s.C, transpose(s.C)), h) / 2,
        eps**2 * s.s * s.along * form(h, s.M, h),
        -(eps**2) * form(dw, s.M, h),
    ]


def term_at_most(
    s: Letters, k: int, right: Expr, norms: Iterable[Norm] = (), least: Iterable[Least] = ()
) -> BoundEveryN:
    """Term k of (15) is at most an expression for every n, by what is known of its letters."""
    return at_most_every_n(terms(s)[k - 1], right, norms, least)


def rate_at_most(s: Letters, right: Expr, norms: Iterable[Norm], least: Iterable[Least]) -> BoundEveryN:
    """dV/dt is at most an expression for every n; ``s`` are short letters, for which ε̇ = ε s êᵀw."""
    rates = (*moving(s), (s.eps, s.eps * s.s * s.along))
    return at_most_every_n(rate(energy(s)), right, norms, least, (s.M,), rates, ((s.M, s.a, force(s)),))


def known_norms(s: Letters, known: FamilyBounds) -> dict[str, Norm]:
    """What is known of the norms of the letters, in a = ‖h(e)‖, b = ‖w‖ and the constants of the loop.

    ``h`` bounds h(e) by a, ``reach`` by √nγ and ``share`` h(e)/(1 + r) by G.
    """
    a, b, beta, kc, kv_max, b_max = map(var, ("a", "b", "beta", "kc", "kv_max", "b_max"))
    return {
        "u": (s.u, 1),
        "w": (s.w, b),
        "h": (s.h, a),
        "reach": (s.h, known.reach),
        "share": ((s.s, s.h), known.G),
        "hw": (s.hw, known.L * b),
        "dh": (diagonal(s.dh), known.rho),
        "K_v": (diagonal(s.kv), kv_max),
        "B": (diagonal(s.b), b_max),
        "M": (s.M, beta),
        "C": (s.C, kc * b),
    }


def known_least(s: Letters) -> dict[str, Least]:
    """What is known of forms: h has the sign of its argument, and the least eigenvalues of B and K_p."""
    a, b, b_min, kp = map(var, ("a", "b", "b_min", "kp"))
    return {
        "damping": (dot(s.w, scaled(s.kv, s.hw)), 0),
        "friction": (dot(s.w, scaled(s.b, s.w)), b_min * b**2),
        "gain": (dot(s.h, scaled(s.kp, s.h)), kp * a**2),
    }
