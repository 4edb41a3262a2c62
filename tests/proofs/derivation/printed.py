"""The sums (14) and (15) as printed, term by term, as data: sign, scalar factors, vector, matrix, vector.

Each term reads  sign · factors · leftᵀ matrix right,  and has one value in the ring of
``tests.proofs.derivation.generators``. The numbers are the places in the printed sum, the ones
that the paper's text means by "first", "sixth" and so on.

References: (14), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import fmpq_mpoly

from tests.proofs.derivation.generators import Generators, Matrix, Vector, dot, generators, times, total


@dataclass(frozen=True)
class Term:
    """One printed term: ``sign · factors · leftᵀ matrix right``.

    Args:
        number: its place in the printed sum, from 1.
        sign: 1 or −1.
        factors: scalar factors, see ``_factor``.
        left: see ``_vector``.
        matrix: see ``_matrix``.
        right: see ``_vector``.
    """

    number: int
    sign: int
    factors: tuple[str, ...]
    left: str
    matrix: str
    right: str

    def value(self, ring: Generators) -> fmpq_mpoly:
        """The term as a normal form."""
        product = dot(_vector(ring, self.left), times(_matrix(ring, self.matrix), _vector(ring, self.right)))
        for factor in self.factors:
            product = product * _factor(ring, factor)
        return ring.normal_form(product * self.sign)


PRINTED_14 = (
    Term(1, 1, (), "w", "Kp", "h"),
    Term(2, -1, (), "w", "Kv", "h(w)"),
    Term(3, -1, (), "w", "B", "w"),
    Term(4, -1, (), "w", "C", "w"),
    Term(5, 1, ("half",), "w", "dM", "w"),
    Term(6, -1, (), "w", "Kp", "h"),
    Term(7, 1, ("eps",), "h'w", "M", "w"),
    Term(8, -1, ("eps0 e.w/(r(1+r)^2)",), "h", "M", "w"),
    Term(9, -1, ("eps",), "h", "C+C^T", "w"),
    Term(10, -1, ("eps",), "h", "Kp", "h"),
    Term(11, 1, ("eps",), "h", "B", "w"),
    Term(12, 1, ("eps",), "h", "Kv", "h(w)"),
    Term(13, 1, ("eps",), "h", "C", "w"),
    Term(14, 1, ("half", "eps^2"), "h", "C+C^T", "h"),
    Term(15, 1, ("half", "eps^2", "2 e.w/(r(1+r))"), "h", "M", "h"),
    Term(16, -1, ("eps^2",), "h'w", "M", "h"),
)
"""The sixteen terms of (14)."""

PRINTED_15 = (
    Term(1, -1, (), "w", "Kv", "h(w)"),
    Term(2, -1, (), "w", "B", "w"),
    Term(3, 1, ("eps",), "h'w", "M", "w"),
    Term(4, -1, ("eps0 e.w/(r(1+r)^2)",), "h", "M", "w"),
    Term(5, -1, ("eps",), "h", "C^T", "w"),
    Term(6, -1, ("eps",), "h", "Kp", "h"),
    Term(7, 1, ("eps",), "h", "B", "w"),
    Term(8, 1, ("eps",), "h", "Kv", "h(w)"),
    Term(9, 1, ("half", "eps^2"), "h", "C+C^T", "h"),
    Term(10, 1, ("eps^2", "e.w/(r(1+r))"), "h", "M", "h"),
    Term(11, -1, ("eps^2",), "h'w", "M", "h"),
)
"""The eleven terms of (15)."""

STEPS: tuple[tuple[tuple[int, ...], int | None], ...] = (
    ((1, 6), None),
    ((4, 5), None),
    ((9, 13), 5),
    ((2,), 1),
    ((3,), 2),
    ((7,), 3),
    ((8,), 4),
    ((10,), 6),
    ((11,), 7),
    ((12,), 8),
    ((14,), 9),
    ((15,), 10),
    ((16,), 11),
)
"""Which terms of (14) sum to which term of (15); ``None`` where they sum to zero.

The text says that 9 and 13 cancel; they leave −ε hᵀCᵀw, which (15) prints as its fifth term.
"""


def printed_14(n: int) -> fmpq_mpoly:
    """The sum (14) for n joints, as a normal form."""
    return sum_of(PRINTED_14, n)


def printed_15(n: int) -> fmpq_mpoly:
    """The sum (15) for n joints, as a normal form."""
    return sum_of(PRINTED_15, n)


def sum_of(terms: tuple[Term, ...], n: int) -> fmpq_mpoly:
    """The sum of some terms for n joints, as a normal form."""
    ring = generators(n)
    return total((term.value(ring) for term in terms), ring.ring.constant(0))


def step_holds(step: tuple[tuple[int, ...], int | None], n: int) -> bool:
    """Decide one step from (14) to (15): the named terms sum to the one that is left, or to zero."""
    numbers, left = step
    gathered = tuple(term for term in PRINTED_14 if term.number in numbers)
    remains = tuple(term for term in PRINTED_15 if term.number == left)
    return bool(sum_of(gathered, n) == sum_of(remains, n))


def _factor(ring: Generators, name: str) -> fmpq_mpoly:
    inward = dot(ring.vector("e"), ring.vector("w")) * ring["ri"]
    values = {
        "half": ring.half,
        "eps": ring.eps,
        "eps^2": ring.eps**2,
        "eps0 e.w/(r(1+r)^2)": ring.eps * ring["s"] * inward,
        "2 e.w/(r(1+r))": ring["s"] * inward * 2,
        "e.w/(r(1+r))": ring["s"] * inward,
    }
    return values[name]


def _vector(ring: Generators, name: str) -> Vector:
    if name == "h'w":
        return [d * w for d, w in zip(ring.vector("d"), ring.vector("w"), strict=True)]
    return ring.vector({"w": "w", "h": "h", "h(w)": "g"}[name])


def _matrix(ring: Generators, name: str) -> Matrix:
    if name in ("Kp", "Kv", "B"):
        return ring.diagonal({"Kp": "kp", "Kv": "kv", "B": "b"}[name])
    joints, C = range(ring.n), ring.C
    if name == "M":
        return ring.M
    if name == "C":
        return C
    if name == "C^T":
        return [[C[j][i] for j in joints] for i in joints]
    return [[C[i][j] + C[j][i] for j in joints] for i in joints]
