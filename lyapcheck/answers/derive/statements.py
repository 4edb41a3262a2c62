"""What SymPy has derived, written as statements that the checker can judge."""

from __future__ import annotations

from functools import reduce
from operator import add, mul
from typing import Any, cast

import sympy as sp

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.statement import Statement
from lyapcheck.claims import loops
from lyapcheck.claims.expressions import Expr, diff, expr, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, diagonal, every_n
from lyapcheck.claims.statements import identity
from lyapcheck.derive.family import Member
from lyapcheck.derive.lyapunov import EPS, Letters, R, matrices, terms_15, value_12, value_13

X = var("x")
LOOP = loops.letters()


def tree(expression: Any) -> Tree:
    """An expression in numbers, x, sinh, cosh and log as the checker writes it."""
    if expression.is_Rational:
        return "num", str(expression)
    if expression.is_Symbol:
        return "var", expression.name
    if expression.is_Pow:
        base, power = tree(expression.base), int(expression.exp)
        return ("pow", base, power) if power > 0 else ("div", ("num", "1"), ("pow", base, -power))
    parts = tuple(map(tree, expression.args))
    if expression.is_Add or expression.is_Mul:
        return ("add" if expression.is_Add else "mul", *parts)
    return expression.func.__name__, *parts


def of_family(member: Member) -> dict[str, Statement]:
    """By the id of the claim: U' is the h that was derived, and h' of the checker's h is the derived one."""
    h, dh = Expr(tree(member.h)), Expr(tree(member.dh))
    return {
        "14": identity(diff(Expr(("potential", member.m, X.tree)), "x"), h),
        "8": identity(diff(Expr(("h", member.m, X.tree)), "x"), dh),
    }


def equal_values() -> Statement:
    """(12), as SymPy has it, equals (13) for every n; Σ k_pi U_i in place of uᵀK_p u/(2m)."""
    x = matrices()
    squares = {x.share * x.root.T * x.Kp * x.root: x.kp.T * x.U}
    return every_n(number(value_12(x).subs(squares)), number(value_13(x)), (LOOP.M,), positive=(LOOP.r,))


def rate_of_value() -> Statement:
    """V of (13) has the sum of the derived terms as its derivative along (11), for every n."""
    x = matrices()
    return loops.along(LOOP, number(value_13(x)), reduce(add, map(number, terms_15(x))))


def number(expression: Any) -> Expr:
    """A (1, 1) matrix of SymPy in the letters of every n."""
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(number, expression.args))
    scalar, parts = _factors(expression)
    result = _scalar(scalar)
    while parts:
        if parts[0].shape == (1, 1):
            result *= number(parts.pop(0))
            continue
        last = next(k for k, part in enumerate(parts) if part.shape[1] == 1)
        row, column = _vector(parts[0].T.doit()), _vector(sp.MatMul(*parts[1 : last + 1]).doit())
        result, parts = result * (row @ column), parts[last + 1 :]
    return result


def _factors(expression: Any) -> tuple[Any, list[Any]]:
    """The number in front, and the matrices of a product."""
    if not isinstance(expression, sp.MatMul):
        return sp.Integer(1), [expression]
    matrices = [part for part in expression.args if part.is_Matrix]
    return sp.Mul(*(part for part in expression.args if not part.is_Matrix)), matrices


def _vector(expression: Any) -> AnyVector:
    if isinstance(expression, sp.MatrixSymbol):
        return cast("AnyVector", LETTERS[expression.name])
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(_vector, expression.args))
    scalar, parts = _factors(expression)
    result = _vector(parts[-1])
    for part in reversed(parts[:-1]):
        result = _matrix(part) @ result
    return result if scalar == 1 else result.times(_scalar(scalar))


def _matrix(expression: Any) -> AnyMatrix:
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(_matrix, expression.args))
    if isinstance(expression, sp.Transpose):
        return _matrix(expression.arg).T
    return cast("AnyMatrix", LETTERS[expression.name])


def _scalar(expression: Any) -> Expr:
    """Sums, products and powers of numbers."""
    if expression.is_Rational:
        return expr(str(expression))
    if expression.is_Symbol:
        return cast("Expr", LETTERS[expression.name])
    if expression.is_Pow:
        return _scalar(expression.base) ** int(expression.exp)
    return reduce(add if expression.is_Add else mul, map(_scalar, expression.args))


def _letters(x: Letters) -> dict[str, Any]:
    """The letters of SymPy by name as those of the checker."""
    s = LOOP
    named = {
        x.w: s.w,
        x.e: s.e,
        x.h: s.h,
        x.hw: s.hw,
        x.U: s.U,
        x.kp: s.kp,
        x.M: s.M,
        x.C: s.C,
        x.slope: diagonal(s.dh),
        x.Kp: diagonal(s.kp),
        x.Kv: diagonal(s.kv),
        x.B: diagonal(s.b),
        EPS: s.eps,
        R: s.r,
    }
    return {letter.name: value for letter, value in named.items()}


LETTERS = _letters(matrices())
