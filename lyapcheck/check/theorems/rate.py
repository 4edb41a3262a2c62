"""A closed loop for every n: that the controller closes it, and dV/dt against its quadratic form.

With u = e/‖e‖ and s = 1/(1 + ‖e‖) the rate of ε = ε₀s is ε s uᵀw. H' = diag(dh), K_p = diag(Kp), and so on.

References: ``reyes2019family`` (1), (6), (11), (13), (15), (21).
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN, Given
from lyapcheck.check.theorems.closed_loop import ClosedLoop

EPS, S, A, B = (("var", name) for name in ("eps", "s", "a", "b"))
W, H, U, UNIT, DAMPING, ACCELERATION = (("vec", name) for name in ("w", "h", "U", "u", "hw", "dw"))
M, C, D = (("mat", name) for name in "MCD")
"""``C`` stands for C(q, w), ``D`` for C(q, q̇_d)."""
KP: Tree = ("vec", "Kp")


def loop_closed(desired: bool) -> EveryN:
    """Torque less the left side of (1) is K_p h − K_v h(w) − Bw − Cw − Mẇ: both vanish together.

    The torque is (6), or (21) with q̇ = q̇_d + w, q̈ = q̈_d + ẇ; there h(ė) = −h(w), as h is odd.
    """
    turning, weight, test = _turning(desired), ("vec", "g"), ("vec", "z")
    speed, acceleration = (("vec", "vd"), ("vec", "ad")) if desired else (("sum",), ("sum",))
    torque = ("sum", _scaled("Kp", H), _minus(_scaled("Kv", DAMPING)), *_needed(speed, acceleration, turning))
    needed = _needed(("sum", speed, W), ("sum", acceleration, ACCELERATION), turning)
    left = ("sum", torque, weight, _minus(("sum", *needed, weight)))
    right = ("sum", _push(turning), _minus(("apply", M, ACCELERATION)))
    return EveryN(("dot", test, left), ("dot", test, right))


def _needed(speed: Tree, acceleration: Tree, turning: Tree) -> tuple[Tree, ...]:
    """The left side of (1) without gravity."""
    return ("apply", M, acceleration), ("apply", turning, speed), _scaled("B", speed)


def _turning(desired: bool) -> Tree:
    return ("sum", C, D) if desired else C


def _push(turning: Tree) -> Tree:
    """What Mẇ equals in the loop."""
    damping, friction = _scaled("Kv", DAMPING), _scaled("B", W)
    return ("sum", _scaled("Kp", H), _minus(damping), _minus(friction), _minus(("apply", turning, W)))


def rate_bound(loop: ClosedLoop) -> BoundEveryN:
    """dV/dt <= −[a b] Θ [a b]ᵀ for every n, from the norms of the letters."""
    turning = _turning(loop.desired)
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
    motion = Given("M", "dw", _push(turning))
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
