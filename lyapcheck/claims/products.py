"""Vectors and matrices in a proof script: lists of entries for a given n, or letters for every n.

The functions take either and give the same kind back, so that a formula is written once for both.
"""

from __future__ import annotations

from typing import TypeVar

from lyapcheck.claims.expressions import Expr, total, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, diagonal

Vector = list[Expr]
Matrix = list[list[Expr]]
V = TypeVar("V", Vector, AnyVector)
A = TypeVar("A", Matrix, AnyMatrix)


def vector(name: str, n: int) -> Vector:
    """The variables name1, …, namen."""
    return [var(f"{name}{i + 1}") for i in range(n)]


def matrix(name: str, n: int, symmetric: bool = False) -> Matrix:
    """An n × n matrix of variables name11, name12, …."""
    return [
        [
            var(f"{name}{min(i, j) + 1}{max(i, j) + 1}" if symmetric else f"{name}{i + 1}{j + 1}")
            for j in range(n)
        ]
        for i in range(n)
    ]


def dot(x: V, y: V) -> Expr:
    """xᵀy."""
    if isinstance(x, AnyVector):
        return x.dot(y)
    return total(a * b for a, b in zip(x, y, strict=True))


def apply(a: Matrix | AnyMatrix, x: V) -> V:
    """A x."""
    if isinstance(x, AnyVector):
        assert isinstance(a, AnyMatrix), "letters are multiplied with letters"
        return a @ x
    assert isinstance(a, list), "entries are multiplied with entries"
    return [dot(row, x) for row in a]


def form(x: V, a: Matrix | AnyMatrix, y: V) -> Expr:
    """xᵀ A y."""
    return dot(x, apply(a, y))


def transpose(a: A) -> A:
    """Aᵀ."""
    if isinstance(a, AnyMatrix):
        return a.T
    return [list(column) for column in zip(*a, strict=True)]


def plus(a: A, b: A) -> A:
    """A + B."""
    if isinstance(a, AnyMatrix):
        return a + b
    return [[x + y for x, y in zip(p, q, strict=True)] for p, q in zip(a, b, strict=True)]


def scaled(x: V, y: V) -> V:
    """The elementwise product, diag(x) y; for every n, x is a letter."""
    if isinstance(x, AnyVector):
        return diagonal(x) @ y
    return [a * b for a, b in zip(x, y, strict=True)]


def combined(x: V, factor: Expr, y: V) -> V:
    """x + factor·y."""
    if isinstance(x, AnyVector):
        return x + y.times(factor)
    return [a + factor * b for a, b in zip(x, y, strict=True)]
