"""The steps by which ``f > 0`` or ``f >= 0`` is shown for an expression of one variable x >= 0.

- everywhere, exactly: f is a quotient of polynomials in x alone or in y = exp(x) alone (Sturm);
- on a box: Taylor's formula about its middle, the remainder enclosed over the whole box;
- next to 0, where f may vanish: the first Taylor coefficient that is not exactly zero, enclosed over the box;
- next to 0, where f has no Taylor series, and on [X, ∞): the dominant term of its asymptotic scale;
- on [X, ∞): one term of a polynomial in x and y outweighs the sum of all others from X on.

Each step returns ``True`` only if it is a proof; ``False`` says nothing.

References: ``tucker2011validated``, chapters 3 and 5; ``sturm1829``.
"""

from __future__ import annotations

from fractions import Fraction

from flint import arb, ctx, fmpq, fmpq_mpoly, fmpq_poly, fmpq_series

from lyapcheck.check.expressions.expression import (
    ExactSeriesAlgebra,
    Tree,
    Unsupported,
    ball,
    evaluate,
    taylor,
)
from lyapcheck.check.expressions.grammar import MAX_EXPONENT
from lyapcheck.check.expressions.normal_form import Ratio, normal_form
from lyapcheck.check.expressions.scales import sign_beside, sign_from
from lyapcheck.check.numbers.enclosure import ball_of
from lyapcheck.check.numbers.polynomials import nonnegative_on, positive_on

Terms = dict[tuple[int, int], fmpq | arb]
"""A polynomial in x and y = exp(x): exponents to coefficient, a ball where constants like γ or √3 come in."""


def exactly_zero_coefficients(tree: Tree, name: str, order: int) -> int:
    """How many leading Taylor coefficients at 0 are exactly zero (at most ``order``)."""
    cap, ctx.cap = ctx.cap, order + 1
    try:
        series = evaluate(tree, {name: fmpq_series([0, 1])}, ExactSeriesAlgebra())
        zeros = [c == 0 for c in list(series.coeffs())[: order + 1]]
    except (Unsupported, ValueError, ZeroDivisionError):
        zeros = [bool(c.is_zero()) for c in taylor(tree, name, arb(0), order)]
    finally:
        ctx.cap = cap
    return zeros.index(False) if False in zeros else min(len(zeros), order)


def positive_near_zero(
    tree: Tree, name: str, high: Fraction, order: int = 96, zero_included: bool = False
) -> bool:
    """Whether f > 0 on (0, high]; with ``zero_included`` f must also be defined at 0, so that f(0) >= 0."""
    if sign_near_zero(tree, name, high, order) > 0:
        return True
    if zero_included and not _is_defined(tree, name, Fraction(0)):
        return False
    return sign_beside(tree, name, Fraction(0), high) > 0


def _is_defined(tree: Tree, name: str, point: Fraction) -> bool:
    try:
        return bool(ball(tree, {name: ball_of(point)}).is_finite())
    except (ValueError, ZeroDivisionError):
        return False


def sign_near_zero(tree: Tree, name: str, high: Fraction, order: int = 96, more: int = 8) -> int:
    """The sign that f keeps on (0, high], or 0 where that is not shown.

    With f(0), …, f^(k−1)(0) exactly zero, f(x)/x^k = c_k + c_{k+1} x + … + c_K(ξ) x^{K−k}, K = k + ``more``.
    """
    box = ball_of(Fraction(0)).union(ball_of(high))
    try:
        k = exactly_zero_coefficients(tree, name, order)
        coefficients = taylor(tree, name, arb(0), k + more - 1)[k:]
        coefficients.append(taylor(tree, name, box, k + more)[k + more])
    except (ValueError, ZeroDivisionError):
        return 0
    value = arb(0)
    for coefficient in reversed(coefficients):
        value = value * box + coefficient
    return 0 if k == order else 1 if value > 0 else -1 if value < 0 else 0


def positive_on_box(tree: Tree, name: str, low: Fraction, high: Fraction, order: int = 8) -> bool:
    """Whether f > 0 on [low, high], by Taylor's formula about the middle."""
    middle = ball_of((low + high) / 2)
    box = ball_of(low).union(ball_of(high))
    try:
        remainder = taylor(tree, name, box, order)[order]
        coefficients = [*taylor(tree, name, middle, order - 1), remainder]
    except (ValueError, ZeroDivisionError):
        return False
    step = box - middle
    value = arb(0)
    for coefficient in reversed(coefficients):
        value = value * step + coefficient
    return bool(value > 0)


def sign_everywhere(tree: Tree, name: str, low: Fraction, high: Fraction | None, strict: bool) -> bool | None:
    """Whether f > 0 (or >= 0) on [low, high], exactly; ``None`` where f is not in x or y alone.

    With ``strict`` the end 0 is left out: f > 0 is asked on (0, high] when low = 0. The quotient is taken in
    lowest terms: that f has a value everywhere is judged by ``defined``.
    """
    result = _in_x_and_y(tree, name)
    if result is None or any(isinstance(c, arb) for terms in result for c in terms.values()):
        return None
    (top, top_kind), (bottom, bottom_kind) = map(_one_generator, result)
    kinds = {top_kind, bottom_kind} - {"constant"}
    if len(kinds) > 1 or "both" in kinds:
        return None
    if kinds == {"y"}:
        if low != 0 or high is not None:
            return None
        low = Fraction(1)
    if not positive_on(bottom, low, high):
        if not positive_on(-bottom, low, high):
            return None
        top = -top
    if not strict:
        return nonnegative_on(top, low, high)
    return positive_on(top, low, high, open_low=low == (1 if kinds == {"y"} else 0))


def positive_from(tree: Tree, name: str, start: Fraction) -> bool:
    """Whether f > 0 on [start, ∞), start >= 1, by a dominant term in x and exp(x), or in the wider scale."""
    result = _in_x_and_y(tree, name)
    if result is not None:
        signs = [dominant_sign(terms, start) for terms in result]
        if 0 not in signs:
            return signs[0] == signs[1]
    return sign_from(tree, name, start) > 0


def dominant_sign(terms: Terms, start: Fraction) -> int:
    """The sign that Σ c x^i y^j keeps on [start, ∞), or 0 where that is not shown.

    The term (I, J) that is largest by (j, i) leads. Each ratio x^(i−I) y^(j−J) falls from x = (i−I)/(J−j) on
    (for j = J always, since i < I); if the ratios, weighted by |c/C|, sum to less than 1 at ``start`` and all
    fall from there, they do so for ever.
    """
    if not terms:
        return 0
    lead = max(terms, key=lambda e: (e[1], e[0]))
    x, y, largest = ball_of(start), ball_of(start).exp(), arb(terms[lead])
    rest = arb(0)
    for (i, j), coefficient in terms.items():
        if (i, j) != lead:
            di, dj = i - lead[0], lead[1] - j
            if dj and start < Fraction(di, dj):
                return 0
            rest += abs(arb(coefficient) * x**di / y**dj)
    if rest < largest:
        return 1
    return -1 if rest < -largest else 0


def _in_x_and_y(tree: Tree, name: str) -> tuple[Terms, Terms] | None:
    """Top and bottom of the normal form in x and y = exp(x), when there is nothing else in it."""
    try:
        ratio, algebra = normal_form(tree)
    except Unsupported:
        return None
    ratio = Ratio(ratio.top, ratio.bottom).lowest()
    x = algebra.names.index(name) if name in algebra.names else None
    constants = algebra.constants()
    others = set(algebra.uses.values()) - set(constants)
    own = algebra.uses.get(("exp", str(algebra.variable(name).top.monoms()[0]))) if x is not None else None
    if others - {own}:
        return None
    return _terms(ratio.top, x, own, constants), _terms(ratio.bottom, x, own, constants)


def _terms(polynomial: fmpq_mpoly, x: int | None, y: int | None, constants: dict[int, arb]) -> Terms:
    result: Terms = {}
    for exponents, coefficient in polynomial.to_dict().items():
        key = (int(exponents[x]) if x is not None else 0, int(exponents[y]) if y is not None else 0)
        value: fmpq | arb = coefficient
        for index, number in constants.items():
            if exponents[index]:
                value = arb(value) * number ** int(exponents[index])
        result[key] = result[key] + value if key in result else value
    return {key: value for key, value in result.items() if isinstance(value, arb) or value != 0}


def _one_generator(terms: Terms) -> tuple[fmpq_poly, str]:
    """The polynomial in the one generator that occurs, and which that is."""
    in_x, in_y = any(i for i, _ in terms), any(j for _, j in terms)
    kind = "both" if in_x and in_y else "x" if in_x else "y" if in_y else "constant"
    if kind == "both":
        return fmpq_poly(), kind
    degree = max((i + j for i, j in terms), default=0)
    if degree > MAX_EXPONENT:
        raise Unsupported(f"a power above {MAX_EXPONENT}")
    coefficients = [fmpq(0)] * (1 + degree)
    for (i, j), c in terms.items():
        coefficients[i + j] = c
    return fmpq_poly(coefficients), kind
