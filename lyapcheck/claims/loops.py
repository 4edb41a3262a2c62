"""The letters of a closed loop with V of the form (13), for any robot and any function h, and its dV/dt.

    V = ½ yᵀMy + Σ k_pi U(e_i),  y = w − εh,  ε = ε₀/(1 + r),  r = ‖e‖,  U' = h
    ė = −w,  Mẇ = K_p h − K_v h(w) − Bw − Cw,  Ṁ = C + Cᵀ

C is a matrix of its own: C(q, w) with w = q̇ is (11); C(q, q̇_d + w) is the loop that (21) closes, where
w = −(q̇_d − q̇).

References: ``reyes2019family`` (11), (13), (15), (21).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.claims.bounds import FamilyBounds
from lyapcheck.claims.expressions import Expr, diff, expr, total, var
from lyapcheck.claims.letters import (
    AnyMatrix,
    AnyVector,
    Letter,
    any_matrix,
    any_vector,
    every_n,
    rate,
    zero_vector,
)
from lyapcheck.claims.products import (
    Matrix,
    Vector,
    apply,
    combined,
    dot,
    form,
    matrix,
    plus,
    scaled,
    transpose,
    vector,
)
from lyapcheck.claims.statements import Majorant, majorant

V = TypeVar("V", Vector, AnyVector)
A = TypeVar("A", Matrix, AnyMatrix)


@dataclass(frozen=True)
class Loop(Generic[V, A]):
    """The letters: ``h`` stands for h(e), ``dh`` for h'(e), ``hw`` for h(w), ``a`` for ẇ."""

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
    M: A
    C: A
    r: Expr
    eps0: Expr

    @property
    def eps(self) -> Expr:
        """ε = ε₀/(1 + r)."""
        return self.eps0 / (1 + self.r)

    @property
    def y(self) -> V:
        """w − εh."""
        return combined(self.w, -self.eps, self.h)

    @property
    def along(self) -> Expr:
        """êᵀw."""
        return dot(self.e, self.w) / self.r


Entries = Loop[Vector, Matrix]
Letters = Loop[AnyVector, AnyMatrix]
NAMES = ("w", "a", "e", "h", "dh", "U", "hw", "kp", "kv", "b")


def loop(n: int) -> Entries:
    """The letters for n joints; M is symmetric, C any matrix."""
    own = {name: vector(name, n) for name in NAMES}
    return Loop(**own, M=matrix("M", n, symmetric=True), C=matrix("C", n), r=var("r"), eps0=var("eps0"))


def letters() -> Letters:
    """The letters for every number of joints."""
    own = {name: any_vector(name) for name in NAMES}
    return Loop(**own, M=any_matrix("M"), C=any_matrix("C"), r=var("r"), eps0=var("eps0"))


def energy(s: Loop[V, A]) -> Expr:
    """V of (13)."""
    return form(s.y, s.M, s.y) / 2 + dot(s.kp, s.U)


def chain_rule(s: Entries, function: Expr) -> Expr:
    """The derivative of a function of the letters along the loop, ẇ = a left as it is.

    ṙ = −êᵀw has no value at e = 0; where h = 0 as well, it enters V's derivative only in products with h.
    """
    joints = range(len(s.w))
    rates = {f"w{i + 1}": s.a[i] for i in joints}
    rates |= {f"h{i + 1}": -s.dh[i] * s.w[i] for i in joints}
    rates |= {f"U{i + 1}": -s.h[i] * s.w[i] for i in joints}
    rates |= {f"M{i + 1}{j + 1}": s.C[i][j] + s.C[j][i] for i in joints for j in range(i, len(s.w))}
    rates["r"] = -s.along
    return total(diff(function, name) * rate for name, rate in rates.items())


def along(s: Letters, function: Expr, equals: Expr) -> EveryN:
    """For every n: a function has this derivative along the loop; the rates are those of ``chain_rule``."""
    still = [(x, zero_vector()) for x in (s.kp, s.kv, s.b)]
    moving = [(s.w, s.a), (s.e, -s.w), (s.h, -scaled(s.dh, s.w)), (s.U, -scaled(s.h, s.w))]
    scalars = [(s.r, -s.along), (s.eps0, expr(0))]
    rates: list[tuple[Letter, Letter]] = [*scalars, *moving, *still, (s.M, s.C + s.C.T)]
    return every_n(rate(function), equals, (s.M,), rates, [(s.M, s.a, force(s))])


def inertia(s: Loop[V, A]) -> V:
    """M ẇ."""
    return apply(s.M, s.a)


def force(s: Loop[V, A]) -> V:
    """What Mẇ equals in the loop: K_p h − K_v h(w) − Bw − Cw."""
    pull, minus = scaled(s.kp, s.h), expr(-1)
    for resisting in (scaled(s.kv, s.hw), scaled(s.b, s.w), apply(s.C, s.w)):
        pull = combined(pull, minus, resisting)
    return pull


def terms(s: Loop[V, A]) -> list[Expr]:
    """The eleven terms of (15), in printed order."""
    w, h, dw, eps = s.w, s.h, scaled(s.dh, s.w), s.eps
    return [
        -dot(w, scaled(s.kv, s.hw)),
        -dot(w, scaled(s.b, w)),
        eps * form(dw, s.M, w),
        -eps / (1 + s.r) * s.along * form(h, s.M, w),
        -eps * form(h, transpose(s.C), w),
        -eps * dot(h, scaled(s.kp, h)),
        eps * dot(h, scaled(s.b, w)),
        eps * dot(h, scaled(s.kv, s.hw)),
        eps**2 * form(h, plus(s.C, transpose(s.C)), h) / 2,
        eps**2 / (1 + s.r) * s.along * form(h, s.M, h),
        -(eps**2) * form(dw, s.M, h),
    ]


def rate_with(s: Loop[V, A], moved: V) -> Expr:
    """dV/dt with Mẇ replaced by a vector: yᵀ(Mẇ − M d(εh)/dt) + ½yᵀ(C + Cᵀ)y − Σ k_pi h(e_i) w_i."""
    turned = combined(moved, -s.eps / (1 + s.r) * s.along, apply(s.M, s.h))
    pull = combined(turned, s.eps, apply(s.M, scaled(s.dh, s.w)))
    turning = form(s.y, plus(s.C, transpose(s.C)), s.y) / 2
    return dot(s.y, pull) + turning - dot(s.w, scaled(s.kp, s.h))


def norms(known: FamilyBounds) -> dict[str, tuple[Majorant, ...]]:
    """What is known of the norm of each factor in ``terms``, in a = ‖h(e)‖, w = ‖w‖, v = ‖q̇‖ and constants.

    ``beta``, ``kc``, ``b_max`` and ``kv_max`` are the bounds of M, C, B and K_v.
    """
    return {
        "eps": (majorant(eps=1),),
        "ê·w": (majorant(w=1),),
        "h(e)": (majorant(a=1), majorant(known.reach)),
        "h(e)/(1+r)": (majorant(known.G),),
        "h(w)": (majorant(known.L, w=1),),
        "h'(e)∘w": (majorant(known.rho, w=1),),
        "w": (majorant(w=1),),
        "M": (majorant(beta=1),),
        "C(q,w)": (majorant(kc=1, w=1),),
        "C(q,q̇)": (majorant(kc=1, v=1),),
        "K_v": (majorant(kv_max=1),),
        "B": (majorant(b_max=1),),
    }
