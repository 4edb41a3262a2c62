"""What links say of polynomials: whether they make a given M(q), and whether gravity leaves joints alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.loop.affine import at_corner, corners_of, is_affine
from lyapcheck.check.loop.chain import Posture, RigidLink
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.statement import Ends, Monomials

Reduce = Callable[[fmpq_mpoly], fmpq_mpoly]


def makes(links: Sequence[RigidLink], mass: Sequence[Sequence[Monomials]]) -> bool:
    """Whether M(q) of the links has these entries, polynomials in sin q_1 … sin q_n, cos q_1 … cos q_n.

    Soundness: both sides are reduced by s² = 1 − c², after which equal functions are equal polynomials.
    """
    n, (ring, reduced) = len(links), _ring(len(links))
    rows = _posture(links, ring, reduced).mass()
    return all(
        reduced(ring.from_dict(_terms(mass[i][j])) - rows[i][j]) == 0 for i in range(n) for j in range(n)
    )


def makes_at_corners(
    arms: Sequence[Sequence[RigidLink]], mass: Sequence[Sequence[Monomials]], parameters: Sequence[Ends]
) -> bool:
    """Whether M is affine in each parameter, and at each corner of their ranges that of real links given.

    Soundness: M then is everywhere a mean of its values at the corners, and so are its rates.
    """
    n, corners = len(mass), list(corners_of(parameters))
    real = all(len(links) == n and all(link.fits for link in links) for links in arms)
    return (
        is_affine(mass, n)
        and real
        and len(arms) == len(corners)
        and all(
            makes(links, [[at_corner(entry, 2 * n, corner) for entry in row] for row in mass])
            for links, corner in zip(arms, corners, strict=True)
        )
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
