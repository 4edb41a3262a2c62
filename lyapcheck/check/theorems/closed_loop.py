"""The closed loop that a theorem is about, as data."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.statement import Monomials, Relation


@dataclass(frozen=True)
class ArmAndGains:
    """One arm under given gains: M(q) in kg·m², the diagonals of B, N·m·s/rad, of K_p and K_v, N·m."""

    mass: tuple[tuple[Monomials, ...], ...]
    viscous: tuple[Fraction, ...]
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]


@dataclass(frozen=True)
class ClosedLoop:
    """A loop of the form (11), V of the form (13), and the bounds by which it is shown to be stable.

        ė = −w,  Mẇ = K_p h(e) − K_v h(w) − Bw − Cw,     V = ½yᵀMy + Σ k_pi (U(e_i) − U(0)),  y = w − εh(e)
        dV/dt <= −[a b] Θ [a b]ᵀ,  a = ‖h(e)‖, b = ‖w‖, ε = ε₀/(1 + ‖e‖),     Θ = [θ11 θ12; θ12 θ22]

    Attributes:
        n: the number of joints.
        h: an expression in x; likewise its derivative ``slope`` and U, ``potential``.
        gamma: at least sup |h|; so ``rho`` for |h'|, ``L`` for h(x)/x, ``reach`` for ‖h(e)‖ and ``G`` for
            ‖h(e)‖/(1 + ‖e‖).
        form: θ11, θ12, θ22 in eps, eps0, kp = λmin(K_p), b_min and b_max for B, kv_max = λmax(K_v), beta, kc
            and vd.
        desired: whether C is C(q, q̇_d + w) with ‖q̇_d‖ <= vd, as in (21), and not C(q, w).
        condition: what is asked of ε₀ = eps0 and the constants; empty where some ε₀ > 0 is enough.
        arm: the arm and the gains, where the conclusion is for these alone.
        numbers: bounds of its constants, and eps0; none without an arm.
    """

    n: int
    h: Tree
    slope: Tree
    potential: Tree
    gamma: Fraction
    rho: Fraction
    L: Fraction
    reach: Fraction
    G: Fraction
    form: tuple[Tree, Tree, Tree]
    desired: bool = False
    condition: tuple[Relation, ...] = ()
    arm: ArmAndGains | None = None
    numbers: tuple[tuple[str, Fraction], ...] = ()
