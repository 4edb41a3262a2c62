"""Writing identities between vectors and matrices that hold for every n, with the usual operators.

The functions of ``claims.products`` take these letters as well as lists of entries.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.every_n import EveryN, Given
from lyapcheck.claims.expressions import Expr, expr


@dataclass(frozen=True, eq=False)
class AnyVector:
    """A vector of Rⁿ for every n."""

    tree: Tree

    def __add__(self, other: AnyVector) -> AnyVector:
        return AnyVector(("sum", self.tree, other.tree))

    def __sub__(self, other: AnyVector) -> AnyVector:
        return self + -other

    def __neg__(self) -> AnyVector:
        return self.times(-1)

    def dot(self, other: AnyVector) -> Expr:
        """The dot product."""
        return Expr(("dot", self.tree, other.tree))

    def times(self, factor: object) -> AnyVector:
        """A multiple by a number."""
        return AnyVector(("scale", expr(factor).tree, self.tree))


@dataclass(frozen=True, eq=False)
class AnyMatrix:
    """An n × n matrix for every n."""

    tree: Tree

    def __add__(self, other: AnyMatrix) -> AnyMatrix:
        return AnyMatrix(("sum", self.tree, other.tree))

    @property
    def T(self) -> AnyMatrix:
        """The transpose."""
        return AnyMatrix(("transpose", self.tree))

    def __matmul__(self, x: AnyVector) -> AnyVector:
        return AnyVector(("apply", self.tree, x.tree))


Letter = Expr | AnyVector | AnyMatrix


def any_vector(name: str) -> AnyVector:
    """A vector of Rⁿ, by name."""
    return AnyVector(("vec", name))


def any_matrix(name: str) -> AnyMatrix:
    """An n × n matrix, by name."""
    return AnyMatrix(("mat", name))


def diagonal(x: AnyVector) -> AnyMatrix:
    """The diagonal matrix of a vector that is a letter.

    Raises:
        ValueError: it is a sum or a product.
    """
    if x.tree[0] != "vec":
        raise ValueError("diag is of a letter, not of a sum or product; give that a letter of its own")
    return AnyMatrix(("diag", x.tree[1]))


def zero_vector() -> AnyVector:
    """0 in Rⁿ."""
    return AnyVector(("sum",))


def rate(of: Expr) -> Expr:
    """The derivative of a number by time, where the statement gives those of the letters in it."""
    return Expr(("rate", of.tree))


def every_n(
    left: Expr,
    right: Expr,
    symmetric: Iterable[AnyMatrix] = (),
    rates: Iterable[tuple[Letter, Letter]] = (),
    given: Iterable[tuple[AnyMatrix, AnyVector, AnyVector]] = (),
    positive: Iterable[Expr] = (),
) -> EveryN:
    """``left = right`` for every n and all values of the letters.

    Args:
        left: a number made of the letters; so is ``right``.
        right: what it equals.
        symmetric: the matrices with Aᵀ = A.
        rates: the letters that move, or stand still, each with its derivative by time.
        given: A, x and b with A x = b.
        positive: the numbers that are > 0; the others are real.
    """
    return EveryN(
        left.tree,
        expr(right).tree,
        tuple(str(matrix.tree[1]) for matrix in symmetric),
        tuple((letter.tree, value.tree) for letter, value in rates),
        tuple(Given(a.tree[1], x.tree[1], b.tree) for a, x, b in given),
        tuple(number.tree[1] for number in positive),
    )
