"""What links say of polynomials: whether they make a given M(q), and whether gravity leaves joints alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.loop.chain import Posture, RigidLink
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.statement import Monomials

Reduce = Callable[[fmpq_mpoly], fmpq_mpoly]


def makes(links: Sequence[RigidLink], mass: Sequence[Sequence[Monomials]]) -> bool:
    """Whether these are real links whose M(q) has these entries, polynomials in sin q_1 …, cos q_1 … cos q_n.

    Soundness: both sides are reduced by s² = 1 − c², after which equal functions are equal polynomials.
    """
    if len(links) != len(mass) or not all(link.fits for link in links):
        return False
    n, (ring, reduced) = len(links), _ring(len(links))
    rows = _posture(links, ring, reduced).mass()
    return all(
        reduced(ring.from_dict(_terms(mass[i][j])) - rows[i][j]) == 0 for i in range(n) for j in range(n)
    )


def no_torque(links: Sequence[RigidLink], fall: Sequence[Fraction], joints: Sequence[int]) -> bool:
    """Whether g_i(q) = 0 for all q at some joints, counted from 0; as polynomials, like `makes`."""
    ring, reduced = _ring(len(links))
    torque = _posture(links, ring, reduced).torques(fall)
    return all(reduced(torque[i]) == 0 for i in joints)


def _ring(n: int) -> tuple[fmpq_mpoly_ctx, Reduce]:
    """Polynomials in the sines and then the cosines, and their normal form without squares of sines."""
    ring = fmpq_mpoly_ctx.get([f"{letter}{i}" for letter in "sc" for i in range(n)], Ordering.lex)
    gens = ring.gens()

    def reduced(polynomial: fmpq_mpoly) -> fmpq_mpoly:
        degrees = polynomial.degrees()
        for i in range(n):
            if degrees[i] >= 2:
                _, polynomial = divmod(polynomial, gens[i] ** 2 + gens[n + i] ** 2 - 1)
        return polynomial

    return ring, reduced


def _posture(links: Sequence[RigidLink], ring: fmpq_mpoly_ctx, reduced: Reduce) -> Posture:
    n, gens = len(links), ring.gens()
    return Posture(links, gens[:n], gens[n:], Algebra(lambda x: ring.constant(rational(x)), reduced))


def _terms(entry: Monomials) -> dict[tuple[int, ...], fmpq]:
    result: dict[tuple[int, ...], fmpq] = {}
    for powers, c in entry:
        result[powers] = result.get(powers, fmpq(0)) + rational(c)
    return result
