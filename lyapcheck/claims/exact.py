"""Expressions that stand for one number: bounds, ends of intervals and ε₀ in a proof script."""

from __future__ import annotations

from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.defined import Undefined, require_defined
from lyapcheck.check.expressions.expression import Tree, Unsupported, variables
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.verify import BITS
from lyapcheck.claims.expressions import expr


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
    try:
        ratio, _ = normal_form(tree)
    except Unsupported:
        ratio = None
    if ratio is None or not (ratio.top.is_constant() and ratio.bottom.is_constant()):
        shown = expression_text(tree)
        rule = "is not shown to be rational, and only exact numbers may stand here"
        raise ValueError(f"{shown} {rule}; round it by above({shown}) or below({shown})")
    if ratio.top == 0:
        return Fraction(0)
    quotient = ratio.top.leading_coefficient() / ratio.bottom.leading_coefficient()
    return Fraction(int(quotient.p), int(quotient.q))
