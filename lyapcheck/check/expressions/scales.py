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
    power_of,
    summed,
)
from lyapcheck.check.expressions.expression import (
    Algebra,
    ExactSeriesAlgebra,
    Tree,
    Unsupported,
    evaluate,
    taylor,
)

OUTER: dict[str, Tree] = {
    "root": ("sqrt", ("add", ("num", "1"), ("var", "u"))),
    "log": ("log", ("add", ("num", "1"), ("var", "u"))),
    **{name: (name, ("var", "u")) for name in ("exp", "sin", "cos", "sinh", "cosh", "tanh", "atan", "asin")},
}


def composed(name: str, small: Asymptotic) -> Asymptotic:
    """A function of ``OUTER`` at u: its Taylor polynomial at 0 and a remainder over all values of u."""
    values = arb(0).union(small.enclosure())
    remainder = Coefficient(taylor(OUTER[name], "u", values, ORDER)[ORDER])
    if not remainder.ball.is_finite():
        raise Open("a function at the end of its domain")
    result = constant(remainder, small.start)
    for c in reversed(_taylor_at_0(name)):
        result = result * small + constant(exactly({0: c}), small.start)
    return result


@lru_cache(maxsize=32)
def _taylor_at_0(name: str) -> tuple[Fraction, ...]:
    """The Taylor coefficients 0 … ORDER − 1 at 0, which are rational."""
    cap, ctx.cap = ctx.cap, ORDER
    try:
        series = evaluate(OUTER[name], {"u": fmpq_series([0, 1])}, ExactSeriesAlgebra())
        result = [Fraction(int(c.p), int(c.q)) for c in list(series.coeffs())[:ORDER]]
    finally:
        ctx.cap = cap
    return tuple(result + [Fraction(0)] * (ORDER - len(result)))


@dataclass(frozen=True)
class ScaleAlgebra(Algebra):
    """The arithmetic of :class:`Asymptotic` on [start, ∞)."""

    start: Fraction

    def number(self, value: Fraction) -> Asymptotic:
        """A rational number."""
        return constant(exactly({0: value}), self.start)

    def constant(self, name: str, m: int) -> Asymptotic:
        """γ_m, ρ_m or L_m."""
        ball = super().constant(name, m)
        return self.number(Fraction(1)) if m == 1 else constant(Coefficient(ball), self.start)

    def pi(self) -> Asymptotic:
        """The number π."""
        return constant(exactly({1: Fraction(1)}), self.start)

    def function(self, name: str, value: Asymptotic) -> Asymptotic:
        """An elementary function."""
        if name == "abs":
            return value if value.sign() > 0 else -value
        if name == "sqrt":
            return self._root(value)
        if name == "log":
            return self._log(value)
        large, limit, small = value.parts()
        if not large and limit.is_zero and name in OUTER:
            return composed(name, small)
        return self._at_infinity(name, value) if large else self._near(name, limit, small)

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
            quarter = exactly({1: Fraction(value.sign(), 2)})
            return constant(quarter, self.start) - composed("atan", self.number(Fraction(1)) / value)
        if name in ("sin", "cos"):
            return constant(Coefficient(arb(-1).union(arb(1))), self.start)
        raise Unsupported(f"{name} at infinity")

    def _near(self, name: str, limit: Coefficient, small: Asymptotic) -> Asymptotic:
        """A function near a number that is not 0: Taylor's formula about all values at once."""
        values = limit.ball + arb(0).union(small.enclosure())
        outcome = taylor((name, ("var", "u")), "u", limit.ball, ORDER - 1)
        outcome.append(taylor((name, ("var", "u")), "u", values, ORDER)[ORDER])
        if not all(c.is_finite() for c in outcome):
            raise Open("a function at the end of its domain")
        result = constant(Coefficient(arb(0)), self.start)
        for c in reversed(outcome):
            result = result * small + constant(Coefficient(c), self.start)
        return result

    def _root(self, value: Asymptotic) -> Asymptotic:
        key, c, small = value.leading()
        if not c.ball > 0:
            raise Open("the root of what is negative")
        return composed("root", small).scaled(c.root(), power_of(key, Fraction(1, 2)))

    def _log(self, value: Asymptotic) -> Asymptotic:
        """ln(c e^{ax} x^b (1 + u)) = ln c + a x + b ln x + ln(1 + u)."""
        (a, b, j), c, small = value.leading()
        if j or not c.ball > 0:
            raise Open("the logarithm of a logarithm, or of what is negative")
        number = exactly({}) if c.as_rational() == 1 else Coefficient(c.ball.log())
        terms = [(X, exactly({0: a})), (LOG_X, exactly({0: b})), (ONE, number)]
        return summed([*terms, *composed("log", small).terms], self.start)

    def _exp(self, value: Asymptotic) -> Asymptotic:
        """exp of a x + b ln x + c + u."""
        large, limit, small = value.parts()
        result = {X: Fraction(0), LOG_X: Fraction(0)}
        for key, c in large:
            exact = c.as_rational()
            if key not in result or exact is None:
                raise Unsupported("exp of what is not a multiple of x and ln x")
            result[key] = exact
        number = exactly({0: Fraction(1)}) if limit.is_zero else Coefficient(limit.ball.exp())
        return composed("exp", small).scaled(number, (result[X], result[LOG_X], 0))


def sign_from(tree: Tree, name: str, start: Fraction) -> int:
    """The sign that f keeps on [start, ∞), start >= 2; 0 where that is not shown."""
    return _sign(tree, name, _term(X, start))


def sign_beside(tree: Tree, name: str, point: Fraction, width: Fraction) -> int:
    """The sign that f keeps on (p, p + width], or on [p + width, p) for width < 0; 0 where that is not shown.

    With x = p ± 1/t this is the sign for t >= 1/|width| >= 2. Nothing is said of f(p).
    """
    start = 1 / abs(width)
    step = _term(power_of(X, Fraction(-1)), start)
    here = constant(exactly({0: point}), start)
    return _sign(tree, name, here + step if width > 0 else here - step)


def _term(key: Key, start: Fraction) -> Asymptotic:
    return Asymptotic(((key, exactly({0: Fraction(1)})),), start)


def _sign(tree: Tree, name: str, x: Asymptotic) -> int:
    """The sign of f(x(t)) for all t >= start."""
    if x.start < 2:
        return 0
    try:
        function: Asymptotic = evaluate(tree, {name: x}, ScaleAlgebra(x.start))
        return function.sign()
    except (Open, Unsupported, ValueError, ZeroDivisionError):
        return 0
