"""dV/dt of a closed loop against its quadratic form, for every n: the statement that the theorem needs.

With u = e/‖e‖ and s = 1/(1 + ‖e‖) the rate of ε = ε₀s is ε s uᵀw. H' = diag(dh), K_p = diag(Kp), and so on.

References: ``reyes2019family`` (11), (13), (15), (21).
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.certificates.every_n import BoundEveryN, Given
from lyapcheck.check.certificates.theorems import ClosedLoop
from lyapcheck.check.functions import Tree

EPS, S, A, B = (("var", name) for name in ("eps", "s", "a", "b"))
W, H, U, UNIT, DAMPING, ACCELERATION = (("vec", name) for name in ("w", "h", "U", "u", "hw", "dw"))
M, C, D = (("mat", name) for name in "MCD")
"""``C`` stands for C(q, w), ``D`` for C(q, q̇_d)."""
KP: Tree = ("vec", "Kp")


def rate_bound(loop: ClosedLoop) -> BoundEveryN:
    """dV/dt <= −[a b] Θ [a b]ᵀ for every n, from the norms of the letters."""
    turning: Tree = ("sum", C, D) if loop.desired else C
    push = ("sum", _scaled("Kp", H), _minus(_scaled("Kv", DAMPING)), _minus(_scaled("B", W)))
    y: Tree = ("sum", W, ("scale", ("neg", EPS), H))
    energy: Tree = ("add", ("div", _form(y, M, y), ("num", "2")), ("dot", KP, U))
    rates = (
        (W, ACCELERATION),
        (H, _minus(_scaled("dh", W))),
        (U, _minus(_scaled("h", W))),
        (KP, ("sum",)),
        (M, ("sum", turning, ("transpose", turning))),
        (EPS, ("mul", EPS, S, ("dot", UNIT, W))),
    )
    motion = Given("M", "dw", ("sum", push, _minus(("apply", turning, W))))
    corner, side, low = loop.form
    form = ("add", ("mul", corner, A, A), ("mul", ("num", "2"), side, A, B), ("mul", low, B, B))
    return BoundEveryN(("rate", energy), ("neg", form), ("M",), rates, (motion,), _norms(loop), _least())


def _norms(loop: ClosedLoop) -> tuple[tuple[tuple[Tree, ...], Tree], ...]:
    """Cauchy–Schwarz is used with these; what they rest on is for the premises of the theorem to show."""
    known: tuple[tuple[tuple[Tree, ...], Tree], ...] = (
        ((UNIT,), ("num", "1")),
        ((W,), B),
        ((H,), A),
        ((H,), _num(loop.reach)),
        ((S, H), _num(loop.G)),
        ((DAMPING,), ("mul", _num(loop.L), B)),
        ((("diag", "dh"),), _num(loop.rho)),
        ((("diag", "Kv"),), ("var", "kv_max")),
        ((("diag", "B"),), ("var", "b_max")),
        ((M,), ("var", "beta")),
        ((C,), ("mul", ("var", "kc"), B)),
    )
    return (*known, ((D,), ("mul", ("var", "kc"), ("var", "vd")))) if loop.desired else known


def _least() -> tuple[tuple[Tree, Tree], ...]:
    """wᵀK_v h(w) >= 0, as h has the sign of its argument, and the least eigenvalues of B and K_p."""
    return (
        (("dot", W, _scaled("Kv", DAMPING)), ("num", "0")),
        (("dot", W, _scaled("B", W)), ("mul", ("var", "b_min"), B, B)),
        (("dot", H, _scaled("Kp", H)), ("mul", ("var", "kp"), A, A)),
    )


def _form(x: Tree, a: Tree, y: Tree) -> Tree:
    return ("dot", x, ("apply", a, y))


def _scaled(name: str, x: Tree) -> Tree:
    return ("apply", ("diag", name), x)


def _minus(x: Tree) -> Tree:
    return ("scale", ("num", "-1"), x)


def _num(value: Fraction) -> Tree:
    return ("num", str(value))
