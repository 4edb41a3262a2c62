"""Proposing what bounds k_c = sup ‖C(q, x)x‖ along a chain: one semidefinite program in doubles.

Unknown are κ, the polynomials s_3, …, s_n as sums of those that turns leave alone, and how each coefficient
is shared out among the pairs of monomials with that product. The solution is rounded, and what this changes
of the exact polynomials is put back into the matrices; the checker decides.

References: `lyapcheck.check.loop.motion`; rounding of sums of squares, ``peyrl2008computing``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from flint import fmpq, fmpq_mat, fmpq_mpoly

from lyapcheck import store
from lyapcheck._types import Array
from lyapcheck.check.kinds.chain_coriolis import MotionForms
from lyapcheck.check.loop import motion
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.motion import (
    COSINE,
    COUNT,
    FIRST_RATE,
    FIRST_SPEED,
    GENS,
    HEAD,
    JOINT,
    LINEAR,
    POLYNOMIALS,
    RATE,
    RING,
    SINE,
    SPEED,
    STATE,
    Gram,
    products,
)
from lyapcheck.check.loop.storage import Hinge, hinges
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import ZERO
from lyapcheck.constants.storage.program import Blocks, solve
from lyapcheck.robots.dynamics import Chain

_TOLERANCE = 1e-6
_RAISED = Fraction(1, 10**5)
_BITS = 40
"""To which the matrices are rounded, relative to their largest entries."""
_CIRCLE = SINE**2 + COSINE**2 - 1
_STATES = [*STATE[:12], *products(STATE[12:18]), COUNT]
"""What s_k is a quadratic form of."""
_COUNTED = list(combinations_with_replacement(range(len(LINEAR)), 2))
Pair = tuple[int, int]


def coriolis_forms(
    chain: Chain, margin: float, rounded: Callable[[Fraction], Fraction]
) -> tuple[Fraction, MotionForms] | None:
    """An upper bound of k_c and what is to show it; ``None`` for one joint, or where the solver fails.

    Args:
        chain: the arm.
        rounded: a number that is not below.
        margin: the least eigenvalues that are sought, relative to the largest entry of an inertia.
    """
    solved = None if len(chain.links) < 2 else _solved(chain.links, margin)
    if solved is None:
        return None
    program, x = solved
    kappa = rounded(Fraction(float(x[0])) * (1 + _RAISED))
    return kappa, program.proof(x, kappa)


@lru_cache(maxsize=2)
def _solved(links: tuple[RigidLink, ...], margin: float) -> tuple[_Program, Array] | None:
    """The program and its solution, from the store if it is there: it takes seconds, and several ask."""
    program, asked = _Program(hinges(links), margin), {"motion": store.exact(links, margin)}
    kept = store.take(asked)
    if isinstance(kept, list) and len(kept) == program.unknowns:
        return program, np.array(kept, dtype=np.float64)
    x = solve(program.blocks, program.unknowns, _TOLERANCE)
    if x is None or not x[0] > 0:
        return None
    store.put(asked, x.tolist())
    return program, x


class _Squares:
    """Polynomials as mᵀPm of some monomials m, where s² + c² = 1."""

    def __init__(self, terms: Sequence[fmpq_mpoly]) -> None:
        self.terms, self.size = terms, len(terms)
        self._pair: dict[tuple[int, ...], Pair] = {}
        others: list[tuple[Pair, fmpq_mpoly]] = []
        for pair in combinations_with_replacement(range(self.size), 2):
            product = _reduced(terms[pair[0]] * terms[pair[1]])
            powers = list(product.to_dict())
            if len(powers) == 1 and powers[0] not in self._pair:
                self._pair[powers[0]] = pair
            else:
                others.append((pair, product))
        self.relations = [_unit(pair, self.size) - self.matrix(product) for pair, product in others]
        """A basis of the P with mᵀPm = 0."""

    def _entries(self, polynomial: fmpq_mpoly) -> dict[Pair, fmpq]:
        return {self._pair[powers]: c for powers, c in _reduced(polynomial).to_dict().items()}

    def matrix(self, polynomial: fmpq_mpoly) -> Array:
        """A P of a polynomial, in doubles."""
        result = np.zeros((self.size, self.size))
        for pair, c in self._entries(polynomial).items():
            result += _double(c) * _unit(pair, self.size)
        return result

    def rows(self, polynomials: Sequence[fmpq_mpoly]) -> Array:
        """The coefficients of sums of the monomials, in doubles, (len(polynomials), size)."""
        place = {next(iter(term.to_dict())): i for i, term in enumerate(self.terms)}
        result = np.zeros((len(polynomials), self.size))
        for row, polynomial in zip(result, polynomials, strict=True):
            for powers, c in _reduced(polynomial).to_dict().items():
                row[place[powers]] = _double(c)
        return result

    def exact(self, near: Array, polynomial: fmpq_mpoly) -> Gram:
        """A P near a matrix for which mᵀPm is the polynomial."""
        rows = [list(row) for row in _rounded(near)]
        for (i, j), c in self._entries(polynomial - motion.gram(rows, self.terms)).items():
            rows[j][i] += Fraction(int(c.p), int(c.q)) / (1 if i == j else 2)
        return tuple(map(tuple, rows))


class _Program:
    """The program of one chain; its unknowns are κ, then of each joint from the third on the coefficients of
    s_k, the shares and Q, then the shares of the first two joints.

    Args:
        links: two or more, base first.
        margin: see `coriolis_forms`.
    """

    def __init__(self, links: Sequence[Hinge], margin: float) -> None:
        self.links, self.n = links, len(links)
        self.joint, self.head, self.own = _Squares(JOINT), _Squares(HEAD), _invariant()
        states = _Squares(_STATES)
        self.forms = [states.matrix(form) for form in self.own]
        self.each = len(self.own) + len(self.joint.relations) + len(_COUNTED)
        self.unknowns = 1 + (self.n - 2) * self.each + len(self.head.relations)
        self.least = margin * max(float(abs(x)) for link in links for row in link.body for x in row)
        of = POLYNOMIALS
        base = motion.moved(of, [ZERO] * len(STATE), FIRST_RATE, FIRST_SPEED)
        second = motion.turned(of, SINE, COSINE, motion.carried(of, links[1], base))
        self.second = motion.moved(of, second, RATE, SPEED)
        self.moved = motion.moved(of, STATE, RATE, SPEED)
        self.start = motion.cost(of, links[0], base)
        self.blocks = Blocks()
        for k in range(2, self.n):
            self._add_joint(k)
        self._add_head()

    def proof(self, x: Array, kappa: Fraction) -> MotionForms:
        """The matrices of a solution, for a κ that may be larger."""
        near = [self.blocks.at(x, b) + self.least * np.eye(size) for b, size in enumerate(self.blocks.sizes)]
        price, joints = rational(kappa), []
        after = -price * COUNT**2
        for k in range(self.n - 1, 1, -1):
            squares, counted = near[2 * (k - 2) : 2 * (k - 1)]
            q = _rounded(counted)
            own = RING.constant(0)
            for c, form in zip(x[self._first(k) :], self.own, strict=False):
                own += rational(Fraction(float(c))) * form
            left = (
                own + price * RATE**2 - self._charged(k, self.moved, after) - COUNT * motion.gram(q, LINEAR)
            )
            joints.append((self.joint.exact(squares, left), q))
            after = own
        left = price * (FIRST_RATE**2 + RATE**2) - self.start - self._charged(1, self.second, after)
        return MotionForms(tuple(reversed(joints)), self.head.exact(near[-1], left))

    def _charged(self, k: int, state: Sequence[fmpq_mpoly], after: fmpq_mpoly) -> fmpq_mpoly:
        onwards = motion.onwards(self.links[k + 1 :], state, after)
        return motion.cost(POLYNOMIALS, self.links[k], state) + onwards

    def _first(self, k: int) -> int:
        """The place of the unknowns of joint k, counted from 0."""
        return 1 + (k - 2) * self.each

    def _add_joint(self, k: int) -> None:
        first = self._first(k)
        constant, slopes = self._charges(self.joint, k, self.moved)
        slopes[0] = slopes.get(0, 0) + self.joint.matrix(RATE**2)
        here = self.joint.rows(_STATES)
        own = [here.T @ form @ here for form in self.forms]
        counted = [-self.joint.matrix(COUNT * LINEAR[i] * LINEAR[j]) for i, j in _COUNTED]
        slopes |= {first + i: form for i, form in enumerate([*own, *self.joint.relations, *counted])}
        self.blocks.add(constant - self.least * np.eye(len(JOINT)), slopes)
        place, size = first + self.each - len(_COUNTED), len(LINEAR)
        units = {place + i: _unit(pair, size) for i, pair in enumerate(_COUNTED)}
        self.blocks.add(-self.least * np.eye(size), units)

    def _add_head(self) -> None:
        constant, slopes = self._charges(self.head, 1, self.second)
        slopes[0] = slopes.get(0, 0) + self.head.matrix(FIRST_RATE**2 + RATE**2)
        slopes |= {self._first(self.n) + i: form for i, form in enumerate(self.head.relations)}
        self.blocks.add(constant - self.head.matrix(self.start) - self.least * np.eye(len(HEAD)), slopes)

    def _charges(
        self, squares: _Squares, k: int, state: Sequence[fmpq_mpoly]
    ) -> tuple[Array, dict[int, Array]]:
        """Less the cost of joint k, and less s_{k+1} by its unknowns."""
        constant = -squares.matrix(motion.cost(POLYNOMIALS, self.links[k], state))
        if k + 1 == self.n:
            return constant, {0: squares.matrix(state[18] ** 2)}
        reached = [*map(POLYNOMIALS.value, motion.carried(POLYNOMIALS, self.links[k + 1], state))]
        there = squares.rows([*reached[:12], *products(reached[12:18]), reached[18]])
        after = self._first(k + 1)
        return constant, {after + i: -(there.T @ form @ there) for i, form in enumerate(self.forms)}


@lru_cache(maxsize=1)
def _invariant() -> list[fmpq_mpoly]:
    """A basis of the quadratic forms of the state that turns about the third axis leave as they are.

    A pair (a, b) that turns as (cos mt, sin mt) is the complex number a + ib of rate m.
    """
    zero = RING.constant(0)
    vectors = [[(1, GENS[i], GENS[i + 1]), (0, GENS[i + 2], zero)] for i in range(0, 18, 3)]
    spins, parts = [*vectors[4], *vectors[5]], [part for vector in vectors[:4] for part in vector]
    for (m, a, b), (n, c, d) in combinations_with_replacement(spins, 2):
        parts.append((m + n, a * c - b * d, a * d + b * c))
        if m and n:
            parts += [(0, a * c + b * d, zero), (0, b * c - a * d, zero)]
    parts.append((0, COUNT, zero))
    pairs = [
        (a * c + b * d, b * c - a * d)
        for (m, a, b), (n, c, d) in combinations_with_replacement(parts, 2)
        if m == n
    ]
    forms = [form for pair in pairs for form in pair if form]
    rows = {powers: i for i, powers in enumerate(dict.fromkeys(p for form in forms for p in form.to_dict()))}
    table = fmpq_mat(len(rows), len(forms))
    for j, form in enumerate(forms):
        for powers, c in form.to_dict().items():
            table[rows[powers], j] = c
    echelon, rank = table.rref()
    return [forms[next(j for j in range(len(forms)) if echelon[i, j] != 0)] for i in range(rank)]


def _unit(pair: Pair, size: int) -> Array:
    """The P with mᵀPm = m_i m_j."""
    result = np.zeros((size, size))
    result[pair] += 0.5
    result[pair[::-1]] += 0.5
    return result


def _rounded(matrix: Array) -> Gram:
    """The entries on and below the diagonal with fewer digits."""
    step = 2.0 ** (np.ceil(np.log2(np.abs(matrix).max())) - _BITS)
    short = np.round(matrix / step) * step
    return tuple(tuple(Fraction(float(x)) for x in row[: i + 1]) for i, row in enumerate(short))


def _reduced(polynomial: fmpq_mpoly) -> fmpq_mpoly:
    return divmod(polynomial, _CIRCLE)[1]


def _double(c: fmpq) -> float:
    return int(c.p) / int(c.q)
