"""Sums of squares for implications between polynomials, by convex programs in floating point.

Unknown are the Gram matrices G of the squares vᵀGv in  (1 + σ)·C = Σ μ_k σ_k H_k.  The identity is linear in
them. A program looks for matrices that are positive definite by the largest margin. They are rounded, and the
identity is solved exactly for the rest. Where no margin is left, the matrices are singular at every solution:
their kernels are rounded too, and the search goes on in what is left of v. A hypothesis that is an equation
has any polynomial as its factor; equations alone are tried first, by linear algebra.

References: ``parrilo2003semidefinite``, ``peyrl2008computing``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, combinations_with_replacement, product
from math import log2

import numpy as np
from flint import fmpq, fmpq_mpoly

from lyapcheck.check.kinds.implies import (
    Exponents,
    Implies,
    Monomial,
    Product,
    Signs,
    Squares,
    SumOfSquares,
    gaps_of,
    letters_of,
    signs_of,
)
from lyapcheck.check.numbers.polynomials import fraction
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.gram import (
    Block,
    Matrix,
    System,
    Vector,
    eigenvectors,
    factored,
    ldl,
    needed,
    without,
)

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
MOST_FACTORS, EXTRA = 400, 4
"""Unknown coefficients in factors of equations alone, and the degrees up to which these are tried."""
LIFT = -1
"""Stands for the conclusion in place of a hypothesis."""


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


def by_equations(statement: Implies) -> SumOfSquares | None:
    """A proof of a polynomial fact by equations alone, or None.

    p² <= 0 follows from p = Σ factors · equations, times p.
    """
    end, root = statement.conclusion, statement
    squared = end.left[0] == "pow" and end.left[2] == 2 and end.right == ("num", "0")
    if squared:
        root = replace(statement, conclusion=Relation(end.left[1], end.operator, end.right))
    search = _Search(signs_of(root), end.strict)
    for extra in range(EXTRA) if search.equations and not end.strict else ():
        factors = search.factors_of_equations(search.goal.total_degree() + extra)
        if factors is not None:
            times = -gaps_of(search.signs)[0] if squared else search.ring.constant(1)
            products = [one for k, factor in factors for one in search.products(k, factor * times)]
            return SumOfSquares(Squares((), (), ()), tuple(products))
    return None


class _Search:
    """In variables x′, x = 2^scale · x′, in which the coefficients are of about one size, and in 1 − cos."""

    def __init__(self, signs: Signs, strict: bool) -> None:
        self.signs, self.strict, self.ring = signs, strict, signs.ring
        self.count = len(signs.algebra.names)
        self.one: Exponents = (0,) * self.ring.nvars()
        self.left = PROGRAMS
        gaps = gaps_of(signs)
        self.scales = _scales(gaps, self.count)
        powers = [fmpq(2) ** scale for scale in self.scales] + [fmpq(1)] * (len(self.one) - self.count)
        generators = [x * power for x, power in zip(self.ring.gens(), powers, strict=True)]
        self.letters = sorted(letters_of(signs))
        circular = {i: one for i, one in signs.algebra.squares.items() if i in self.letters}
        self.turned = [1 - x if i in circular else x for i, x in enumerate(self.ring.gens())]
        for i in circular:
            generators[i] = self.turned[i]
        # with cos = 1 − d, cos² = 1 − sin² becomes d² = 2d − sin²
        squares = {i: one - 1 + 2 * self.ring.gen(i) for i, one in circular.items()}
        self.algebra = replace(signs.algebra, squares=squares)
        goal, *self.hypotheses = (
            self.algebra.reduced(gap.compose(*generators, ctx=self.ring)) for gap in gaps
        )
        self.equations = {k for k, gap in enumerate(self.hypotheses) if -gap in self.hypotheses}
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
                if k not in self.equations and (degree == 0 or gap.total_degree() <= room):
                    result.append(self._block(k, over, max(0, room - gap.total_degree()) // 2))
        result += [self._equation(k, max(degree, 2 * half)) for k in sorted(self.equations)]
        if self.strict:
            # what makes the conclusion strict must be definite by itself
            single = tuple(self.ring.gens()[: self.count])
            one = self.ring.constant(1)
            result += [self._block(None, self.one, 0), Block(None, self.one, one, single, self.algebra)]
        return result

    def _equation(self, k: int, degree: int) -> Block:
        """A hypothesis times any polynomial, up to a degree of both; of two opposite ones the first does."""
        gap = self.hypotheses[k]
        twice = self.hypotheses.index(-gap) < k
        vector = () if twice else self._monomials(max(0, degree - gap.total_degree()))
        return Block(k, self.one, gap, vector, self.algebra, True)

    def _block(self, hypothesis: int | None, over: Exponents, half: int) -> Block:
        gap = self.ring.constant(1)
        if hypothesis is not None:
            gap = -self.goal if hypothesis == LIFT else self.hypotheses[hypothesis]
        return Block(hypothesis, over, gap * self._monomial(over), self._monomials(half), self.algebra)

    def _monomials(self, degree: int) -> Vector:
        """All up to a degree, without squares of 1 − cos."""
        chosen = (
            some for size in range(degree + 1) for some in combinations_with_replacement(self.letters, size)
        )
        all_of = (tuple(some.count(i) for i in range(len(self.one))) for some in chosen)
        return tuple(self._monomial(e) for e in all_of if all(e[i] < 2 for i in self.algebra.squares))

    def _monomial(self, exponents: Exponents) -> fmpq_mpoly:
        return self.ring.from_dict({exponents: fmpq(1)})

    def proofs(self, blocks: list[Block], faces: int) -> Iterator[SumOfSquares]:
        """Proofs by matrices that are positive semidefinite and fit exactly."""
        blocks = needed(blocks, self.goal)
        sizes = [0 if block.equation else len(block.vector) for block in blocks]
        unknowns = sum(len(list(block.places)) for block in blocks)
        self.left -= 1
        if self.left < 0 or not any(sizes) or unknowns > MOST_UNKNOWNS or max(sizes) > MOST_ENTRIES:
            return
        system = System(blocks, self.goal)
        answer = system.solved()
        if answer is None or answer[0] < INFEASIBLE or not system.reduce():
            return
        margin, matrices, duals = answer
        for denominator in DENOMINATORS:
            exact = system.exact(matrices, denominator)
            both = zip(exact, blocks, strict=True)
            if all(block.equation or ldl(matrix) is not None for matrix, block in both):
                yield self._proof(blocks, exact)
        if margin > NO_MARGIN or not faces:
            return
        tried = [[block.vector for block in blocks]]
        negated = [-matrix for matrix in matrices]
        choices = [*((duals, bound) for bound in DUAL), *((negated, -bound) for bound in SMALL)]
        for (of, bound), denominator in product(choices, KERNEL_DENOMINATORS):
            kernels = [eigenvectors(one, bound) for one in of]
            pairs = zip(blocks, kernels, strict=True)
            vectors = [
                block.vector if block.equation else without(block.vector, one, denominator)
                for block, one in pairs
            ]
            if vectors not in tried:
                tried.append(vectors)
                smaller = [replace(b, vector=left) for b, left in zip(blocks, vectors, strict=True) if left]
                yield from self.proofs(smaller, faces - 1)

    def _proof(self, blocks: list[Block], matrices: list[Matrix]) -> SumOfSquares:
        """The certificate, in the variables of the statement, from matrices that are semidefinite."""
        lift, products = Squares((), (), ()), []
        for block, matrix in zip(blocks, matrices, strict=True):
            vector = [one.compose(*self.turned, ctx=self.ring) for one in block.vector]
            if block.equation:
                products += self.products(block.hypothesis, self._factor(block, matrix))
                continue
            monomials, lower, diagonal = factored(matrix, vector)
            weight = (1 if block.hypothesis == LIFT else self.size) / self._power(block.over)
            own = [self._power(one) for one in monomials]
            rows = [
                tuple(fraction(lower[i][k] * own[k] / own[i]) for k in range(i))
                for i in range(len(monomials))
            ]
            weights = [fraction(d * weight / s**2) for d, s in zip(diagonal, own, strict=True)]
            squares = Squares(tuple(map(_sparse, monomials)), tuple(rows), tuple(weights))
            if block.hypothesis == LIFT:
                lift = squares
            elif any(weights):
                products.append(Product(block.hypothesis, _sparse(block.over), squares))
        return SumOfSquares(lift, tuple(products))

    def factors_of_equations(self, degree: int) -> list[tuple[int, fmpq_mpoly]] | None:
        """Polynomials, up to a degree of all products, with which equations add up to the conclusion."""
        blocks = [self._equation(k, degree) for k in sorted(self.equations)]
        blocks = [block for block in blocks if block.vector]
        if sum(len(block.vector) for block in blocks) > MOST_FACTORS:
            return None
        system = System(blocks, self.goal)
        if not system.reduce():
            return None
        rows = system.exact([np.zeros((1, len(block.vector))) for block in blocks], 1)
        pairs = zip(blocks, rows, strict=True)
        return [(block.hypothesis or 0, self._factor(block, matrix)) for block, matrix in pairs]

    def _factor(self, block: Block, matrix: Matrix) -> fmpq_mpoly:
        """What an equation is multiplied by, in the variables of the statement."""
        terms = (x * g for x, g in zip(block.vector, matrix[0], strict=True))
        factor = sum(terms, self.ring.constant(0)).compose(*self.turned, ctx=self.ring)
        return self.ring.from_dict({e: c * self.size / self._power(e) for e, c in factor.to_dict().items()})

    def products(self, hypothesis: int | None, factor: fmpq_mpoly) -> list[Product]:
        """An equation times a polynomial, term by term."""
        terms = self.signs.algebra.reduced(factor).to_dict().items()
        return [Product(hypothesis, _sparse(e), Squares(((),), ((),), (fraction(c),))) for e, c in terms]

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


def _sparse(exponents: Exponents) -> Monomial:
    return tuple((i, int(e)) for i, e in enumerate(exponents) if e)
