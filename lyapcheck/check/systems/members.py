"""What makes a function a member of the class of :class:`Entrywise`: facts in one variable."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, derivative, substitute
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Relation, Statement
from lyapcheck.check.systems.system import Member

X: Tree = ("var", "x")
ZERO: Tree = ("num", "0")


def facts(member: Member) -> Iterator[tuple[str, Statement]]:
    """f odd and positive right of 0, U' = f, U(0) = 0, f' its slope, and its bounds.

    Soundness: so U(x) > 0 for x ≠ 0, and as f >= low > 0 from some x on, U grows without end; f' has a value
    everywhere, so f is differentiable, and as a quotient, product or smooth function its slope is continuous.
    """
    f, slope = member.value, member.slope
    for name in ("gamma", "rho", "secant", "low"):
        number = getattr(member, name)
        require(number is None or number > 0, name, number, "must be positive")
    yield "f(−x) = −f(x)", Identity(substitute(f, {"x": ("neg", X)}), ("neg", f))
    yield "0 < f(x) for x > 0", ForAll(Relation(ZERO, "<", f), Fraction(0), None, open_low=True)
    yield "f' is the derivative of f", Identity(derivative(f, "x"), slope)
    yield "U' = f", Identity(derivative(member.potential, "x"), f)
    yield "U(0) = 0", Identity(substitute(member.potential, {"x": ZERO}), ZERO)
    bounds = [("f'", slope, member.rho)]
    bounds += [("f", f, member.gamma)] if member.gamma is not None else []
    for name, tree, number in bounds:
        bound: Tree = ("num", str(number))
        yield f"{name} ≤ {number}", ForAll(Relation(tree, "<=", bound))
        yield f"−{number} ≤ {name}", ForAll(Relation(("neg", bound), "<=", tree))
    yield f"|f(x)| ≤ {member.secant}|x|", NormBound(f, 1, ("num", str(member.secant)), 1)
    low: Tree = ("num", str(member.low))
    yield f"{member.low} ≤ f(x) for x ≥ {member.start}", ForAll(Relation(low, "<=", f), member.start)
