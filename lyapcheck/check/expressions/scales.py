"""Functions near infinity as sums in the scale  e^{ax} x^b (ln x)^j,  and their signs there and near points.

An :class:`Asymptotic` is a finite sum  Σ c_k(x) e^{a_k x} x^{b_k} (ln x)^{j_k}  in which each c_k is either
an exact number (a polynomial in π, γ_m, √c and their inverses) or lies in a ball for every x >= X. Sums and
products keep that form. Exact coefficients cancel exactly, so that functions which agree to some order at
infinity can be told apart by the next one.

A function of c + u, u → 0, is its Taylor polynomial in u with a remainder in Lagrange's form, enclosed over
all values of u; exp, ln, √ and atan of what grows are taken apart by their laws.

References: ``gruntz1996limits`` for the scale; ``tucker2011validated``, chapter 3.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product
from math import prod
from typing import NamedTuple

from flint import arb, ctx, fmpq, fmpq_series

from lyapcheck.check.expressions.expression import (
    Algebra,
    Tree,
    Unsupported,
    evaluate,
    family_constant,
    taylor,
)
from lyapcheck.check.numbers.polynomials import ball_of, fraction, rational, rational_root

Key = tuple[Fraction | int, Fraction | int, int]
"""(a, b, j) of e^{ax} x^b (ln x)^j; in lexicographic order the larger one dominates."""
ONE: Key = (0, 0, 0)
X: Key = (0, 1, 0)
LOG_X: Key = (0, 0, 1)
ORDERS = (4, 12)
"""The orders of Taylor polynomials, the first for most of all signs."""
TERMS = 16
"""How many terms are kept; lower ones are taken into the last."""


class Open(Exception):
    """X is too small, or the scale too coarse, to say anything."""


Symbol = tuple[str, Fraction]
"""A number by name: ("sqrt", c) for √c, ("gamma", m) and its like, ("pi", 0)."""
Monomial = tuple[tuple[Symbol, int], ...]
"""Powers of symbols."""


class Coefficient:
    """A number that lies in a ball; ``exact`` has its monomials if it is the same known one for all x."""

    __slots__ = ("_ball", "exact")

    def __init__(self, ball: arb | None, exact: tuple[tuple[Monomial, fmpq], ...] | None = None) -> None:
        self._ball, self.exact = ball, exact

    @property
    def ball(self) -> arb:
        """The ball; that of an exact number is worked out where it is asked for first."""
        if self._ball is None:
            parts = (prod((_value(*s) ** e for s, e in p), start=arb(c)) for p, c in self.exact or ())
            self._ball = sum(parts, arb(0))
        return self._ball

    def __mul__(self, other: Coefficient) -> Coefficient:
        if self.exact is None or other.exact is None:
            return Coefficient(self.ball * other.ball)
        return _collected(
            _monomial((*p, *q), c * d) if p and q else (p or q, c * d)
            for (p, c), (q, d) in product(self.exact, other.exact)
        )

    @property
    def is_zero(self) -> bool:
        return self.exact == ()

    def inverse(self) -> Coefficient:
        """1/c, exact for one monomial."""
        if self.exact is not None and len(self.exact) == 1:
            ((p, c),) = self.exact
            return _collected([_monomial([(symbol, -e) for symbol, e in p], 1 / c)])
        return Coefficient(1 / self.ball)

    def root(self) -> Coefficient:
        """√c, exact for a rational number times even powers."""
        if self.exact is not None and len(self.exact) == 1:
            ((p, c),) = self.exact
            if c > 0 and all(e % 2 == 0 for _, e in p):
                halves = [(symbol, e // 2) for symbol, e in p]
                root = ("sqrt", fraction(c))
                return _collected([_monomial([*halves, (root, 1)], fmpq(1))])
        return Coefficient(self.ball.sqrt())

    def as_rational(self) -> Fraction | int | None:
        """The value, if it is known to be rational; whole numbers as such, which make keys that hash fast."""
        if self.exact is None or any(p for p, _ in self.exact):
            return None
        value = sum((c for _, c in self.exact), fmpq(0))
        return int(value.p) if value.q == 1 else fraction(value)


def _monomial(powers: Iterable[tuple[Symbol, int]], factor: fmpq) -> tuple[Monomial, fmpq]:
    """A product of powers of symbols, with squares of roots and roots of squares as numbers."""
    exponents: dict[Symbol, int] = {}
    for symbol, e in powers:
        exponents[symbol] = exponents.get(symbol, 0) + e
    for symbol, e in exponents.items():
        name, c = symbol
        if name == "sqrt":
            factor *= rational(c) ** (e // 2)
            exponents[symbol] = e % 2
            root = rational_root(c)
            if e % 2 and root is not None:
                factor, exponents[symbol] = factor * rational(root), 0
    return tuple(sorted((symbol, e) for symbol, e in exponents.items() if e)), factor


def _collected(terms: Iterable[tuple[Monomial, fmpq]]) -> Coefficient:
    result: dict[Monomial, fmpq] = {}
    for p, c in terms:
        result[p] = result[p] + c if p in result else c
    return Coefficient(None, tuple(sorted((p, c) for p, c in result.items() if c)))


def _value(name: str, c: Fraction) -> arb:
    if name == "sqrt":
        return ball_of(c).sqrt()
    return arb.pi() if name == "pi" else family_constant(name, int(c))


def exactly(c: Fraction | int) -> Coefficient:
    """A rational number."""
    return _collected([((), rational(c))])


def named(name: str, c: int = 0) -> Coefficient:
    """The number of a symbol."""
    return _collected([((((name, Fraction(c)), 1),), fmpq(1))])


class Start(NamedTuple):
    """X of [X, ∞), and the order of the Taylor polynomials there."""

    x: Fraction
    order: int = ORDERS[-1]


@dataclass(frozen=True)
class Asymptotic:
    """Σ c_k(x) e^{a_k x} x^{b_k} (ln x)^{j_k} for x >= start, the dominant term first."""

    terms: tuple[tuple[Key, Coefficient], ...]
    start: Start

    def __add__(self, other: Asymptotic) -> Asymptotic:
        return summed([*self.terms, *other.terms], self.start)

    def __mul__(self, other: Asymptotic) -> Asymptotic:
        return summed([(_times(k, n), c * d) for k, c in self.terms for n, d in other.terms], self.start)

    def __neg__(self) -> Asymptotic:
        return self.scaled(exactly(-1))

    def __sub__(self, other: Asymptotic) -> Asymptotic:
        return self + (-other)

    def __truediv__(self, other: Asymptotic) -> Asymptotic:
        """By  1/(1 + u) = 1 − u + … + (−u)^K/(1 + u)."""
        key, c, small = other.leading()
        result = constant(Coefficient(1 / (1 + small.enclosure())), self.start)
        for _ in range(self.start.order):
            result = constant(exactly(1), self.start) - result * small
        return self * result.scaled(c.inverse(), power_of(key, Fraction(-1)))

    def scaled(self, by: Coefficient, key: Key = ONE) -> Asymptotic:
        return Asymptotic(tuple((_times(k, key), c * by) for k, c in self.terms), self.start)

    def leading(self) -> tuple[Key, Coefficient, Asymptotic]:
        """c, M and u with  f = c M (1 + u),  u > −1, where c is not 0."""
        if not self.terms:
            raise Open("a function that is zero")
        (key, c), *rest = self.terms
        if not (c.ball > 0 or c.ball < 0):
            raise Open("the sign of the leading coefficient")
        small = Asymptotic(tuple(rest), self.start).scaled(c.inverse(), power_of(key, Fraction(-1)))
        if not small.enclosure() > -1:
            raise Open("the leading term does not dominate yet")
        return key, c, small

    def enclosure(self) -> arb:
        """A ball that contains every value; for functions whose terms are bounded."""
        return sum((c.ball * _bounded(key, self.start.x) for key, c in self.terms), arb(0))

    def parts(self) -> tuple[list[tuple[Key, Coefficient]], Coefficient, Asymptotic]:
        """The terms that are not bounded, the constant one, and what tends to 0."""
        large = [(key, c) for key, c in self.terms if key > ONE]
        limit = dict(self.terms).get(ONE, exactly(0))
        small = tuple((key, c) for key, c in self.terms if key < ONE)
        return large, limit, Asymptotic(small, self.start)

    def sign(self) -> int:
        """The sign that the function keeps on [start, ∞); ``Open`` where that is not shown."""
        _, c, _ = self.leading()
        return 1 if c.ball > 0 else -1


def _times(a: Key, b: Key) -> Key:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def power_of(key: Key, exponent: Fraction) -> Key:
    """The scale function to a power; ``Unsupported`` where ln x would get a fractional exponent."""
    a, b, logs = (x.numerator if x.denominator == 1 else x for x in (part * exponent for part in key))
    if not isinstance(logs, int):
        raise Unsupported("a fractional power of a logarithm")
    return a, b, logs


def _bounded(key: Key, start: Fraction) -> arb:
    """A ball that contains e^{ax} x^b (ln x)^j for all x >= start.

    Its logarithmic derivative a + b/x + j/(x ln x) is at most what it is at ``start`` with the negative ones
    of b and j left out where something else is negative, and each such bound falls with x. Where that is not
    negative, x^b (ln x)^j still is at most its largest value, (j/(−be))^j.
    """
    if key == ONE:
        return arb(1)
    if key > ONE:
        raise Open("a term that grows")
    a, b, j = key
    x = ball_of(start)
    log = x.log()
    rise = j / log if j > 0 else arb(0)
    if a < 0:
        slope = ball_of(a) + (ball_of(max(b, 0)) + rise) / x
    elif b < 0:
        slope = ball_of(b) + rise
    else:
        slope = arb(j)
    if slope <= 0:
        return arb(0).union((ball_of(a) * x + ball_of(b) * log).exp() * log**j)
    if a < 0:
        raise Open("a term that does not fall yet")
    return arb(0).union((ball_of(Fraction(-j) / b) / arb(1).exp()) ** j)


def summed(terms: list[tuple[Key, Coefficient]], start: Start) -> Asymptotic:
    """The sum of terms; the lowest ones are taken into the last that is kept."""
    parts: dict[Key, list[Coefficient]] = {}
    for key, c in terms:
        parts.setdefault(key, []).append(c)
    kept = []
    for key in sorted(parts, reverse=True):
        total, *more = parts[key]
        if more:  # those that are exact first
            total = _collected(term for c in parts[key] if c.exact is not None for term in c.exact)
            others = [c.ball for c in parts[key] if c.exact is None]
            total = Coefficient(sum(others, total.ball)) if others else total
        if not total.is_zero:
            kept.append((key, total))
    if len(kept) > TERMS:
        last = kept[TERMS - 1][0]
        rest = Asymptotic(tuple(kept[TERMS - 1 :]), start).scaled(exactly(1), power_of(last, Fraction(-1)))
        kept = [*kept[: TERMS - 1], (last, Coefficient(rest.enclosure()))]
    return Asymptotic(tuple(kept), start)


def constant(c: Coefficient, start: Start) -> Asymptotic:
    """A function that is one number, or lies in one ball."""
    return Asymptotic(() if c.is_zero else ((ONE, c),), start)


AT_ZERO = ("exp", "sin", "cos", "sinh", "cosh", "tanh", "atan", "asin")
CENTRES = {"sqrt": 1, "log": 1, **dict.fromkeys(AT_ZERO, 0)}
"""Where a function has rational Taylor coefficients."""


def composed(name: str, small: Asymptotic, centre: arb | None = None) -> Asymptotic:
    """f(c + u): the Taylor polynomial at c, without one that of ``CENTRES``, and a remainder over all u."""
    about = arb(CENTRES[name]) if centre is None else centre
    values = about + arb(0).union(small.enclosure())
    outer: Tree = (name, ("var", "u"))
    order = small.start.order
    remainder = Coefficient(taylor(outer, "u", values, order)[order])
    if centre is None:
        terms = [exactly(c) for c in _rational_taylor(name, order)]
    else:
        terms = [Coefficient(c) for c in taylor(outer, "u", centre, order - 1)]
    result = constant(remainder, small.start)
    for c in reversed(terms):
        result = result * small + constant(c, small.start)
    if not all(c.ball.is_finite() for c in (*terms, remainder)):
        raise Open("a function at the end of its domain")
    return result


@lru_cache(maxsize=32)
def _rational_taylor(name: str, order: int) -> tuple[Fraction, ...]:
    """The Taylor coefficients 0 … order − 1 of a function of ``CENTRES``."""
    cap, ctx.cap = ctx.cap, order
    try:
        series = getattr(fmpq_series([CENTRES[name], 1]), name)()
    finally:
        ctx.cap = cap
    return tuple(fraction(series[k]) for k in range(order))


@dataclass(frozen=True)
class ScaleAlgebra(Algebra):
    """The arithmetic of :class:`Asymptotic` on [start, ∞)."""

    start: Start

    def number(self, value: Fraction) -> Asymptotic:
        return constant(exactly(value), self.start)

    def constant(self, name: str, m: int) -> Asymptotic:
        return constant(exactly(1) if m == 1 else named(name, m), self.start)

    def pi(self) -> Asymptotic:
        return constant(named("pi"), self.start)

    def function(self, name: str, value: Asymptotic) -> Asymptotic:
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
    first = reach if point is None else 1 / abs(reach)
    for start in (Start(first, order) for order in ORDERS if first >= 1):
        x = t = Asymptotic(((X, exactly(1)),), start)
        with suppress(Open, Unsupported, ValueError, ZeroDivisionError):
            if point is not None:
                step = constant(exactly(1 if reach > 0 else -1), start) / t
                x = constant(exactly(point), start) + step
            function: Asymptotic = evaluate(tree, {name: x}, ScaleAlgebra(start))
            return function.sign()
    return 0
