"""Elementary expressions as plain data, evaluated in balls and in power series.

An expression is a nested tuple (a list, once it has been through JSON):

    ("num", "3/2")  ("var", "x")  ("pi",)  ("gamma", m)  ("rho", m)  ("L", m)
    ("add", a, b, ...)  ("mul", a, b, ...)  ("neg", a)  ("div", a, b)  ("pow", a, k)      k = 0, 1, 2, ...
    ("sin", a) and the other names of ``FUNCTIONS``
    ("h", m, a)  ("dh", m, a)  ("potential", m, a)   the hyperbolic family, by its formulas

One walk, :func:`evaluate`, serves every arithmetic: an :class:`Algebra` says what a number, a constant and a
function are in it.

References: ``reyes2019family`` (6), (8), (12).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from lyapcheck.check.numbers.balls import hyperbolic_constants, power

Tree = tuple[Any, ...]
FUNCTIONS = ("abs", "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh")
FAMILY = ("h", "dh", "potential")
CONSTANTS = ("gamma", "rho", "L")
LEAVES = ("num", "var", "pi", *CONSTANTS)
SUMS = ("add", "neg", "sum", "transpose")
PRODUCTS = {"mul": "add", "dot": "add", "scale": "sum", "apply": "sum"}
"""What is linear in each part, and the sum that the product rule makes; of ``check.letters`` too."""


class Unsupported(ValueError):
    """An arithmetic cannot express a node; never a statement about truth."""


class Algebra:
    """The arithmetic of real balls at the current precision of flint."""

    def number(self, value: Fraction) -> Any:
        return arb(fmpq(value.numerator, value.denominator))

    def constant(self, name: str, m: int) -> Any:
        return family_constant(name, m)

    def pi(self) -> Any:
        return arb.pi()

    def power_zero(self, base: Any) -> Any:
        """1, where the base has a value."""
        undefined = isinstance(base, arb) and not base.is_finite()
        return arb("nan") if undefined else self.number(Fraction(1))

    def function(self, name: str, value: Any) -> Any:
        return abs(value) if name == "abs" else getattr(value, name)()


class ExactAlgebra(Algebra):
    """Rational arithmetic: constants and functions that leave ℚ have no place in it."""

    def number(self, value: Fraction) -> Any:
        return fmpq(value.numerator, value.denominator)

    def constant(self, name: str, m: int) -> Any:
        """γ_1 = ρ_1 = L_1 = 1; ``Unsupported`` for m > 1."""
        if m > 1:
            raise Unsupported(f"{name}_{m} is not rational")
        return self.number(Fraction(1))

    def pi(self) -> Any:
        raise Unsupported("π is not rational")

    def function(self, name: str, value: Any) -> Any:
        raise Unsupported(f"{name} leaves the rational numbers")


class SeriesAlgebra(Algebra):
    """Truncated power series with balls as coefficients, to the length that ``ctx.cap`` allows."""

    def number(self, value: Fraction) -> Any:
        return arb_series([super().number(value)])

    def constant(self, name: str, m: int) -> Any:
        return arb_series([super().constant(name, m)])

    def pi(self) -> Any:
        return arb_series([arb.pi()])

    def function(self, name: str, value: Any) -> Any:
        """An elementary function of a series; the hyperbolic ones by the exponential."""
        if name in ("sinh", "cosh", "tanh"):
            grow = value.exp()
            fall = (-value).exp()
            top = grow + fall if name == "cosh" else grow - fall
            return top / (grow + fall) if name == "tanh" else top / 2
        if name == "abs":
            raise Unsupported("abs has no power series")
        return getattr(value, name)()


def evaluate(tree: Tree, values: Mapping[str, Any], algebra: Algebra) -> Any:
    """The value of an expression with elements of an algebra for its variables (or ``Unsupported``)."""
    return _Evaluation(values, algebra).of(tree)


class _Evaluation:
    """One evaluation: a node that stands in several places of an expression is worked out once."""

    def __init__(self, values: Mapping[str, Any], algebra: Algebra) -> None:
        self.values = values
        self.algebra = algebra
        # the node is kept beside its value, so that its id stays its own
        self.known: dict[int, tuple[Tree, Any]] = {}

    def of(self, tree: Tree) -> Any:
        known = self.known.get(id(tree))
        if known is None:
            kind, rest = tree[0], tree[1:]
            if kind == "num":
                return self.algebra.number(_fraction(rest[0]))
            if kind == "var":
                return self.values[rest[0]]
            if kind in LEAVES:
                return self.algebra.pi() if kind == "pi" else self.algebra.constant(kind, rest[0])
            known = self.known[id(tree)] = tree, self._worked_out(kind, rest)
        return known[1]

    def _worked_out(self, kind: str, rest: Tree) -> Any:
        if kind in FAMILY:
            return self.of(family_formula(kind, *rest))
        if kind == "pow":
            base, exponent = self.of(rest[0]), rest[1]
            if not isinstance(exponent, int) or exponent < 0:
                raise Unsupported(f"exponent {exponent!r} is not a natural number")
            return power(base, exponent) if exponent else self.algebra.power_zero(base)
        parts = [self.of(part) for part in rest]
        if kind == "neg":
            return -parts[0]
        if kind == "div":
            return parts[0] / parts[1]
        if kind in ("add", "mul"):
            result = parts[0]
            for part in parts[1:]:
                result = result + part if kind == "add" else result * part
            return result
        if kind in FUNCTIONS:
            return self.algebra.function(kind, parts[0])
        raise Unsupported(f"unknown operation {kind!r}")


@lru_cache(maxsize=1 << 14)
def _fraction(text: str) -> Fraction:
    """Kept, as reading a number takes longer than reckoning with it."""
    return Fraction(*map(int, text.split("/"))) if "/" in text else Fraction(text)


def family_formula(kind: str, m: int, argument: Tree) -> Tree:
    """h_m, h_m' or U_m of an expression, spelled out as the paper prints them in (6), (8) and (12)."""
    s: Tree = ("sinh", argument)
    bottom: Tree = ("add", ("num", "1"), ("pow", s, 2 * m))
    if kind == "h":
        return ("div", ("mul", ("pow", s, 2 * m - 1), ("cosh", argument)), bottom)
    if kind == "potential":
        return ("div", ("log", bottom), ("num", str(2 * m)))
    top: Tree = (
        "add",
        ("mul", ("num", str(2 * m - 1)), ("pow", s, 2 * m - 2)),
        ("mul", ("num", str(2 * m)), ("pow", s, 2 * m)),
        ("neg", ("pow", s, 4 * m - 2)),
    )
    return ("div", top, ("pow", bottom, 2))


@lru_cache(maxsize=1024)
def _constant_at(name: str, m: int, digits: int) -> arb:
    return getattr(hyperbolic_constants(m, digits), name).to_arb()


def family_constant(name: str, m: int) -> arb:
    """A ball for γ_m, ρ_m or L_m, about as tight as the current precision."""
    return _constant_at(name, m, max(30, ctx.prec * 3 // 10))


def ball(tree: Tree, values: Mapping[str, arb] | None = None) -> arb:
    """An enclosure of an expression at ball arguments; not finite where it is undefined."""
    return evaluate(tree, values or {}, Algebra())


def taylor(tree: Tree, name: str, centre: arb, order: int) -> list[arb]:
    """The Taylor coefficients 0 … order of an expression of one variable about every point of a ball.

    With a ball X as ``centre`` entry k encloses f^(k)(x)/k! for every x in X, which makes the last one a
    remainder in Lagrange's form.
    """
    cap, ctx.cap = ctx.cap, order + 1
    try:
        series = evaluate(tree, {name: arb_series([centre, 1])}, SeriesAlgebra())
        result = list(series.coeffs())[: order + 1]
        if series.prec < order + 1:
            raise Unsupported("a division that loses terms of the series")
    finally:
        ctx.cap = cap
    return result + [arb(0)] * (order + 1 - len(result))


def derivative(tree: Tree, name: str) -> Tree:
    """The derivative of an expression with respect to a variable, as an expression."""

    def other(tree: Tree) -> Tree:
        kind, *rest = tree
        if kind in LEAVES:
            return ("num", "1" if tree == ("var", name) else "0")
        if kind in FAMILY:
            return derivative(family_formula(kind, *rest), name)
        return ("mul", _outer_derivative(kind, rest[0]), derivative(rest[0], name))

    return differentiated(tree, other)


def differentiated(tree: Tree, other: Callable[[Tree], Tree]) -> Tree:
    """By the rules for sums, products, quotients and powers; ``other`` has the derivative of all else."""
    kind, *rest = tree
    if kind in SUMS:
        return (kind, *(differentiated(part, other) for part in rest))
    if kind in PRODUCTS:
        each = ((kind, *rest[:k], differentiated(part, other), *rest[k + 1 :]) for k, part in enumerate(rest))
        return (PRODUCTS[kind], *each)
    if kind == "pow":
        a, k = rest
        return ("mul", ("num", str(k)), ("pow", a, k - 1), differentiated(a, other)) if k else ("num", "0")
    if kind == "div":
        a, b = rest
        slopes = differentiated(a, other), differentiated(b, other)
        return ("div", ("add", ("mul", slopes[0], b), ("neg", ("mul", a, slopes[1]))), ("pow", b, 2))
    return other(tree)


def _outer_derivative(kind: str, a: Tree) -> Tree:
    one: Tree = ("num", "1")
    square: Tree = ("pow", a, 2)
    table: dict[str, Tree] = {
        "exp": ("exp", a),
        "log": ("div", one, a),
        "sqrt": ("div", one, ("mul", ("num", "2"), ("sqrt", a))),
        "sin": ("cos", a),
        "cos": ("neg", ("sin", a)),
        "tan": ("add", one, ("pow", ("tan", a), 2)),
        "sinh": ("cosh", a),
        "cosh": ("sinh", a),
        "tanh": ("add", one, ("neg", ("pow", ("tanh", a), 2))),
        "atan": ("div", one, ("add", one, square)),
        "asin": ("div", one, ("sqrt", ("add", one, ("neg", square)))),
        "acos": ("neg", ("div", one, ("sqrt", ("add", one, ("neg", square))))),
    }
    if kind not in table:
        raise Unsupported(f"{kind} is not differentiable")
    return table[kind]


def substitute(tree: Tree, values: Mapping[str, Tree]) -> Tree:
    """An expression with expressions in place of some variables."""
    if tree[0] == "var":
        return values.get(tree[1], tree)
    return tuple(substitute(part, values) if isinstance(part, tuple) else part for part in tree)


def shared(tree: Tree) -> Tree:
    """The same expression with equal parts as one object, which an evaluation works out once."""
    done: dict[int, Tree] = {}
    first: dict[Tree, Tree] = {}

    def of(tree: Tree) -> Tree:
        if id(tree) not in done:
            parts = tuple([of(part) if isinstance(part, tuple) else part for part in tree])
            # parts are told apart by where they are, as hashing them goes through all of them again
            key = tuple([(id(part),) if isinstance(part, tuple) else part for part in parts])
            done[id(tree)] = first.setdefault(key, parts)
        return done[id(tree)]

    return of(tree)


def variables(tree: Sequence[Any]) -> set[str]:
    """The names of the variables of an expression."""
    return {node[1] for node in nodes(tree) if node[0] == "var"}


def nodes(*trees: Sequence[Any]) -> Iterator[Sequence[Any]]:
    """All nodes of expressions; one that stands in several places, as the same object, comes once."""
    waiting, seen = list(trees), set(map(id, trees))
    while waiting:
        node = waiting.pop()
        yield node
        for part in node[1:]:
            if isinstance(part, (tuple, list)) and id(part) not in seen:
                seen.add(id(part))
                waiting.append(part)
