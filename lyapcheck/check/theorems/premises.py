"""What the claims behind the hypotheses of Lyapunov's direct method must state, for one loop and one V.

For h odd with h(x) > 0 for x > 0, V >= ½λmin(M)‖y‖² + Σ k_pi ∫h is positive definite; h(x) >= c > 0 for large
x and |h| <= γ make it radially unbounded; ‖h(e)‖ <= L‖e‖ and a bounded derivative make it differentiable
where ‖e‖ is not; at rest Mẇ = K_p h(e) vanishes with e alone. ``loop_rate`` is the bound of dV/dt, in which
a = ‖h(e)‖ and b = ‖w‖ vanish together at the origin alone.

Not judged here: that the robot is (1) with Properties 2.1–2.7, and that numbers given for its constants are
those of the robot; claims of their own are about these.

References: ``kelly2005control``, chapter 2; ``khalil2002nonlinear``, theorem 4.9; ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, derivative, substitute
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.theorem import Theorem
from lyapcheck.check.statement import Relation, Statement, Variable
from lyapcheck.check.theorems.closed_loop import ClosedLoop
from lyapcheck.check.theorems.definiteness import shows_positive
from lyapcheck.check.theorems.rate import loop_closed, rate_bound

X: Tree = ("var", "x")
ZERO: Tree = ("num", "0")
Premise = Callable[[ClosedLoop, frozenset[Statement]], str | None]
Needed = tuple[str, Statement]
"""A statement, and how it is called in words."""


def unmet(theorem: Theorem, stated: Mapping[str, Statement]) -> str | None:
    """What a claim behind a hypothesis fails to state, in words; ``None`` if nothing is missing.

    Args:
        theorem: its name is known and its hypotheses are those of the theorem.
        stated: the statements of the claims by id, all of them proved; a claim that is not here is left out.
    """
    for label, claim in theorem.hypotheses:
        lacks = PREMISES[label](theorem.loop, parts_of(stated[claim])) if claim in stated else None
        if lacks is not None:
            return f"{claim} does not state {lacks}, which “{label}” needs"
    return None


def parts_of(statement: Statement) -> frozenset[Statement]:
    """A statement and, if it is a conjunction, its parts."""
    if isinstance(statement, AllOf):
        return frozenset().union(*(parts_of(part) for _, part in statement.parts))
    return frozenset([statement])


def _needs(listed: Callable[[ClosedLoop], Iterable[Needed]]) -> Premise:
    """A premise that is a list of statements."""
    return lambda loop, parts: next((name for name, one in listed(loop) if one not in parts), None)


def _sign(loop: ClosedLoop) -> list[Needed]:
    mirrored = substitute(loop.h, {"x": ("neg", X)})
    return [
        ("h(−x) = −h(x)", Identity(mirrored, ("neg", loop.h))),
        ("0 < h(x) for x > 0", ForAll(Relation(ZERO, "<", loop.h), Fraction(0), None, open_low=True)),
    ]


def _at_rest(loop: ClosedLoop) -> list[Needed]:
    controller = "(21)" if loop.desired else "(6)"
    return [*_sign(loop), (f"the loop that {controller} closes, for every n", loop_closed(loop))]


def _positive(loop: ClosedLoop) -> list[Needed]:
    return [("U' = h", Identity(derivative(loop.potential, "x"), loop.h)), *_sign(loop)]


def _smooth(loop: ClosedLoop) -> list[Needed]:
    rho = _num(loop.rho)
    return [
        ("h' as it is", Identity(derivative(loop.h, "x"), loop.slope)),
        ("h' ≤ ρ", ForAll(Relation(loop.slope, "<=", rho))),
        ("−ρ ≤ h'", ForAll(Relation(_num(-loop.rho), "<=", loop.slope))),
        ("‖h(e)‖ ≤ L‖e‖", NormBound(loop.h, loop.n, _num(loop.L), 1)),
    ]


def _unbounded(loop: ClosedLoop, parts: frozenset[Statement]) -> str | None:
    """That h stays above a positive number from somewhere on, and below γ."""
    lines = [one for one in parts if isinstance(one, ForAll) and one.variable == "x" and one.high is None]
    if not any(one.relation.right == loop.h and _is_positive(one.relation.left) for one in lines):
        return "c ≤ h(x) from some x on, with a number c > 0"
    gamma = _num(loop.gamma)
    above = (one.relation.right for one in lines if one.low is None and one.relation.left == loop.h)
    if not any(top == gamma or Constant(Relation(top, "<=", gamma)) in parts for top in above):
        return "h ≤ γ"
    return _needs(lambda loop: _sign(loop)[:1])(loop, parts)


def _is_positive(tree: Tree) -> bool:
    return tree[0] == "num" and Fraction(tree[1]) > 0


def _rate(loop: ClosedLoop) -> list[Needed]:
    return [("dV/dt ≤ −[a b] Θ [a b]ᵀ for this V and Θ, for every n", rate_bound(loop))]


def _inertia(below: bool) -> Callable[[ClosedLoop], list[Needed]]:
    """½μ‖y‖² + P <= ½yᵀMy + P, or ½yᵀMy + P <= ½β‖y‖² + P, from what μ or β is."""
    size: Tree = ("var", "yMy")
    other: Tree = ("mul", ("var", "mu" if below else "beta"), ("var", "yy"))
    small, large = (other, size) if below else (size, other)
    names = ("mu", "beta", "yy", "yMy", "stored")
    variables = [Variable(name, Fraction(0), name in ("mu", "beta")) for name in names]
    left, right = (("add", ("div", one, ("num", "2")), ("var", "stored")) for one in (small, large))
    bound = Implies(tuple(variables), (Relation(small, "<=", large),), Relation(left, "<=", right))
    return lambda loop: [("the bound of V by that of M", bound)]


def _definite(loop: ClosedLoop, parts: frozenset[Statement]) -> str | None:
    corner, side, low = loop.form
    minor = ("add", ("mul", corner, low), ("neg", ("pow", side, 2)))
    for name, target in (("θ11 > 0", corner), ("θ11 θ22 − θ12² > 0", minor)):
        if not any(shows_positive(one, target, loop) for one in parts):
            return f"{name} for the Θ of this loop"
    return None


def _num(value: Fraction) -> Tree:
    return ("num", str(value))


PREMISES: dict[str, Premise] = {
    "only equilibrium": _needs(_at_rest),
    "equilibrium": _needs(_at_rest),
    "differentiable": _needs(_smooth),
    "positive definite": _needs(_positive),
    "bounded below by a positive definite function": _needs(_inertia(below=True)),
    "bounded above by a positive definite function": _needs(_inertia(below=False)),
    "radially unbounded": _unbounded,
    "rate bounded by a form": _needs(_rate),
    "form negative definite": _definite,
}
"""For each hypothesis, what is missing among the statements of its claim."""
