"""Writing what holds between vectors and matrices for every n, with the usual operators.

The functions at the end take these letters as well as lists of entries.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN, Given
from lyapcheck.claims.expressions import Expr, Multiplied, expr, total, var


@dataclass(frozen=True, eq=False)
class AnyVector(Multiplied):
    """A vector of Rⁿ for every n. ``x @ y`` is xᵀy, ``x @ A @ y`` is xᵀAy, and ``s * x`` is a multiple."""

    tree: Tree

    def __add__(self, other: AnyVector) -> AnyVector:
        return AnyVector(("sum", self.tree, _summand(other)))

    def __sub__(self, other: AnyVector) -> AnyVector:
        return self + -other

    def __neg__(self) -> AnyVector:
        return self.times(-1)

    def __rmul__(self, factor: object) -> AnyVector:
        return self.times(factor)

    def __matmul__(self, other: Any) -> Any:
        return Row(self, (other,)) if isinstance(other, AnyMatrix) else _dot(self.tree, _vector(other).tree)

    def dot(self, other: AnyVector) -> Expr:
        """The dot product."""
        return Expr(("dot", self.tree, other.tree))

    def times(self, factor: object) -> AnyVector:
        """A multiple by a number."""
        return AnyVector(("scale", expr(factor).tree, self.tree))


@dataclass(frozen=True, eq=False)
class AnyMatrix(Multiplied):
    """An n × n matrix for every n."""

    tree: Tree

    def __add__(self, other: AnyMatrix) -> AnyMatrix:
        return AnyMatrix(("sum", self.tree, _summand(other)))

    def __sub__(self, other: AnyMatrix) -> AnyMatrix:
        return self + -1 * other

    def __neg__(self) -> AnyMatrix:
        return -1 * self

    def __rmul__(self, factor: object) -> AnyMatrix:
        return AnyMatrix(("scale", expr(factor).tree, self.tree))

    @property
    def T(self) -> AnyMatrix:
        """The transpose."""
        return AnyMatrix(("transpose", self.tree))

    def __matmul__(self, x: AnyVector) -> AnyVector:
        return AnyVector(("apply", self.tree, _vector(x).tree))


@dataclass(frozen=True, eq=False)
class Row:
    """xᵀA B …, which waits for the vector on its right."""

    left: AnyVector
    matrices: tuple[AnyMatrix, ...]

    def __matmul__(self, other: Any) -> Any:
        if isinstance(other, AnyMatrix):
            return Row(self.left, (*self.matrices, other))
        for matrix in reversed(self.matrices):
            other = matrix @ other
        return _dot(self.left.tree, _vector(other).tree)


def _vector(other: object) -> AnyVector:
    if isinstance(other, AnyMatrix):
        raise TypeError(
            "a product of two matrices is no letter here; begin at a vector: K @ (A @ x), or x @ K @ A @ y"
        )
    if not isinstance(other, AnyVector):
        raise TypeError(
            f"@ multiplies vectors and matrices, and a {type(other).__name__} is neither; write s * x"
        )
    return other


def _summand(other: object) -> Tree:
    if not isinstance(other, AnyVector | AnyMatrix):
        raise TypeError(
            "a number stands beside a vector or matrix in a sum; write norm(x), or x @ y, for numbers"
        )
    return other.tree


def _dot(left: Tree, right: Tree) -> Expr:
    """xᵀy, with the factor of x in front."""
    if left[0] != "scale":
        return Expr(("dot", left, right))
    _, factor, x = left
    product = _dot(x, right)
    return -product if factor == ("num", "-1") else Expr(factor) * product


Letter = Expr | AnyVector | AnyMatrix
Rates = Iterable[tuple[Letter, Letter]]
Motions = Iterable[tuple[AnyMatrix, AnyVector, AnyVector]]
Norm = tuple[Letter | tuple[Letter, ...], object]
Least = tuple[Expr, object]
SORTS = {"var": "number", "vec": "vector", "mat": "matrix"}


def any_vector(name: str) -> AnyVector:
    """A vector of Rⁿ, by name."""
    return AnyVector(("vec", name))


def any_matrix(name: str) -> AnyMatrix:
    """An n × n matrix, by name."""
    return AnyMatrix(("mat", name))


def diagonal(x: AnyVector) -> AnyMatrix:
    """The diagonal matrix of a vector that is a symbol.

    Raises:
        ValueError: it is a sum or a product.
    """
    return AnyMatrix(("diag", _name("diagonal", x, "vec")))


def zero_vector() -> AnyVector:
    """0 in Rⁿ."""
    return AnyVector(("sum",))


def rate(of: Expr) -> Expr:
    """The derivative of a number by time. The statement gives the derivatives of its symbols."""
    return Expr(("rate", of.tree))


def every_n(
    left: Expr,
    right: Expr,
    symmetric: Iterable[AnyMatrix] = (),
    rates: Rates = (),
    given: Motions = (),
    positive: Iterable[Expr] = (),
) -> EveryN:
    """Claim ``left = right`` for every n and all values of the symbols.

    Args:
        left: a number made of symbols.
        right: a number made of symbols.
        symmetric: the matrices with Aᵀ = A.
        rates: the symbols that depend on time, each with its derivative.
        given: A, x and b with A x = b.
        positive: the numbers that are > 0. The others are real.

    Raises:
        ValueError: something stands where only a letter may.
    """
    return EveryN(
        left.tree,
        expr(right).tree,
        tuple(_name("symmetric", matrix, "mat") for matrix in symmetric),
        tuple((letter.tree, value.tree) for letter, value in rates),
        _given(given),
        tuple(_name("positive", number, "var") for number in positive),
    )


def at_most_every_n(
    left: Expr,
    right: object,
    norms: Iterable[Norm] = (),
    least: Iterable[Least] = (),
    symmetric: Iterable[AnyMatrix] = (),
    rates: Rates = (),
    given: Motions = (),
) -> BoundEveryN:
    """Claim ``left <= right`` for every n, from bounds of norms. These bounds are printed with the statement.

    Args:
        left: a number made of symbols, as in :func:`every_n`. Its numbers are >= 0.
        right: an expression in numbers >= 0 and constants.
        norms: pairs of a symbol and an upper bound of its norm. Several symbols are the product of norms.
            A matrix has the spectral norm, and ``diagonal(x)`` the largest |x_i|.
        least: pairs of a number and a lower bound.
        symmetric: as in :func:`every_n`, like ``rates`` and ``given``.
        rates: the symbols that move, each with its derivative by time.
        given: A, x and b with A x = b.

    Raises:
        ValueError: something stands where only a letter may.
    """
    groups = ((known if isinstance(known, tuple) else (known,), size) for known, size in norms)
    return BoundEveryN(
        left=left.tree,
        right=expr(right).tree,
        symmetric=tuple(_name("symmetric", matrix, "mat") for matrix in symmetric),
        rates=tuple((letter.tree, value.tree) for letter, value in rates),
        given=_given(given),
        norms=tuple((tuple(letter.tree for letter in group), expr(size).tree) for group, size in groups),
        least=tuple((number.tree, expr(size).tree) for number, size in least),
    )


def _given(motions: Motions) -> tuple[Given, ...]:
    return tuple(Given(_name("given", a, "mat"), _name("given", x, "vec"), b.tree) for a, x, b in motions)


def _name(use: str, letter: Letter, kind: str) -> str:
    """The name of a letter of one sort.

    Raises:
        ValueError: it is no such letter.
    """
    if letter.tree[0] != kind:
        shown = expression_text(letter.tree)
        raise ValueError(f"{use}: {shown} is not the letter of a {SORTS[kind]}; give it a letter of its own")
    return str(letter.tree[1])


# --- Vectors and matrices in a proof script: lists of entries for a given n, or letters for every n.
#
# The functions take either and give the same kind back, so that a formula is written once for both.


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
    """The elementwise product, diag(x) y. For every n, x is a symbol."""
    if isinstance(x, AnyVector):
        return diagonal(x) @ y
    return [a * b for a, b in zip(x, y, strict=True)]
