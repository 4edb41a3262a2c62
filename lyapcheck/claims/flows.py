"""Proofs about an ODE of a few variables, as in textbooks: equations as data, theorems by name.

::

    x, y = var("x"), var("y")
    s = system({"x": y, "y": -x - y + x**3})
    V = x**2 + x * y + y**2
    proof.add("P", "…", local(s, V, region=V <= Fraction(1, 4), within=Fraction(1, 2)))

What each theorem asks for is in ``check.kinds.flow``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.kinds.flow import Flow
from lyapcheck.check.statement import Relation
from lyapcheck.claims.expressions import Expr, expr


@dataclass(frozen=True)
class Equations:
    """The derivatives of some variables, and positive constants; made by ``system``."""

    rates: tuple[tuple[str, Tree], ...]
    constants: tuple[str, ...]

    def flow(self, conclusion: str, V: Expr, parts: Iterable[Expr] = (), **numbers: object) -> Flow:
        """A statement about the motions, with the numbers that it needs."""
        level, radius, a, b = (
            expr(numbers[name]).tree if name in numbers else None for name in ("level", "radius", "a", "b")
        )
        trees = tuple(expr(part).tree for part in parts)
        return Flow(conclusion, self.rates, self.constants, V.tree, level, radius, a, b, trees)


def system(rates: Mapping[str, object], constants: str = "") -> Equations:
    """An ODE of a few variables.

    Args:
        rates: the derivative of each variable by its name: a polynomial, also with sin and cos of a variable.
            A variable that occurs in sin and cos alone is an angle, which counts up to full turns.
        constants: names of positive constants, between spaces.

    Raises:
        ValueError: a rate has another name in it.
    """
    trees = {name: expr(value).tree for name, value in rates.items()}
    known = {*trees, *constants.split()}
    for name, tree in trees.items():
        if lost := sorted(variables(tree) - known):
            raise ValueError(f"the rate of {name} has {lost[0]}; name it as a variable, or in constants")
    return Equations(tuple(trees.items()), tuple(constants.split()))


def local(s: Equations, V: Expr, region: Relation, within: object, rest: Iterable[Expr] = ()) -> Flow:
    """Claim that the origin is asymptotically stable, and attracts the region V <= c in a ball.

    V is above c on the sphere ‖x‖² = ``within``. In the region but at 0, V > 0 and dV/dt < 0. With ``rest``,
    polynomials as for ``converges_to``, dV/dt <= 0 in the ball is enough; they are 0 together only at 0.
    """
    return s.flow("nearby", V, rest, level=_level(V, region), radius=within)


def global_(s: Equations, V: Expr, grows: object = 1, less: object = 0, rest: Iterable[Expr] = ()) -> Flow:
    """Claim that the origin is globally asymptotically stable, with V at least grows·‖x‖² − less.

    But at 0, V > 0 and dV/dt < 0. With ``rest`` dV/dt <= 0 is enough, as for ``local``.
    """
    return s.flow("everywhere", V, rest, a=grows, b=less)


def enters(s: Equations, V: Expr, region: Relation, grows: object = 1, less: object = 0) -> Flow:
    """Claim that every motion enters the region V <= c and stays, with V at least grows·‖x‖² − less."""
    return s.flow("bounded", V, level=_level(V, region), a=grows, b=less)


def converges_to(s: Equations, V: Expr, zeros: Iterable[Expr], grows: object = 1, less: object = 0) -> Flow:
    """Claim that motions are bounded and some polynomials tend to 0 along them, one after the other.

    dV/dt <= 0. Each polynomial is 0 where dV/dt, those before it and their derivatives are all 0.
    """
    return s.flow("towards", V, zeros, a=grows, b=less)


def _level(V: Expr, region: Relation) -> Expr:
    """The number c of a region V <= c.

    Raises:
        ValueError: the region is of another form.
    """
    if region.left != V.tree or region.strict:
        raise ValueError("region: write V <= c, with the V of the theorem")
    return Expr(region.right)
