"""Proposing what bounds k_c = sup ‖C(q, x)x‖ along a chain: semidefinite programs in doubles.

Unknown are κ, the polynomials s_{K+1}, …, s_n as sums of those that turns leave alone, and how each
coefficient is shared out among the pairs of monomials with that product. What the first joints ask is put
for some postures, each with relations of its own, then for the worst ones of what was found (`Postures`). No
program is solved to the end: solutions that keep away from all limits leave fewer postures to find. The last
one is rounded, and what this changes of the exact polynomials is put back into the matrices; the checker
decides.

References: `lyapcheck.check.loop.motion`; rounding of sums of squares, ``peyrl2008computing``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from flint import arb_mat, fmpq, fmpq_mat, fmpq_mpoly

from lyapcheck import store
from lyapcheck._types import Array, Progress, silent
from lyapcheck.check.kinds.chain_coriolis import MOST_ALONE, MotionForms
from lyapcheck.check.loop import motion
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.control_points import nodes
from lyapcheck.check.loop.head import DEGREE, DEGREE_ALONE, PARTS, Head
from lyapcheck.check.loop.motion import (
    COUNT,
    GENS,
    JOINT,
    LINEAR,
    POLYNOMIALS,
    RATE,
    RING,
    SPEED,
    STATE,
    Gram,
    products,
)
from lyapcheck.check.loop.storage import Hinge, hinges
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.constants.extreme import extreme
from lyapcheck.constants.storage.postures import Postures, exact_rows
from lyapcheck.constants.storage.program import Blocks, solve
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.number import Number
from lyapcheck.robots.plant import Plant

_TOLERANCE = 3e-4
_BITS = 40
"""To which matrices are rounded, relative to their largest entries."""
_STATES = [*STATE[:12], *products(STATE[12:18]), COUNT]
"""What s_k is a quadratic form of."""
_COUNTED = list(combinations_with_replacement(range(len(LINEAR)), 2))
FIRST = {2: 2, 3: 3, 4: 4, 5: 4, 6: 3, 7: 4}
"""Of the number of joints, those that are taken together; with more joints two."""
_ROUNDS, _NEAR = 12, 2e-3
"""Of postures, at most, and what they may still ask for, as a share of κ."""
_RAISES, _OF_THREE = (0.0015, 0.003, 0.006, 0.01, 0.02, 0.04, 0.1), 0.006
"""Shares of κ by which it is raised beyond what it lacks, so that control points suffice; of three angles
the least of them, as smaller ones take many more points."""
_TOGETHER = (Fraction(1, 100), Fraction(2, 100), Fraction(5, 100))
"""Shares above what is reached that are tried where all joints are taken together."""
Pair = tuple[int, int]


def coriolis_forms(
    chain: Chain, margin: float, rounded: Callable[[Fraction], Fraction]
) -> MotionForms | None:
    """What is to show an upper bound of k_c; ``None`` for one joint, or where the solver fails.

    Args:
        chain: the arm.
        rounded: a number that is not below.
        margin: the least eigenvalues that are sought, relative to the largest entry of an inertia.
    """
    if len(chain.links) < 2:
        return None
    together = _all_together(chain, rounded) if of_five_parallel_axes(chain.links) else None
    if together is not None:
        return together
    program = program_of(chain.links, margin)
    x = program.kept_solution()
    if x is None:
        return None
    form = program.handed_on(x)
    relations = program.postures.fitted(x[0], form, program.asked)
    least = x[0] + program.postures.lack(x[0], form, relations)
    for share in _RAISES:
        if share < _OF_THREE and program.first == 4:
            continue
        kappa = rounded(Fraction(float(least + share * x[0])))
        proof = program.proof(x, kappa, relations)
        if proof is not None:
            return proof
    return None


def of_five_parallel_axes(links: Sequence[RigidLink]) -> bool:
    """Whether all joints may be taken together, as M(q) is then of degree one in each angle."""
    return len(links) == MOST_ALONE and all(abs(hinge.turn[2][2]) == 1 for hinge in hinges(links)[1:])


def _all_together(chain: Chain, rounded: Callable[[Fraction], Fraction]) -> MotionForms | None:
    """Nothing is handed on, and no program is solved: see `lyapcheck.constants.products`."""
    n, links = chain.n, hinges(chain.links)
    head = Head(links, n, Fraction(0), arb_mat(PARTS, PARTS))
    values = [head.posture(angles) for angles in nodes(DEGREE_ALONE, n - 1)]
    postures, count = Postures(values, DEGREE_ALONE, n - 1), np.zeros((PARTS, PARTS))
    count[-1, -1] = 1.0
    joints = tuple(f"joint {i + 1}" for i in range(n))
    plant = Plant(name="chain", joints=joints, dynamics=chain, viscous=(Number(Fraction(0)),) * n)
    least = extreme(plant, "k_c").value
    for share in _TOGETHER if least > 0 else ():
        kappa = rounded(least * (1 + share))
        shown = postures.shown(float(kappa), -float(kappa) * count)
        if shown is not None:
            return MotionForms(kappa, (), exact_rows(shown[0]), *shown[1:])
    return None


@lru_cache(maxsize=2)
def program_of(links: tuple[RigidLink, ...], margin: float) -> _Program:
    """The program of a chain, with its solution once there is one: that takes seconds, and several ask."""
    return _Program(links, margin)


def _postures(links: Sequence[Hinge], first: int) -> Postures:
    head = Head(links, first, Fraction(0), arb_mat(PARTS, PARTS))
    return Postures([head.posture(angles) for angles in nodes(DEGREE, first - 1)], DEGREE, first - 1)


class _Squares:
    """Polynomials as mᵀPm of some monomials m."""

    def __init__(self, terms: Sequence[fmpq_mpoly]) -> None:
        self.terms, self.size = terms, len(terms)
        self._pair: dict[tuple[int, ...], Pair] = {}
        others: list[tuple[Pair, fmpq_mpoly]] = []
        for pair in combinations_with_replacement(range(self.size), 2):
            product = terms[pair[0]] * terms[pair[1]]
            powers = list(product.to_dict())
            if len(powers) == 1 and powers[0] not in self._pair:
                self._pair[powers[0]] = pair
            else:
                others.append((pair, product))
        self.relations = [_unit(pair, self.size) - self.matrix(product) for pair, product in others]
        """A basis of the P with mᵀPm = 0."""

    def _entries(self, polynomial: fmpq_mpoly) -> dict[Pair, fmpq]:
        return {self._pair[powers]: c for powers, c in polynomial.to_dict().items()}

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
            for powers, c in polynomial.to_dict().items():
                row[place[powers]] = _double(c)
        return result

    def exact(self, near: Array, polynomial: fmpq_mpoly) -> Gram:
        """A P near a matrix for which mᵀPm is the polynomial."""
        rows = [list(row) for row in _rounded(near)]
        for (i, j), c in self._entries(polynomial - motion.gram(rows, self.terms)).items():
            rows[j][i] += Fraction(int(c.p), int(c.q)) / (1 if i == j else 2)
        return tuple(map(tuple, rows))


class _Program:
    """The program of one chain; its unknowns are κ and of each joint behind the first ones the coefficients
    of s_k, the shares and Q; behind them stand the relations of each posture.

    Args:
        chain: the links, two or more, base first.
        margin: see `coriolis_forms`.
    """

    def __init__(self, chain: tuple[RigidLink, ...], margin: float) -> None:
        links = hinges(chain)
        self.question = {"motion": store.exact(chain, margin)}
        self.links, self.n = links, len(links)
        self.first = FIRST.get(self.n, 2)
        self.joint, self.own = _Squares(JOINT), _invariant()
        states = _Squares(_STATES)
        self.forms = [states.matrix(form) for form in self.own]
        self.each = len(self.own) + len(self.joint.relations) + len(_COUNTED)
        self.unknowns = 1 + (self.n - self.first) * self.each
        self.postures = _postures(links[: self.first + 1], self.first)
        self.parts, self.places = np.array(self.forms), self._first(self.first) + np.arange(len(self.own))
        """Of what F is a sum, and the unknowns that go with it; behind the last joint it is −κN²."""
        if self.first == self.n:
            self.parts, self.places = -states.matrix(COUNT**2)[None], np.array([0])
        self.least = margin * max(float(abs(x)) for link in links for row in link.body for x in row)
        self.moved = motion.moved(POLYNOMIALS, STATE, RATE, SPEED)
        self.blocks = Blocks()
        for k in range(self.first, self.n):
            self._add_joint(k)
        self.behind = len(self.blocks.sizes)
        self.asked: list[Array] = []
        """The postures of the program."""
        self.found: Array | None = None

    def kept_solution(self, on_progress: Progress = silent) -> Array | None:
        """What `solution` finds, from the store if it is there."""
        if self.found is None:
            kept = store.take(self.question)
            if isinstance(kept, list) and [len(part) for part in kept[:1]] == [self.unknowns]:
                self.found, *self.asked = (np.array(part, dtype=np.float64) for part in kept)
            else:
                self.found = self.solution(on_progress)
                if self.found is not None:
                    store.put(self.question, [part.tolist() for part in (self.found, *self.asked)])
        return self.found

    def solution(self, on_progress: Progress) -> Array | None:
        """The unknowns, with a κ that suffices for the first joints at all postures that were seen."""
        best: tuple[float, Array] | None = None
        for q in self.postures.some():
            self._add_posture(q)
        for done in range(_ROUNDS):
            on_progress(1 - 0.7**done, f"{len(self.asked)} postures")
            unknowns = self.unknowns + len(self.asked) * len(self.postures.relations)
            x = solve(self.blocks, unknowns, _TOLERANCE)
            if x is None or not x[0] > 0:
                break
            x = x[: self.unknowns]
            worst = self.postures.worst(x[0], self.handed_on(x), self.asked)
            missing = max((lack for lack, _ in worst), default=0.0)
            if best is None or x[0] + missing < best[0]:
                best = x[0] + missing, self._raised(x, missing)
            if missing <= _NEAR * x[0]:
                break
            for _, q in worst:
                self._add_posture(q)
        return None if best is None else best[1]

    def proof(self, x: Array, kappa: Fraction, relations: Array) -> MotionForms | None:
        """The matrices of a solution, for a larger κ; ``None`` where control points do not suffice."""
        more = float(kappa) - x[0]
        x = self._raised(x, more)
        relations = self.postures.short(x[0], relations + more * self.postures.fourth)
        points = self.postures.refined(self.postures.at_nodes(x[0], self.handed_on(x), relations))
        if points is None:
            return None
        near = [self.blocks.at(x, b) + self.least * np.eye(self.blocks.sizes[b]) for b in range(self.behind)]
        price, joints = rational(kappa), []
        after = -price * COUNT**2
        for k in range(self.n - 1, self.first - 1, -1):
            squares, counted = near[2 * (k - self.first) : 2 * (k - self.first) + 2]
            q = _rounded(counted)
            own = RING.constant(0)
            for c, form in zip(x[self._first(k) :], self.own, strict=False):
                own += rational(Fraction(float(c))) * form
            left = (
                own + price * RATE**2 - self._charged(k, self.moved, after) - COUNT * motion.gram(q, LINEAR)
            )
            joints.append((self.joint.exact(squares, left), q))
            after = own
        rows = exact_rows(relations)
        return MotionForms(kappa, tuple(reversed(joints)), rows, *points)

    def _raised(self, x: Array, more: float) -> Array:
        """A larger κ, s_k less so much N², and Q for 2 N x² that a joint then has over."""
        x, square = x.copy(), self.own.index(COUNT**2)
        x[0] += more
        for k in range(self.first, self.n):
            x[self._first(k) + square] -= more
            x[self._first(k) + self.each - 1] += 2 * more
        return x

    def handed_on(self, x: Array) -> Array:
        """F of what the first joints ask."""
        return np.asarray(np.tensordot(x[self.places], self.parts, 1))

    def _charged(self, k: int, state: Sequence[fmpq_mpoly], after: fmpq_mpoly) -> fmpq_mpoly:
        onwards = motion.onwards(self.links[k + 1 :], state, after)
        return motion.cost(POLYNOMIALS, self.links[k], state) + onwards

    def _first(self, k: int) -> int:
        """The place of the unknowns of joint k, counted from 0."""
        return 1 + (k - self.first) * self.each

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

    def _add_posture(self, q: Array) -> None:
        """What the first joints ask at one posture; its relations are further unknowns."""
        first = self.unknowns + len(self.asked) * len(self.postures.relations)
        self.asked.append(q)
        constant, price, forms = self.postures.parts(q, self.parts)
        slopes = dict(zip(self.places.tolist(), forms, strict=True))
        slopes[0] = slopes.get(0, 0) + price
        slopes |= {first + i: relation for i, relation in enumerate(self.postures.relations)}
        self.blocks.add(constant - self.least * np.eye(len(constant)), slopes)

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


def _double(c: fmpq) -> float:
    return int(c.p) / int(c.q)
