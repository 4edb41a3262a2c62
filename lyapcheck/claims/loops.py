"""The letters of a closed loop with V of the form (13), for any robot and any function h, and its dV/dt.

    V = ½ yᵀMy + Σ k_pi U(e_i),  y = w − εh,  ε = ε₀/(1 + r),  r = ‖e‖,  U' = h
    ė = −w,  Mẇ = K_p h − K_v h(w) − Bw − Cw,  Ṁ = C + Cᵀ

C is a matrix of its own: C(q, w) with w = q̇ is (11); C(q, q̇_d + w) is the loop that (21) closes, where
w = −(q̇_d − q̇).

References: ``reyes2019family`` (11), (13), (15), (21).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.claims.bounds import FamilyBounds
from lyapcheck.claims.expressions import Expr, expr, var
from lyapcheck.claims.letters import (
    AnyMatrix,
    AnyVector,
    Least,
    Norm,
    Rates,
    any_matrix,
    any_vector,
    at_most_every_n,
    diagonal,
    dot,
    every_n,
    form,
    rate,
    scaled,
    zero_vector,
)

w, dw, e, h, dh, U, hw = map(any_vector, ("w", "dw", "e", "h", "dh", "U", "hw"))
Kp, Kv, B, u = map(any_vector, ("Kp", "Kv", "B", "u"))
M, C = map(any_matrix, "MC")
R, EPS0, SHARE, EPS = map(var, ("r", "eps0", "s", "eps"))


@dataclass(frozen=True)
class Loop:
    """The letters: ``h`` stands for h(e), ``dh`` for h'(e), ``hw`` for h(w), ``a`` for ẇ.

    ``u`` is e/r, ``s`` is 1/(1 + r) and ``eps`` is ε: as these formulas say, or letters of their own.
    """

    w: AnyVector = w
    a: AnyVector = dw
    e: AnyVector = e
    h: AnyVector = h
    dh: AnyVector = dh
    U: AnyVector = U
    hw: AnyVector = hw
    kp: AnyVector = Kp
    kv: AnyVector = Kv
    b: AnyVector = B
    u: AnyVector = u
    M: AnyMatrix = M
    C: AnyMatrix = C
    r: Expr = R
    eps0: Expr = EPS0
    s: Expr = SHARE
    eps: Expr = EPS

    @property
    def y(self) -> AnyVector:
        """w − εh."""
        return self.w + self.h.times(-self.eps)

    @property
    def along(self) -> Expr:
        """êᵀw."""
        return dot(self.u, self.w)


def letters() -> Loop:
    """With e/r, 1/(1 + r) and ε₀/(1 + r) written out."""
    return Loop(u=e.times(1 / R), s=1 / (1 + R), eps=EPS0 / (1 + R))


def short_letters() -> Loop:
    """With letters for them, whose sizes are known."""
    return Loop()


def energy(s: Loop) -> Expr:
    """V of (13)."""
    return form(s.y, s.M, s.y) / 2 + dot(s.kp, s.U)


def along(s: Loop, function: Expr, equals: Expr) -> EveryN:
    """For every n and r > 0: a function has this derivative along the loop.

    ṙ = −êᵀw has no value at e = 0; where h = 0 as well, it enters V's derivative only in products with h.
    """
    rates, motion = (*moving(s), (s.e, -s.w), (s.r, -s.along), (s.eps0, expr(0))), (s.M, s.a, force(s))
    return every_n(rate(function), equals, (s.M,), rates, (motion,), (s.r,))


def moving(s: Loop) -> Rates:
    """The derivatives of all letters but e, r and ε; ẇ is a letter, Ṁ = C + Cᵀ and the gains stand still."""
    still = ((x, zero_vector()) for x in (s.kp, s.kv, s.b))
    return (
        (s.w, s.a),
        (s.h, -scaled(s.dh, s.w)),
        (s.U, -scaled(s.h, s.w)),
        (s.M, s.C + s.C.T),
        *still,
    )


def inertia(s: Loop) -> AnyVector:
    """M ẇ."""
    return s.M @ s.a


def force(s: Loop) -> AnyVector:
    """What Mẇ equals in the loop: K_p h − K_v h(w) − Bw − Cw."""
    return scaled(s.kp, s.h) - scaled(s.kv, s.hw) - scaled(s.b, s.w) - s.C @ s.w


def terms(s: Loop) -> list[Expr]:
    """The eleven terms of (15), in printed order."""
    w, h, dw, eps = s.w, s.h, scaled(s.dh, s.w), s.eps
    return [
        -dot(w, scaled(s.kv, s.hw)),
        -dot(w, scaled(s.b, w)),
        eps * form(dw, s.M, w),
        -eps * s.s * s.along * form(h, s.M, w),
        -eps * form(h, s.C.T, w),
        -eps * dot(h, scaled(s.kp, h)),
        eps * dot(h, scaled(s.b, w)),
        eps * dot(h, scaled(s.kv, s.hw)),
        eps**2 * form(h, s.C + s.C.T, h) / 2,
        eps**2 * s.s * s.along * form(h, s.M, h),
        -(eps**2) * form(dw, s.M, h),
    ]


def term_at_most(
    s: Loop, k: int, right: Expr, norms: Iterable[Norm] = (), least: Iterable[Least] = ()
) -> BoundEveryN:
    """Term k of (15) is at most an expression for every n, by what is known of its letters."""
    return at_most_every_n(terms(s)[k - 1], right, norms, least)


def rate_at_most(s: Loop, right: Expr, norms: Iterable[Norm], least: Iterable[Least]) -> BoundEveryN:
    """dV/dt is at most an expression for every n; ``s`` are short letters, for which ε̇ = ε s êᵀw."""
    rates = (*moving(s), (s.eps, s.eps * s.s * s.along))
    return at_most_every_n(rate(energy(s)), right, norms, least, (s.M,), rates, ((s.M, s.a, force(s)),))


def known_norms(s: Loop, known: FamilyBounds) -> dict[str, Norm]:
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


def known_least(s: Loop) -> dict[str, Least]:
    """What is known of forms: h has the sign of its argument, and the least eigenvalues of B and K_p."""
    a, b, b_min, kp = map(var, ("a", "b", "b_min", "kp"))
    return {
        "damping": (dot(s.w, scaled(s.kv, s.hw)), 0),
        "friction": (dot(s.w, scaled(s.b, s.w)), b_min * b**2),
        "gain": (dot(s.h, scaled(s.kp, s.h)), kp * a**2),
    }
