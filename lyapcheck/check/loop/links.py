"""Whether some links make a matrix of polynomials."""

from __future__ import annotations

from collections.abc import Sequence

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.loop.chain import Posture, RigidLink
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.statement import Monomials


def makes(links: Sequence[RigidLink], mass: Sequence[Sequence[Monomials]]) -> bool:
    """Whether M(q) of the links has these entries, polynomials in sin q_1 … sin q_n, cos q_1 … cos q_n.

    Soundness: both sides are reduced by s² = 1 − c², after which equal functions are equal polynomials.
    """
    n = len(links)
    ring = fmpq_mpoly_ctx.get([f"{letter}{i}" for letter in "sc" for i in range(n)], Ordering.lex)
    gens = ring.gens()

    def reduced(polynomial: fmpq_mpoly) -> fmpq_mpoly:
        degrees = polynomial.degrees()
        for i in range(n):
            if degrees[i] >= 2:
                _, polynomial = divmod(polynomial, gens[i] ** 2 + gens[n + i] ** 2 - 1)
        return polynomial

    of = Algebra(lambda x: ring.constant(rational(x)), reduced)
    rows = Posture(links, gens[:n], gens[n:], of).mass()
    return all(
        reduced(ring.from_dict(_terms(mass[i][j])) - rows[i][j]) == 0 for i in range(n) for j in range(n)
    )


def _terms(entry: Monomials) -> dict[tuple[int, ...], fmpq]:
    found: dict[tuple[int, ...], fmpq] = {}
    for powers, c in entry:
        found[powers] = found.get(powers, fmpq(0)) + rational(c)
    return found
