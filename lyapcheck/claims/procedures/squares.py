"""Sums of squares for implications between polynomials, by convex programs in floating point.

Unknown are the Gram matrices G of the squares vᵀGv in  (1 + σ)·C = Σ μ_k σ_k H_k.  The identity is linear in
them. A program looks for matrices that are positive definite by the largest margin. They are rounded, and the
identity is solved exactly for the rest. Where no margin is left, the matrices are singular at every solution:
their kernels are rounded too, and the search goes on in what is left of v.

References: ``parrilo2003semidefinite``, ``peyrl2008computing``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations, combinations_with_replacement, product
from math import log2
from typing import TYPE_CHECKING, Any

import numpy as np
from flint import fmpq, fmpq_mat, fmpq_mpoly

from lyapcheck.check.kinds.implies import Exponents, Implies, Monomial, Signs
from lyapcheck.check.kinds.sum_of_squares import Product, Squares, SumOfSquares, gaps_of
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.convex import Ended, solved

if TYPE_CHECKING:
    from lyapcheck._types import Array

NEEDED = ("scipy", "cvxpy", "clarabel")
"""Libraries of this search."""
DENOMINATORS = (1, 2, 12, 120, 2520, 10**5, 10**7, 10**9)
"""Of the entries that are rounded, one after the other."""
NO_MARGIN, INFEASIBLE = 1e-5, -1e-4
DUAL, SMALL = (1e-2, 1e-4, 1e-6), (1e-5, 1e-3)
"""Where no margin is left, kernels belong to eigenvalues of the dual matrices above, or of G below."""
KERNEL_DENOMINATORS = 60, 400
FACES, PROGRAMS = 4, 20
"""How often kernels are taken out, and how many programs are solved for a statement."""
MOST_UNKNOWNS, MOST_ENTRIES = 2_500, 40
"""Of a program, and of a vector in it."""
LARGEST_TRACE = 100
"""For each entry of the vectors."""
LIFT = -1
"""Stands for the conclusion in place of a hypothesis."""

Vector = tuple[fmpq_mpoly, ...]
Matrix = list[list[fmpq]]
Factors = tuple[list[Exponents], Matrix, list[fmpq]]
"""Monomials, L and D."""


def by_squares(statement: Implies, signs: Signs) -> SumOfSquares | None:
    """A proof that the checker accepts, or None.

    Args:
        statement: the implication.
        signs: its polynomials, which are plain.
    """
    search = _Search(signs, statement.conclusion.strict)
    for blocks in search.programs():
        for proof in search.proofs(blocks, FACES):
            try:
                verify(statement, proof)
            except Refused:
                continue
            return proof
    return None


@dataclass(frozen=True)
class Block:
    """``over · vᵀGv · gap`` with G unknown; ``factor`` is over · gap, or −C for the lift."""

    hypothesis: int | None
    over: Exponents
    factor: fmpq_mpoly
    vector: Vector


class _Search:
    """In variables x′, x = 2^scale · x′, in which the coefficients are of about one size."""

    def __init__(self, signs: Signs, strict: bool) -> None:
        self.signs, self.strict, self.ring = signs, strict, signs.ring
        self.count = len(signs.algebra.names)
        self.one: Exponents = (0,) * self.ring.nvars()
        self.left = PROGRAMS
        gaps = gaps_of(signs)
        self.scales = _scales(gaps, self.count)
        powers = [fmpq(2) ** scale for scale in self.scales] + [fmpq(1)] * (len(self.one) - self.count)
        generators = [x * power for x, power in zip(self.ring.gens(), powers, strict=True)]
        goal, *self.hypotheses = (gap.compose(*generators, ctx=self.ring) for gap in gaps)
        self.size = max(map(abs, goal.coeffs()), default=fmpq(1))
        self.goal = goal / self.size

    def programs(self) -> Iterator[list[Block]]:
        """The blocks of unknowns, programs of low degree first."""
        half = (max(0, self.goal.total_degree()) + 1) // 2
        most = max((max(0, one.total_degree()) + 1) // 2 for one in (self.goal, *self.hypotheses))
        bounded = [i for i in range(self.count) if i in self.signs.bounds]
        if self.hypotheses or bounded:
            yield self._blocks(half, 0, ())
            yield self._blocks(most, 2 * most, bounded)
            yield self._blocks(most + 1, 2 * most + 2, bounded)
        else:
            yield self._blocks(half, 0, ())
        yield [*self._blocks(half + 1, 2 * half + 2, bounded), self._block(LIFT, self.one, 1)]

    def _blocks(self, half: int, degree: int, bounded: Sequence[int]) -> list[Block]:
        """Squares up to a half degree; hypotheses and bounded variables times squares up to a degree."""
        result = [self._block(None, self.one, half)]
        chosen = [some for size in range(3) for some in combinations(bounded, size)]
        for some in chosen:
            over = tuple(int(i in some) for i in range(len(self.one)))
            room = degree - len(some)
            if some and room >= 0:
                result.append(self._block(None, over, room // 2))
            for k, gap in enumerate(self.hypotheses):
                if degree == 0 or gap.total_degree() <= room:
                    result.append(self._block(k, over, max(0, room - gap.total_degree()) // 2))
        if self.strict:
            # what makes the conclusion strict must be definite by itself
            single = tuple(self.ring.gens()[: self.count])
            result += [self._block(None, self.one, 0), Block(None, self.one, self.ring.constant(1), single)]
        return result

    def _block(self, hypothesis: int | None, over: Exponents, half: int) -> Block:
        gap = self.ring.constant(1)
        if hypothesis is not None:
            gap = -self.goal if hypothesis == LIFT else self.hypotheses[hypothesis]
        letters = range(self.count)
        vector = []
        for size in range(half + 1):
            for some in combinations_with_replacement(letters, size):
                vector.append(self._monomial(tuple(some.count(i) for i in range(len(self.one)))))
        return Block(hypothesis, over, gap * self._monomial(over), tuple(vector))

    def _monomial(self, exponents: Exponents) -> fmpq_mpoly:
        return self.ring.from_dict({exponents: fmpq(1)})

    def proofs(self, blocks: list[Block], faces: int) -> Iterator[SumOfSquares]:
        """Proofs by matrices that are positive semidefinite and fit exactly."""
        blocks = _needed(blocks, self.goal)
        sizes = [len(block.vector) for block in blocks]
        unknowns = sum(n * (n + 1) // 2 for n in sizes)
        self.left -= 1
        if self.left < 0 or not blocks or unknowns > MOST_UNKNOWNS or max(sizes) > MOST_ENTRIES:
            return
        system = _System(blocks, self.goal)
        answer = system.solved()
        if answer is None or answer[0] < INFEASIBLE or not system.reduce():
            return
        margin, matrices, duals = answer
        for denominator in DENOMINATORS:
            factors = [
                _factored(matrix, block.vector)
                for matrix, block in zip(system.exact(matrices, denominator), blocks, strict=True)
            ]
            if None not in factors:
                yield self._proof(blocks, [one for one in factors if one is not None])
        if margin > NO_MARGIN or not faces:
            return
        tried = [[block.vector for block in blocks]]
        negated = [-matrix for matrix in matrices]
        choices = [*((duals, bound) for bound in DUAL), *((negated, -bound) for bound in SMALL)]
        for (of, bound), denominator in product(choices, KERNEL_DENOMINATORS):
            kernels = [_eigenvectors(one, bound) for one in of]
            pairs = zip(blocks, kernels, strict=True)
            vectors = [_without(block.vector, one, denominator) for block, one in pairs]
            if vectors not in tried:
                tried.append(vectors)
                smaller = [replace(b, vector=left) for b, left in zip(blocks, vectors, strict=True) if left]
                yield from self.proofs(smaller, faces - 1)

    def _proof(self, blocks: list[Block], factors: list[Factors]) -> SumOfSquares:
        """The certificate, in the variables of the statement."""
        lift, products = Squares((), (), ()), []
        for block, (monomials, lower, diagonal) in zip(blocks, factors, strict=True):
            weight = (1 if block.hypothesis == LIFT else self.size) / self._power(block.over)
            own = [self._power(one) for one in monomials]
            rows = [
                tuple(_fraction(lower[i][k] * own[k] / own[i]) for k in range(i))
                for i in range(len(monomials))
            ]
            weights = [_fraction(d * weight / s**2) for d, s in zip(diagonal, own, strict=True)]
            squares = Squares(tuple(map(_sparse, monomials)), tuple(rows), tuple(weights))
            if block.hypothesis == LIFT:
                lift = squares
            elif any(weights):
                products.append(Product(block.hypothesis, _sparse(block.over), squares))
        return SumOfSquares(lift, tuple(products))

    def _power(self, exponents: Exponents) -> fmpq:
        """By what a monomial grows from x′ to x."""
        return fmpq(2) ** sum(int(e) * k for e, k in zip(exponents, self.scales, strict=False))


def _scales(gaps: list[fmpq_mpoly], count: int) -> list[int]:
    """Powers of 2 for the variables that bring the coefficients of each gap near to each other."""
    terms = [(k, e, c) for k, gap in enumerate(gaps) for e, c in gap.to_dict().items()]
    if not terms:
        return [0] * count
    rows = [[*map(float, e[:count]), *(float(k == own) for own in range(len(gaps)))] for k, e, _ in terms]
    sizes = [log2(abs(int(c.p))) - log2(int(c.q)) for _, _, c in terms]
    found = np.linalg.lstsq(np.array(rows), -np.array(sizes), rcond=None)[0]
    return [max(-20, min(20, round(float(scale)))) for scale in found[:count]]


def _needed(blocks: list[Block], goal: fmpq_mpoly) -> list[Block]:
    """Without the entries of vectors that must be 0, as only squares of one sign have their monomial."""
    while True:
        mixed = set(goal.to_dict())
        squares: dict[Any, list[tuple[int, int, bool]]] = {}
        for b, block in enumerate(blocks):
            for i, left in enumerate(block.vector):
                for e, c in (block.factor * left * left).to_dict().items():
                    squares.setdefault(e, []).append((b, i, c > 0))
                for right in block.vector[i + 1 :]:
                    mixed |= set((block.factor * left * right).to_dict())
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
class _System:
    """The identity as linear equations for the upper triangles of the matrices."""

    blocks: list[Block]
    goal: fmpq_mpoly
    places: list[tuple[int, int, int]] = field(init=False)
    entries: list[tuple[int, int, fmpq]] = field(init=False)
    side: list[fmpq] = field(init=False)
    rows: list[list[tuple[int, fmpq]]] = field(default_factory=list)

    def __post_init__(self) -> None:
        sizes = enumerate(len(block.vector) for block in self.blocks)
        self.places = [(b, i, j) for b, n in sizes for i in range(n) for j in range(i, n)]
        columns = []
        for b, i, j in self.places:
            block = self.blocks[b]
            columns.append((block.factor * block.vector[i] * block.vector[j] * (1 + (i != j))).to_dict())
        goals = self.goal.to_dict()
        index = {e: r for r, e in enumerate(sorted({*goals, *(e for column in columns for e in column)}))}
        self.entries = [(index[e], c, v) for c, column in enumerate(columns) for e, v in column.items()]
        self.side = [goals.get(e, fmpq(0)) for e in index]

    def solved(self) -> tuple[float, list[Array], list[Array]] | None:
        """The margin, the matrices and those of the dual program, in floating point."""
        import cvxpy as cp

        sizes = [len(block.vector) for block in self.blocks]
        margin, matrices = cp.Variable(), [cp.Variable((n, n), symmetric=True) for n in sizes]
        parts = [np.zeros((len(self.side), n * n)) for n in sizes]
        for row, column, value in self.entries:
            b, i, j = self.places[column]
            parts[b][row, i * sizes[b] + j] = _float(value)
        left = sum(part @ cp.vec(G, order="C") for part, G in zip(parts, matrices, strict=True))
        definite = [G - margin * np.eye(n) >> 0 for G, n in zip(matrices, sizes, strict=True)]
        small = sum(cp.trace(G) for G in matrices) <= LARGEST_TRACE * sum(sizes)
        fits = left == np.array(list(map(_float, self.side)))
        answer = solved(margin, [fits, margin <= 1, small, *definite], [margin, *matrices])
        if answer.ended is Ended.FAILED:
            return None
        # almost solved is good enough: what is rounded is exact, and the checker judges it
        return float(answer.values[0]), list(answer.values[1:]), [one.dual_value for one in definite]

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
        result = [[[fmpq(0)] * len(block.vector) for _ in block.vector] for block in self.blocks]
        for (b, i, j), value in zip(self.places, values, strict=False):
            result[b][i][j] = result[b][j][i] = value
        return result


def _eigenvectors(matrix: Array, bound: float) -> Array:
    """Those of the eigenvalues above a bound, as rows."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.array(vectors[:, values > bound].T)


def _without(vector: Vector, kernel: Array, denominator: int) -> Vector:
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


def _factored(matrix: Matrix, vector: Vector) -> Factors | None:
    """Monomials with L and D of the matrix for them; None where it is not positive semidefinite."""
    if _ldl(matrix) is None:
        return None
    terms = [one.to_dict() for one in vector]
    monomials = sorted({e for one in terms for e in one})
    basis = fmpq_mat([[one.get(e, fmpq(0)) for e in monomials] for one in terms])
    factors = _ldl((basis.transpose() * fmpq_mat(matrix) * basis).tolist())
    return None if factors is None else (monomials, *factors)


def _ldl(matrix: Matrix) -> tuple[Matrix, list[fmpq]] | None:
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


def _float(value: fmpq) -> float:
    return int(value.p) / int(value.q)


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def _sparse(exponents: Exponents) -> Monomial:
    return tuple((i, int(e)) for i, e in enumerate(exponents) if e)


# --- Points at which a polynomial fact may fail: where descents end, rounded.

STARTS, SEED = 16, 1
LENGTHS = (0.3, 1.0, 3.0)
MARGINS = (0.0, 1e-3)
"""By how much hypotheses are to hold, as rounding moves a point."""
ROUND = (1, 2, 3, 4, 6, 12, 60, 1000, 10**6)


def lowest_points(statement: Implies, signs: Signs) -> Iterator[dict[str, Fraction]]:
    """Points near local minima of the conclusion's gap, in the region where the hypotheses hold.

    Args:
        statement: the implication.
        signs: its polynomials, which are plain.
    """
    names, random = signs.algebra.names, np.random.default_rng(SEED)
    goal, *given = (_Numeric(gap, len(names)) for gap in gaps_of(signs))
    free = [i not in signs.bounds for i in range(len(names))]
    lows = {v.name: v.low or Fraction(0) for v in statement.variables}
    for _ in range(STARTS):
        start = random.normal(size=len(names)) * random.choice(LENGTHS)
        for margin in MARGINS if given else MARGINS[:1]:
            place = _descended(goal, given, np.where(free, start, abs(start)), free, margin)
            for most in ROUND if np.isfinite(place).all() else ():
                moved = zip(names, (Fraction(float(x)).limit_denominator(most) for x in place), strict=True)
                yield {name: low + 1 for name, low in lows.items()} | {
                    name: lows[name] + x for name, x in moved
                }


@dataclass
class _Numeric:
    """A polynomial and its slope in floating point, its largest coefficient 1."""

    polynomial: fmpq_mpoly
    count: int

    def __post_init__(self) -> None:
        terms = self.polynomial.to_dict() or {(0,) * self.count: fmpq(0)}
        self.powers = np.array([e[: self.count] for e in terms], dtype=int)
        numbers = np.array(list(map(_float, terms.values())))
        self.numbers = numbers / (np.abs(numbers).max() or 1.0)

    def value(self, x: Array) -> float:
        return float(self.numbers @ np.prod(x**self.powers, axis=1))

    def slope(self, x: Array) -> Array:
        result = []
        for i in range(self.count):
            lowered = self.powers - np.eye(self.count, dtype=int)[i]
            result.append(self.numbers * self.powers[:, i] @ np.prod(x ** np.maximum(lowered, 0), axis=1))
        return np.array(result)


def _descended(goal: _Numeric, given: list[_Numeric], start: Array, free: list[bool], margin: float) -> Array:
    from scipy.optimize import minimize

    constraints = [
        {"type": "ineq", "fun": lambda x, one=one: one.value(x) - margin, "jac": one.slope} for one in given
    ]
    bounds = [(None if any_sign else 0.0, None) for any_sign in free]
    settings = {"maxiter": 60, "ftol": 1e-14}
    with np.errstate(all="ignore"):
        found = minimize(
            goal.value, start, jac=goal.slope, bounds=bounds, constraints=constraints, options=settings
        )
    return np.asarray(found.x)
