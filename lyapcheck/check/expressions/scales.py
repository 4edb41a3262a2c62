"""Elementary functions of sums in the scale of ``asymptotic``, and their signs near infinity and near points.

A function of c + u, u → 0, is its Taylor polynomial in u with a remainder in Lagrange's form, enclosed over
all values of u; exp, ln, √ and atan of what grows are taken apart by their laws.

References: ``gruntz1996limits`` for the scale; ``tucker2011validated``, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from flint import arb, ctx, fmpq_series

from lyapcheck.check.expressions.asymptotic import (
    LOG_X,
    ONE,
    ORDER,
    Asymptotic,
    Coefficient,
    Key,
    Open,
    X,
    constant,
    exactly,
    named,
    power_of,
    summed,
)
from lyapcheck.check.expressions.expression import Algebra, Tree, Unsupported, evaluate, taylor

AT_ZERO = ("exp", "sin", "cos", "sinh", "cosh", "tanh", "atan", "asin")
CENTRES = {"sqrt": 1, "log": 1, **dict.fromkeys(AT_ZERO, 0)}
"""Where a function has rational Taylor coefficients."""


def composed(name: str, small: Asymptotic, centre: arb | None = None) -> Asymptotic:
    """f(c + u): the Taylor polynomial at c, without one that of ``CENTRES``, and a remainder over all u."""
    about = arb(CENTRES[name]) if centre is None else centre
    values = about + arb(0).union(small.enclosure())
    outer: Tree = (name, ("var", "u"))
    remainder = Coefficient(taylor(outer, "u", values, ORDER)[ORDER])
    if centre is None:
        terms = [exactly(c) for c in _rational_taylor(name)]
    else:
        terms = [Coefficient(c) for c in taylor(outer, "u", centre, ORDER - 1)]
    result = constant(remainder, small.start)
    for c in reversed(terms):
        result = result * small + constant(c, small.start)
    if not all(c.ball.is_finite() for c in (*terms, remainder)):
        raise Open("a function at the end of its domain")
    return result


@lru_cache(maxsize=32)
def _rational_taylor(name: str) -> tuple[Fraction, ...]:
    """The Taylor coefficients 0 … ORDER − 1 of a function of ``CENTRES``."""
    cap, ctx.cap = ctx.cap, ORDER
    try:
        series = getattr(fmpq_series([CENTRES[name], 1]), name)()
    finally:
        ctx.cap = cap
    return tuple(Fraction(int(series[k].p), int(series[k].q)) for k in range(ORDER))


@dataclass(frozen=True)
class ScaleAlgebra(Algebra):
    """The arithmetic of :class:`Asymptotic` on [start, ∞)."""

    start: Fraction

    def number(self, value: Fraction) -> Asymptotic:
        """A rational number."""
        return constant(exactly(value), self.start)

    def constant(self, name: str, m: int) -> Asymptotic:
        """γ_m, ρ_m or L_m."""
        return constant(exactly(1) if m == 1 else named(name, m), self.start)

    def pi(self) -> Asymptotic:
        """The number π."""
        return constant(named("pi"), self.start)

    def function(self, name: str, value: Asymptotic) -> Asymptotic:
        """An elementary function."""
        if name == "abs":
            return value if value.sign() > 0 else -value
        if name == "sqrt":
            return self._root(value)
        if name == "log":
            return self._log(value)
        large, limit, small = value.parts()
        if large:
            return self._at_infinity(name, value)
        return composed(name, small, None if limit.is_zero and name in AT_ZERO else limit.ball)

    def _at_infinity(self, name: str, value: Asymptotic) -> Asymptotic:
        """A function of what is not bounded."""
        if name == "exp":
            return self._exp(value)
        if name in ("sinh", "cosh", "tanh"):
            grow, fall = self._exp(value), self._exp(-value)
            total, difference = grow + fall, grow - fall
            half = self.number(Fraction(1, 2))
            return difference / total if name == "tanh" else half * (total if name == "cosh" else difference)
        if name == "atan":
            quarter = named("pi") * exactly(Fraction(value.sign(), 2))
            return constant(quarter, self.start) - composed("atan", self.number(Fraction(1)) / value)
        if name in ("sin", "cos"):
            return constant(Coefficient(arb(-1).union(arb(1))), self.start)
        raise Unsupported(f"{name} at infinity")

    def _root(self, value: Asymptotic) -> Asymptotic:
        key, c, small = value.leading()
        if not c.ball > 0:
            raise Open("the root of what is negative")
        return composed("sqrt", small).scaled(c.root(), power_of(key, Fraction(1, 2)))

    def _log(self, value: Asymptotic) -> Asymptotic:
        """ln(c e^{ax} x^b (1 + u)) = ln c + a x + b ln x + ln(1 + u)."""
        (a, b, j), c, small = value.leading()
        if j or not c.ball > 0:
            raise Open("the logarithm of a logarithm, or of what is negative")
        number = exactly(0) if c.as_rational() == 1 else Coefficient(c.ball.log())
        terms = [(X, exactly(a)), (LOG_X, exactly(b)), (ONE, number)]
        return summed([*terms, *composed("log", small).terms], self.start)

    def _exp(self, value: Asymptotic) -> Asymptotic:
        """exp of a x + b ln x + c + u."""
        large, limit, small = value.parts()
        result: dict[Key, Fraction | int] = {X: 0, LOG_X: 0}
        for key, c in large:
            exact = c.as_rational()
            if key not in result or exact is None:
                raise Unsupported("exp of what is not a multiple of x and ln x")
            result[key] = exact
        number = exactly(1) if limit.is_zero else Coefficient(limit.ball.exp())
        return composed("exp", small).scaled(number, (result[X], result[LOG_X], 0))


def sign_from(tree: Tree, name: str, start: Fraction) -> int:
    """The sign that f keeps on [start, ∞), start >= 1; 0 where that is not shown."""
    return _sign(tree, name, None, start, ctx.prec)


def sign_beside(tree: Tree, name: str, point: Fraction, width: Fraction) -> int:
    """The sign that f keeps on (p, p + width], or on [p + width, p) for width < 0; 0 where that is not shown.

    With x = p ± 1/t this is the sign for t >= 1/|width| >= 1. Nothing is said of f(p).
    """
    return _sign(tree, name, point, width, ctx.prec)


@lru_cache(maxsize=64)
def _sign(tree: Tree, name: str, point: Fraction | None, reach: Fraction, bits: int) -> int:
    """The sign of f(x(t)) for all t from some start on; kept, since a rule asks what its search did."""
    start = reach if point is None else 1 / abs(reach)
    if start < 1:
        return 0
    t = Asymptotic(((X, exactly(1)),), start)
    try:
        if point is None:
            x = t
        else:
            step = constant(exactly(1 if reach > 0 else -1), start) / t
            x = constant(exactly(point), start) + step
        function: Asymptotic = evaluate(tree, {name: x}, ScaleAlgebra(start))
        return function.sign()
    except (Open, Unsupported, ValueError, ZeroDivisionError):
        return 0
