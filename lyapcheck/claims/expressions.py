"""Writing expressions and relations in a proof script with the usual operators."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.expression import Tree, derivative, substitute, variables
from lyapcheck.check.expressions.normal_form import rational_value
from lyapcheck.check.expressions.signs import Undefined, require_defined
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.numbers.polynomials import fraction
from lyapcheck.check.statement import Relation
from lyapcheck.check.verify import BITS


class Multiplied:
    """What a number can multiply and is none itself: vectors and matrices."""


@dataclass(frozen=True, eq=False)
class Expr:
    """An expression: a tree of plain data under the arithmetic operators.

    A Python ``float`` is refused. Write 1.05 as ``"1.05"``, which is read exactly.
    """

    tree: Tree

    def __add__(self, other: object) -> Expr:
        return Expr(("add", self.tree, expr(other).tree))

    def __radd__(self, other: object) -> Expr:
        return expr(other) + self

    def __sub__(self, other: object) -> Expr:
        return Expr(("add", self.tree, ("neg", expr(other).tree)))

    def __rsub__(self, other: object) -> Expr:
        return expr(other) - self

    def __mul__(self, other: object) -> Expr:
        if isinstance(other, Multiplied):
            return NotImplemented
        return Expr(("mul", self.tree, expr(other).tree))

    def __rmul__(self, other: object) -> Expr:
        return expr(other) * self

    def __truediv__(self, other: object) -> Expr:
        return Expr(("div", self.tree, expr(other).tree))

    def __rtruediv__(self, other: object) -> Expr:
        return expr(other) / self

    def __pow__(self, exponent: int) -> Expr:
        if not isinstance(exponent, int):
            raise TypeError(f"the exponent {exponent!r} is no whole number; write sqrt(x), or exp(p*log(x))")
        if exponent < 0:
            return Expr(("div", ("num", "1"), ("pow", self.tree, -exponent)))
        return Expr(("pow", self.tree, exponent))

    def __neg__(self) -> Expr:
        return Expr(("neg", self.tree))

    def __abs__(self) -> Expr:
        return Expr(("abs", self.tree))

    def __float__(self) -> float:
        raise TypeError(
            "math and numpy take numbers, not letters; write tanh(x) with tanh of lyapcheck.claims"
        )

    def __array_ufunc__(self, *_: object, **__: object) -> float:
        return float(self)

    def at(self, **values: object) -> Expr:
        """The same expression with other expressions or numbers for some variables."""
        return Expr(substitute(self.tree, {name: expr(value).tree for name, value in values.items()}))

    def __le__(self, other: object) -> Relation:
        return Relation(self.tree, "<=", expr(other).tree)

    def __lt__(self, other: object) -> Relation:
        return Relation(self.tree, "<", expr(other).tree)

    def __ge__(self, other: object) -> Relation:
        return expr(other) <= self

    def __gt__(self, other: object) -> Relation:
        return expr(other) < self


def expr(value: object) -> Expr:
    """An expression from an expression or an exact number (int, Fraction, Decimal or decimal text)."""
    if isinstance(value, Expr):
        return value
    if isinstance(value, Multiplied):
        raise TypeError("a vector or matrix stands where a number must; write K @ x, x @ A @ y, or norm(x)")
    if isinstance(value, bool) or not isinstance(value, (int, str, Fraction, Decimal)):
        raise TypeError(f"{value!r} is not exact; write it as text ('1.05'), an int or a Fraction")
    return Expr(("num", str(Fraction(value))))


def var(name: str) -> Expr:
    """A variable."""
    return Expr(("var", name))


def _function(name: str) -> Callable[[object], Expr]:
    return lambda x: Expr((name, expr(x).tree))


sinh, cosh, tanh = map(_function, ("sinh", "cosh", "tanh"))
exp, log, sqrt = map(_function, ("exp", "log", "sqrt"))
sin, cos, atan = map(_function, ("sin", "cos", "atan"))
"""Elementary functions of an expression or an exact number."""


def h(m: int, x: object) -> Expr:
    """h_m of an expression."""
    return Expr(("h", m, expr(x).tree))


def dh(m: int, x: object) -> Expr:
    """h_m' of an expression, by the formula printed in (8)."""
    return Expr(("dh", m, expr(x).tree))


def potential(m: int, x: object) -> Expr:
    """U_m = ln(1 + sinh^{2m})/(2m) of an expression."""
    return Expr(("potential", m, expr(x).tree))


def gamma(m: int) -> Expr:
    """γ_m = sup h_m, as certified."""
    return Expr(("gamma", m))


def rho(m: int) -> Expr:
    """ρ_m = sup |h_m'|, as certified."""
    return Expr(("rho", m))


def secant_bound(m: int) -> Expr:
    """L_m = sup h_m(x)/x over x > 0, as certified."""
    return Expr(("L", m))


def diff(of: Expr, by: str) -> Expr:
    """The derivative of an expression with respect to a variable."""
    return Expr(derivative(of.tree, by))


pi = Expr(("pi",))


def total(parts: Iterable[Expr]) -> Expr:
    """The sum of expressions; 0 for none."""
    trees = [part.tree for part in parts]
    if not trees:
        return expr(0)
    return Expr(("add", *trees)) if len(trees) > 1 else Expr(trees[0])


# --- Expressions that stand for one number: bounds, ends of intervals and ε₀ in a proof script.


def closed_value(value: object) -> Tree:
    """An expression without variables that has a value.

    Raises:
        ValueError: it contains variables, or is not shown to have a value.
    """
    tree = expr(value).tree
    names = ", ".join(sorted(variables(tree)))
    if names:
        raise ValueError(f"{expression_text(tree)} contains {names}; give a number here, without variables")
    try:
        with ctx.workprec(BITS):
            require_defined(tree, {})
    except Undefined as problem:
        raise ValueError(
            f"{problem.value} is not shown to have a value; give a number here that has one"
        ) from problem
    return tree


def exact_value(value: object) -> Fraction:
    """The rational number that a closed expression equals.

    Raises:
        ValueError: it is not shown to be rational, or is no closed expression with a value.
    """
    tree = closed_value(value)
    result = rational_value(tree)
    if result is None:
        shown = expression_text(tree)
        rule = "is not shown to be rational, and only exact numbers may stand here"
        raise ValueError(f"{shown} {rule}; round it by above({shown}) or below({shown})")
    return fraction(result)
