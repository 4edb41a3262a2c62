"""The steps by which ``f > 0`` or ``f >= 0`` is shown for an expression of one variable x >= 0.

- everywhere, exactly: f is a quotient of polynomials in x alone or in y = exp(x) alone (Sturm);
- on a box: Taylor's formula about its middle, the remainder enclosed over the whole box.

Next to 0 and on [X, ∞) ``scales`` has the sign of the dominant term. Each step returns ``True`` only if it is
a proof; ``False`` says nothing.

References: ``tucker2011validated``, chapters 3 and 5; ``sturm1829``.
"""

from __future__ import annotations

from fractions import Fraction

from flint import arb, fmpq_poly

from lyapcheck.check.expressions.expression import Tree, Unsupported, ball, taylor
from lyapcheck.check.expressions.grammar import MAX_EXPONENT
from lyapcheck.check.expressions.normal_form import Ratio, normal_form
from lyapcheck.check.numbers.polynomials import ball_of, nonnegative_on, positive_on, univariate


def positive_at(tree: Tree, name: str, x: Fraction) -> bool:
    """Whether f(x) > 0."""
    return bool(ball(tree, {name: ball_of(x)}) > 0)


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
    lowest terms: that f has a value everywhere, and so a bottom that is not 0, is judged by ``defined``.
    """
    result = _in_x_or_exp(tree, name)
    if result is None:
        return None
    polynomial, exponential = result
    if exponential:
        if low != 0 or high is not None:
            return None
        low = Fraction(1)
    if not strict:
        return nonnegative_on(polynomial, low, high)
    return positive_on(polynomial, low, high, open_low=low == int(exponential))


def _in_x_or_exp(tree: Tree, name: str) -> tuple[fmpq_poly, bool] | None:
    """Top times bottom of the normal form, if it is in x or exp(x) alone, and whether in exp(x)."""
    try:
        ratio, algebra = normal_form(tree)
    except Unsupported:
        return None
    ratio = Ratio(ratio.top, ratio.bottom).lowest()
    degrees = [max(pair) for pair in zip(ratio.top.degrees(), ratio.bottom.degrees(), strict=True)]
    used = [index for index, degree in enumerate(degrees) if degree]
    x = algebra.names.index(name) if name in algebra.names else None
    own = algebra.uses.get(("exp", str(algebra.variable(name).top.monoms()[0]))) if x is not None else None
    if len(used) > 1 or not {*used} <= {x, own}:
        return None
    [index] = used or [0]
    if degrees[index] > MAX_EXPONENT:
        raise Unsupported(f"a power above {MAX_EXPONENT}")
    return univariate(ratio.top, index) * univariate(ratio.bottom, index), bool(used) and index == own
