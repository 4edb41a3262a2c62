"""Squares vᵀGv with unknown Gram matrices G that add up to a polynomial, in floating point and exactly.

References: ``parrilo2003semidefinite``, ``peyrl2008computing``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from flint import fmpq, fmpq_mat, fmpq_mpoly

from lyapcheck.check.expressions.normal_form import RationalAlgebra
from lyapcheck.check.kinds.implies import Exponents
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.convex import Ended, solved

if TYPE_CHECKING:
    from lyapcheck._types import Array

LARGEST_TRACE = 100
"""For each entry of the vectors."""

Vector = tuple[fmpq_mpoly, ...]
Matrix = list[list[fmpq]]
Factors = tuple[list[Exponents], Matrix, list[fmpq]]
"""Monomials, L and D."""


@dataclass(frozen=True)
class Block:
    """``over · vᵀGv · gap`` with G unknown; ``factor`` is over · gap, or −C for the lift.

    For an equation it is ``gᵀv · gap`` with a row g of any signs.
    """

    hypothesis: int | None
    over: Exponents
    factor: fmpq_mpoly
    vector: Vector
    algebra: RationalAlgebra
    equation: bool = False

    @property
    def places(self) -> Iterator[tuple[int, int]]:
        """Of the unknown numbers: the upper triangle of G, or the row."""
        n = len(self.vector)
        return ((i, j) for i in range(1 if self.equation else n) for j in range(i, n))

    def column(self, i: int, j: int) -> fmpq_mpoly:
        """What the number at a place is multiplied by."""
        left = self.vector[j] if self.equation else self.vector[i] * self.vector[j] * (1 + (i != j))
        return self.algebra.reduced(self.factor * left)


def needed(blocks: list[Block], goal: fmpq_mpoly) -> list[Block]:
    """Without the entries of vectors that must be 0, as only squares of one sign have their monomial."""
    while True:
        mixed = set(goal.to_dict())
        squares: dict[Any, list[tuple[int, int, bool]]] = {}
        for b, block in enumerate(blocks):
            for i, j in block.places:
                if i != j or block.equation:
                    mixed |= set(block.column(i, j).to_dict())
                    continue
                for e, c in block.column(i, j).to_dict().items():
                    squares.setdefault(e, []).append((b, i, c > 0))
        of_one_sign = (
            found for e, found in squares.items() if e not in mixed and len({sign for *_, sign in found}) == 1
        )
        gone = {(b, i) for found in of_one_sign for b, i, _ in found}
        blocks = [
            replace(block, vector=tuple(v for i, v in enumerate(block.vector) if (b, i) not in gone))
            for b, block in enumerate(blocks)
        ]
        if not gone:
            return [block for block in blocks if block.vector]


@dataclass
class System:
    """The identity as linear equations for the upper triangles of the matrices."""

    blocks: list[Block]
    goal: fmpq_mpoly
    places: list[tuple[int, int, int]] = field(init=False)
    entries: list[tuple[int, int, fmpq]] = field(init=False)
    side: list[fmpq] = field(init=False)
    rows: list[list[tuple[int, fmpq]]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.places = [(b, i, j) for b, block in enumerate(self.blocks) for i, j in block.places]
        columns = [self.blocks[b].column(i, j).to_dict() for b, i, j in self.places]
        goals = self.goal.to_dict()
        index = {e: r for r, e in enumerate(sorted({*goals, *(e for column in columns for e in column)}))}
        self.entries = [(index[e], c, v) for c, column in enumerate(columns) for e, v in column.items()]
        self.side = [goals.get(e, fmpq(0)) for e in index]

    def solved(self) -> tuple[float, list[Array], list[Array]] | None:
        """The margin, the matrices and those of the dual program, in floating point."""
        import cvxpy as cp

        sizes = [len(block.vector) for block in self.blocks]
        square = [not block.equation for block in self.blocks]
        margin = cp.Variable()
        matrices = [
            cp.Variable((n, n), symmetric=True) if own else cp.Variable((1, n))
            for n, own in zip(sizes, square, strict=True)
        ]
        parts = [
            np.zeros((len(self.side), n * n if own else n)) for n, own in zip(sizes, square, strict=True)
        ]
        for row, column, value in self.entries:
            b, i, j = self.places[column]
            parts[b][row, i * sizes[b] + j] = as_float(value)
        left = sum(part @ cp.vec(G, order="C") for part, G in zip(parts, matrices, strict=True))
        squares = [(G, n) for G, n, own in zip(matrices, sizes, square, strict=True) if own]
        definite = [G - margin * np.eye(n) >> 0 for G, n in squares]
        small = sum(cp.trace(G) for G, _ in squares) <= LARGEST_TRACE * sum(n for _, n in squares)
        fits = left == np.array(list(map(as_float, self.side)))
        answer = solved(margin, [fits, margin <= 1, small, *definite], [margin, *matrices])
        if answer.ended is Ended.FAILED:
            return None
        # almost solved is good enough: what is rounded is exact, and the checker judges it
        duals = iter(one.dual_value for one in definite)
        both = [next(duals) if own else np.zeros((n, n)) for n, own in zip(sizes, square, strict=True)]
        return float(answer.values[0]), list(answer.values[1:]), both

    def reduce(self) -> bool:
        """Solve the equations for some entries; whether they have a solution."""
        width = len(self.places)
        full = fmpq_mat(len(self.side), width + 1)
        for row, column, value in self.entries:
            full[row, column] = value
        for row, value in enumerate(self.side):
            full[row, width] = value
        rows, rank = full.rref()
        self.rows = [[(c, rows[r, c]) for c in range(width + 1) if rows[r, c]] for r in range(rank)]
        return all(row[0][0] < width for row in self.rows)

    def exact(self, matrices: list[Array], denominator: int) -> list[Matrix]:
        """The matrices with rounded entries, and others from the equations."""
        values = [fmpq(round(float(matrices[b][i, j]) * denominator), denominator) for b, i, j in self.places]
        values.append(fmpq(-1))  # times the right side, the last column
        for (pivot, _), *others in self.rows:
            values[pivot] = -sum((value * values[c] for c, value in others), fmpq(0))
        result = [
            [[fmpq(0)] * len(block.vector) for _ in (block.vector[:1] if block.equation else block.vector)]
            for block in self.blocks
        ]
        for (b, i, j), value in zip(self.places, values, strict=False):
            result[b][i][j] = value
            if not self.blocks[b].equation:
                result[b][j][i] = value
        return result


def eigenvectors(matrix: Array, bound: float) -> Array:
    """Those of the eigenvalues above a bound, as rows."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.array(vectors[:, values > bound].T)


def without(vector: Vector, kernel: Array, denominator: int) -> Vector:
    """What is left of a vector if the kernel of its matrix, rounded to short rationals, is taken out."""
    pivots: list[int] = []
    for r in range(len(kernel)):
        row, column = divmod(int(np.argmax(np.abs(kernel[r:]))), len(vector))
        kernel[[r, r + row]] = kernel[[r + row, r]]
        kernel[r] /= kernel[r, column]
        for other in range(len(kernel)):
            if other != r:
                kernel[other] -= kernel[other, column] * kernel[r]
        pivots.append(column)
    result = []
    for column in (c for c in range(len(vector)) if c not in pivots):
        short = (Fraction(float(x)).limit_denominator(denominator) for x in kernel[:, column])
        taken = (vector[pivot] * rational(x) for pivot, x in zip(pivots, short, strict=True))
        result.append(vector[column] - sum(taken))
    return tuple(result)


def factored(matrix: Matrix, vector: Sequence[fmpq_mpoly]) -> Factors:
    """Monomials with L and D of the matrix, which is positive semidefinite, for them."""
    terms = [one.to_dict() for one in vector]
    monomials = sorted({e for one in terms for e in one})
    basis = fmpq_mat([[one.get(e, fmpq(0)) for e in monomials] for one in terms])
    factors = ldl((basis.transpose() * fmpq_mat(matrix) * basis).tolist())
    if factors is None:
        raise ArithmeticError("a product of semidefinite matrices that is not")
    return monomials, *factors


def ldl(matrix: Matrix) -> tuple[Matrix, list[fmpq]] | None:
    """L and D, exactly; None where the matrix is not positive semidefinite."""
    n = len(matrix)
    rest, lower = [row[:] for row in matrix], [[fmpq(0)] * n for _ in range(n)]
    for k in range(n):
        pivot = rest[k][k]
        if pivot < 0 or (pivot == 0 and any(rest[i][k] for i in range(k, n))):
            return None
        for i in range(k + 1, n):
            if rest[i][k]:
                lower[i][k] = rest[i][k] / pivot
                for j in range(k + 1, n):
                    rest[i][j] -= lower[i][k] * rest[k][j]
    return lower, [rest[k][k] for k in range(n)]


def as_float(value: fmpq) -> float:
    """The nearest double."""
    return int(value.p) / int(value.q)
